-- The paper's figure 8: the network of figure5.lua, and beside the picture what its operators give each other: the light
-- that the cache gathers, where photons and records lie, and how densely.
--
--     image ─▶ lighting ─┬▶ direct
--       ┊                ├▶ caustics ┄ dots
--       ┊ show           └▶ soft ┄ records
--       ┊                    ▼
--       └┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄▶ first ─┬▶ direct
--                                 ├▶ caustics
--                                 └▶ global ┄ density
--
-- To see each in its place in the graph:
-- lightnet run graphs/paper/figure8.lua -o figure8.exr
-- lightnet dot graphs/paper/figure8.lua --pictures figure8.exr | dot -Tpng > figure8.png
file = "../glass_ball.pbrt"
width, height, samples, rays = 256, 256, 16, 256
wanted_error, photons = 0.04, 0    -- how far off the picture may be; 0 photons: as many as that wants

scene    = Scene           { file }
direct   = DirectLighting  { samples = 1 }
caustics = PhotonMap       { paths = "caustic", photons = photons, error = wanted_error, gather = 50 }
global   = PhotonMap       { paths = "diffuse", photons = photons, error = wanted_error, gather = 50 }
first    = Combine         { direct, caustics, global }
soft     = IrradianceCache { first, rays = rays, error = wanted_error }
lighting = Combine         { direct, caustics, soft }

dots     = PhotonPositions { of = caustics }
density  = PhotonDensity   { of = global }
records  = RecordPositions { of = soft }
image    = RayTracer       { lighting, show = { global, first, dots, density, records }, scene = scene, samples = samples, film = { width, height, file = "figure8.exr" } }
