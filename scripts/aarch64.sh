#!/bin/sh
# The passes on another architecture: cross-builds them and tests/golden for aarch64 and runs the golden frames under qemu's emulation. Every bit must be
# that of x86-64. Libraries for arm64 are unpacked to build/aarch64/sysroot; nothing but the cross compiler and qemu is installed.
# Two minutes of processor time to build, one to run.
#   scripts/aarch64.sh              all golden frames
#   scripts/aarch64.sh NAME...      those alone (names of tests/golden/goldens.json)
set -eu
cd "$(dirname "$0")/.."
folder=$PWD/build/aarch64
sysroot=$folder/sysroot
triplet=aarch64-linux-gnu
libraries="libtbb-dev libtinygltf-dev libssl-dev libglm-dev nlohmann-json3-dev"

scripts/setup.sh --aarch64

# apt with an index and a package state of its own, so that this machine's stay as they are: an empty arm64 machine gets the libraries and all below them.
if [ ! -f "$sysroot/complete" ]; then
    rm -rf "$sysroot" "$folder/apt"
    mkdir -p "$sysroot/usr/lib" "$folder/apt/lists/partial" "$folder/apt/cache/archives/partial"
    : >"$folder/apt/status"
    apt_arm64() {
        apt-get -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Sandbox::User=root -o APT::Install-Recommends=false \
            -o Dir::State="$folder/apt" -o Dir::State::status="$folder/apt/status" -o Dir::Cache="$folder/apt/cache" "$@"
    }
    apt_arm64 update
    apt_arm64 install -y --download-only $libraries
    ln -s usr/lib "$sysroot/lib"  # releases differ in which of the two they name
    for package in "$folder"/apt/cache/archives/*.deb; do dpkg-deb --fsys-tarfile "$package" | tar -x --keep-directory-symlink -C "$sysroot"; done
    touch "$sysroot/complete"
fi

scripts/configure.sh release -B "$folder/passes" -DLRSM_PASSES_ONLY=ON \
    -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_CXX_COMPILER=$triplet-g++ -DCMAKE_LIBRARY_ARCHITECTURE=$triplet \
    -DCMAKE_FIND_ROOT_PATH="$sysroot" -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY \
    -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY -DCMAKE_CXX_FLAGS="-isystem $sysroot/usr/include/$triplet" \
    -DCMAKE_EXE_LINKER_FLAGS="-Wl,-rpath-link,$sysroot/usr/lib/$triplet"
cmake --build "$folder/passes" --target lrsm_golden

golden() {
    "qemu-${triplet%%-*}" -L "$sysroot" "$folder/passes/tests/lrsm_golden" tests/golden/goldens.json 0 "$@"
}
if [ $# = 0 ]; then
    golden
else
    for name in "$@"; do golden --only "$name"; done
fi
