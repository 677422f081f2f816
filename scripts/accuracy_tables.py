#!/usr/bin/python3
"""The tables of docs/accuracy.md, from what `lrsm sweep` measured (scripts/accuracy.sh runs both).

    scripts/accuracy_tables.py PAGE presets SWEEP.csv           presets in each scene, beside the path tracer
    scripts/accuracy_tables.py PAGE points SWEEP.csv            points along the front: mean and spread over the scenes
    scripts/accuracy_tables.py PAGE unseen SWEEP.csv SEEN.csv   the same points in scenes that played no part in choosing them
    scripts/accuracy_tables.py PAGE effects SWEEP.csv           one setting at a time around balanced

A table goes between the lines <!-- NAME: begin --> and <!-- NAME: end --> of PAGE.
"""

import csv
import math
import sys

PRESETS = ["literal", "fast", "balanced", "fine", "accurate"]


def number(row, key):
    return float(row[key]) if row.get(key) else math.nan


def read(path):
    """scene -> its rows."""
    scenes = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            scenes.setdefault(row["scene"], []).append(row)
    return scenes


def is_path_tracer(row):
    return row["spp"] not in ("", "0")


def settings_rows(rows):
    return {row["label"]: row for row in rows if not is_path_tracer(row)}


def mean(values):
    """Geometric."""
    return math.exp(sum(math.log(value) for value in values) / len(values))


def cost_of_error(rows, error):
    """Of the path tracer, calibration frames, interpolated in logarithms; nothing where its curve does not reach `error` from above."""
    curve = sorted((number(row, "cost"), number(row, "net")) for row in rows if is_path_tracer(row) and number(row, "rmse") > number(row, "noise"))
    for (cost, high), (next_cost, low) in zip(curve, curve[1:]):
        if high >= error > low:
            at = math.log(high / error) / math.log(high / low)
            return cost * (next_cost / cost) ** at
    return math.nan


def table(head, rows):
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, ["---"] * len(head), *rows])


def presets(scenes):
    rows = []
    for scene, measured in scenes.items():
        by_label = settings_rows(measured)
        balanced = by_label["balanced"]
        for name in PRESETS:
            row = by_label[name]
            error = number(row, "net")
            tracer = cost_of_error(measured, error) if error > number(row, "noise") else math.nan
            rows.append([scene, name, f"{number(row, 'energy'):.2f}", f"{error:.3f}", f"{number(row, 'noise'):.3f}", f"{number(row, 'mae'):.3f}", f"{number(row, 'flip'):.3f}",
                         f"{number(row, 'cost') / number(balanced, 'cost'):.2f}", f"{number(row, 'bytes') / 1e6:.0f}", "" if math.isnan(tracer) else f"{tracer / number(row, 'cost'):.2f}"])
    return table(["scene", "preset", "energy", "net RMSE / mean", "noise of the truth", "MAE / mean", "FLIP", "time over `balanced`", "MB", "path tracer's time for this error, over the preset's"], rows)


def relative(scenes, label, key):
    return [number(rows[label], key) / number(rows["balanced"], key) for rows in map(settings_rows, scenes.values())]


def span(values):
    return f"{mean(values):.2f} ({min(values):.2f} .. {max(values):.2f})"


def common_labels(scenes):
    by_label = [settings_rows(rows) for rows in scenes.values()]
    labels = [label for label in by_label[0] if all(label in rows for rows in by_label)]
    return sorted(labels, key=lambda label: mean(relative(scenes, label, "cost")))


def energies(scenes, label):
    values = [number(settings_rows(rows)[label], "energy") for rows in scenes.values()]
    return f"{min(values):.2f} .. {max(values):.2f}"


def points(scenes):
    rows, best = [], math.inf
    for label in common_labels(scenes):
        error = mean(relative(scenes, label, "net"))
        on_front, best = error < best, min(error, best)
        rows.append([f"**{label}**" if label in PRESETS else label, span(relative(scenes, label, "cost")), span(relative(scenes, label, "net")), energies(scenes, label),
                     f"{mean(relative(scenes, label, 'bytes')):.2f}", "yes" if on_front else ""])
    return table(["point", "time over `balanced`", "error over `balanced`", "energy", "memory", "on the front of the mean"], rows)


def unseen(scenes, seen):
    """Whether what the seen scenes say of a point, relative to balanced, holds elsewhere."""
    rows = []
    for label in common_labels(scenes):
        if label not in common_labels(seen) or label == "balanced":
            continue
        expected = mean(relative(seen, label, "net"))
        found = relative(scenes, label, "net")
        cells = [f"**{label}**" if label in PRESETS else label, f"{expected:.2f}", *(f"{value:.2f}" for value in found)]
        rows.append(cells + [f"{mean(found):.2f}", f"{min(found) / expected:.2f} .. {max(found) / expected:.2f}"])
    balanced = [settings_rows(measured)["balanced"] for measured in scenes.values()]
    rows.append(["`balanced` itself: net (energy)", "", *(f"{number(row, 'net'):.3f} ({number(row, 'energy'):.2f})" for row in balanced), "", ""])
    return table(["point", "error over `balanced`: expected", *scenes, "mean", "found over expected"], rows)


def effects(scenes):
    rows, nothing = [], []
    first = next(iter(scenes.values()))
    for label in (row["label"] for row in first if row["kind"] == "axis"):
        by_scene = [settings_rows(rows) for rows in scenes.values()]
        if any(label not in rows for rows in by_scene):
            continue
        if all(rows[label]["irradiance_sha256"] == rows["balanced"]["irradiance_sha256"] for rows in by_scene):
            nothing.append(f"`{label}`")
            continue
        rows.append((mean(relative(scenes, label, "net")), mean(relative(scenes, label, "cost")), mean(relative(scenes, label, "bytes")), energies(scenes, label), label))
    rows.sort()
    text = table(["setting", "error", "time", "memory", "energy"],
                 [[f"`{label}`", f"{error:.2f}", f"{cost:.2f}", f"{size:.2f}", energy] for error, cost, size, energy, label in rows])
    return text + "\n\nNot a bit of the irradiance changes in these scenes by: " + ", ".join(nothing) + "."


def main():
    makers = {"presets": presets, "points": points, "unseen": unseen, "effects": effects}
    if len(sys.argv) < 4 or sys.argv[2] not in makers:
        sys.exit(__doc__)
    page, name = sys.argv[1], sys.argv[2]
    text = makers[name](*map(read, sys.argv[3:]))
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
    with open(page) as file:
        old = file.read()
    if begin not in old or end not in old:
        sys.exit(f"{page}: has no lines {begin.strip()} and {end.strip()}")
    with open(page, "w") as file:
        file.write(old[: old.index(begin)] + begin + text + "\n" + old[old.index(end):])


main()
