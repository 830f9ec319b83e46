-- The old library's own renderer, which follows one ray at a time, with lightnet's light: its picture is one layer.
size, samples = 256, 16

scene  = Scene { "cornell_box.pbrt" }
direct = DirectLighting { samples = 1 }
image  = CandelaEye { direct, scene = scene, samples = samples, film = { size, size, file = "traditional_eye.exr" } }
