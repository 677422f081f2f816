#!/bin/sh
# Installs the Debian packages that the build needs, if any is missing. Works as root or through sudo; does nothing when all are there.
#   scripts/setup.sh         what building and testing need
#   scripts/setup.sh --ci    and what .ci/run needs besides (clang, fuzzing; OpenGL in software for tests/twin; Python for tests/capture; Slurm
#                            and Snakemake for scripts/cluster; what --aarch64 does)
#   scripts/setup.sh --aarch64   what scripts/aarch64.sh needs alone: a cross compiler and an emulator
set -eu

packages="g++ cmake ninja-build ccache
  libembree-dev libglm-dev libtinygltf-dev libopenimageio-dev openimageio-tools libopenexr-dev libpng-dev libtbb-dev libssl-dev libzip-dev
  libdraco-dev libmeshoptimizer-dev libwebp-dev
  libcli11-dev nlohmann-json3-dev libjs-chart.js
  catch2 libbenchmark-dev librapidcheck-dev libboost-dev libmpfr-dev dpkg-dev file"
if [ "${1:-}" = "--ci" ]; then packages="$packages clang clang-format libclang-rt-dev libepoxy-dev libegl-dev libegl1 libgl1-mesa-dri
  python3-numpy python3-jsonschema g++-aarch64-linux-gnu qemu-user slurm-wlm munge snakemake"; fi
if [ "${1:-}" = "--aarch64" ]; then packages="g++-aarch64-linux-gnu cmake ninja-build ccache qemu-user"; fi

if ! command -v dpkg-query >/dev/null; then
    echo "setup: this is not a Debian system; install the equivalents of:" $packages >&2
    exit 2
fi

missing=""
for package in $packages; do
    status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
    [ "$status" = "install ok installed" ] || missing="$missing $package"
done
if [ -z "$missing" ]; then
    echo "setup: all packages are installed"
    exit 0
fi

if [ "$(id -u)" = 0 ]; then
    run=""
elif command -v sudo >/dev/null; then
    run="sudo"
else
    echo "setup: these packages are missing; install them as root:$missing" >&2
    exit 3
fi
echo "setup: installing$missing"
$run apt-get update -q
$run env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
