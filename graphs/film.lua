-- A short film: the camera goes through the Cornell box with the ball of glass, and one kind of light comes up. Each
-- frame is blurred by what the camera moves in half of its time.
-- lightnet run film.lua --frames 1-48
frames = 48

eye = keys { [1] = { 278, 273, -800 }, [24] = { 420, 330, -600 }, [48] = { 120, 180, -640 }, smooth = true }
at  = keys { [1] = { 278, 273, 0 }, [48] = { 240, 200, 200 } }

scene    = Scene { "glass_ball.pbrt", camera = { from = eye, to = at }, shutter = { 0, 0.5 } }
direct   = DirectLighting { samples = 1 }
bounce   = PathTracing    { samples = 1 }
lighting = Combine        { direct, bounce }
image    = RayTracer {
    lighting,
    scene = scene,
    samples = 32,
    film = { 192, 192, gains = { bounce = keys { [1] = 0.25, [frames] = 1 } }, file = "film.####.exr" }
}
