-- For figure3.lua: the paper's figure 3, ray tracers that are spread over the network, and lighting objects in threads
-- of one process, each group behind a multiplexer.
--
--     tcp://…:7777   image ─┐                                  ┌▶ lighting, soft, direct   thread 1
--     tcp://…:7778   image ─┼▶ multiplexer ── this process ────┼▶ lighting, soft, direct   thread 2
--                           ┘                                  └▶ lighting, soft, direct   thread 3
--
-- Daemons on this machine: lightnetd --listen tcp://127.0.0.1:7777, and one at 7778.
place "tcp://127.0.0.1:7777" { image = 1 }
place "tcp://127.0.0.1:7778" { image = 1 }
place "here" { places = 3, lighting = 3, soft = 3, direct = 3 }
