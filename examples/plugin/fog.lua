-- The Cornell box in fog. lightnet run fog.lua --plugin build/fog.so
scene  = Scene { "box.pbrt" }
direct = DirectLighting {}
foggy  = Fog { direct, from = { 278, 273, -800 }, half = 800 }
image  = RayTracer { foggy, scene = scene, samples = 16, film = { 256, 256, file = "fog.exr" } }
