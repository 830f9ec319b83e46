#!/bin/bash
# lightnet-health [ADDRESS:PORT]: whether the daemon of this container can take work (its --metrics). For images without
# curl. Where something else than a daemon is process 1, there is nothing to ask.
address=${1:-127.0.0.1:9100}
[ -n "${1-}" ] || [ "$(cat /proc/1/comm 2>/dev/null)" = lightnetd ] || exit 0
exec 3<>"/dev/tcp/${address%:*}/${address##*:}" || exit 1
printf 'GET /healthz HTTP/1.1\r\nHost: %s\r\nConnection: close\r\n\r\n' "$address" >&3
read -r -t 5 _ code _ <&3 && [ "$code" = 200 ]
