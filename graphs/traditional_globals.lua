-- A class of an old lighting library that draws its random numbers from a global variable (nodes/examples/candela): one
-- call at a time in each process, by a named lock.
size, samples = 256, 16

scene = Scene { "cornell_box.pbrt" }
open  = CandelaOpen { rays = 4, near = 150 }
image = RayTracer   { open, scene = scene, samples = samples, film = { size, size, file = "traditional_globals.exr" } }
