#!/usr/bin/env python3
"""Tries plans on virtual experiments and writes the generated table of the documentation.

usage: tools/plan_table.py BUILD DOCS [SEEDS [WORK]]

For every case below: `manoscope plan` places the levels, BUILD/coverage_campaign makes, measures and
judges SEEDS experiments (default 20) with them and as many with the same number of log-spaced levels.
What was forecast and what came out goes into DOCS/planning.md, between its markers. The experiments'
rows are kept in WORK (default: a folder that is removed), and those that stand there are not made
again.
"""

import collections
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

BEGIN, END = "<!-- begin generated -->", "<!-- end generated -->"
# Scenario, number of maps, what is made small.
CASES = (("S1", 16, "rms"), ("S4", 12, "worst"))
STRETCH = "inside"  # of the campaign: 1.6 to 13.9 mm, a plan's test section


def with_levels(scenario, levels):
    """A scenario's text with other levels."""
    values = [f'"{level["pressure_Pa"]:.10g} Pa"' for level in levels
              for _ in range(level["repeats"])]
    text, n = re.subn(r"levels = \[[^\]]*\]", f"levels = [{', '.join(values)}]", scenario)
    if n != 1:
        raise ValueError("the scenario has no list of levels")
    return text


def observed(rows, base, stretch, column):
    """Root mean square over the experiments of a base, by run."""
    squares = collections.defaultdict(list)
    for row in rows:
        if row["base"] == base and row["stretch"] == stretch:
            squares[row["run"]].append(float(row[column]) ** 2)
    return {run: math.sqrt(sum(values) / len(values)) for run, values in squares.items()}


def read_rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return [row for row in csv.DictReader(file) if row["run"] != "done" and row["stretch"]]


def together(values):
    values = list(values)
    return math.sqrt(sum(value ** 2 for value in values) / len(values))


def rows_of_case(plan, rows, bases):
    """Lines of the table: every run, and all of them together."""
    planned, log = plan["planned"], plan["others"][0]
    lines, columns = [], collections.defaultdict(list)
    found = {base: observed(rows, base, STRETCH, "rms_Pa") for base in bases}
    drops = {base: observed(rows, base, "drop", "rms_Pa") for base in bases}
    for mine, other in zip(planned["runs"], log["runs"]):
        run = mine["run"]
        values = [mine["rms_Pa"], mine["rms_error_Pa"], found[bases[0]][run],
                  other["rms_Pa"], other["rms_error_Pa"], found[bases[1]][run],
                  mine["drop_uncertainty_Pa"], drops[bases[0]][run],
                  other["drop_uncertainty_Pa"], drops[bases[1]][run]]
        for i, value in enumerate(values):
            columns[i].append(value)
        lines.append([run, *values])
    lines.append(["all", *(together(columns[i]) for i in sorted(columns))])
    return lines


def words_of(levels):
    return ", ".join(f"{level['pressure_Pa']:.10g}"
                     + (f" (x{level['repeats']})" if level["repeats"] > 1 else "")
                     for level in levels)


def table_of_case(name, plan, seeds, lines):
    planned, log = plan["planned"], plan["others"][0]
    text = [f"### {name}: {planned['maps']} maps, {plan['minimised']} made small, {seeds} experiments "
            "each", "",
            f"Planned, Pa: {words_of(planned['levels'])}. Beside it as many {log['name']}.", "",
            "| run | planned: u, error forecast | found | log-spaced: u, error forecast | found "
            "| drop, planned: u forecast | found | drop, log-spaced: u forecast | found |",
            "|---|---|---|---|---|---|---|---|---|"]
    for run, *v in lines:
        text.append(f"| {run} | {v[0]:.1f}, {v[1]:.1f} | {v[2]:.1f} | {v[3]:.1f}, {v[4]:.1f} "
                    f"| {v[5]:.1f} | {v[6]:.1f} | {v[7]:.1f} | {v[8]:.1f} | {v[9]:.1f} |")
    return text + [""]


def try_case(build, work, case, seeds):
    name, n_maps, aim = case
    planned = work / f"{name}-planned.toml"
    plan_file = work / f"{name}-plan.json"
    if not plan_file.exists():
        plan_file.write_text(subprocess.run(
            [build / "manoscope", "plan", name, "--levels", str(n_maps), "--minimise", aim, "-o",
             planned, "--overwrite", "--json"], check=True, text=True,
            stdout=subprocess.PIPE).stdout, encoding="utf-8")
    plan = json.loads(plan_file.read_text(encoding="utf-8"))
    log = work / f"{name}-log.toml"
    log.write_text(with_levels(planned.read_text(encoding="utf-8"), plan["others"][0]["levels"]),
                   encoding="utf-8")
    bases = [planned.name, log.name]
    subprocess.run([build / "coverage_campaign", "--bases", ",".join(bases), "--walls", "1",
                    "--seeds", str(seeds), "-o", work / "rows.csv", "--scratch", work / "scratch"],
                   check=True, cwd=work)
    lines = rows_of_case(plan, read_rows(work / "rows.csv"), bases)
    return table_of_case(name, plan, seeds, lines)


def put_between_markers(page, lines):
    text = page.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    page.write_text(before + BEGIN + "\n\n" + "\n".join(lines) + "\n" + END + after,
                    encoding="utf-8")


def main(arguments):
    build, docs = (pathlib.Path(word).resolve() for word in arguments[:2])
    seeds = int(arguments[2]) if len(arguments) > 2 else 20
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(arguments[3] if len(arguments) > 3 else folder).resolve()
        work.mkdir(parents=True, exist_ok=True)
        lines = [line for case in CASES for line in try_case(build, work, case, seeds)]
    put_between_markers(docs / "planning.md", lines)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1:])
