#!/bin/bash
# Eight daemons behind one uplink of 2 Mbit/s, as at home: all take part, and the bytes are those of one machine. In a
# network of its own, with the kernel's own queue: 77 where that can't be had.
set -u
if [ -z "${SLOW_UPLINK:-}" ]; then
    programs=$(realpath "${1:?usage: $0 FOLDER_OF_PROGRAMS}")
    apart="unshare -mn"
    [ "$(id -u)" = 0 ] || apart="unshare -Urmn"
    command -v tc > /dev/null && $apart true 2> /dev/null || exit 77
    SLOW_UPLINK=1 exec timeout -k 2 100 $apart bash "$(realpath "$0")" "$programs"
fi
programs=$1 work=$(mktemp -d) numbers=() far=uplink$$
mount --make-rprivate /
mount -t tmpfs none /run && mkdir -p /run/netns && ip netns add $far || exit 77
trap 'kill -9 "${numbers[@]}" 2> /dev/null; wait 2> /dev/null; ip netns del $far; rm -rf "$work"' EXIT
cd "$work" && export HOME=$work
ip link set lo up
ip link add near type veth peer name far netns $far
ip link set near up && ip addr add 10.9.1.1/24 dev near
ip -n $far link set lo up && ip -n $far link set far up && ip -n $far addr add 10.9.1.2/24 dev far
queue="root tbf rate 2mbit burst 16k latency 400ms"
tc qdisc add dev near $queue && ip netns exec $far tc qdisc add dev far $queue || exit 77

{ printf '%s\n' 'LookAt 0 1 -4  0 1 0  0 1 0' 'Camera "perspective"' 'Film "rgb"' WorldBegin \
      'LightSource "infinite" "rgb L" [ 1 2 3 ]' 'Material "diffuse"' 'Shape "sphere"'
  head -c 60000 /dev/urandom | base64 -w 100 | sed 's/^/#/'; } > scene.pbrt
cat > scene.lua << 'E2'
scene = Scene { "scene.pbrt" }
light = PathTracing {}
image = RayTracer { light, scene = scene, samples = 32, film = { 128, 128, file = "x.exr" } }
E2
for i in 1 2 3 4 5 6 7 8; do
    ip netns exec $far "$programs/lightnetd" --listen tcp://10.9.1.2:770$i --insecure --places 1 --cache "$work/c$i" \
        > d$i.log 2>&1 &
    numbers+=($!)
    echo "place 'tcp://10.9.1.2:770$i' {}" >> hosts.lua
done
for i in 1 2 3 4 5 6 7 8; do
    for _ in $(seq 200); do grep -q "listening on" d$i.log && break; sleep .05; done
done
"$programs/lightnet" run scene.lua --cache none --progress plain --tile 16 --hosts hosts.lua --insecure -o far.exr > log 2>&1 ||
    { cat log; exit 1; }
"$programs/lightnet" run scene.lua --cache none --progress none --threads 1 -o near.exr || exit 1
cmp far.exr near.exr || exit 1
[ "$(grep -c 'is ready' log)" = 8 ] && ! grep -q 'is lost' log || { cat log; exit 1; }
