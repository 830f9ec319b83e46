-- For paper/figure5.lua: each of the two daemons keeps the photons of one half of the room, and those that are near to it; questions
-- go where they lie. All other nodes are on both. Daemons as in two.lua.
layout = "sharded"
place "tcp://127.0.0.1:7777" { places = 1 }
place "tcp://127.0.0.1:7778" { places = 1 }
