#!/usr/bin/env python3
"""Measures experiments whose truth is known and writes the generated tables of the documentation.

usage: tools/accuracy_table.py PROGRAM DOCS [EXPERIMENT_WITH_TRUTH...]

Makes every shipped scenario at full size, measures and judges it: its errors by source go into
DOCS/accuracy.md, what it shares with the paper's table I into DOCS/virtual-experiments.md. Each
experiment named becomes a table of its own; the demo is made and measured with ten seeds and summed
up in another. What stands between the markers of the pages is replaced.
"""

import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

BEGIN, END = "<!-- begin generated -->", "<!-- end generated -->"
START, STOP = "1.6mm", "13mm"
SEEDS = range(1, 11)
INSIDE = ("1.6mm", "13.9mm")
# Ozsun, Yakhot & Ekinci (2013), table I: Reynolds numbers, largest deflection [um].
TABLE_I = {"S1": (70, 1200, 33), "S2": (100, 1200, 20), "S3": (250, 1300, 37),
           "S4": (200, 800, 86), "S5": (200, 900, 25)}
PARTS = ("labels", "maps", "curve_shape", "locality")


def ask(*command):
    return json.loads(subprocess.run([*map(str, command)], check=True, text=True,
                                     stdout=subprocess.PIPE).stdout)


def judge(program, result, truth):
    """Runs judged over [START, STOP], each with the drop over its own test section beside it."""
    runs = ask(program, "judge", result, truth, "--start", START, "--end", STOP, "--json")["runs"]
    for run, whole in zip(runs, ask(program, "judge", result, truth, "--json")["runs"]):
        run["section"] = whole
    return runs


def experiment_table(program, experiment, work):
    out = work / experiment.name
    ask(program, "measure", experiment, "-o", out, "--quiet", "--json")
    lines = [f"### {experiment.name}", "",
             "| run | true drop, Pa | rms error of p(x), Pa | % of drop | largest, Pa "
             "| error of the drop, Pa | in 95 % bars | dp_e of the test section: error, Pa (pull) |",
             "|---|---|---|---|---|---|---|---|"]
    for run in judge(program, out, experiment):
        drop, rms = run["true_drop_Pa"], run["rms_error_Pa"]
        lines.append(f"| {run['run']} | {drop:.0f} | {rms:.1f} | {100 * rms / drop:.2f} "
                     f"| {run['largest_error_Pa']:.0f} | {run['drop_error_Pa']:+.0f} "
                     f"| {100 * run['coverage']:.0f} % "
                     f"| {run['section']['drop_error_Pa']:+.0f} "
                     f"({run['section']['drop_pull']:+.1f}) |")
    return lines + [""]


def high_pressure_power(folder):
    """Log-log slope of the deflection at mid-channel over the last third of the levels."""
    levels = {row["map"]: float(row["true_pressure_Pa"])
              for row in csv.DictReader(open(folder / "truth" / "truth_levels.csv"))}
    rows = list(csv.DictReader(open(folder / "truth" / "truth_static.csv")))
    middle = rows[len(rows) // 2]
    last = list(levels.items())[-(len(levels) // 3):]
    points = [(math.log(p), math.log(float(middle[f"zeta_um_{name.removesuffix('.gsf')}"])))
              for name, p in last]
    mean_p = sum(p for p, _ in points) / len(points)
    mean_z = sum(z for _, z in points) / len(points)
    return (sum((p - mean_p) * (z - mean_z) for p, z in points)
            / sum((p - mean_p) ** 2 for p, _ in points))


def scenario_tables(program, work):
    """Errors by source of every shipped scenario, and its comparison with table I."""
    errors = ["### Shipped scenarios at full size, seed 1, 1.6 to 13.9 mm", "",
              "rms over the stations, Pa; the largest error beside the first.", "",
              "| run | true drop | error (largest) | labels | maps | curve shape | locality "
              "| no answer | in 95 % bars | pull rms |",
              "|---|---|---|---|---|---|---|---|---|---|"]
    table_one = ["| sample | largest deflection, paper | twin | off by | Reynolds numbers, paper "
                 "| twin | largest S | slope d ln zeta / d ln p, last third of the levels |",
                 "|---|---|---|---|---|---|---|---|"]
    for scenario in ask(program, "twin", "--list", "--json")["scenarios"]:
        name = scenario["name"]
        folder, out = work / name, work / f"{name}-result"
        made = ask(program, "twin", name, "-o", folder, "--json")["runs"]
        ask(program, "measure", folder, "-o", out, "--quiet", "--json")
        judged = ask(program, "judge", out, folder, "--start", INSIDE[0], "--end", INSIDE[1],
                     "--json")["runs"]
        for run in judged:
            parts = " | ".join(f"{run['split'][part]['rms_error_Pa']:.1f}" for part in PARTS)
            errors.append(
                f"| {name} {run['run']} | {run['true_drop_Pa']:.0f} | {run['rms_error_Pa']:.1f} "
                f"({run['largest_error_Pa']:.0f}) | {parts} "
                f"| {run['silent']}/{run['silent'] + run['answered']} "
                f"| {100 * run['coverage']:.0f} % | {run['pull_rms']:.2f} |")
        largest = made[-1]["largest_deflection_m"] * 1e6
        reynolds = f"{made[0]['reynolds']:.0f}-{made[-1]['reynolds']:.0f}"
        paper = TABLE_I.get(name)
        beside = (f"| {paper[2]} um | {largest:.1f} um | {100 * (largest / paper[2] - 1):+.1f} % "
                  f"| {paper[0]}-{paper[1]} | {reynolds} " if paper else
                  f"| - | {largest:.1f} um | - | - | {reynolds} ")
        table_one.append(f"| {name} {beside}| {max(run['speed_index'] for run in made):.2f} "
                         f"| {high_pressure_power(folder):.2f} |")
    return errors + [""], table_one + [""]


def demo_table(program, work):
    runs = {}
    for seed in SEEDS:
        out = work / f"demo{seed}"
        subprocess.run([program, "demo", "-o", out, "--seed", str(seed), "--quiet"], check=True,
                       stdout=subprocess.DEVNULL)
        for run in judge(program, out, out / "experiment"):
            runs.setdefault(run["run"], []).append(run)
    lines = [f"### The embedded virtual experiment, seeds {SEEDS[0]} to {SEEDS[-1]}", "",
             "| run | true drop, Pa | rms error of p(x), Pa: median (worst) "
             "| rms error of the drop, Pa | rms pull of the drop | in 95 % bars "
             "| rms pull of dp_e of the test section |",
             "|---|---|---|---|---|---|---|"]
    for name, found in runs.items():
        rms = sorted(run["rms_error_Pa"] for run in found)
        middle = 0.5 * (rms[(len(rms) - 1) // 2] + rms[len(rms) // 2])
        mean_square = [sum(run[key] ** 2 for run in found) / len(found)
                       for key in ("drop_error_Pa", "drop_pull")]
        section = sum(run["section"]["drop_pull"] ** 2 for run in found) / len(found)
        coverage = sum(run["coverage"] for run in found) / len(found)
        lines.append(f"| {name} | {found[0]['true_drop_Pa']:.0f} | {middle:.1f} ({rms[-1]:.1f}) "
                     f"| {math.sqrt(mean_square[0]):.1f} | {math.sqrt(mean_square[1]):.2f} "
                     f"| {100 * coverage:.0f} % | {math.sqrt(section):.2f} |")
    return lines + [""]


def fill_in(page, lines):
    text = page.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    page.write_text(f"{before}{BEGIN}\n\n" + "\n".join(lines) + f"\n{END}{after}", encoding="utf-8")


def main():
    program, docs = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    lines = []
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for experiment in map(pathlib.Path, sys.argv[3:]):
            lines += experiment_table(program, experiment, work)
        errors, table_one = scenario_tables(program, work)
        lines += errors + demo_table(program, work)
    fill_in(docs / "accuracy.md", lines)
    fill_in(docs / "virtual-experiments.md", table_one)


if __name__ == "__main__":
    main()
