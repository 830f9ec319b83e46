-- Two balls of fur: light goes through their hairs, many times, and is turned and coloured by each.
scene    = Scene { "fur.pbrt" }
direct   = DirectLighting { samples = 1 }
bounce   = PathTracing    { samples = 1, max_depth = 50 }
lighting = Combine        { direct, bounce }
image    = RayTracer      { lighting, scene = scene, samples = 64, film = { 512, 512, file = "fur.exr" } }
