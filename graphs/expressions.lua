-- Layers by light path expressions, as other renderers write them: the key light however it arrives, and what all other
-- lamps give, directly and by way of other surfaces.
scene = Scene { "studio.pbrt", groups = { key = "softbox" } }

direct   = DirectLighting { groups = true }
bounce   = PathTracing    { groups = true }
lighting = Combine        { direct, bounce }

image = RayTracer { lighting, groups = true, scene = scene, samples = 64,
                    layers = { softbox = "C.*<L.'key'>", lit = "CS*D<L.'rest'>", indirect = "CS*D.+<L.'rest'>" },
                    film = { 512, 384, file = "expressions.exr" } }
