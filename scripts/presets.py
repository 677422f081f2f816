#!/usr/bin/env python3
"""README's table: all presets beside each other, held against the path tracer. Twenty minutes on two cores; interrupted, the same command goes on.
  python3 scripts/presets.py [OUT]      default out/presets
Scenes: built-ins, and the views in $LRSM_SCENES (default ../shared/scenes)."""
import json
import math
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LRSM = os.environ.get("LRSM", os.path.join(ROOT, "build/release/apps/lrsm"))
VIEWS = os.path.join(os.environ.get("LRSM_SCENES", os.path.join(ROOT, "../shared/scenes")), "views")
OUT = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "out/presets")
BUILT_IN, REAL = ("cornell-box", "two-rooms", "atrium"), ("sponza", "sibenik-nave", "sibenik-carpet")
PRESETS = ("literal", "paper", "fast", "balanced", "fine", "accurate", "rays", "vct", "caches", "proxies", "ism")
SIZE = ["--size", "320x180"]


def once(folder, command, *arguments):
    """Runs `lrsm command` unless its folder is there; it appears whole or not at all."""
    if not os.path.isdir(folder):
        subprocess.run([LRSM, command, *arguments, *SIZE, "--quiet", "-o", folder], check=True, stderr=subprocess.DEVNULL)


def measured(scene, preset):
    """Energy and net RMSE over mean of the irradiance, processor ms and resident bytes in a GPU's formats of the frame."""
    view = scene if scene in BUILT_IN else f"{VIEWS}/{scene}.json"
    truth, folder = f"{OUT}/ref-{scene}", f"{OUT}/{scene}-{preset}"
    once(truth, "reference", view, "--model", "single", "--target-noise", "0.03")
    once(folder, "render", view, "--preset", preset)
    compared = subprocess.run([LRSM, "compare", folder, truth, "--layer", "irradiance", "--json", "--quiet"], capture_output=True, text=True, check=True)
    layer = json.loads(compared.stdout)["layers"][0]
    net = math.sqrt(max(0.0, layer["rmse_over_mean"] ** 2 - layer["z_pixels"]["noise_rmse_over_mean"] ** 2))
    with open(f"{folder}/frame.json") as file:
        passes = json.load(file)["passes"]
    return layer["energy_ratio"], net, sum(p["cpu_milliseconds"] for p in passes), sum(p["gpu_format_bytes"] for p in passes if p["resident"])


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


def main():
    os.makedirs(OUT, exist_ok=True)
    scenes = BUILT_IN + REAL
    rows = {(s, p): measured(s, p) for s in scenes for p in PRESETS}
    print("| preset | energy | net RMSE / mean: built-ins; Sponza, nave, carpet | all, mean | time | memory |\n| --- | --- | --- | --- | --- | --- |")
    for p in PRESETS:
        energy, net = [rows[s, p][0] for s in scenes], {s: rows[s, p][1] for s in scenes}
        small = [net[s] for s in BUILT_IN]
        time = geometric_mean([rows[s, p][2] / rows[s, "balanced"][2] for s in scenes])
        print(f"| `{p}` | {min(energy):.2f}-{max(energy):.2f} | {min(small):.2f}-{max(small):.2f}; {', '.join(f'{net[s]:.2f}' for s in REAL)} "
              f"| {geometric_mean(list(net.values())):.3f} | {time:.2f} | {rows['sponza', p][3] / 1e6:.0f} MB |")


main()
