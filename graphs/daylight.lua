-- The Cornell box with its front open to a clear sky, whose sun shines in: lamp, sun and sky each in layers of their own.
scene = Scene { "cornell_box.pbrt", sky = { towards = { -0.4, 0.8, -1 }, turbidity = 4, scale = 30, sun_angle = 3 }, groups = { sun = "sun", sky = "environment" } }
direct = DirectLighting { groups = true }
bounce = PathTracing { groups = true }
light = Combine { direct, bounce }
image = RayTracer { light, scene = scene, samples = 64, film = { 512, 512, file = "daylight.exr" } }
