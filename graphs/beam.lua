-- Fog around a glass ball: the light that it gathers is a beam, which photons find and paths hardly do.
scene    = Scene { "glass_ball.pbrt", fog = { density = 0.0004, albedo = 0.95 } }
direct   = DirectLighting { samples = 1 }
caustics = PhotonMap      { paths = "caustic", photons = 100000, beams = 20000 }
rest     = FinalGather    { direct }
lighting = Combine        { direct, caustics, rest }
image    = RayTracer      { lighting, scene = scene, samples = 64, film = { 512, 512, file = "beam.exr" } }
