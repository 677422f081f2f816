#!/bin/sh
# The truths of this folder: what the path tracer says of the built-in scenes, single bounce. A few minutes on two cores.
#   tests/accuracy/make_truth.sh [SCENE...]      default: all of `lrsm info --list`
# Needs build/release with `lrsm` and `lrsm_accuracy`; then `lrsm_accuracy --measure` (README.md).
set -eu
cd "$(dirname "$0")/../.."
lrsm=${LRSM:-build/release/apps/lrsm}
accuracy=${LRSM_ACCURACY:-build/release/tests/lrsm_accuracy}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for scene in ${*:-$("$lrsm" info --list | cut -d: -f1)}; do
    "$lrsm" reference "$scene" -o "$work/$scene" --model single --size 96x54 --target-noise 0.0025 --block 64
    "$accuracy" --store "$work/$scene/image.exr" "tests/accuracy/truth/$scene.exr"
done
