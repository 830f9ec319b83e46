-- For figure5.lua: the paper's Table 3, different operators on three hosts with seven processors; the photon maps, which
-- have most to do, on all of them. It shows what is lost where hosts wait for each other.
--
--     host 1, 4 processors: lighting, first, direct, caustics, global  ◀─┐
--     host 2, 2 processors: image, soft, caustics, global ───────────────┤
--     host 3, 1 processor:  image, caustics, global ─────────────────────┘
--
-- Daemons on this machine: lightnetd --listen tcp://127.0.0.1:7777, and two more up to 7779.
place "tcp://127.0.0.1:7777" { places = 4, lighting = 4, first = 4, direct = 4, caustics = 4, global = 4 }
place "tcp://127.0.0.1:7778" { places = 2, image = 2, soft = 2, caustics = 2, global = 2 }
place "tcp://127.0.0.1:7779" { places = 1, image = 1, caustics = 1, global = 1 }
