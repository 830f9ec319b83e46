-- The Cornell box in clay, from a lens of its own, under an evening sky.
scene = Scene { "cornell_box.pbrt", camera = { from = { 420, 400, -700 }, to = { 278, 250, 280 }, fov = 45, lens = 8, focus = 950 }, environment = { 0.2, 0.3, 0.5 }, environment_scale = 2, exposure = 1, material = "clay" }
direct = DirectLighting {}
bounce = PathTracing {}
light = Combine { direct, bounce }
image = RayTracer { light, scene = scene, samples = 64, film = { 512, 512, file = "clay.exr" } }
