#!/bin/sh
# The tables of docs/proxies.md: error and time of methods `proxies` and `ism`, and what each setting trades. An hour on two cores; what is there already is kept.
#   scripts/proxies.sh [OUT]      default out/proxies
# SIZE, NOISE: of pictures and truth; VIEWS: built-in scenes or view files; CHOICES: a file of rows "title: options of render", in place of those below.
set -eu
cd "$(dirname "$0")/.."
out=${1:-out/proxies}
lrsm=${LRSM:-build/release/apps/lrsm}
views=${VIEWS:-"cornell-box two-rooms atrium"}
size=${SIZE:-320x180}
mkdir -p "$out"

for view in $views; do
    truth=$out/$(basename "$view" .json)-$size-truth
    [ -d "$truth" ] || "$lrsm" reference "$view" --model single --size "$size" --target-noise "${NOISE:-0.03}" --quiet -o "$truth"
done

if [ -z "${CHOICES:-}" ]; then
    CHOICES=$out/choices.txt
    # Blocks are in pixels: at 320x180 those of half the presets' size.
    small="--preset proxies --set pp_march_divisor=2"
    {
        echo "\`balanced\`: --preset balanced"
        echo "\`proxies\`: --preset proxies"
        echo "\`proxies\`, \`pp_march_divisor=2\`: $small"
        for value in pp_cell_weight=one pp_filter_test=printed pp_filter_radius=0 pp_filter_radius=1 pp_filter_radius=3 pp_filter_radius=5 pp_rays=16 pp_rays=256 pp_range=0 pp_range=2 pp_range=1000 \
            pp_grid=12 pp_grid=24 pp_grid=96 pp_count=24000 pp_count=65536 pp_count=400000 pp_radius=1 pp_radius=1.3 pp_radius=2 pp_gather_divisor=1 pp_gather_divisor=4 pp_march_divisor=1; do
            echo "... \`$value\`: $small --set $value"
        done
        echo "\`proxies-paper\`: --preset proxies-paper"
        echo "... \`pp_filter_radius=0\`: --preset proxies-paper --set pp_filter_radius=0"
        echo "\`ism\`: --preset ism"
        echo "... \`ism_fill=none\`: --preset ism --set ism_fill=none"
    } >"$CHOICES"
fi

# A cell: energy / net RMSE over mean of the irradiance (of the specular part behind it, where there is one), processor ms of the method's own passes.
cell() {
    python3 -c 'import json, math, sys
parts = []
for layer in json.load(open(sys.argv[1]))["layers"]:
    if layer["layer"] in ("irradiance", "indirect.specular") and layer["rmse_over_mean"] > 0:
        noise = layer["z_pixels"]["noise_rmse_over_mean"] or 0
        parts.append("%.2f / %.3f" % (layer["energy_ratio"], math.sqrt(max(0, layer["rmse_over_mean"] ** 2 - noise ** 2))))
common = ("rsm", "gbuffer", "direct", "voxel", "shadow", "composite")
own = sum(p["cpu_milliseconds"] for p in json.load(open(sys.argv[2]))["passes"] if not p["name"].startswith(common))
print("; ".join(parts) + ", %.0f" % own)' "$1" "$2"
}

{ printf "| |"; for view in $views; do printf " %s |" "$(basename "$view" .json)"; done; echo; printf "|---|"; for view in $views; do printf "%s" "---|"; done; echo; } >"$out/table-$size.md"
while IFS=: read -r title options; do
    printf "| %s |" "$title" >>"$out/table-$size.md"
    for view in $views; do
        name=$(basename "$view" .json)
        folder=$out/$name-$size-$(echo "$options" | tr -d ' -' | sed 's/preset//; s/set/-/g')
        [ -d "$folder" ] || "$lrsm" render "$view" $options --size "$size" --quiet -o "$folder"
        [ -f "$folder.json" ] || "$lrsm" compare "$folder" "$out/$name-$size-truth" --layer irradiance --layer indirect.specular --json >"$folder.json"
        printf " %s |" "$(cell "$folder.json" "$folder/frame.json")" >>"$out/table-$size.md"
    done
    echo >>"$out/table-$size.md"
done <"$CHOICES"
cat "$out/table-$size.md"
