-- Lab 4: an irradiance cache, and where its records lie. -D wanted_error=0.05
wanted_error, rays, samples = 0.02, 512, 16

scene    = Scene           { "../cornell_box.pbrt" }
direct   = DirectLighting  {}
paths    = PathTracing     { paths = "all" }
soft     = IrradianceCache { paths, rays = rays, error = wanted_error }
dots     = RecordPositions { of = soft }
lighting = Combine         { direct, soft }
image    = RayTracer { lighting, scene = scene, samples = samples, show = { dots },
                       film = { 256, 256, file = "records.exr" } }
