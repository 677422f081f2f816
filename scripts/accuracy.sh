#!/bin/sh
# The figures of docs/accuracy.md: sweeps against the path tracer, their tables and plots. An hour on two cores; interrupted, the same command goes on.
#   scripts/accuracy.sh [OUT]      default out/accuracy
# Scenes: built-ins, and the views in $LRSM_SCENES/views (default ../shared/scenes); UNSEEN adds scenes to the last table. References are kept in
# OUT/references, or REFERENCES, and reused.
set -eu
cd "$(dirname "$0")/.."
out=${1:-out/accuracy}
lrsm=${LRSM:-build/release/apps/lrsm}
references=${REFERENCES:-$out/references}
views=${LRSM_SCENES:-../shared/scenes}/views
page=docs/accuracy.md

existing() {
    for view in "$@"; do
        if [ -f "$views/$view.json" ]; then echo "$views/$view.json"; fi
    done
}
chosen="cornell-box two-rooms atrium $(existing sponza sibenik-nave)"
search="$chosen $(existing sibenik-carpet)"
unseen="furnace cornell-glossy $(existing cornell sponza-curtains) ${UNSEEN:-}"
effects="cornell-glossy atrium $(existing sponza sibenik-nave)"
sweep() { "$lrsm" sweep "$@" --spp 2048 --references "$references"; }

# The points that tune offers, presets among them, and the path tracer.
sweep $chosen -o "$out/points" --axes points --size 640x360 --repeat 1
# One setting at a time around balanced.
sweep $effects -o "$out/settings" --axes one-at-a-time --repeat 1 --path-tracer 0
# The front, searched from two bases.
sweep $search -o "$out/search" --axes search --repeat 1 --path-tracer 0 --budget 90
sweep $search -o "$out/search" --axes search --repeat 1 --path-tracer 0 --budget 60 --set cone_count=16 --set emitter_delay_taps=2.5 --set emitter_slant_cap=0.25 --set depth_layers=3
# Scenes that played no part in the choice, and the chosen ones at the same size.
sweep $search -o "$out/seen" --axes points --repeat 1 --path-tracer 0
sweep $unseen -o "$out/unseen" --axes points --repeat 1

scripts/accuracy_tables.py $page presets "$out/points/sweep.csv"
scripts/accuracy_tables.py $page points "$out/points/sweep.csv"
scripts/accuracy_tables.py $page effects "$out/settings/sweep.csv"
scripts/accuracy_tables.py $page unseen "$out/unseen/sweep.csv" "$out/seen/sweep.csv"
scripts/plots.py front "$out/points/sweep.csv" docs/images/accuracy-front.png
scripts/plots.py front "$out/search/sweep.csv" docs/images/accuracy-search.png
