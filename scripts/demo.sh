#!/bin/sh
# From nothing to a picture: installs what is missing, builds, renders the Cornell box by LRSM, path-traces it, compares the two.
# Quick when nothing changed. Results in out/demo.
set -eu
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/configure.sh release
cmake --build build/release --target lrsm_program
lrsm=build/release/apps/lrsm
size=512x512

echo "demo: rendering the Cornell box by layered reflective shadow maps"
$lrsm render cornell-box --size $size -o out/demo/lrsm

if $lrsm reference --help >/dev/null 2>&1; then
    # The path tracer's picture is kept until the program changes.
    if [ ! out/demo/reference/frame.json -nt $lrsm ]; then
        echo "demo: path-tracing the same box"
        $lrsm reference cornell-box --size $size --spp 256 --block 64 -o out/demo/reference
    fi
    echo "demo: comparing"
    $lrsm compare out/demo/lrsm out/demo/reference -o out/demo/compare
fi

echo
echo "demo: look at"
for file in out/demo/lrsm/image.png out/demo/lrsm/irradiance.png out/demo/reference/image.png out/demo/compare/*.html; do
    if [ -f "$file" ]; then echo "  $file"; fi
done
