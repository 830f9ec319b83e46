-- Direct light: what comes straight from the lamp.
size, samples = 256, 16

scene  = Scene { "cornell_box.pbrt" }
direct = DirectLighting { samples = 4 }
image  = RayTracer { direct, scene = scene, samples = samples, film = { size, size, file = "direct.exr" } }
