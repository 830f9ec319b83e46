-- A room in fog, with a ball of milk and a lump of smoke: each collision of light is asked about as a surface is.
scene    = Scene { "fog.pbrt" }
direct   = DirectLighting { samples = 1 }
bounce   = PathTracing    { samples = 1, max_depth = 100 }
lighting = Combine        { direct, bounce }
image    = RayTracer      { lighting, scene = scene, samples = 64, film = { 512, 512, file = "fog.exr" } }
