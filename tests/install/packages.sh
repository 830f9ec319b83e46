#!/usr/bin/env bash
# packages.sh SOURCES [FOLDER]: packages of this tree (those in FOLDER, if it is given) pass lintian, and are installed,
# upgraded and purged in a root that has nothing but a minimal Debian. Ends with 77 where that can't be played.
set -euo pipefail
sources=$1
. "$(dirname "$0")/minimal_root.sh"
skip() { echo "not run: $*"; exit 77; }
fail() { echo "$*"; exit 1; }
for tool in debootstrap lintian dpkg-deb chroot; do command -v "$tool" >/dev/null || skip "$tool is not here"; done
[ "$(id -u)" -eq 0 ] || skip "it takes root"

folder=$(mktemp -d)
trap 'umount "$folder/root/proc" 2>/dev/null || true; rm -rf --one-file-system "$folder"' EXIT
packages=${2-}
[ -n "$packages" ] || { packages=$folder/packages; "$sources/scripts/package.sh" "$packages" >/dev/null; }
ls "$packages"/lightnet-dbgsym_*.ddeb "$packages"/lightnetd-dbgsym_*.ddeb >/dev/null || fail "no debug symbols"

errors=$(lintian --fail-on none --tag-display-limit 0 "$packages"/*.deb 2>/dev/null | grep '^E:' || true)
[ -z "$errors" ] || fail "$errors"

dpkg-deb --fsys-tarfile "$packages"/lightnetd_*.deb | tar -xO ./usr/lib/systemd/system/lightnetd.service >"$folder/unit"
grep -c '^ExecStart=/usr/bin/lightnetd ' "$folder/unit" >/dev/null || fail "the unit starts another program"

root=$folder/root
minimal_root "$root" "$folder/debootstrap.log"
mount -t proc proc "$root/proc" 2>/dev/null || mount --rbind /proc "$root/proc" || skip "/proc can't be mounted"
inside() { DEBIAN_FRONTEND=noninteractive LC_ALL=C HOME=/root chroot "$root" "$@"; }
apt() { inside apt-get -qq -y --no-install-recommends "$@" >"$folder/apt.log" 2>&1 || { cat "$folder/apt.log"; fail "apt-get $1 failed"; }; }
mkdir "$root/packages"
cp "$packages"/*.deb "$root/packages/"
before=$(inside sh -c 'ls -d /usr/share/lightnet /usr/bin/lightnet* 2>/dev/null' || true)
[ -z "$before" ] || fail "the root is not clean: $before"

# Installed: the first picture, from nothing.
begin=$(date +%s)
apt update
apt install $(cd "$root" && ls ./packages/lightnet_*.deb ./packages/lightnetd_*.deb | sed 's|^\.||')
inside sh -c 'cd /tmp && lightnet run /usr/share/lightnet/graphs/cornell.lua --size 64x64 --samples 4 --progress none -o one.exr'
echo "from nothing to the first picture: $(($(date +%s) - begin)) s"
if inside sh -c 'command -v c++ || command -v cmake' >/dev/null; then fail "there is a compiler: the root is not what it should be"; fi
inside sh -c 'cd /tmp && lightnet run /usr/share/lightnet/graphs/cornell.lua --size 64x64 --samples 4 --progress none --local-workers 2 -o two.exr && cmp one.exr two.exr'
# The page Start, word by word, with no compiler.
sed -n '/^```sh$/,/^```$/p' "$sources/docs/start.md" | sed '/^```/d' >"$root/tmp/start.sh"
inside sh -c 'mkdir /tmp/start && cd /tmp/start && bash -eu /tmp/start.sh' >"$folder/start.log" 2>&1 </dev/null || { cat "$folder/start.log"; fail "the page Start fails"; }
inside gzip -dc /usr/share/man/man1/lightnet-run.1.gz | grep -c '^\.TH LIGHTNET-RUN 1 ' >/dev/null

# Upgraded: the same files under a higher version.
for package in lightnet lightnetd; do
    dpkg-deb -R "$packages/$package"_*.deb "$folder/new-$package"
    sed -i 's/^Version: .*/&.1/' "$folder/new-$package/DEBIAN/control"
    dpkg-deb --root-owner-group -b "$folder/new-$package" "$root/packages/new-$package.deb" >/dev/null
done
apt install /packages/new-lightnet.deb /packages/new-lightnetd.deb
inside dpkg-query -W lightnet | grep -c '\.1$' >/dev/null || fail "it was not upgraded"
inside sh -c 'cd /tmp && lightnet run /usr/share/lightnet/graphs/cornell.lua --size 64x64 --samples 4 --progress none -o three.exr && cmp one.exr three.exr'

# Purged: nothing is left.
mkdir -p "$root/var/cache/private/lightnetd"
apt purge lightnet lightnetd
left=$(find "$root/usr" "$root/etc" "$root/var/cache" "$root/lib" -name '*lightnet*' | head)
[ -z "$left" ] || fail "left behind: $left"
