-- The network of the paper's Table 1: code that asks for one point at a time and was not written to be distributed
-- (nodes/examples/candela). One operator gathers light, and asks another about each spot that it meets; on two hosts, each
-- question travels. 2 samples of 16 rays for 76 × 76 pixels are about the paper's 128,070 questions.
--
--     image ──▶ gathered ──▶ direct
--
-- lightnet run graphs/paper/table1.lua --hosts graphs/paper/hosts/table1.lua
file = "../cornell_box.pbrt"
width, height, samples, rays = 76, 76, 2, 16

scene    = Scene           { file }
direct   = CandelaDirect   {}
gathered = CandelaGathered { direct, rays = rays }
image    = RayTracer       { gathered, scene = scene, samples = samples, film = { width, height, file = "table1.exr" } }
