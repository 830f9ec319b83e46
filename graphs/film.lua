-- A short film: the camera goes through the Cornell box with the ball of glass, and one kind of light comes up.
-- lightnet run film.lua --frames 1-24
frames = 24

eye = keys { [1] = { 278, 273, -800 }, [12] = { 420, 330, -600 }, [24] = { 120, 180, -640 }, smooth = true }
at  = keys { [1] = { 278, 273, 0 }, [24] = { 240, 200, 200 } }

scene    = Scene { "glass_ball.pbrt", camera = { from = eye, to = at } }
direct   = DirectLighting { samples = 1 }
bounce   = PathTracing    { samples = 1 }
lighting = Combine        { direct, bounce }
image    = RayTracer {
    lighting,
    scene = scene,
    samples = 32,
    film = { 192, 192, gains = { bounce = keys { [1] = 0.25, [frames] = 1 } }, file = "film.####.exr" }
}
