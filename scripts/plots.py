#!/usr/bin/python3
"""Plots for docs/, from what the program measured.

    scripts/plots.py scaling BENCH_DIR IMAGES [PAGE]    scaling-AXIS.png for each axis of `lrsm bench -o BENCH_DIR`; the table of exponents goes
                                                        between the marks of PAGE (docs/performance.md), or to standard output
    scripts/plots.py front SWEEP.csv OUT.png            error against cost of `lrsm sweep`, a panel a scene

Needs matplotlib: apt-get install python3-matplotlib. Neither the program nor its tests do.
"""

import argparse
import csv
import json
import math
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

COLOURS = ["#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377"]
DOTS_PER_INCH = 110


def style(axes):
    axes.grid(True, which="major", alpha=0.35)
    axes.grid(True, which="minor", alpha=0.12)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def save(figure, path):
    figure.tight_layout()
    figure.savefig(path, dpi=DOTS_PER_INCH, metadata={"Software": None})  # the same bytes from the same figures
    plt.close(figure)
    print(path, file=sys.stderr)


# --- How cost grows ---


def readable(series):
    """cones_cpu_ms -> cones"""
    for end in ("_cpu_ms", "_ms"):
        if series.endswith(end):
            return series[: -len(end)].replace("_", " ") + (" (wall)" if end == "_ms" else "")
    return series.replace("_", " ")


def medians_from_rows(folder):
    """(axis, label, series) -> values of the repeats, from the rows as they were measured."""
    values = {}
    with open(os.path.join(folder, "bench.csv"), newline="") as file:
        for row in csv.DictReader(file):
            for series, value in row.items():
                if series not in ("axis", "label", "repeat"):
                    values.setdefault((row["axis"], row["label"], series), []).append(float(value))
    return values


def fit_line(fit, x):
    return [fit["coefficient"] * value ** fit["exponent"] for value in x]


def offset_line(fit, x):
    return [fit["constant"] + fit["factor"] * value ** fit["exponent"] for value in x]


def between(x, count=60):
    low, high = math.log(min(x)), math.log(max(x))
    return [math.exp(low + (high - low) * i / (count - 1)) for i in range(count)]


def shown_series(axis):
    """The frame and what the axis drives: first expectation first, times only."""
    names = ["frame_cpu_ms"] if axis["name"] != "threads" else ["frame_ms", "cones_ms"]
    for expected in axis["expected"]:
        if expected["series"].endswith("_ms") and expected["series"] not in names:
            names.append(expected["series"])
    return names[:4]


def plot_axis(axis, rows, path):
    curves = {curve["series"]: curve for curve in axis["curves"]}
    figure, plot = plt.subplots(figsize=(5.6, 3.9))
    x = axis["x"]
    for colour, series in zip(COLOURS, (name for name in shown_series(axis) if name in curves)):
        curve = curves[series]
        spans = [rows[(axis["name"], label, series)] for label in axis["labels"]]
        errors = [[median - min(span) for median, span in zip(curve["median"], spans)], [max(span) - median for median, span in zip(curve["median"], spans)]]
        label = readable(series) + (" (processor)" if axis["name"] == "threads" and series.endswith("_cpu_ms") else "")
        if curve["power"]:
            label += f"  $x^{{{curve['power']['exponent']:.2f}}}$"
            if offset_text(curve):
                plot.plot(between(x), offset_line(curve["offset"], between(x)), "-", color=colour, linewidth=1, alpha=0.6)
            plot.plot(x, fit_line(curve["power"], x), "--", color=colour, linewidth=1)
        plot.errorbar(x, curve["median"], yerr=errors, fmt="o", markersize=4, color=colour, elinewidth=1, label=label)
    if axis["name"] == "threads" and "frame_ms" in curves:
        plot.plot(x, [curves["frame_ms"]["median"][0] / n for n in x], ":", color="#888888", label="ideal")
    plot.set_xscale("log", base=2 if axis["name"] not in ("pixels", "triangles") else 10)
    if axis["name"] not in ("pixels", "triangles"):
        ticks = [round(value) for value in x]
        plot.set_xticks(ticks, [str(tick) for tick in ticks])
        plot.set_xticks([], minor=True)
    plot.set_yscale("log")
    plot.set_xlabel(axis["x_label"])
    plot.set_ylabel("ms" if axis["name"] == "threads" else "processor ms")
    plot.set_title(axis["fixed"], fontsize=7)
    style(plot)
    plot.legend(fontsize=8, frameon=False)
    save(figure, path)


def expected_text(expected):
    return f"{expected['low']:g}" if expected["low"] == expected["high"] else f"{expected['low']:g} .. {expected['high']:g}"


def offset_text(curve):
    """Nothing of what hardly changes: its exponent would be the noise's."""
    fit = curve["offset"]
    if not fit or max(curve["median"]) < 1.25 * min(curve["median"]):
        return ""
    return f"{fit['constant']:.3g} + {fit['factor']:.3g} x^{fit['exponent']:.2f}"


def markdown_table(axes):
    table = ["| axis | what | measured exponent | a + b x^p | expected | because |", "| --- | --- | --- | --- | --- | --- |"]
    for axis in axes:
        curves = {curve["series"]: curve for curve in axis["curves"]}
        name = f"`{axis['name']}`"
        for expected in axis["expected"]:
            curve = curves.get(expected["series"])
            if not curve or not curve["power"]:
                continue
            fit = curve["power"]
            error = f" +- {fit['standard_error']:.2f}" if len(axis["x"]) > 2 and expected["series"].endswith("_ms") else ""
            table.append(f"| {name} | {readable(expected['series'])} | {fit['exponent']:.2f}{error} | {offset_text(curve)} | {expected_text(expected)} | {expected['why']} |")
            name = ""
    return "\n".join(table)


def machine_text(bench):
    machine = bench["machine"]
    def load(values):
        return f"{values[0]:.1f}" if values else "unknown"
    return (f"{machine['processor']} (family {machine['family']} model {machine['model']}), {machine['cores']} cores, {machine['compiler']}; "
            f"load average {load(machine['load'])} before and {load(bench['load_at_end'])} after; medians of {bench['repeat']}.")


BEGIN, END = "<!-- scaling: begin -->\n", "<!-- scaling: end -->\n"


def replace_between_marks(page, text):
    with open(page) as file:
        old = file.read()
    if BEGIN not in old or END not in old:
        sys.exit(f"{page}: has no lines {BEGIN.strip()} and {END.strip()}")
    with open(page, "w") as file:
        file.write(old[: old.index(BEGIN)] + BEGIN + text + old[old.index(END):])


def scaling(folder, images, page=None):
    with open(os.path.join(folder, "bench.json")) as file:
        bench = json.load(file)
    rows = medians_from_rows(folder)
    os.makedirs(images, exist_ok=True)
    for axis in bench["axes"]:
        plot_axis(axis, rows, os.path.join(images, f"scaling-{axis['name']}.png"))
    text = machine_text(bench) + "\n\n" + markdown_table(bench["axes"]) + "\n"
    if page:
        replace_between_marks(page, text)
    else:
        print(text, end="")


# --- Error against cost ---


def number(row, key):
    try:
        return float(row[key])
    except (KeyError, TypeError, ValueError):
        return math.nan


def pareto(points):
    """Points (cost, error, ...) that none beats, by rising cost."""
    front = []
    for point in sorted(points, key=lambda p: (p[0], p[1])):
        if not front or point[1] < front[-1][1]:
            front.append(point)
    return front


def plot_scene(plot, name, rows, x_key, y_key):
    def points(chosen):
        listed = [(number(row, x_key), number(row, y_key), row["label"]) for row in chosen]
        return [point for point in listed if point[0] > 0 and point[1] > 0]

    settings = points(row for row in rows if row["kind"] != "path_tracer")
    tracer = sorted(points(row for row in rows if row["kind"] == "path_tracer"))
    plot.plot([p[0] for p in settings], [p[1] for p in settings], "o", markersize=2.5, color="#bbbbbb", label="settings")
    front = pareto(settings)
    plot.plot([p[0] for p in front], [p[1] for p in front], "-o", markersize=3.5, linewidth=1.2, color=COLOURS[0], drawstyle="steps-post", label="front")
    if tracer:
        plot.plot([p[0] for p in tracer], [p[1] for p in tracer], "--s", markersize=3, linewidth=1, color=COLOURS[2], label="path tracer")
    presets = points(row for row in rows if row["kind"] == "preset")
    plot.plot([p[0] for p in presets], [p[1] for p in presets], "D", markersize=5, color=COLOURS[1], label="presets")
    for cost, error, label in presets:
        plot.annotate(label, (cost, error), textcoords="offset points", xytext=(5, 4), fontsize=7, color=COLOURS[1])
    noise = [number(row, "noise") for row in rows if number(row, "noise") > 0]
    if noise and y_key in ("rmse", "net"):
        plot.axhline(min(noise), color="#888888", linestyle=":", linewidth=1, label="noise of the reference")
    plot.set_xscale("log")
    plot.set_yscale("log")
    plot.set_title(name, fontsize=9)
    style(plot)


def front(table, output, x_key="cost", y_key="net"):
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
    cases = {}
    for row in rows:
        cases.setdefault((row["scene"], row.get("case", "")), []).append(row)
    if not cases:
        sys.exit(f"{table}: has no rows")
    columns = min(3, len(cases))
    lines = -(-len(cases) // columns)
    figure, plots = plt.subplots(lines, columns, figsize=(3.9 * columns, 3.2 * lines), squeeze=False)
    flat = [plot for line in plots for plot in line]
    for plot, ((scene, _), scene_rows) in zip(flat, sorted(cases.items())):
        plot_scene(plot, scene, scene_rows, x_key, y_key)
    for plot in flat[len(cases):]:
        plot.set_visible(False)
    for plot in flat:
        plot.set_xlabel({"cost": "cost, calibration frames"}.get(x_key, x_key.replace("_", " ")))
    for line in plots:
        line[0].set_ylabel({"net": "RMSE / mean, noise removed"}.get(y_key, y_key))
    flat[0].legend(fontsize=7, frameon=False)
    save(figure, output)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("scaling", help="plots and table of lrsm bench")
    one.add_argument("folder")
    one.add_argument("images")
    one.add_argument("page", nargs="?", help="markdown whose table between the marks is replaced")
    two = commands.add_parser("front", help="error against cost of lrsm sweep")
    two.add_argument("table")
    two.add_argument("output")
    two.add_argument("--x", default="cost", help="column: cost, frame_cpu_ms, bytes ...")
    two.add_argument("--y", default="net", help="column: net, rmse, flip ...")
    chosen = parser.parse_args()
    if chosen.command == "scaling":
        scaling(chosen.folder, chosen.images, chosen.page)
    else:
        front(chosen.table, chosen.output, chosen.x, chosen.y)


if __name__ == "__main__":
    main()
