#!/usr/bin/env python3
"""Two versions of the program in pairs: processor time of each pass and of the whole run, peak memory, and the ratios; says whether the picture is the same.
  scripts/pairs.py A B [--repeat N] -- ARGUMENTS       ARGUMENTS of `lrsm render`, without -o
  scripts/pairs.py HEAD~1 HEAD -- atrium --size 640x360
  scripts/pairs.py "build/release/apps/lrsm --lanes 4" "build/release/apps/lrsm --lanes 8" -- ../shared/scenes/views/sponza.json
A and B: a commit, which is built below out/pairs, or a program with options. Both run once in turn, N times (default 5), so that a slow minute hits both; a
figure is the median over runs, a ratio the median over pairs, as the machine's noise is mostly shared by a pair."""
import argparse
import json
import os
import statistics
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
OUT = os.path.join(ROOT, "out/pairs")


def program(text):
    """The command of a version: what is a file is run, what is a commit is built first."""
    words = text.split()
    if os.path.exists(words[0]):
        return [words[0], "render", *words[1:]]
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--verify", words[0] + "^{commit}"], capture_output=True, text=True, check=True).stdout.strip()
    tree = os.path.join(OUT, commit[:12])
    if not os.path.isdir(tree):
        os.makedirs(tree)
        files = subprocess.run(["git", "-C", ROOT, "archive", commit], stdout=subprocess.PIPE, check=True).stdout
        subprocess.run(["tar", "-x", "-C", tree], input=files, check=True)
    subprocess.run(["scripts/configure.sh", "release", "-DBUILD_TESTING=OFF", "-DLRSM_BENCHMARKS=OFF"], cwd=tree, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", "build/release", "--target", "lrsm_program"], cwd=tree, check=True, stdout=subprocess.DEVNULL)
    return [os.path.join(tree, "build/release/apps/lrsm"), "render", *words[1:]]


def run(command, arguments, folder):
    """Milliseconds of processor time by pass, of the whole run last; MB at most; the hash of the last pass."""
    process = subprocess.Popen([*command, *arguments, "--quiet", "-o", folder], stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"pairs: {' '.join(command)} failed")
    with open(f"{folder}/frame.json") as file:
        passes = json.load(file)["passes"]
    figures = {p["name"]: p["cpu_milliseconds"] for p in passes}
    figures["the whole run"] = 1000 * (used.ru_utime + used.ru_stime)
    return figures, used.ru_maxrss / 1024, passes[-1]["sha256"]


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("versions", nargs=2, metavar="VERSION")
parser.add_argument("--repeat", type=int, default=5)
parser.add_argument("arguments", nargs="+")
options = parser.parse_args()
commands = [program(text) for text in options.versions]
rows = [[run(command, options.arguments, f"{OUT}/{side}") for side, command in zip("ab", commands)] for _ in range(options.repeat)]

print(f"A: {options.versions[0]}\nB: {options.versions[1]}\n\n| pass | A, ms | B, ms | A / B |\n| --- | --- | --- | --- |")
for name in dict.fromkeys(name for side in rows[0] for name in side[0]):
    pairs = [(a[0].get(name), b[0].get(name)) for a, b in rows]
    medians = ["" if pairs[0][side] is None else f"{statistics.median(p[side] for p in pairs):.0f}" for side in (0, 1)]
    ratio = "" if "" in medians else f"{statistics.median(a / max(b, 1e-3) for a, b in pairs):.2f}"
    print(f"| {name} | {medians[0]} | {medians[1]} | {ratio} |")
print(f"| MB at most | {max(a[1] for a, _ in rows):.0f} | {max(b[1] for _, b in rows):.0f} | |")
print("the picture is the same" if rows[0][0][2] == rows[0][1][2] else "the pictures differ")
