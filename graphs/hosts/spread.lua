-- For cornell.lua: its light operators on other hosts than those who ask them, two of them twice, so that questions
-- travel and multiplexers choose. Daemons as in two.lua.
place "tcp://127.0.0.1:7777" { image = 1, direct = 1, bounce = 2 }
place "tcp://127.0.0.1:7778" { image = 1, lighting = 2 }
