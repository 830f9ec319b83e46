-- Groups of lamps through caches: photons carry the group of their lamp, records of the cache hold one irradiance for
-- each. So a group's layers have its light, and nothing of another's.
wanted_error, photons, rays, samples = 0.04, 0, 384, 16    -- 0 photons: as many as the error wants

scene    = Scene { "studio.pbrt", groups = { key = "softbox", fill = "reflector", rim = "rim light" } }
direct   = DirectLighting  { groups = true }
caustics = PhotonMap       { groups = true, paths = "caustic", photons = photons, error = wanted_error }
global   = PhotonMap       { groups = true, paths = "diffuse", photons = photons, error = wanted_error }
first    = Combine         { direct, caustics, global }
soft     = IrradianceCache { first, groups = true, rays = rays, error = wanted_error }
lighting = Combine         { direct, caustics, soft }
image    = RayTracer { lighting, groups = true, scene = scene, samples = samples,
                       film = { 512, 384, file = "studio_maps.exr" } }
