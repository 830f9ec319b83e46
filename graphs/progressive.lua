-- Any scene by progressive photon mapping: each sample has photons of its own, and is sharper than the one before; as
-- many as wanted (--samples), also later (--resume). For caustics, also those that are seen in mirrors.
-- lightnet run graphs/progressive.lua -D file=/somewhere/scene.pbrt
file = "glass_ball.pbrt"
width, height, samples, photons = 256, 256, 64, 100000

scene    = Scene          { file }
direct   = DirectLighting { samples = 1 }
indirect = ProgressivePhotonMapping { paths = "indirect", photons = photons }
lighting = Combine        { direct, indirect }
image    = RayTracer { lighting, scene = scene, samples = samples, film = { width, height, file = "progressive.exr" } }
