#!/usr/bin/env bash
# keys_how_to.sh BIN ROOT: does literally what "With keys, in ten lines" of docs/trust.md says, on two hosts: network
# namespaces, joined by a cable. `ssh render1` and `scp … render1:` lead from the one to the other. Exit code 77: this
# system gives us no such hosts.
set -euo pipefail
bin=$1 root=$2
cant() { echo "$*"; exit 77; }
[ "$(id -u)" -eq 0 ] || cant "only root makes network namespaces"
command -v ip >/dev/null || cant "the program ip is not here (package iproute2)"
desk=lightnet-desk-$$ render=lightnet-render-$$ folder=$(mktemp -d)
clean_up() {
    for name in "$desk" "$render"; do
        ip netns pids "$name" 2>/dev/null | xargs -r kill 2>/dev/null || true
        ip netns del "$name" 2>/dev/null || true
    done
    rm -rf "$folder"
}
trap clean_up EXIT
for name in "$desk" "$render"; do ip netns add "$name" 2>/dev/null || cant "this system makes no network namespaces"; done
ip link add eth0 netns "$desk" type veth peer name eth0 netns "$render" 2>/dev/null || cant "this system joins no network namespaces"
number=1
for name in "$desk" "$render"; do
    ip -n "$name" addr add "10.99.0.$number/24" dev eth0
    ip -n "$name" link set eth0 up
    ip -n "$name" link set lo up
    number=$((number + 1))
done

mkdir -p "$folder"/{desk,render,shims}
ln -s "$root/graphs" "$folder/desk/graphs"
cat >"$folder/shims/ssh" <<END
#!/usr/bin/env bash
[ "\$1" = render1 ] || exit 1
shift
cd "$folder/render" && exec ip netns exec "$render" env HOME="$folder/render" bash -c "\$*"
END
cat >"$folder/shims/scp" <<END
#!/usr/bin/env bash
[ "\$2" = render1: ] && exec cp "\$1" "$folder/render/"
END
chmod +x "$folder"/shims/*

awk '/^## With keys, in ten lines/ { found = 1 } /^```/ { if (inside) exit; inside = found; next } inside' \
    "$root/docs/trust.md" >"$folder/how_to"
lines=$(grep -c . "$folder/how_to")
[ "$lines" -ge 5 ] && [ "$lines" -le 10 ] || { echo "$lines lines are not ten"; exit 1; }
unset LIGHTNET_KEY XDG_CONFIG_HOME
cd "$folder/desk"
ip netns exec "$desk" env HOME="$folder/desk" PATH="$folder/shims:$bin:$PATH" bash -eux "$folder/how_to"
[ -s cornell.exr ] || { echo "there is no picture"; exit 1; }
grep -q '"tcp://10.99.0.2:7777"' cornell.run.json || { echo "somebody else has rendered"; exit 1; }
[ "$(stat -c %a .config/lightnet/key ../render/.config/lightnet/key | sort -u)" = 600 ]
