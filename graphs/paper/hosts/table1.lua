-- For table1.lua: the paper's Table 1. The operator that asks is on one host and the one that answers on another, so that
-- every question travels. What bundles are worth: the same with --bundle 1 --credit 1 --spare-fibers 0.
--
--     host 1: image, gathered ──▶ host 2: direct
--
-- Daemons on this machine: lightnetd --listen tcp://127.0.0.1:7777, and one at 7778.
place "tcp://127.0.0.1:7777" { places = 1, image = 1, gathered = 1 }
place "tcp://127.0.0.1:7778" { places = 1, direct = 1 }
