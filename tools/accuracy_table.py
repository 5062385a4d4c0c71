#!/usr/bin/env python3
"""Measures experiments whose truth is known and writes the tables of docs/accuracy.md.

usage: tools/accuracy_table.py PROGRAM PAGE [EXPERIMENT_WITH_TRUTH...]

Each experiment becomes one table; the embedded virtual experiment is made and measured with ten seeds
and summed up in another. What stands between the markers of the page is replaced.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

BEGIN, END = "<!-- begin generated -->", "<!-- end generated -->"
START, STOP = "1.6mm", "13mm"
SEEDS = range(1, 11)


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


def main():
    program, page = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    lines = []
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for experiment in map(pathlib.Path, sys.argv[3:]):
            lines += experiment_table(program, experiment, work)
        lines += demo_table(program, work)
    text = page.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    page.write_text(f"{before}{BEGIN}\n\n" + "\n".join(lines) + f"\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
