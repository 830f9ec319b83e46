-- A picture for compositing: alpha, what is seen of the scene, and mattes by name (Cryptomatte) beside the light.
scene = Scene { "studio.pbrt", groups = { key = "softbox", rim = "rim light" },
                camera = { from = { -0.3, 1.5, -5.8 }, to = { 0.1, 1.3, 0 }, fov = 55 } }

direct   = DirectLighting { groups = true }
bounce   = PathTracing    { groups = true }
lighting = Combine        { direct, bounce }

depth          = SurfaceFact { of = "depth" }
normal         = SurfaceFact { of = "camera_normal" }
albedo         = SurfaceFact { of = "albedo" }
CryptoObject   = Cryptomatte { of = "object" }
CryptoMaterial = Cryptomatte { of = "material" }
CryptoLamp     = Cryptomatte { of = "lamp", ranks = 2 }

image = RayTracer { lighting, groups = true, alpha = true, background = false, scene = scene, samples = 64,
                    show = { depth, normal, albedo, CryptoObject, CryptoMaterial, CryptoLamp },
                    film = { 512, 384, half = true, compression = "zips", file = "compositing.exr" } }
