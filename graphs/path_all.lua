-- Any scene by path tracing in one node, several light paths per sample: quicker than path.lua, without layers.
-- lightnet run graphs/path_all.lua -D file=/somewhere/scene.pbrt -D width=640 -D height=360
file = "cornell_box.pbrt"
width, height, samples, paths = 256, 256, 16, 4

scene    = Scene { file }
lighting = PathTracing { paths = "all", samples = paths }
image    = RayTracer   { lighting, scene = scene, samples = samples, film = { width, height, file = "path_all.exr" } }
