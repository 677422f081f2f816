"""Tables and pictures of docs/paper.md from what scripts/paper.sh measured: paper_tables.py OUT PAGE IMAGES PRESET ...

A table NAME stands between the lines <!-- NAME: begin --> and <!-- NAME: end --> of the page.
"""
import functools
import json
import os
import shutil
import subprocess
import sys

DARK = 0.02  # of the truth's mean irradiance: below it a pixel counts as dark
LUMINANCE = (0.2126, 0.7152, 0.0722)


def load(*path):
    with open(os.path.join(*path)) as file:
        return json.load(file)


@functools.lru_cache(maxsize=4)
def picture(path):
    """Channel names of an EXR, and its pixels as text."""
    listed = subprocess.run(["oiiotool", "--info", "-v", path], capture_output=True, text=True, check=True).stdout
    channels = next(line for line in listed.splitlines() if "channel list:" in line).split(":")[1].replace(" ", "").split(",")
    text = subprocess.run(["oiiotool", "--dumpdata", path], capture_output=True, text=True, check=True).stdout
    return channels, [line.split(":", 1)[1].split() for line in text.splitlines() if line.startswith("    Pixel (")]


def layer(folder, name):
    """Pixels (r, g, b) of a layer of image.exr."""
    channels, pixels = picture(os.path.join(folder, "image.exr"))
    at = [channels.index(name + "." + c) for c in "RGB"]
    return [tuple(float(values[i]) for i in at) for values in pixels]


def luminance(pixel):
    return sum(w * c for w, c in zip(LUMINANCE, pixel))


def chroma(pixel):
    return max(pixel) - min(pixel)


def leak_and_colour(test, truth):
    """Light in pixels that are dark in truth over the truth's mean, with the truth's own; colour kept."""
    lit = [i for i, p in enumerate(truth) if sum(p) > 0.0 or sum(test[i]) > 0.0]
    mean = sum(luminance(truth[i]) for i in lit) / len(lit)
    dark = [i for i in lit if luminance(truth[i]) < DARK * mean]
    leak = tuple(sum(luminance(of[i]) for i in dark) / len(dark) / mean for of in (test, truth)) if dark else None
    colour = sum(chroma(test[i]) for i in lit) / sum(chroma(truth[i]) for i in lit)
    return leak, colour


def judged(*path):
    """What `lrsm compare` says of each layer."""
    return {found["layer"]: found for found in load(*path)["layers"]}


def figure7(out, images, presets):
    pictures = ["| | direct only | reference | " + " | ".join(f"`{p}`" for p in presets) + " |", "| --- " * (len(presets) + 3) + "|"]
    numbers = ["| scene | | " + " | ".join(f"`{p}`" for p in presets) + " |", "| --- | --- " + "| --- " * len(presets) + "|"]
    for scene in ("sibenik", "sponza"):
        folder = os.path.join(out, "fig7", scene)
        cells = []
        for name, file in [("direct", "reference/direct.png"), ("reference", "reference/image.png")] + [(p, f"{p}/image.png") for p in presets]:
            target = f"paper-{scene}-{name}.png"
            shutil.copyfile(os.path.join(folder, file), os.path.join(images, target))
            cells.append(f"![{name}](images/{target})")
        pictures.append(f"| {scene.capitalize()} | " + " | ".join(cells) + " |")
        truth = layer(os.path.join(folder, "reference"), "irradiance")
        rows = {"energy / RMSE over mean": [], "light in dark pixels": [], "colour": [], "glossy: energy / RMSE": []}
        for preset in presets:
            found = judged(folder, f"{preset}.json")
            for row, name in (("energy / RMSE over mean", "irradiance"), ("glossy: energy / RMSE", "indirect.specular")):
                rows[row].append(f"{found[name]['energy_ratio']:.2f} / {found[name]['rmse_over_mean']:.2f}")
            leak, colour = leak_and_colour(layer(os.path.join(folder, preset), "irradiance"), truth)
            rows["light in dark pixels"].append(f"{100 * leak[0]:.1f} % ({100 * leak[1]:.1f})" if leak else "none are dark")
            rows["colour"].append(f"{colour:.2f}")
        for name, values in rows.items():
            numbers.append(f"| {scene.capitalize()} | {name} | " + " | ".join(values) + " |")
    return pictures, numbers


def megabytes(value):
    return f"{value / 1e6:.1f}"


def table2(out):
    lines = ["| | paper | here | |", "| --- | --- | --- | --- |"]
    printed = {"sibenik": (256, "19.2", "33.6", "75.2"), "sponza": (512, "156.4", "33.6", "212.4"), "dragon": (512, "156.4", "50.4", "229.2")}
    for scene, (n, voxels, layers, total) in printed.items():
        rows = load(out, "table2", f"{scene}-lrsm.json")["memory"]
        def of(prefix):
            return sum(r.get("gpu_format_bytes") or 0 for r in rows if r["structure"].startswith(prefix))
        note = "a byte a voxel, and mips" + ("" if scene == "sibenik" else ": 8/7 of 512^3 bytes; the paper's 3 MB more are not explained")
        name = {"sibenik": "Sibenik", "sponza": "Sponza", "dragon": "Sponza Dragon, static part"}[scene]
        lines.append(f"| {name}: voxels {n}^3 | {voxels} MB | {megabytes(of('voxel'))} MB | {note} |")
        lines.append(f"| {name}: RSM 1024^2 | 22.4 MB | {megabytes(of('rsm'))} MB | the paper: two textures with mips, which nothing reads; here without mips, with depth |")
        lines.append(f"| {name}: LRSM | {layers} MB | {megabytes(of('lrsm'))} MB | |")
        lines.append(f"| {name}: total | {total} MB | {megabytes(of('voxel') + of('rsm') + of('lrsm'))} MB | |")
    for scene, name in (("sibenik", "Sibenik, 256^3"), ("sponza", "Sponza, 512^3")):
        info = load(out, "table2", f"{scene}-vct.json")
        row = next(r for r in info["memory"] if r["structure"] == "vct")
        paper = "3 GB" if scene == "sponza" else "not said"
        lines.append(f"| VCT: {name}, dense | {paper} | {megabytes(row['gpu_format_bytes'])} MB | held here in bricks: {megabytes(row['predicted_bytes'])} MB |")
        sparse = info["sparse"]
        lines.append(
            f"| VCT: {name}, an octree | \"could reduce\" | {megabytes(sparse['octree_occupied_only'])}, {megabytes(sparse['octree_tiles_of_eight'])}, "
            f"{megabytes(sparse['octree_bricks'])} MB | occupied nodes alone; children in tiles of eight; 3^3 bricks |")
    return lines


def stage_times(out, preset):
    """Processor milliseconds of stages, the least of the repeats: world, shadow cones, diffuse cones, specular cones."""
    def least(view, names):
        folder = os.path.join(out, "table3", preset, view)
        times = []
        for run in os.listdir(folder):
            passes = load(folder, run, "frame.json")["passes"]
            times.append(sum(p["cpu_milliseconds"] for p in passes if p["name"].rstrip("0123456789 ") in names))
        return min(times)
    diffuse = least("sponza-diffuse", ("cones", "vct cones"))
    both = least("sponza-all-gloss", ("cones", "vct cones"))
    return {
        "voxelization, mips": least("sponza-diffuse", ("voxelize", "voxel mips")),
        "RSM, LRSM": least("sponza-diffuse", ("rsm", "lrsm")),
        "injection, six mips": least("sponza-diffuse", ("vct surface", "vct inject", "vct mips")),
        "shadow cones": least("sponza-diffuse", ("direct",)),
        "diffuse cones": diffuse,
        "specular cones": max(both - diffuse, 1e-9),
    }


def table3(out):
    presets = ["vct-paper", "vct", "literal", "paper", "balanced"]
    times = {p: stage_times(out, p) for p in presets}
    lines = ["| stage | paper: VCT | paper: LRSM | " + " | ".join(f"`{p}`" for p in presets) + " |", "| --- " * (len(presets) + 3) + "|"]
    printed = {"voxelization, mips": ("", "9.8 %"), "RSM, LRSM": ("", "5.7 %"), "injection, six mips": ("precomputed", ""), "shadow cones": ("", "12.9 %"), "diffuse cones": ("", "40.8 %"), "specular cones": ("", "30.7 %")}
    for stage, (vct, lrsm) in printed.items():
        cells = []
        for p in presets:
            total = sum(times[p].values())
            cells.append(f"{100 * times[p][stage] / total:.1f} % ({times[p][stage]:.0f} ms)" if times[p][stage] else "")
        lines.append(f"| {stage} | {vct} | {lrsm} | " + " | ".join(cells) + " |")
    ratio = [times[p]["diffuse cones"] / times[p]["specular cones"] for p in presets]
    lines.append("| diffuse over specular cones | 0.22 | 1.33 | " + " | ".join(f"{r:.2f}" for r in ratio) + " |")
    shadow = [times[p]["shadow cones"] / times["literal"]["shadow cones"] for p in presets]
    lines.append("| shadow cones over LRSM's | 1.40 | 1 | " + " | ".join(f"{r:.2f}" for r in shadow) + " |")
    return lines


def figure8(out, images):
    lines = ["| `rsm_min_level` | picture | glossy: RMSE over mean | diffuse: RMSE over mean | flicker, glossy | flicker, diffuse |", "| --- | --- | --- | --- | --- | --- |"]
    reference = os.path.join(out, "fig7", "sponza", "reference")
    truth = {name: layer(reference, name) for name in ("indirect.specular", "irradiance")}
    for level in (0, 2, 4):
        folder = os.path.join(out, "fig8", f"level{level}")
        target = f"paper-sponza-level{level}.png"
        shutil.copyfile(os.path.join(folder, "1", "image.png"), os.path.join(images, target))
        error, flicker = {}, {}
        for name in truth:
            before, now, after = (layer(os.path.join(folder, step), name) for step in "012")
            error[name] = judged(out, "fig8", f"level{level}.json")[name]["rmse_over_mean"]
            second = sum(abs(luminance(a) - 2.0 * luminance(b) + luminance(c)) for a, b, c in zip(before, now, after))
            flicker[name] = second / sum(luminance(p) for p in truth[name])
        lines.append(f"| {level} | ![level {level}](images/{target}) | {error['indirect.specular']:.2f} | {error['irradiance']:.3f} | "
                     f"{flicker['indirect.specular']:.4f} | {flicker['irradiance']:.4f} |")
    return lines


SCENES, RESOLUTIONS = ("cornell-box", "two-rooms", "atrium", "cornell-glossy", "furnace"), (128, 256, 512)


def trade_rows(out):
    """Rows of the sweep by scene, method and resolution; the preset `vct` is its own row at 256^3."""
    rows = {}
    with open(os.path.join(out, "trade", "rows.jsonl")) as file:
        for line in file:
            row = json.loads(line)
            if row.get("label", "").startswith("method=") or row.get("label") == "vct":
                rows[row["scene"], row["method"], row["voxel_resolution"]] = row
    return rows


def trade(out):
    rows = trade_rows(out)
    lines = ["| scene | voxels | cost | MB on a GPU | MB held here | net RMSE over mean | energy |", "| --- | --- | --- | --- | --- | --- | --- |"]
    for scene in SCENES:
        for n in RESOLUTIONS:
            both = [rows[scene, method, n] for method in ("lrsm", "vct")]
            cells = [", ".join(form.format(row[key] * scale) for row in both)
                     for key, form, scale in (("cost", "{:.1f}", 1), ("gpu_bytes", "{:.0f}", 1e-6), ("bytes", "{:.0f}", 1e-6), ("net", "{:.3f}", 1), ("energy", "{:.2f}", 1))]
            lines.append(f"| {scene} | {n}^3 | " + " | ".join(cells) + " |")
    return lines


def equal(out):
    """The best row of each method within a budget: of time (15 calibration frames), of GPU memory (80 MB), of error."""
    rows = trade_rows(out)
    lines = ["| scene | least RMSE in 15 calibration frames | in 80 MB | in 450 MB | least cost for VCT's best RMSE |", "| --- | --- | --- | --- | --- |"]
    for scene in SCENES:
        own = {m: [rows[scene, m, n] for n in RESOLUTIONS] for m in ("lrsm", "vct")}
        def best(key, limit, wanted):
            found = [min((r[wanted] for r in own[m] if r[key] <= limit), default=None) for m in ("lrsm", "vct")]
            return ", ".join("none" if v is None else f"{v:.3f}" if wanted == "net" else f"{v:.1f}" for v in found)
        error = min(r["net"] for r in own["vct"])
        lines.append(f"| {scene} | {best('cost', 15, 'net')} | {best('gpu_bytes', 80e6, 'net')} | {best('gpu_bytes', 450e6, 'net')} | {best('net', error, 'cost')} ({error:.3f}) |")
    return lines


def put(page, name, lines):
    with open(page) as file:
        text = file.read()
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->"
    before, rest = text.split(begin, 1)
    after = rest.split(end, 1)[1]
    with open(page, "w") as file:
        file.write(before + begin + "\n".join(lines) + "\n" + end + after)


def main():
    out, page, images, presets = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False).stdout.strip()
    pictures, numbers = figure7(out, images, presets)
    put(page, "commit", [f"Measured on commit {commit or 'unknown'}."])
    put(page, "figure7", pictures)
    put(page, "figure7-numbers", numbers)
    put(page, "table2", table2(out))
    put(page, "table3", table3(out))
    put(page, "figure8", figure8(out, images))
    put(page, "trade", trade(out))
    put(page, "equal", equal(out))


main()
