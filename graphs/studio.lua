-- Light taken apart: one rendering, a layer for each group of lamps by way of each operator.
-- lightnet remix studio.exr key=0.6 sky=1.5 rim=1,0.8,0.6 -o evening.exr
scene = Scene { "studio.pbrt", groups = { key = "softbox", fill = "reflector", rim = "rim light", sky = "environment" } }

direct   = DirectLighting { groups = true, samples = 2 }
bounce   = PathTracing    { groups = true }
lighting = Combine        { direct, bounce }

image = RayTracer { lighting, groups = true, scene = scene, samples = 64, film = { 512, 384, file = "studio.exr" } }
