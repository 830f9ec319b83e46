-- Any scene by progressive photon mapping: as many passes as samples, each sharper than the one before. For caustics,
-- also those that are seen in mirrors. lightnet run graphs/progressive.lua -D file=/somewhere/scene.pbrt
file = "glass_ball.pbrt"
width, height, passes, photons = 256, 256, 64, 100000

scene    = Scene          { file }
direct   = DirectLighting { samples = 1 }
indirect = ProgressivePhotonMapping { paths = "indirect", passes = passes, photons = photons }
lighting = Combine        { direct, indirect }
image    = RayTracer { lighting, scene = scene, samples = passes, film = { width, height, file = "progressive.exr" } }
