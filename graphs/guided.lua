-- Any scene by path tracing whose paths are guided: where light comes by a narrow way, as through a door that stands ajar.
-- lightnet run graphs/guided.lua -D file=/somewhere/scene.pbrt -D width=640 -D height=360 -D samples=256
file = "cornell_box.pbrt"
width, height, samples, paths, when = 256, 256, 64, 150000, "worthwhile"

scene    = Scene          { file }
direct   = DirectLighting { samples = 1 }
guide    = Guide          { paths = paths, when = when }
bounce   = PathTracing    { samples = 1, guide = guide }
lighting = Combine        { direct, bounce }
image    = RayTracer { lighting, scene = scene, samples = samples, film = { width, height, file = "guided.exr" } }
