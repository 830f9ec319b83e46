-- Two daemons on this machine, each with the whole network; start them with
--   lightnetd --listen tcp://127.0.0.1:7777
--   lightnetd --listen tcp://127.0.0.1:7778
place "tcp://127.0.0.1:7777" { places = 1 }
place "tcp://127.0.0.1:7778" { places = 1 }
