-- Lab 2: -D how=lamps, directions, balance or power.
how = "power"
scene = Scene { "plates.pbrt" }
direct = DirectLighting { heuristic = how }
image = RayTracer { direct, scene = scene, samples = 16, film = { 256, 192, file = "mis.exr" } }
