#!/usr/bin/env bash
# namespaces.sh HOSTS PLACES DAEMON PROGRAM ARGUMENT...: hosts of their own on one machine. Each is a network
# namespace with an address, and all are joined by a bridge in one more; nothing touches the machine's real network. In
# each, DAEMON is started, told where to listen and its places; in one more host PROGRAM is run, told all their endpoints behind its
# arguments. Takes everything away afterwards. Exit code 77, and why: this system gives us no such hosts.
set -euo pipefail
hosts=$1 places=$2 daemon=$3
shift 3
lab=lightnet-$$ port=7777
address() { echo "10.78.$(($1 / 250)).$(($1 % 250 + 1))"; }
cant() { echo "$*"; exit 77; }

[ "$(id -u)" -eq 0 ] || cant "only root makes network namespaces"
command -v ip >/dev/null || cant "the program ip is not here (package iproute2)"
made=() daemons=()
clean_up() {
    [ ${#daemons[@]} -eq 0 ] || { kill "${daemons[@]}" && wait "${daemons[@]}"; } 2>/dev/null || true
    for name in "${made[@]}"; do ip netns del "$name" || true; done
}
trap clean_up EXIT
make() { ip netns add "$1" 2>/dev/null || cant "this system makes no network namespaces"; made+=("$1"); }

make "$lab-bridge"
ip -n "$lab-bridge" link add name bridge type bridge 2>/dev/null || cant "this system has no bridges"
ip -n "$lab-bridge" link set bridge up
endpoints=()
for ((i = 0; i <= hosts; ++i)); do
    make "$lab-$i"
    ip link add eth0 netns "$lab-$i" type veth peer name "host$i" netns "$lab-bridge" 2>/dev/null ||
        cant "this system joins no network namespaces"
    ip -n "$lab-bridge" link set "host$i" master bridge up
    ip -n "$lab-$i" addr add "$(address "$i")/16" dev eth0
    ip -n "$lab-$i" link set eth0 up
    ip -n "$lab-$i" link set lo up
    [ "$i" -gt 0 ] || continue
    endpoint=tcp://$(address "$i"):$port
    ip netns exec "$lab-$i" "$daemon" "$endpoint" "$places" &
    daemons+=($!)
    endpoints+=("$endpoint")
done
ip netns exec "$lab-0" "$@" "${endpoints[@]}"
