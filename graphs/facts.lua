-- The Cornell box with what compositing wants beside it: facts about the surfaces that are seen.
size, samples = 256, 64

scene    = Scene { "cornell_box.pbrt" }
direct   = DirectLighting { samples = 1 }
bounce   = PathTracing    { samples = 1 }
lighting = Combine        { direct, bounce }

alpha    = SurfaceFact { of = "coverage" }
depth    = SurfaceFact { of = "depth" }
normal   = SurfaceFact { of = "normal" }
position = SurfaceFact { of = "position" }
albedo   = SurfaceFact { of = "albedo" }

beside   = { alpha, depth, normal, position, albedo }
image    = RayTracer { lighting, show = beside, scene = scene, samples = samples, film = { size, size, file = "facts.exr" } }
