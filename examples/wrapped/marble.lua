-- The Cornell box in marble. lightnet run marble.lua --plugin build/marble.so
scene  = Scene { "box.pbrt" }
direct = DirectLighting {}
stone  = Marble { direct, size = 300 }
image  = RayTracer { stone, scene = scene, samples = 16, film = { 256, 256, file = "marble.exr" } }
