-- The Cornell box with a glass ball by few samples, and a picture without noise beside it: quiet.clean.exr.
size, samples = 256, 32

scene    = Scene { "glass_ball.pbrt" }
direct   = DirectLighting { samples = 1 }
bounce   = PathTracing    { samples = 1 }
lighting = Combine        { direct, bounce }
image    = RayTracer      { lighting, scene = scene, samples = samples, film = { size, size, clean = true, file = "quiet.exr" } }
