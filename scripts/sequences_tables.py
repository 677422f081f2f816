"""Tables of docs/sequences.md from what scripts/sequences.sh measured, on standard output: sequences_tables.py TABLE FOLDER ..."""
import json
import os
import statistics
import sys


def load(*path):
    with open(os.path.join(*path)) as file:
        return json.load(file)


def text(value):
    return "-" if value is None else f"{value:.3g}"


def layers(folder, name):
    return {found["layer"]: found for found in load(folder, name + "-flicker", "compare.json")["layers"]}


def mean_rmse(layer):
    return statistics.mean(frame["rmse_over_mean"] for frame in layer["frames"])


def table(head, rows):
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def flicker(folder):
    """Of the irradiance; rows.tsv names the choices, the truth's noise first."""
    with open(os.path.join(folder, "rows.tsv")) as file:
        choices = [line.rstrip("\n").split("\t") for line in file]
    rows = []
    for name, title in choices:
        found = layers(folder, name)["irradiance"]
        middle = found["frames"][len(found["frames"]) // 2]
        rows.append([title, text(found["fe"]), text(found["f"]), text(found["v"]), text(found["j"]), text(middle["rmse_over_mean"])])
    print("F of the truth: " + text(layers(folder, choices[0][0])["irradiance"]["f_reference"]) + "\n")
    table([os.path.basename(folder), "F_e", "F", "V", "J", "RMSE / mean"], rows)


COLOURS = ("#0a6ebd", "#c2410c", "#15803d")
SIZES, LEVELS = (512, 1024, 2048), range(7)


def plot(curves, floor):
    """Specular RMSE over F_e, a curve a size of the map with its levels, as SVG. Values to the left and below are better."""
    width, height, left, bottom, top, right = 620, 400, 60, 50, 20, 20
    xs = [x for curve in curves.values() for x, _ in curve]
    ys = [y for curve in curves.values() for _, y in curve]
    x_end, y_begin, y_end = 1.1 * max(xs), 0.95 * min(ys), 1.05 * max(ys)
    at_x = lambda x: left + (width - left - right) * x / x_end
    at_y = lambda y: height - bottom - (height - bottom - top) * (y - y_begin) / (y_end - y_begin)
    label = lambda x, y, words, anchor="middle", colour="#333": f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{words}</text>'
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">',
             f'<rect width="{width}" height="{height}" fill="white"/>']
    for i in range(6):
        x, y = x_end * i / 5, y_begin + (y_end - y_begin) * i / 5
        parts += [f'<path d="M{at_x(x):.1f} {top}V{height - bottom}M{left} {at_y(y):.1f}H{width - right}" stroke="#ddd"/>',
                  label(at_x(x), height - bottom + 16, text(x)), label(left - 6, at_y(y) + 4, text(y), "end")]
    parts += [f'<path d="M{at_x(floor):.1f} {top}V{height - bottom}" stroke="#888" stroke-dasharray="4 3"/>',
              label(at_x(floor) + 4, top + 12, "two truths", "start", "#888"),
              label((left + width - right) / 2, height - 12, "F_e of the specular light"),
              f'<text transform="translate(14 {height / 2}) rotate(-90)" text-anchor="middle" fill="#333">RMSE / mean of the specular light</text>']
    for place, (colour, (size, curve)) in enumerate(zip(COLOURS, curves.items())):
        points = " ".join(f"{at_x(x):.1f},{at_y(y):.1f}" for x, y in curve)
        parts += [f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>',
                  label(width - right - 8, top + 16 + 16 * place, f"RSM {size}, levels 0 to 6", "end", colour)]
        for level, (x, y) in enumerate(curve):
            parts += [f'<circle cx="{at_x(x):.1f}" cy="{at_y(y):.1f}" r="3" fill="{colour}"/>', label(at_x(x) + 5, at_y(y) - 5, str(level), "start", colour)]
    return "\n".join(parts) + "\n</svg>\n"


def figure8(folder, picture):
    rows, curves = [], {}
    for size in SIZES:
        curves[size] = []
        for level in LEVELS:
            found = layers(folder, f"rsm{size}-level{level}")
            specular, diffuse = found["indirect.specular"], found["irradiance"]
            curves[size].append((specular["fe"], mean_rmse(specular)))
            rows.append([f"{size}", f"{level}", text(specular["fe"]), text(mean_rmse(specular)), text(specular["j"]), text(diffuse["fe"]), text(mean_rmse(diffuse))])
    floor = layers(folder, "truth-of-seed-1")
    rows.append(["the truth's noise", ""] + [text(v) for v in (floor["indirect.specular"]["fe"], mean_rmse(floor["indirect.specular"]), floor["indirect.specular"]["j"],
                                                            floor["irradiance"]["fe"], mean_rmse(floor["irradiance"]))])
    table(["RSM", "`rsm_min_level`", "specular F_e", "specular RMSE / mean", "specular J", "diffuse F_e", "diffuse RMSE / mean"], rows)
    with open(picture, "w") as file:
        file.write(plot(curves, floor["indirect.specular"]["fe"]))


def passes_of(*path):
    return load(*path, "frame.json")["passes"]


def reuse(folder):
    rows = []
    for case in ("moving-camera", "moving-sun", "moving-dragons"):
        times = {}
        for switch in ("off", "on"):
            frames = [passes_of(folder, f"{case}-{switch}-{turn}", f"{frame:04d}") for turn in (0, 1) for frame in range(2, 8)]
            times[switch] = statistics.median(sum(p["cpu_milliseconds"] for p in passes) for passes in frames)
        kept = sorted({p["name"] for p in passes_of(folder, f"{case}-on-0", "0003") if p.get("kept")})
        same = all([p["sha256"] for p in passes_of(folder, f"{case}-on-0", f"{f:04d}")] == [p["sha256"] for p in passes_of(folder, f"{case}-off-0", f"{f:04d}")] for f in range(8))
        rows.append([f"`{case}`", f"{times['off']:.0f} ms", f"{times['on']:.0f} ms", f"{times['on'] / times['off']:.2f}", ", ".join(kept) or "-", "equal" if same else "DIFFERENT"])
    table(["", "passes of a frame, off", "on", "ratio", "kept whole", "hashes of all passes"], rows)


def dragons(folder):
    structures = ("voxel", "rsm", "lrsm")
    rows = []
    for case in ("moving-dragons", "no-dragons"):
        predicted = load(folder, case + "-info.json")["memory"]
        frame = load(folder, "table2", case + "-off", "0002", "frame.json")
        held = {p["name"]: p["gpu_format_bytes"] for p in frame["passes"] if p["resident"]}
        of = lambda start: sum(r["gpu_format_bytes"] or 0 for r in predicted if r["structure"].startswith(start))
        measured = lambda start: sum(b for name, b in held.items() if name.startswith(start))
        cells = [f"{of(s) / 1e6:.1f}, {measured(s) / 1e6:.1f}" for s in structures]
        total = sum(of(s) for s in structures), sum(measured(s) for s in structures)
        rows.append([f"`{case}`", f"{frame['scene']['triangles']}"] + cells + [f"{total[0] / 1e6:.1f}, {total[1] / 1e6:.1f}"])
    table(["MB on a GPU: predicted, measured", "triangles", "voxels 512^3", "RSM 1024^2", "LRSM, 3x2 layers", "in all (the paper: 229.2)"], rows)

    stages = (("voxelization, mips", ("voxelize", "voxel mips")), ("RSM, LRSM", ("rsm", "lrsm")), ("G-buffer", ("gbuffer",)), ("shadow cones", ("direct",)), ("cones", ("cones",)))
    columns = [(case, switch) for case in ("no-dragons", "moving-dragons") for switch in ("off", "on")]
    rows, totals = [], {}
    for column in columns:
        totals[column] = sum(p["cpu_milliseconds"] for p in passes_of(folder, "table2", "-".join(column), "0002"))
    for title, names in stages:
        cells = []
        for column in columns:
            ms = sum(p["cpu_milliseconds"] for p in passes_of(folder, "table2", "-".join(column), "0002") if p["name"].rstrip("0123456789 ") in names)
            cells.append(f"{100 * ms / totals[column]:.1f} % ({ms:.0f} ms)")
        rows.append([title] + cells)
    rows.append(["frame"] + [f"{totals[column]:.0f} ms" for column in columns])
    table(["processor time"] + [f"`{case}`, reuse {switch}" for case, switch in columns], rows)


if __name__ == "__main__":
    {"flicker": flicker, "figure8": figure8, "reuse": reuse, "dragons": dragons}[sys.argv[1]](*sys.argv[2:])
