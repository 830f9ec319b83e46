-- Lab 5: the same light by a coarse photon map looked at directly, and by final gathering from it.
-- -D way=direct or -D way=gather
way, photons, samples = "gather", 30000, 16

scene  = Scene     { "../cornell_box.pbrt" }
direct = DirectLighting {}
coarse = PhotonMap { paths = "diffuse", photons = photons }
first  = Combine   { direct, coarse }
gather = FinalGather { first, rays = 4 }
lighting = way == "gather" and Combine { direct, gather } or Combine { direct, coarse }
image  = RayTracer { lighting, scene = scene, samples = samples, film = { 256, 256, file = "gather.exr" } }
