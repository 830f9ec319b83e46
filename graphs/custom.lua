-- Ambient occlusion as a function of this file: it goes to all hosts with the graph, and runs in a sandbox there.
-- lightnet run graphs/custom.lua
rays, distance = 16, 300

ao = Custom {
    light = function(q, ask)
        local open = 0
        for i = 1, rays do
            open = q:open(hemisphere(q.n, q:random(i, rays)), distance) + open
        end
        return open / rays
    end
}

scene = Scene { "cornell_box.pbrt" }
image = RayTracer { ao, scene = scene, samples = 16, film = { 256, 256, file = "custom.exr" } }
