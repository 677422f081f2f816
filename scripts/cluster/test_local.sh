#!/bin/bash
# The workflow on this machine: reference, frames and sweep in parts must be what each is in one piece.
#   scripts/cluster/test_local.sh [LRSM]        default build/release/apps/lrsm
# Needs the Debian package snakemake; without it says SKIPPED and exits with 0.
set -euo pipefail
cluster=$(cd "$(dirname "$0")" && pwd)
lrsm=$(realpath "${1:-$cluster/../../build/release/apps/lrsm}")
if ! command -v snakemake >/dev/null; then
    echo "test_local: SKIPPED: no snakemake (Debian: snakemake)"
    exit 0
fi
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
reference="--size 64x36 --block 16"
frames="--fps 24 --size 64x36 --set voxel_resolution=32 --set rsm_resolution=64"
sweep="--axis cone_count=2,4,6 --repeat 1 --max-memory 3 --set voxel_resolution=32 --set rsm_resolution=64 --path-tracer 4"
cat >my.yaml <<END
lrsm: $lrsm
threads: 1
reference: {options: "$reference", spp: 64, samples_per_job: 16}
frames: {command: render, options: "$frames", count: 5, frames_per_job: 2}
sweep: {size: 32x18, spp: 16, options: "$sweep", jobs: 3}
END
snakemake reference frames sweep -s "$cluster/Snakefile" --profile "$cluster/local" --directory work --configfile my.yaml >snakemake.log 2>&1 ||
    { cat snakemake.log; exit 1; }

"$lrsm" reference cornell-box $reference --spp 64 --quiet -o one/reference
"$lrsm" render cornell-box $frames --frames 0:5 --quiet -o one/frames
"$lrsm" sweep cornell-box --size 32x18 --spp 16 $sweep --quiet -o one/sweep
same() { cmp "one/$1" "work/$1" || { echo "test_local: FAILED: $1 differs"; exit 1; }; }
same reference/image.exr
same reference/samples.bin
for frame in 0000 0001 0002 0003 0004; do same frames/$frame/image.exr; done
same frames/sequence.json
# Rows are known by key; error is the same, time is not.
figures() { sed -E 's/.*"key": ?"([^"]*)".*"rmse": ?([^,]*),.*/\1 \2/' "$1/sweep/rows.jsonl" | sort; }
[ "$(figures one)" = "$(figures work)" ] || { diff <(figures one) <(figures work); echo "test_local: FAILED: rows differ"; exit 1; }
[ "$(ls one/sweep/thumbnails)" = "$(ls work/sweep/thumbnails)" ] && [ -s work/sweep/report.html ] || { echo "test_local: FAILED: the joined sweep lacks files"; exit 1; }
echo "test_local: passed in $SECONDS s: the same picture, frames and $(figures work | wc -l) rows"
