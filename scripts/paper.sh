#!/bin/sh
# The paper's own comparison: Tables 2 and 3, Figures 7 and 8, put into docs/paper.md with their pictures. Half an hour on two cores; interrupted, the same
# command goes on with what is not there yet.
#   scripts/paper.sh [OUT]      default out/paper
# Needs Sponza and Sibenik in $LRSM_SCENES (default ../shared/scenes), python3 and oiiotool. PRESETS: those of Figure 7; THREADS and REPEATS of Table 3.
set -eu
cd "$(dirname "$0")/.."
out=${1:-out/paper}
lrsm=${LRSM:-build/release/apps/lrsm}
scenes=$(realpath "${LRSM_SCENES:-../shared/scenes}")
presets=${PRESETS:-literal paper balanced vct-paper vct}
page=${PAGE:-docs/paper.md}
images=${IMAGES:-docs/images}
size=256x144
mkdir -p "$out/views"

# Table 2's resolutions: voxels of Sibenik, of Sponza.
voxels_sibenik=256
voxels_sponza=512

# view NAME FILE MATERIALS [LIGHT]: the paper's scenes as this project looks at them; floors and columns gloss as in its Figure 7.
view() {
    echo "{\"scene\": \"$scenes/$2.glb\", $(camera "$2"), \"lights\": [${4:-$(light "$2")}], \"materials\": [$3]}" >"$out/views/$1.json"
}
camera() {
    case $1 in
    sponza) echo '"camera": {"eye": [-8.9, 1.6, -0.35], "target": [4, 2.4, 0.1], "up": [0, 1, 0], "verticalFovDegrees": 60}' ;;
    sibenik) echo '"camera": {"eye": [-17.5, -11.8, 0], "target": [5, -11, 0.3], "up": [0, 1, 0], "verticalFovDegrees": 60}' ;;
    esac
}
light() {
    case $1 in
    sponza) sun 0.25 ;;
    sibenik) echo '{"type": "spot", "position": [-5, -1.5, 0], "target": [-7.5, -15.3, 2.5], "color": [1, 1, 1], "intensity": 2000, "innerConeAngleDegrees": 25, "outerConeAngleDegrees": 28}' ;;
    esac
}
sun() { echo "{\"type\": \"directional\", \"direction\": [$1, -1, 0.11], \"color\": [1, 1, 1], \"intensity\": 10}"; }
gloss() {
    list=
    for name in "$@"; do list="$list${list:+, }{\"name\": \"$name\", \"roughness\": 0.3, \"metallic\": 0.5}"; done
    echo "$list"
}
sponza_all="leaf Material__57 vase_round Material__298 bricks arch ceiling floor details Material__47 flagpole chain vase_hanging vase Material__25 roof
    column_a column_b column_c fabric_a fabric_c fabric_d fabric_e fabric_f fabric_g"
view sponza sponza "$(gloss floor)"
view sibenik sibenik "$(gloss pod stupovi)"
view sponza-diffuse sponza ""
view sponza-all-gloss sponza "$(gloss $sponza_all)"
for step in 0 1 2; do view "sponza-sun$step" sponza "$(gloss floor)" "$(sun "0.2$((step + 4))")"; done

# once FOLDER COMMAND ...: runs it unless the folder is there; it appears whole or not at all.
once() {
    folder=$1
    shift
    if [ ! -d "$folder" ]; then
        echo "paper: $folder"
        "$@" --quiet -o "$folder"
    fi
}

# judge RESULT TEST REFERENCE: energy and RMSE of the indirect light's two layers, into RESULT.json.
judge() {
    "$lrsm" compare "$2" "$3" --layer irradiance --layer indirect.specular --json --quiet >"$1.part"
    mv "$1.part" "$1.json"
}

# Figure 7, and what it is judged by.
for scene in sibenik sponza; do
    eval "voxels=\$voxels_$scene"
    echo "paper: $out/fig7/$scene/reference"
    "$lrsm" reference "$out/views/$scene.json" --size $size --spp 1024 --resume --quiet -o "$out/fig7/$scene/reference"
    stops=$(sed -n 's/.*"exposure_stops": *\([-0-9.]*\).*/\1/p' "$out/fig7/$scene/reference/frame.json")
    for preset in $presets; do
        once "$out/fig7/$scene/$preset" "$lrsm" render "$out/views/$scene.json" --size $size --preset "$preset" --set voxel_resolution=$voxels --exposure "$stops"
        judge "$out/fig7/$scene/$preset" "$out/fig7/$scene/$preset" "$out/fig7/$scene/reference"
    done
done

# Table 2: what the program predicts for the paper's sizes; Sponza Dragon's static part is Sponza with three depth layers.
mkdir -p "$out/table2"
info() { if [ ! -s "$out/table2/$1.json" ]; then "$lrsm" info "$out/views/$2.json" --json --sparse $3 >"$out/table2/$1.part" && mv "$out/table2/$1.part" "$out/table2/$1.json"; fi; }
paper_lrsm="--preset literal --set rsm_resolution=1024 --set drop_empty=false --set opacity_axes=isotropic"
info sibenik-lrsm sibenik "$paper_lrsm --set voxel_resolution=256"
info sponza-lrsm sponza "$paper_lrsm --set voxel_resolution=512"
info dragon-lrsm sponza "$paper_lrsm --set voxel_resolution=512 --set depth_layers=3"
info sibenik-vct sibenik "--preset vct-paper --set rsm_resolution=1024 --set voxel_resolution=256"
info sponza-vct sponza "--preset vct-paper --set rsm_resolution=1024 --set voxel_resolution=512"

# Table 3: 1280x720 in Sponza, without specular cones, with one a pixel, and with shadow cones.
repeats=${REPEATS:-2}
for preset in literal paper balanced vct-paper vct; do
    for run in $(seq "$repeats"); do
        for view in sponza-diffuse sponza-all-gloss; do
            once "$out/table3/$preset/$view/$run" "$lrsm" render "$out/views/$view.json" --preset "$preset" --set voxel_resolution=512 --set shadows=cone --threads "${THREADS:-0}"
        done
    done
done

# Figure 8: the LRSM's mip level clamped; the truth is Figure 7's, of the same view. A light that turns by 0.5 degrees a frame.
for level in 0 2 4; do
    for step in 0 1 2; do
        once "$out/fig8/level$level/$step" "$lrsm" render "$out/views/sponza-sun$step.json" --size $size --set rsm_min_level=$level --exposure 0
    done
    judge "$out/fig8/level$level" "$out/fig8/level$level/1" "$out/fig7/sponza/reference"
done

# The trade: both methods at three resolutions. A sweep goes on by itself.
"$lrsm" sweep cornell-box two-rooms atrium cornell-glossy furnace --preset vct --axis method=lrsm,vct --axis voxel_resolution=128,256,512 --size 160x90 --spp 256 \
    --path-tracer 0 --repeat 2 --quiet -o "$out/trade"

python3 scripts/paper_tables.py "$out" "$page" "$images" $presets
