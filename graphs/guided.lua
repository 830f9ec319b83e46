-- Any scene by path tracing whose paths are guided: where light comes by a narrow way, as through a door that stands ajar.
-- lightnet run graphs/guided.lua -D file=/somewhere/scene.pbrt -D width=640 -D height=360 -D samples=256
file = "cornell_box.pbrt"
width, height, samples, when = 256, 256, 64, "worthwhile"
paths = 0  -- that the guide learns from; 0: one for every 14 samples of the picture

scene    = Scene       { file }
guide    = Guide       { paths = paths > 0 and paths or math.floor(width * height * samples / 14) + 64, when = when }
lighting = PathTracing { paths = "all", guide = guide }
image    = RayTracer   { lighting, scene = scene, samples = samples, film = { width, height, file = "guided.exr" } }
