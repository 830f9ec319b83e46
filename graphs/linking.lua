-- Light linking: the rim light falls on the clay ball alone, all other lamps on everything.
scene  = Scene { "studio.pbrt", groups = { rim = "rim light" } }

edge   = DirectLighting { lamps = "rim" }
linked = Select         { edge, material = "clay" }
others = DirectLighting { lamps = "rest" }
bounce = PathTracing    { lamps = "rest" }
light  = Combine        { linked, others, bounce }
image  = RayTracer      { light, scene = scene, samples = 64, film = { 512, 384, file = "linking.exr" } }
