#!/usr/bin/env python3
"""The tables of docs/caches.md, each cell held against the path tracer; interrupted, the same command goes on.
  python3 scripts/caches.py [OUT [FIGURE ...]]      default out/caches, and all of: fronts fills fig4 fig5 fig7 fig8
SIZE (640x360), SPP of the truth (24), BUILTINS, LRSM_SCENES (default ../shared/scenes), where views/sponza.json is. Tiles are given for 1280x720 and scaled."""
import json
import math
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LRSM = os.environ.get("LRSM", os.path.join(ROOT, "build/release/apps/lrsm"))
SCENES = os.path.abspath(os.environ.get("LRSM_SCENES", os.path.join(ROOT, "../shared/scenes")))
OUT = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "out/caches")
SIZE, SPP = os.environ.get("SIZE", "640x360"), os.environ.get("SPP", "24")
BUILTINS = os.environ.get("BUILTINS", "cornell-box two-rooms atrium").split()
FLOOR, ROUGHNESS = "floor", (0.467, 0.315, 0.240, 0.178)  # Phong exponents 10, 50, 150, 500
COMMON = ("rsm", "gbuffer", "direct", "voxel", "shadow", "composite")  # passes of every method


def tile(at720):
    """A tile of so many pixels at 1280x720, in this picture's."""
    return max(1, at720 * int(SIZE.split("x")[1]) // 720)


def sponza(name, **changes):
    """Sponza's view with other lights or materials, as a view file of its own."""
    path = f"{OUT}/{name}.json"
    with open(f"{SCENES}/views/sponza.json") as file:
        view = json.load(file)
    view.update(changes, scene=f"{SCENES}/{view['scene']}" if os.path.exists(f"{SCENES}/{view['scene']}") else os.path.join(SCENES, "views", view["scene"]))
    with open(path, "w") as file:
        json.dump(view, file)
    return path


def ten_suns():
    """Ten suns where a cosine lobe about the zenith has its Hammersley points: the paper's environment map of even brightness."""
    suns = []
    for i in range(10):
        u, v = (i + 0.5) / 10, sum((i >> k & 1) / 2 ** (k + 1) for k in range(4))
        r, phi = math.sqrt(u), 2 * math.pi * v
        suns.append({"type": "directional", "direction": [-r * math.cos(phi), -math.sqrt(1 - u), -r * math.sin(phi)], "color": [1, 1, 1], "intensity": 1})
    return sponza("ten-suns", lights=suns)


def glossy_floor(roughness):
    return sponza(f"floor-{roughness}", materials=[{"name": FLOOR, "roughness": roughness, "metallic": 0}])


def once(folder, command, *arguments):
    """Runs `lrsm command` unless its folder is there; it appears whole or not at all."""
    if not os.path.isdir(folder):
        subprocess.run([LRSM, command, *arguments, "--size", SIZE, "--quiet", "-o", folder], check=True, stderr=subprocess.DEVNULL)


def render(view, options):
    name = os.path.basename(view).removesuffix(".json")
    folder = f"{OUT}/{name}-{SIZE}-{'-'.join(options)}"
    once(folder, "render", view, "--preset", options[0], *[x for option in options[1:] for x in ("--set", option)])
    with open(f"{folder}/frame.json") as file:
        return folder, json.load(file)["passes"]


def measured(view, options, layer="irradiance"):
    """Energy, net RMSE over mean of a layer, processor ms of the method's own passes."""
    name = os.path.basename(view).removesuffix(".json")
    truth = f"{OUT}/{name}-{SIZE}-truth"
    once(truth, "reference", view, "--model", "single", "--spp", SPP)
    folder, passes = render(view, options)
    compared = subprocess.run([LRSM, "compare", folder, truth, "--layer", layer, "--json", "--quiet"], capture_output=True, text=True, check=True)
    found = json.loads(compared.stdout)["layers"][0]
    net = math.sqrt(max(0.0, found["rmse_over_mean"] ** 2 - ((found.get("z_pixels") or {}).get("noise_rmse_over_mean") or 0.0) ** 2))
    return found["energy_ratio"], net, sum(p["cpu_milliseconds"] for p in passes if not p["name"].startswith(COMMON))


def cell(view, options, layer="irradiance"):
    return "{:.2f} / {:.3f}, {:.0f}".format(*measured(view, options, layer))


def table(head, rows):
    print("\n| " + " | ".join(head) + " |\n|" + " --- |" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |", flush=True)


def by_views(choices):
    views = BUILTINS + [f"{SCENES}/views/sponza.json"]
    table([""] + [os.path.basename(v).removesuffix(".json") for v in views], ([title] + [cell(v, options) for v in views] for title, options in choices))


def fronts():
    own = ["caches", f"rc_tile={tile(32)}"]
    choices = [("`balanced`", ["balanced"]), ("`fine`", ["fine"]), ("`caches`, 32", own), ("... 16", ["caches", f"rc_tile={tile(16)}", "rc_max=65536"])]
    by_views(choices + [(f"... `{x}`", own + [x]) for x in ("rc_radius=1.5", "rc_radius=0.75", "rc_min_pixels=8", "rc_min_cosine=-1")])


def fills():
    paper, own = ["caches-paper", f"rc_tile={tile(64)}"], ["caches", f"rc_tile={tile(32)}"]
    by_views([("`caches-paper`", paper)] + [(f"... `{x}`", paper + x.split()) for x in ("rc_fill=lrsm", "rc_shadow=rsm", "transmittance=linear vct_opacity=step")]
             + [(f"`caches`, `{x}`", own + x.split()) for x in ("rc_fill=voxels voxel_resolution=128", "rc_fill=vct voxel_resolution=256 vct_injection=voxel")])


def fig4():
    for preset in ("caches-paper", "caches"):
        passes = render(ten_suns(), [preset, f"rc_tile={tile(64 if preset == 'caches-paper' else 32)}"])[1]
        sums = {}
        for p in passes:
            family = p["name"].rstrip("0123456789 ")
            sums[family] = sums.get(family, 0.0) + p["cpu_milliseconds"]
        whole = sum(sums.values())
        table([f"`{preset}`", "ms", "share"], ([family, f"{ms:.0f}", f"{ms / whole:.0%}"] for family, ms in sums.items()))


def fig5():
    view = glossy_floor(0.240)
    for layer in ("irradiance", "indirect.specular"):
        table([f"{layer}: tile", "N = 8", "16", "32"],
              ([str(t)] + [cell(view, ["caches", f"rc_tile={tile(t)}", "rc_max=65536", f"rc_resolution={n}"], layer) for n in (8, 16, 32)] for t in (16, 32, 64, 128)))


def fig7():
    choices = [("`balanced`", ["balanced"]), ("... `specular_direction=mirror`", ["balanced", "specular_direction=mirror"]), ("`caches`, 32", ["caches", f"rc_tile={tile(32)}"]),
               ("... `rc_lobe=cutoff`", ["caches", f"rc_tile={tile(32)}", "rc_lobe=cutoff"]), ("`caches-paper`", ["caches-paper", f"rc_tile={tile(64)}"])]
    table(["roughness"] + [str(r) for r in ROUGHNESS], ([title] + [cell(glossy_floor(r), options, "indirect.specular") for r in ROUGHNESS] for title, options in choices))


def fig8():
    view = f"{SCENES}/views/sponza.json"
    for preset, t in (("caches", 32), ("caches-paper", 64)):
        table([f"`{preset}`, radius", "1", "1.5", "2", "3"], [[""] + [cell(view, [preset, f"rc_tile={tile(t)}", f"rc_radius={r}"]) for r in (1, 1.5, 2, 3)]])


def main():
    os.makedirs(OUT, exist_ok=True)
    figures = {"fronts": fronts, "fills": fills, "fig4": fig4, "fig5": fig5, "fig7": fig7, "fig8": fig8}
    for name in sys.argv[2:] or figures:
        figures[name]()


main()
