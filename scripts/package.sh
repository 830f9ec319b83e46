#!/usr/bin/env bash
# package.sh [FOLDER]: makes packages of this tree (.deb, tar.gz, sources, a wheel of the module for Python, an add-on for Blender) and puts them
# into FOLDER (default: out).
# Two builds of one commit give the same bytes: all times in them are those of the commit.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p "${1:-out}"
folder=$(cd "${1:-out}" && pwd)

SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null || stat -c %Y CHANGELOG.md)
export SOURCE_DATE_EPOCH LC_ALL=C TZ=UTC
umask 022
scripts/build.sh package lightnet lightnetd manuals
gzip -9nc CHANGELOG.md >build/package/share/changelog.gz
version=$(sed -n 's/^project(lightnet VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
maintainer=$(sed -n 's/^LIGHTNET_MAINTAINER:STRING=//p' build/package/CMakeCache.txt)
printf 'lightnet (%s-1) unstable; urgency=medium\n\n  * See changelog.gz.\n\n -- %s  %s\n' \
    "$version" "$maintainer" "$(date -R -d "@$SOURCE_DATE_EPOCH")" | gzip -9nc >build/package/share/changelog.Debian.gz
find build/package/share/man -name '*.1' -exec gzip -9nf {} +
rm -rf build/package/_CPack_Packages
(cd build/package && cpack -B "$folder" >cpack.log 2>&1 && cpack --config CPackSourceConfig.cmake -B "$folder" >>cpack.log 2>&1) ||
    { cat build/package/cpack.log; exit 1; }
rm -rf "$folder/_CPack_Packages"

python3 python/wheel.py "$folder" >/dev/null
python3 blender/zip.py "$folder" >/dev/null

# What cpack gets wrong: times in the tar, and, in packages of symbols, checksums of files by where they were staged.
again=$(mktemp -d)
trap 'rm -rf "$again"' EXIT
for package in "$folder"/*-dbgsym_*.ddeb; do
    dpkg-deb -R "$package" "$again/symbols"
    sed -i 's|  /.*/usr/lib/debug/|  usr/lib/debug/|' "$again/symbols/DEBIAN/md5sums"
    dpkg-deb --root-owner-group -Zgzip -b "$again/symbols" "$package" >/dev/null
    rm -r "$again/symbols"
done
for tarball in "$folder"/lightnet-*-Linux.tar.gz; do
    mkdir "$again/tar"
    tar -xzf "$tarball" -C "$again/tar"
    tar --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner -C "$again/tar" -c . |
        gzip -9n >"$tarball"
    rm -r "$again/tar"
done
ls -1 "$folder"
