#!/bin/sh
# The tables of docs/requirements.md: what the scene analysis saves, measured on against off, and what its advice costs and saves.
#   scripts/requirements.sh [SIZE [SPP [OUT]]]      default 320x180, 512, out/requirements
# Scenes: SCENES, else the built-ins and the views in $LRSM_SCENES/views (default ../shared/scenes) where they exist. Each pair of frames is
# rendered REPEAT times (3) in turns; times are the processor time of the passes, the least of the repeats. References are kept and reused (REFERENCES).
set -eu
cd "$(dirname "$0")/.."
size=${1:-320x180}
spp=${2:-512}
out=${3:-out/requirements}
lrsm=${LRSM:-build/release/apps/lrsm}
references=${REFERENCES:-$out/references}
views=${LRSM_SCENES:-../shared/scenes}/views

scenes=${SCENES:-cornell-box cornell-glossy two-rooms atrium furnace}
for view in "$views"/*.json; do
    if [ -z "${SCENES:-}" ] && [ -f "$view" ]; then scenes="$scenes $view"; fi
done
mkdir -p "$out" "$references"
for scene in $scenes; do
    name=$(basename "$scene" .json)
    if [ ! -f "$references/$name/frame.json" ]; then
        echo "requirements: reference of $name, $spp samples a pixel" >&2
        "$lrsm" reference "$scene" --size "$size" --spp "$spp" --block 64 -o "$references/$name" --quiet >/dev/null
    fi
done
exec python3 - "$lrsm" "$size" "$out" "$references" "${REPEAT:-3}" $scenes <<'PYTHON'
import json, os, shutil, subprocess, sys

lrsm, size, out, references, repeat = sys.argv[1:5] + [int(sys.argv[5])]


def run(*arguments):
    return subprocess.run([lrsm, *arguments], check=True, capture_output=True, text=True).stdout


def render(scene, folder, settings):
    """Processor time (ms) by pass, bytes and hashes of one frame."""
    folder = os.path.join(out, folder)
    shutil.rmtree(folder, ignore_errors=True)
    run("render", scene, "--size", size, "-o", folder, "--quiet", *[part for s in settings for part in ("--set", s)])
    with open(os.path.join(folder, "frame.json")) as file:
        passes = json.load(file)["passes"]
    return {"cpu": sum(p["cpu_milliseconds"] for p in passes),
            "bytes": sum(p["bytes"] for p in passes if p["name"].split()[0] in ("voxel", "rsm", "lrsm", "gbuffer")),
            "hash": next(p["sha256"] for p in passes if p["name"] == "composite"), "folder": folder}


def pair(scene, name, off, on):
    """The two frames in turns; the least processor time of each."""
    least = [None, None]
    for _ in range(repeat):
        for i, settings in enumerate((off, on)):
            frame = render(scene, f"{name}-{i}", settings)
            if least[i] is None or frame["cpu"] < least[i]["cpu"]:
                least[i] = frame
    return least


def error(folder, name):
    layer = json.loads(run("compare", folder, os.path.join(references, name), "--layer", "irradiance", "--json"))["layers"][0]
    return layer["rmse_over_mean"]


def row(*cells):
    print("| " + " | ".join(str(c) for c in cells) + " |", flush=True)


analysed, advised = [], []
for scene in sys.argv[6:]:
    name = os.path.basename(scene).removesuffix(".json")
    print("requirements: " + name, file=sys.stderr, flush=True)
    info = json.loads(run("info", scene, "--size", size, "--json"))
    off, on = pair(scene, name, ["force_everything=true", "drop_empty=false"], [])
    analysed.append((name, len(info["requires"]["left_out"]), on["cpu"] / off["cpu"], off["bytes"] / 1e6, on["bytes"] / 1e6, "equal" if on["hash"] == off["hash"] else "DIFFER"))
    changes = [f'{a["key"]}={a["to"]}' for a in info["advice"]]
    if not changes:
        advised.append((name, "none", "", "", "", "", ""))
        continue
    before, after = pair(scene, name, [], changes)
    errors = error(before["folder"], name), error(after["folder"], name)
    advised.append((name, " ".join(f"`{c}`" for c in changes), f"{after['cpu'] / before['cpu']:.2f}", f"{after['bytes'] / before['bytes']:.2f}", f"{errors[0]:.3f}",
                    f"{errors[1]:.3f}", "equal" if before["hash"] == after["hash"] else "differ"))

row("scene", "left out", "time, on / off", "MB off", "MB on", "bits")
row(*["---"] * 6)
for name, count, time, before, after, bits in analysed:
    row(name, count, f"{time:.2f}", f"{before:.1f}", f"{after:.1f}", bits)
print()
row("scene", "advice for `balanced`", "time", "memory", "RMSE/mean before", "after", "bits")
row(*["---"] * 7)
for cells in advised:
    row(*cells)
PYTHON
