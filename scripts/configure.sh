#!/bin/sh
# Configures a preset of CMakePresets.json once, with ccache where it is installed.
#   scripts/configure.sh PRESET [cmake arguments, as -B FOLDER]
set -eu
cd "$(dirname "$0")/.."
preset=$1
shift

launcher=""
# The sloppiness lets it remember units that use a precompiled header, which all tests do.
if command -v ccache >/dev/null; then
    launcher="-DCMAKE_CXX_COMPILER_LAUNCHER=env;CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime;ccache"
fi
# Ninja reconfigures by itself when a CMake file changes.
if [ ! -f "build/$preset/build.ninja" ] || [ $# -gt 0 ]; then
    cmake --preset "$preset" ${launcher:+"$launcher"} "$@"
fi
