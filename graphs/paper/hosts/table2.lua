-- For figure3.lua: the paper's Table 2, eight ray tracers and six lighting networks on four hosts with eight
-- processors. It shows how near to eight times as fast that is.
--
--     host 1: 4 × image, 4 × lighting    ┐
--     host 2: 2 × image, 2 × lighting    │ each image asks whichever lighting answers first,
--     host 3: 1 × image                  │ of its own host or another
--     host 4: 1 × image                  ┘
--
-- Daemons on this machine: lightnetd --listen tcp://127.0.0.1:7777, and three more up to 7780.
place "tcp://127.0.0.1:7777" { places = 4, image = 4, lighting = 4, soft = 4, direct = 4 }
place "tcp://127.0.0.1:7778" { places = 2, image = 2, lighting = 2, soft = 2, direct = 2 }
place "tcp://127.0.0.1:7779" { places = 1, image = 1 }
place "tcp://127.0.0.1:7780" { places = 1, image = 1 }
