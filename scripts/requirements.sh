#!/bin/sh
# The tables of docs/requirements.md: what the scene analysis saves, on against off, and what the advice of `lrsm info` costs and saves, scene by scene.
#   scripts/requirements.sh [SIZE [SPP [OUT]]]      default 320x180, 512, out/requirements
# Scenes: SCENES, else the built-ins and the views in $LRSM_SCENES/views (default ../shared/scenes) where they exist. Each setting is rendered REPEAT times (3),
# beside calibration frames. References are kept and reused (REFERENCES). Interrupted, the same command goes on.
set -eu
cd "$(dirname "$0")/.."
size=${1:-320x180}
spp=${2:-512}
out=${3:-out/requirements}
lrsm=${LRSM:-build/release/apps/lrsm}

scenes=${SCENES:-cornell-box cornell-glossy two-rooms atrium furnace}
for view in "${LRSM_SCENES:-../shared/scenes}/views"/*.json; do
    if [ -z "${SCENES:-}" ] && [ -f "$view" ]; then scenes="$scenes $view"; fi
done
for scene in $scenes; do
    name=$(basename "$scene" .json)
    sweep() { "$lrsm" sweep "$scene" -o "$out/$name" --size "$size" --spp "$spp" --repeat "${REPEAT:-3}" --path-tracer 0 --quiet --references "${REFERENCES:-$out/references}" "$@"; }
    sweep --axis force_everything=true --axis drop_empty=false
    # "  --set voxel_resolution=256 (512): why" of the advice
    advice=$("$lrsm" info "$scene" --size "$size" | sed -n 's/^  --set \([^ ]*\) .*/--axis \1/p')
    if [ -n "$advice" ]; then sweep $advice; fi
    printf '# %s\n\n' "$name"
    sed -n '/^## One setting/,$p' "$out/$name/tables.md"
done
