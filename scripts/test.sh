#!/bin/sh
# Builds everything and runs all tests: the README's test command. Quick when nothing changed.
#   scripts/test.sh [PRESET]    release (default), dev (address and undefined-behaviour sanitizers), tsan, ci
set -eu
cd "$(dirname "$0")/.."
preset=${1:-release}

scripts/setup.sh
scripts/configure.sh "$preset"
cmake --build "build/$preset"
ctest --test-dir "build/$preset" --output-on-failure --parallel 2 --timeout 300
