-- For cornell.lua: the two replicas of `bounce` each get the same parts of the scene again and again, so that what they
-- have in their caches is of use; all other nodes are asked where the answer is expected first. Daemons as in two.lua.
strategy { bounce = "affinity" }
place "tcp://127.0.0.1:7777" { image = 1, direct = 1, bounce = 1 }
place "tcp://127.0.0.1:7778" { image = 1, lighting = 1, bounce = 1 }
