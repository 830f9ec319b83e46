-- For figure5.lua: the paper's figure 7. The launcher is host 0: its master renderer deals the picture out to the slave
-- renderers of hosts 3, 4 and 5. These see one facade of all lighting, the entry of the network on host 1, which asks
-- the other operators beside it and on host 2.
--
--     host 0              host 3, 4, 5        host 1                    host 2
--     master renderer ─┬▶ image ──────────┬▶ lighting ─┬▶ direct
--                      ├▶ image ──────────┤            ├──────────────▶ caustics
--                      └▶ image ──────────┘            └▶ soft ─▶ first ─▶ global
--
-- Daemons on this machine: lightnetd --listen tcp://127.0.0.1:7777, and four more up to 7781.
place "tcp://127.0.0.1:7777" { places = 2, lighting = 1, direct = 1, soft = 2, first = 1 }
place "tcp://127.0.0.1:7778" { places = 2, caustics = 2, global = 2 }
place "tcp://127.0.0.1:7779" { places = 1, image = 1 }
place "tcp://127.0.0.1:7780" { places = 1, image = 1 }
place "tcp://127.0.0.1:7781" { places = 1, image = 1 }
