-- The Cornell box: direct and indirect light, each a layer of its own.
size, samples = 256, 64

scene    = Scene { "cornell_box.pbrt" }
direct   = DirectLighting { samples = 1 }
bounce   = PathTracing    { samples = 1 }
lighting = Combine        { direct, bounce }
image    = RayTracer      { lighting, scene = scene, samples = samples, film = { size, size, file = "cornell.exr" } }
