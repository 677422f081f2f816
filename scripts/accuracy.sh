#!/bin/sh
# The figures of docs/accuracy.md: sweeps against the path tracer, their tables and plots (tables.md and report.html in each folder of OUT). An hour on two
# cores; interrupted, the same command goes on.
#   scripts/accuracy.sh [OUT [PART...]]      default out/accuracy, all parts: points settings search unseen pictures
# Scenes: built-ins, and those in $LRSM_SCENES (default ../shared/scenes) where they exist. References are kept in OUT/references, or REFERENCES, and reused.
set -eu
cd "$(dirname "$0")/.."
out=${1:-out/accuracy}
lrsm=${LRSM:-build/release/apps/lrsm}
references=${REFERENCES:-$out/references}
scenes=$(realpath "${LRSM_SCENES:-../shared/scenes}" 2>/dev/null || echo none)
views=$scenes/views
page=${PAGE:-docs/accuracy.md}
if [ $# -gt 0 ]; then shift; fi
parts=${*:-points settings search unseen pictures}

existing() {
    for view in "$@"; do
        if [ -f "$views/$view.json" ]; then echo "$views/$view.json"; fi
    done
}
# view NAME SCENE EYE TARGET FOV LIGHT: a view that no setting was chosen by.
view() {
    if [ ! -f "$scenes/$2" ]; then return; fi
    mkdir -p "$out/views"
    echo "{\"scene\": \"$scenes/$2\", \"camera\": {\"eye\": [$3], \"target\": [$4], \"up\": [0, 1, 0], \"verticalFovDegrees\": $5}, \"lights\": [{$6, \"color\": [1, 1, 1]}]}" >"$out/views/$1.json"
    echo "$out/views/$1.json"
}
spot() { echo "\"type\": \"spot\", \"position\": [$1], \"target\": [$2], \"intensity\": $3, \"innerConeAngleDegrees\": $4, \"outerConeAngleDegrees\": $5"; }
sun() { echo "\"type\": \"directional\", \"direction\": [$1], \"intensity\": $2"; }

chosen="cornell-box two-rooms atrium $(existing sponza sibenik-nave)"
search="$chosen $(existing sibenik-carpet)"
unseen="furnace cornell-glossy $(existing cornell sponza-curtains)
    $(view sponza-gallery sponza.glb "12, 6.5, -4.5" "-6, 5, 3.5" 60 "$(sun "-0.35, -1, 0.12" 10)")
    $(view sibenik-side sibenik.glb "-3, -11.5, -1.5" "10, -11, 1.5" 60 "$(spot "2, -3, 1" "6, -15, -2" 1500 28 33)")
    $(view dragon dragon_lowres.glb "0.9, 0.8, 1.6" "0, 0.45, 0" 40 "$(spot "0.8, 2.2, 1.2" "0, 0.4, 0" 20 20 28)")
    $(view house samples/PlayCanvas_house_mask.glb "0.35, 0.28, 0.45" "0, 0.06, 0" 40 "$(sun "-0.4, -1, -0.3" 6)")"
effects="cornell-glossy atrium $(existing sponza sibenik-nave)"
sweep() { "$lrsm" sweep "$@" --spp 512 --references "$references"; }

# Irradiance by balanced, by the path tracer, and their difference, side by side in docs/images; needs oiiotool.
picture() {
    name=$(basename "$1" .json)
    folder=$out/pictures/$name
    if [ ! -d "$folder/reference" ]; then "$lrsm" reference "$1" --model single --size 640x360 --target-noise 0.02 -o "$folder/reference"; fi
    "$lrsm" render "$1" --size 640x360 --quiet -o "$folder/balanced"
    "$lrsm" compare "$folder/balanced" "$folder/reference" --layer irradiance --quiet -o "$folder/compared"
    oiiotool "$folder/compared/irradiance.test.png" "$folder/compared/irradiance.reference.png" "$folder/compared/irradiance.signed.png" \
        --mosaic:pad=2 3x1 --resize 1296x0 -o "${IMAGES:-docs/images}/accuracy-$name.png"
}

# One setting at a time around balanced; the front, searched from two bases; the points that tune offers, on scenes that played no part in the choice;
# those points, presets among them, and the path tracer on the chosen ones.
measure() {
    case $1 in
        points) sweep $chosen -o "$out/points" --axes points --size 640x360 --repeat 1 ;;
        settings) sweep $effects -o "$out/settings" --axes one-at-a-time --repeat 1 --path-tracer 0 ;;
        search)
            sweep $search -o "$out/search" --axes search --repeat 1 --path-tracer 0 --budget 90
            sweep $search -o "$out/search" --axes search --repeat 1 --path-tracer 0 --budget 60 --set cone_count=16 --set depth_layers=3
            ;;
        unseen) sweep $unseen -o "$out/unseen" --axes points --repeat 1 --path-tracer 0 ;;
        pictures) for scene in cornell-box atrium $(existing sponza sibenik-nave); do picture "$scene"; done ;;
        *) echo "$0: no part is called $1" >&2 && exit 2 ;;
    esac
}
for part in $parts; do measure "$part"; done

# table FOLDER HEADING NAME COLUMNS [CONDITION]: puts these columns of the table under HEADING of FOLDER's tables.md, of rows that meet an awk CONDITION (column i
# is $(i + 1)), between the lines <!-- NAME: begin --> and <!-- NAME: end --> of the page.
table() {
    sed -n "/^## $2/,/^## /{/^|/p}" "$out/$1/tables.md" |
        awk -F ' *[|] *' "NR <= 2 || (${5:-1}) { n = split(\"$4\", column, \" \"); row = \"|\"; for (i = 1; i <= n; ++i) row = row \" \" \$(column[i] + 1) \" |\"; print row }" |
        sed "1{s/over balanced's/time over \`balanced\`/;s/over the preset's/path tracer's time for this error, over the preset's/}" >"$out/$3.md"
    sed -i -e "/<!-- $3: begin -->/,/<!-- $3: end -->/{//!d}" -e "/<!-- $3: begin -->/r $out/$3.md" "$page"
}
for part in $parts; do
    case $part in
        points) table points "Presets" presets "1 2 3 4 6 8 9 13" && table points "All scenes" points "1 2 3 4 5 6" ;;
        settings) table settings "One setting" effects "1 2 3 5 6 7 9" '$4 !~ /loses both/ && ($6 >= 0.5 || $6 <= -0.5)' ;;
    esac
done
