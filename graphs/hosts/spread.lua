-- For cornell.lua: every light operator somewhere else, two of them twice, so that questions travel. Daemons as in
-- two.lua.
place "tcp://127.0.0.1:7777" { image = 1, direct = 1, bounce = 1 }
place "tcp://127.0.0.1:7778" { image = 1, bounce = 1, lighting = 1 }
