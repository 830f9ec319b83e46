-- Lab 6: path tracing a caustic, as it is and clamped. -D most=1
most, samples = 1, 64

scene    = Scene       { "../glass_ball.pbrt" }
direct   = DirectLighting {}
bounce   = PathTracing {}
tame     = Clamp       { bounce, most = most }
lighting = Combine     { direct, tame }
image    = RayTracer { lighting, scene = scene, samples = samples, film = { 256, 256, file = "fireflies.exr" } }
