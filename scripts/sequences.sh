#!/bin/sh
# The tables of docs/sequences.md: what flickers, by preset and by what should hold still; Figure 8; what reuse saves; the paper's scene with dragons. Two hours on
# two cores; interrupted, the same command goes on.
#   scripts/sequences.sh [OUT]      default out/sequences
# Needs sponza.glb and dragon_lowres.glb in $LRSM_SCENES (default ../shared/scenes). SIZE, FRAMES, SPP: of all pictures and the truth; PARTS, CASES, CHOICES: some only.
set -eu
cd "$(dirname "$0")/.."
out=${1:-out/sequences}
lrsm=${LRSM:-build/release/apps/lrsm}
scenes=$(realpath "${LRSM_SCENES:-../shared/scenes}")
count=${FRAMES:-12}
frames="--frames 0:$count --fps 24 --size ${SIZE:-160x90} --quiet"
cases=${CASES:-"moving-sun moving-dragons moving-camera moving-out"}
choices=${CHOICES:-"literal paper fast balanced fine rays vct caches proxies ism"}
parts=${PARTS:-"flicker figure8 reuse dragons"}
images=${IMAGES:-docs/images}
mkdir -p "$out"
cp docs/examples/sequences/*.json "$out" # a view's files are looked for beside it
ln -sf "$scenes/sponza.glb" "$scenes/dragon_lowres.glb" "$scenes/cornell_box.glb" "$out"
tables() { python3 scripts/sequences_tables.py "$@"; }

# truth CASE: and a second one, the floor of what can be told. By the paths' own rays where light moves: their noise then stands still with the pixel; where the
# camera moves no noise does, and there should be little of it.
truth() {
    side=--eye-side-only
    [ "$1" != moving-camera ] || side=
    for seed in 0 1; do
        folder=$out/$1/truth
        [ $seed = 0 ] || folder=$out/$1/truth-of-seed-$seed
        "$lrsm" reference "$out/$1.json" $frames --spp "${SPP:-256}" $side --seed $seed -o "$folder"
    done
    compare "$1" truth-of-seed-1
}
# compare CASE NAME
compare() {
    [ -s "$out/$1/$2-flicker/compare.json" ] || "$lrsm" compare --sequence "$out/$1/$2" "$out/$1/truth" -o "$out/$1/$2-flicker" --quiet
}
# render CASE NAME OPTIONS: and hold it against the truth
render() {
    case=$1 name=$2
    shift 2
    "$lrsm" render "$out/$case.json" $frames --no-preview "$@" -o "$out/$case/$name"
    compare "$case" "$name"
}

flicker() {
    for case in $cases; do
        truth "$case"
        printf "%s\t%s\n" truth-of-seed-1 "the truth's noise" >"$out/$case/rows.tsv"
        choose() { # NAME TITLE OPTIONS
            title=$2
            name=$1
            shift 2
            render "$case" "$name" "$@"
            printf "%s\t%s\n" "$name" "$title" >>"$out/$case/rows.tsv"
        }
        for preset in $choices; do choose "$preset" "\`$preset\`" --preset "$preset"; done
        if [ -z "${CHOICES:-}" ]; then
            case $case in
            moving-sun)
                for snap in none sphere; do choose "snap-$snap" "\`balanced\`, \`rsm_snap=$snap\`" --set rsm_snap=$snap; done
                choose fixed-ranges "\`balanced\`, \`fit_ranges=false\`" --set fit_ranges=false
                for level in 1 2 3 4; do choose "level-$level" "\`balanced\`, \`rsm_min_level=$level\`" --set rsm_min_level=$level; done
                ;;
            moving-out)
                choose union "\`balanced\`, \`--sequence-bounds union\`" --sequence-bounds union
                choose fast-union "\`fast\`, \`--sequence-bounds union\`" --preset fast --sequence-bounds union
                ;;
            *)
                choose union "\`balanced\`, \`--sequence-bounds union\`" --sequence-bounds union
                choose fixed-ranges "\`balanced\`, \`fit_ranges=false\`" --set fit_ranges=false
                choose hash-index "\`proxies\`, \`pp_hash=index\`" --preset proxies --set pp_hash=index
                ;;
            esac
        fi
        tables flicker "$out/$case"
    done
}

# The paper's Figure 8: a glossy floor under the moving sun, the LRSM's mip level held at 0 to 6 or above, three sizes of the map.
figure8() {
    case=moving-sun-glossy
    truth $case
    for size in 512 1024 2048; do
        for level in 0 1 2 3 4 5 6; do render $case "rsm$size-level$level" --set rsm_resolution=$size --set rsm_min_level=$level; done
    done
    tables figure8 "$out/$case" "$images/sequences-figure8.svg"
}

# Processor time of a frame, with and without what the frame before left: in turns, one thread, the median of frames from the third on.
reuse() {
    for case in moving-camera moving-sun moving-dragons; do
        for turn in 0 1; do
            for switch in off on; do
                folder=$out/reuse/$case-$switch-$turn
                [ -s "$folder/sequence.json" ] || "$lrsm" render "$out/$case.json" --frames 0:8 --size ${SIZE:-160x90} --quiet --no-preview --threads 1 --sequence-reuse $switch -o "$folder"
            done
        done
    done
    tables reuse "$out/reuse"
}

# Table 2's dearest row, 512^3 voxels, 1024^2 texels, 3x2 layers, with the dragons and without; and the shares of its stages.
dragons() {
    paper="--preset literal --set rsm_resolution=1024 --set drop_empty=false --set opacity_axes=isotropic --set voxel_resolution=512 --set depth_layers=3 --set shadows=cone"
    python3 -c 'import json, sys
view = json.load(open(sys.argv[1])); view.pop("objects"); json.dump(view, open(sys.argv[2], "w"))' "$out/moving-dragons.json" "$out/no-dragons.json"
    for case in moving-dragons no-dragons; do
        "$lrsm" info "$out/$case.json" --json --size 640x360 $paper >"$out/$case-info.json"
        for switch in off on; do
            "$lrsm" render "$out/$case.json" --frames 0:3 --size 640x360 --quiet --no-preview $paper --sequence-reuse $switch -o "$out/table2/$case-$switch"
        done
    done
    tables dragons "$out"
}

for part in $parts; do $part; done
