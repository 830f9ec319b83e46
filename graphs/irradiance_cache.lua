-- Any scene whose diffuse interreflection is interpolated: direct light as it is, caustics from a photon map, and an
-- irradiance cache that gathers all other light by path tracing.
-- lightnet run graphs/irradiance_cache.lua -D file=/somewhere/scene.pbrt -D width=640 -D height=360
file = "cornell_box.pbrt"
width, height, samples, rays = 256, 256, 16, 0    -- 0 rays: as many as the error wants
wanted_error = 0.04    -- how far off the picture may be, root mean square

scene    = Scene           { file }
direct   = DirectLighting  { samples = 1 }
paths    = PathTracing     { paths = "all", samples = 1 }
caustics = PhotonMap       { paths = "caustic", error = wanted_error }
soft     = IrradianceCache { paths, rays = rays, error = wanted_error }
lighting = Combine         { direct, caustics, soft }
image    = RayTracer { lighting, scene = scene, samples = samples, film = { width, height, file = "irradiance_cache.exr" } }
