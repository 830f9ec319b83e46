-- The network of the paper's figure 5, which figure 7 and Table 3 distribute: direct light, caustics from a photon map,
-- and an irradiance cache that gathers the light of all other surfaces. A lamp, a glass ball and a mirror in the Cornell
-- box.
--
--     image ─▶ lighting ─┬─────────────────────────┬▶ direct
--                        ├───────────────────────┬─│▶ caustics
--                        └▶ soft ─▶ first ─┬─────│─┘
--                                          ├─────┘
--                                          └▶ global
--
-- lightnet run graphs/paper/figure5.lua -D file=/somewhere/scene.pbrt -D width=640 -D height=360
file = "../glass_ball.pbrt"
width, height, samples, rays = 256, 256, 16, 0    -- 0 rays: as many as that wants
wanted_error, photons = 0.04, 0    -- how far off the picture may be; 0 photons: as many as that wants

scene    = Scene           { file }
direct   = DirectLighting  { samples = 1 }
caustics = PhotonMap       { paths = "caustic", photons = photons, error = wanted_error, gather = 50 }
global   = PhotonMap       { paths = "diffuse", photons = photons, error = wanted_error, gather = 50 }
first    = Combine         { direct, caustics, global }
soft     = IrradianceCache { first, rays = rays, glossy_rays = 4, error = wanted_error }
lighting = Combine         { direct, caustics, soft }
image    = RayTracer       { lighting, scene = scene, samples = samples, film = { width, height, file = "figure5.exr" } }
