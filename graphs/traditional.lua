-- Classes of an old lighting library, wrapped as they are (nodes/examples/candela), beside nodes of lightnet. The library
-- asks one point at a time; what it asks leaves in bundles all the same.
size, samples, rays = 256, 16, 2

scene    = Scene { "cornell_box.pbrt" }
direct   = CandelaDirect   { rays = 1 }
gathered = CandelaGathered { direct, rays = rays }
dimmed   = CandelaDimmed   { gathered, limit = 10 }
lighting = Combine         { direct, dimmed }
image    = RayTracer       { lighting, scene = scene, samples = samples, film = { size, size, file = "traditional.exr" } }
