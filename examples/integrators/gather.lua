-- The Cornell box, its indirect light gathered by an integrator of the GNU Scientific Library, off surfaces whose light
-- is traced by paths. lightnet run gather.lua --plugin build/integrators.so
scene  = Scene { "box.pbrt" }
direct = DirectLighting {}
bounce = PathTracing    {}
first  = Combine        { direct, bounce }
soft   = PlainGather    { first, calls = 16 }
light  = Combine        { direct, soft }
image  = RayTracer      { light, scene = scene, samples = 16, film = { 128, 128, file = "gather.exr" } }
