#!/bin/sh
# The tables of docs/sequences.md: what flickers, by preset and by what should hold still. An hour on two cores; interrupted, the same command goes on.
#   scripts/sequences.sh [OUT]      default out/sequences
# Needs sponza.glb and dragon_lowres.glb in $LRSM_SCENES (default ../shared/scenes). SIZE, FRAMES, SPP: of all pictures and the truth; CASES, CHOICES: some only.
set -eu
cd "$(dirname "$0")/.."
out=${1:-out/sequences}
lrsm=${LRSM:-build/release/apps/lrsm}
scenes=$(realpath "${LRSM_SCENES:-../shared/scenes}")
frames="--frames 0:${FRAMES:-12} --fps 24 --size ${SIZE:-160x90} --quiet"
cases=${CASES:-"moving-sun moving-dragons moving-out"}
mkdir -p "$out"
cp docs/examples/sequences/*.json "$out" # a view's files are looked for beside it
ln -sf "$scenes/sponza.glb" "$scenes/dragon_lowres.glb" "$scenes/cornell_box.glb" "$out"

# A row of the table: choice, and of the irradiance F, the truth's, F_e, V, J, RMSE of the middle frame.
row() {
    python3 -c 'import json, sys
layer = json.load(open(sys.argv[1]))["layers"][0]
text = lambda v: "-" if v is None else "%.3g" % v
frames = layer["frames"]
print("| " + " | ".join([sys.argv[2], text(layer["fe"]), text(layer["f"]), text(layer["f_reference"]), text(layer["v"]), text(layer["j"]),
                         text(frames[len(frames) // 2]["rmse_over_mean"])]) + " |")' "$1" "$2"
}
# compare CASE NAME TITLE
compare() {
    "$lrsm" compare --sequence "$out/$1/$2" "$out/$1/truth" -o "$out/$1/$2-flicker" --quiet
    row "$out/$1/$2-flicker/compare.json" "$3" >>"$out/$1.md"
}

for case in $cases; do
    view=$out/$case.json
    # The truth, and a second one: the floor of what can be told.
    for seed in 0 1; do
        folder=$out/$case/truth; [ $seed = 0 ] || folder=$out/$case/truth-of-seed-$seed
        "$lrsm" reference $view $frames --spp "${SPP:-256}" --eye-side-only --seed $seed -o "$folder"
    done
    { echo "| $case | F_e | F | F of the truth | V | J | RMSE / mean |"; echo "|---|---|---|---|---|---|---|"; } >"$out/$case.md"
    compare "$case" truth-of-seed-1 "the truth's noise"
    render() { # NAME TITLE OPTIONS
        name=$1; title=$2; shift 2
        "$lrsm" render $view $frames "$@" -o "$out/$case/$name"
        compare "$case" "$name" "$title"
    }
    for preset in ${CHOICES:-literal paper fast balanced fine vct}; do render "$preset" "\`$preset\`" --preset "$preset"; done
    [ -z "${CHOICES:-}" ] || continue
    render union "\`balanced\`, \`--sequence-bounds union\`" --sequence-bounds union
    for snap in none sphere; do render "snap-$snap" "\`balanced\`, \`rsm_snap=$snap\`" --set rsm_snap=$snap; done
    render fixed-ranges "\`balanced\`, \`fit_ranges=false\`" --set fit_ranges=false
    for level in 1 2 3 4; do render "level-$level" "\`balanced\`, \`rsm_min_level=$level\`" --set rsm_min_level=$level; done
done
for case in $cases; do cat "$out/$case.md"; echo; done
