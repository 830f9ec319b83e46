-- Any scene by path tracing whose paths are guided: where light comes by a narrow way, as through a door that stands ajar.
-- lightnet run graphs/guided.lua -D file=/somewhere/scene.pbrt -D width=640 -D height=360 -D samples=64
file = "cornell_box.pbrt"
width, height, samples, paths, when = 256, 256, 16, 4, "worthwhile"
lessons = 0  -- light paths that the guide learns from; 0: one for every 24 of the picture, 60000 at least

local all = width * height * samples * paths

scene    = Scene       { file }
guide    = Guide       { paths = lessons > 0 and lessons or math.max(60000, all // 24), picture = all, when = when }
lighting = PathTracing { paths = "all", samples = paths, guide = guide }
image    = RayTracer   { lighting, scene = scene, samples = samples, film = { width, height, file = "guided.exr" } }
