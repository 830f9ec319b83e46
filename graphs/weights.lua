-- Sums of sums: layers by how often light was reflected, with weights of their own. Light that was reflected
-- once counts half as much again (`often` has it as well), and a little light comes from everywhere.
size, samples = 256, 16

scene    = Scene { "cornell_box.pbrt" }
direct   = DirectLighting   { samples = 1 }
once     = PathTracing      { samples = 1, max_depth = 1 }
often    = PathTracing      { samples = 1 }
openness = AmbientOcclusion { samples = 4 }

indirect = Combine   { once, often, weights = { 0.5, 1 } }
mood     = Combine   { indirect, openness, weights = { 1, 0.05 } }
lighting = Combine   { direct, mood }
image    = RayTracer { lighting, scene = scene, samples = samples, film = { size, size, file = "weights.exr" } }
