#!/bin/sh
# Configures a preset of CMakePresets.json once, with ccache where it is installed.
#   scripts/configure.sh PRESET [cmake arguments]
set -eu
cd "$(dirname "$0")/.."
preset=$1
shift

launcher=""
if command -v ccache >/dev/null; then launcher=-DCMAKE_CXX_COMPILER_LAUNCHER=ccache; fi
# Ninja reconfigures by itself when a CMake file changes.
if [ ! -f "build/$preset/build.ninja" ] || [ $# -gt 0 ]; then
    cmake --preset "$preset" $launcher "$@"
fi
