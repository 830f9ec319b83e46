-- Lab 3: a photon map of caustics, its photons as dots, and how dense they are.
-- -D photons=20000 -D nearest=60
photons, nearest, samples = 20000, 60, 16

scene    = Scene     { "../glass_ball.pbrt" }
direct   = DirectLighting {}
caustics = PhotonMap { paths = "caustic", photons = photons, gather = nearest }
dots     = PhotonPositions { of = caustics }
lighting = Combine   { direct, caustics }
image    = RayTracer { lighting, scene = scene, samples = samples, show = { dots },
                       film = { 256, 256, file = "photons.exr" } }
