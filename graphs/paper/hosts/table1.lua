-- For figure3.lua: the paper's Table 1, a network whose operators are all on other hosts than those whom they ask, so
-- that every question travels. What bundles are worth: the same with --bundle 1 --credit 1 --spare-fibers 0.
--
--     host 1: image, soft ──▶ host 2: direct
--               └──▶ host 3: lighting ──▶ host 1: soft, host 2: direct
--
-- Daemons on this machine: lightnetd --listen tcp://127.0.0.1:7777, and two more up to 7779.
place "tcp://127.0.0.1:7777" { places = 1, image = 1, soft = 1 }
place "tcp://127.0.0.1:7778" { places = 1, direct = 1 }
place "tcp://127.0.0.1:7779" { places = 1, lighting = 1 }
