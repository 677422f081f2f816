#!/bin/sh
# The accuracy table of docs/accuracy.md: every scene under every preset against the path tracer, on `irradiance`.
#   scripts/accuracy.sh [SIZE [SPP [OUT]]]      default 640x360, 512, out/accuracy
# Scenes: the built-ins, and the views in $LRSM_SCENES/views (default ../shared/scenes) where they exist. References are kept and
# reused; delete OUT to make them anew. "RMSE/mean" is as measured; "noise" is the truth's own share of it, from its stored variance; "net" is
# the rest, sqrt(RMSE^2 - noise^2).
set -eu
cd "$(dirname "$0")/.."
size=${1:-640x360}
spp=${2:-512}
out=${3:-out/accuracy}
lrsm=${LRSM:-build/release/apps/lrsm}
presets=${PRESETS:-literal fast balanced accurate}
views=${LRSM_SCENES:-../shared/scenes}/views

scenes=${SCENES:-cornell-box two-rooms atrium furnace}
for view in "$views"/*.json; do
    if [ -z "${SCENES:-}" ] && [ -f "$view" ]; then scenes="$scenes $view"; fi
done

# The first value of a key in one of our JSON files, rounded.
value() { sed -n "s/.*\"$2\": \([-0-9.e+]*\),*$/\1/p" "$1" | head -n 1 | awk -v f="$3" '{ printf f, $1 }'; }

mkdir -p "$out"
table=$out/table.md
{
    echo "| scene | preset | energy | RMSE/mean | noise | net | MAE/mean | FLIP | frame ms |"
    echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
} >"$table"
for scene in $scenes; do
    name=$(basename "$scene" .json)
    reference=$out/reference/$name
    if [ ! -f "$reference/frame.json" ]; then
        echo "accuracy: reference of $name, $spp samples a pixel" >&2
        mkdir -p "$out/reference"
        "$lrsm" reference "$scene" --size "$size" --spp "$spp" --block 64 -o "$reference" --quiet >/dev/null
    fi
    for preset in $presets; do
        echo "accuracy: $name, $preset" >&2
        mkdir -p "$out/$preset" "$out/compare/$preset"
        "$lrsm" render "$scene" --preset "$preset" --size "$size" -o "$out/$preset/$name" --quiet >/dev/null
        "$lrsm" compare "$out/$preset/$name" "$reference" -o "$out/compare/$preset/$name" --quiet >/dev/null
        json=$out/compare/$preset/$name/compare.json
        rmse=$(value "$json" rmse_over_mean %.3f)
        noise=$(value "$json" noise_rmse_over_mean %.3f)
        net=$(awk -v r="$rmse" -v n="$noise" 'BEGIN { printf "%.3f", (r > n ? sqrt(r * r - n * n) : 0) }')
        echo "| $name | $preset | $(value "$json" energy_ratio %.2f) | $rmse | $noise | $net |" \
            "$(value "$json" mae_over_mean %.3f) | $(value "$json" mean %.3f) | $(value "$out/$preset/$name/frame.json" milliseconds %.0f) |" >>"$table"
    done
done
cat "$table"
