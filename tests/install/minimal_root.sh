# minimal_root FOLDER LOG: a minimal Debian of this machine's release and mirror in FOLDER. To be sourced; ends the script by
# skip() where there is none to be had.
minimal_root() {
    local release mirror
    release=$(. /etc/os-release && echo "$VERSION_CODENAME")
    mirror=$(sed -n 's/^URIs: *//p; s/^deb \(\[[^]]*\] \)\?\([^ ]*\) .*/\2/p' /etc/apt/sources.list \
        /etc/apt/sources.list.d/* 2>/dev/null | head -n 1 || true)
    debootstrap --variant=minbase "$release" "$1" ${mirror:+"$mirror"} >"$2" 2>&1 || {
        tail -n 5 "$2"
        skip "no packages of $release can be reached"
    }
}
