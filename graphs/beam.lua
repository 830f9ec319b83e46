-- A ball of glass in fog: what it does to a cone of light is a beam, which photons find and paths do not.
scene    = Scene { "beam.pbrt" }
direct   = DirectLighting { samples = 1 }
caustics = PhotonMap      { paths = "caustic", photons = 100000, beams = 50000 }
lighting = Combine        { direct, caustics }
image    = RayTracer      { lighting, scene = scene, samples = 64, film = { 512, 512, file = "beam.exr" } }
