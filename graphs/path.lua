-- Any scene by path tracing: lightnet run graphs/path.lua -D file=/somewhere/scene.pbrt -D width=640 -D height=360
file = "cornell_box.pbrt"
width, height, samples = 256, 256, 16

scene    = Scene { file }
direct   = DirectLighting { samples = 1 }
bounce   = PathTracing    { samples = 1 }
lighting = Combine        { direct, bounce }
image    = RayTracer      { lighting, scene = scene, samples = samples, film = { width, height, file = "path.exr" } }
