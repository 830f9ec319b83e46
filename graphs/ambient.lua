-- Ambient occlusion in the Cornell box: how open its corners are.
size, samples = 256, 16

scene    = Scene { "cornell_box.pbrt" }
openness = AmbientOcclusion { samples = 8, distance = 0 }
image    = RayTracer { openness, scene = scene, samples = samples, film = { size, size, file = "ambient.exr" } }
