-- The network of the paper's figure 5: direct light, caustics from a photon map, and an irradiance cache that
-- gathers the light of all other surfaces. A lamp, a glass ball and a mirror in the Cornell box.
-- lightnet run graphs/figure5.lua -D file=/somewhere/scene.pbrt -D width=640 -D height=360
file = "glass_ball.pbrt"
width, height, samples, photons, rays = 256, 256, 16, 200000, 256

scene    = Scene           { file }
direct   = DirectLighting  { samples = 1 }
caustics = PhotonMap       { paths = "caustic", photons = photons, gather = 50 }
global   = PhotonMap       { paths = "diffuse", photons = photons, gather = 50 }
first    = Combine         { direct, caustics, global }
soft     = IrradianceCache { first, rays = rays }
lighting = Combine         { direct, caustics, soft }
image    = RayTracer       { lighting, scene = scene, samples = samples, film = { width, height, file = "figure5.exr" } }
