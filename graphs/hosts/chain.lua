-- For cornell.lua: three levels of hosts that ask each other. What renders asks the lighting on another host, and that asks
-- its operators on two more; at each level a multiplexer deals out to hosts, and each host to its places.
--
--     image ──▶ lighting, lighting ─┬▶ direct, direct
--                                   ├▶ bounce, bounce
--                                   └▶ bounce (the fourth host)
--
-- Daemons on this machine: lightnetd --listen tcp://127.0.0.1:7777, and three more up to 7780.
place "tcp://127.0.0.1:7777" { places = 1, image = 1 }
place "tcp://127.0.0.1:7778" { places = 2, lighting = 2 }
place "tcp://127.0.0.1:7779" { places = 2, direct = 2, bounce = 2 }
place "tcp://127.0.0.1:7780" { places = 1, bounce = 1 }
