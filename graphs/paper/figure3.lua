-- The paper's figure 3, and what its Tables 1 and 2 render: any number of ray tracers ask any number of lighting
-- networks, by way of a multiplexer. Here each network adds direct light and one bounce of it by irradiance gradients.
--
--                          ┌▶ lighting ─┬▶ direct
--     image ─┐             │            └▶ soft ──▶ direct
--     image ─┼▶ multiplexer┼▶ lighting …
--     image ─┘             └▶ lighting …
--
-- lightnet run graphs/paper/figure3.lua --hosts graphs/paper/hosts/figure3.lua
file = "../cornell_box.pbrt"
width, height, samples, rays = 256, 256, 16, 128

scene    = Scene           { file }
direct   = DirectLighting  { samples = 1 }
soft     = IrradianceCache { direct, rays = rays }
lighting = Combine         { direct, soft }
image    = RayTracer       { lighting, scene = scene, samples = samples, film = { width, height, file = "figure3.exr" } }
