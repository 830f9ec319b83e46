#!/usr/bin/env bash
# Installs what lightnet is built from, where Debian's packages are and we may; elsewhere names them. With --tests, what
# only tests use as well.
# The one place that lists the packages; they have the same names in Debian 12 (Embree 3) and 13 (Embree 4).
set -euo pipefail

packages=(
    build-essential cmake ninja-build pkg-config        # the build
    libembree-dev libopenexr-dev libpng-dev libjpeg62-turbo-dev libtiff-dev   # rays and pictures
    libopencolorio-dev                                  # how pictures are shown
    libwebp-dev libgif-dev libzstd-dev                  # more kinds of pictures
    libjemalloc-dev                                     # memory in large pages
    libeigen3-dev                                       # linear equations
    libdraco-dev libmeshoptimizer-dev                   # packed meshes
    libosd-dev                                          # smooth surfaces of cages
    libpugixml-dev zlib1g-dev                           # scenes in XML
    libblosc-dev                                        # packed grids
    libboost-dev libboost-context-dev libzmq3-dev cppzmq-dev libmsgpack-cxx-dev libssl-dev libxxhash-dev   # fibers, HTTP, sockets, hashes
    libsodium-dev                                       # keys
    liblua5.4-dev libfmt-dev libcli11-dev nlohmann-json3-dev        # graphs, text, command lines, JSON
    libgtest-dev libgmock-dev libbenchmark-dev          # tests and benchmarks
)

# What tests hold our files, pictures and hosts against; a test whose program is missing skips itself, and ./test fails.
packages_of_tests=(
    graphviz python3-jsonschema prometheus              # drawings, reports, metrics as their own programs read them
    python3-openimageio python3-numpy openimageio-tools # pictures, as another library reads them; the module for Python
    clang-format                                        # how sources are laid out
    iproute2                                            # network namespaces: hosts of their own
    openssh-client openssh-server python3-yaml          # hosts by ssh; what deploys farms
    libnoise-dev libgsl-dev                             # what examples wrap
    python3-nbclient python3-ipykernel                  # notebooks
    libnanovdb-dev libopenvdb-dev                       # grids as their own libraries write them
    slurm-client slurmctld slurmd munge                 # a queue
)

if [ "${1-}" = --list ]; then
    printf '%s\n' "${packages[@]}"
    exit 0
fi
[ "${1-}" != --tests ] || packages+=("${packages_of_tests[@]}")

if ! command -v dpkg-query >/dev/null; then
    echo "lightnet is built from these packages of Debian 12 or 13; please see that their likes are here:" >&2
    echo "  ${packages[*]}" >&2
    exit 0   # CMake names what it misses
fi

missing=()
for package in "${packages[@]}"; do
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$state" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null || ! sudo -v; then
        echo "please install these packages, as root:" >&2
        echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi

echo "installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends "${missing[@]}" >/dev/null
