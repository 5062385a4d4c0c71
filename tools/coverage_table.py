#!/usr/bin/env python3
"""Sums up a campaign of virtual experiments: do the error bars hold, how far are readings off.

usage: tools/coverage_table.py CAMPAIGN.csv [--by COLUMN] [--json | --page PAGE]

CAMPAIGN.csv is what coverage_campaign writes: one row a run and stretch of the channel. Prints a
Markdown table for each stretch, a row for each value of COLUMN (base: the sample) and one for all:
the share of stations within their 95 % and 68 % bars, mean and rms of the pulls, and median, 95th
percentile and worst of the runs' rms errors, as a share of the goal max(floor, share of the drop).
The stations of a run share their errors, as the runs of an experiment do: the figure behind a ± is
the standard error over experiments. With --page the tables replace what stands between the markers
of that page.
"""

import argparse
import csv
import json
import math
import pathlib
import statistics
import sys

BEGIN, END = "<!-- begin generated -->", "<!-- end generated -->"
STRETCHES = {"inside": "1.6 to 13.9 mm", "inlet": "0.3 to 1.6 mm", "outlet": "13.9 to 15.2 mm",
             "whole": "the whole channel", "drop": "dp_e over the test section"}
# Pa, share of the drop: what the rms error of the median run should keep to.
GOALS = {"inside": (5.0, 0.0005), "inlet": (10.0, 0.002), "outlet": (10.0, 0.002),
         "whole": (10.0, 0.002), "drop": (5.0, 0.0005)}
FINE_GAUGE, FINE_GOAL = 1.0, (2.0, 0.0002)


def read_runs(path):
    """Rows of a campaign without those that mark an experiment as done."""
    with open(path, newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["run"] != "done"]
    if not rows:
        sys.exit(f"{path}: holds no run: the campaign has just begun")
    return rows


def read_rows(path):
    return [row for row in read_runs(path) if int(row["n_answered"]) > 0]


def goal(row):
    fine = row["stretch"] == "inside" and float(row["label_noise_Pa"]) <= FINE_GAUGE
    floor, share = FINE_GOAL if fine else GOALS[row["stretch"]]
    return max(floor, share * float(row["drop_Pa"]))


def mean_and_error(rows, column, square=False):
    """Mean over runs, and its standard error from the scatter between experiments."""
    groups = {}
    for row in rows:
        value = float(row[column])
        groups.setdefault((row["base"], row["wall"], row["seed"]), []).append(
            value * value if square else value)
    means = [statistics.fmean(values) for values in groups.values()]
    mean = statistics.fmean(means)
    error = statistics.stdev(means) / math.sqrt(len(means)) if len(means) > 1 else math.nan
    return mean, error, len(means)


def quantile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def band_share(rows):
    """Share of the runs whose simultaneous band holds the whole of p(x); None where not told."""
    told = [row for row in rows if row.get("within_band")]
    return mean_and_error(told, "within_band")[0] if told else None


def summary(rows):
    coverage, error, n = mean_and_error(rows, "coverage_95")
    square, square_error, _ = mean_and_error(rows, "pull_rms", square=True)
    width = math.sqrt(square)
    shares = [float(row["rms_Pa"]) / goal(row) for row in rows]
    return {"experiments": n, "runs": len(rows), "coverage_95": coverage, "coverage_95_error": error,
            "coverage_68": mean_and_error(rows, "coverage_68")[0],
            "pull_mean": mean_and_error(rows, "pull_mean")[0], "pull_rms": width,
            "pull_rms_error": 0.5 * square_error / width if width > 0 else math.nan,
            "median_rms_Pa": statistics.median(float(row["rms_Pa"]) for row in rows),
            "median_of_goal": statistics.median(shares), "p95_of_goal": quantile(shares, 0.95),
            "worst_of_goal": max(shares),
            "within_band": band_share(rows)}


def table(rows, by):
    lines = [f"| {by} | experiments | runs | in 95 % bars, % | in 68 % bars, % | pull mean "
             "| pull rms | rms error, median, Pa | over goal: median | 95 % of runs | worst |",
             "|---|---|---|---|---|---|---|---|---|---|---|"]
    values = sorted({row[by] for row in rows}, key=lambda v: (len(v), v))
    for value, chosen in [(v, [r for r in rows if r[by] == v]) for v in values] + [("all", rows)]:
        s = summary(chosen)
        lines.append(
            f"| {value} | {s['experiments']} | {s['runs']} "
            f"| {100 * s['coverage_95']:.1f} ± {100 * s['coverage_95_error']:.1f} "
            f"| {100 * s['coverage_68']:.0f} | {s['pull_mean']:+.2f} "
            f"| {s['pull_rms']:.2f} ± {s['pull_rms_error']:.2f} | {s['median_rms_Pa']:.1f} "
            f"| {s['median_of_goal']:.2f} | {s['p95_of_goal']:.2f} | {s['worst_of_goal']:.2f} |"
            + ("" if s["within_band"] is None else f" {100 * s['within_band']:.0f} |"))
    if summary(rows)["within_band"] is not None:
        lines[0] += " in the simultaneous band, % |"
        lines[1] += "---|"
    return "\n".join(lines)


def budget_table(rows, by):
    """Standard uncertainty by source, Pa: root of the mean variance over runs."""
    variances = {}
    for row in rows:
        for item in filter(None, row["budget"].split(";")):
            source, variance = item.rsplit("=", 1)
            for value in (row[by], "all"):
                variances.setdefault(source, {}).setdefault(value, []).append(float(variance))
    values = sorted({row[by] for row in rows}, key=lambda v: (len(v), v)) + ["all"]
    count = {v: sum(1 for row in rows if v in (row[by], "all")) for v in values}
    lines = ["| bars made of, Pa | " + " | ".join(values) + " |", "|---" * (len(values) + 1) + "|"]
    total = {v: 0.0 for v in values}
    for source, of_value in variances.items():
        cells = []
        for v in values:
            mean = sum(of_value.get(v, [])) / (len(rows) if v == "all" else count[v])
            total[v] += mean
            cells.append(f"{math.sqrt(mean):.1f}")
        lines.append(f"| {source} | " + " | ".join(cells) + " |")
    lines.append("| all | " + " | ".join(f"{math.sqrt(total[v]):.1f}" for v in values) + " |")
    return "\n".join(lines)


def pages(stretches, by):
    text = []
    for name, some in stretches.items():
        if not some:
            continue
        text += [f"#### {STRETCHES[name][0].upper()}{STRETCHES[name][1:]}", table(some, by)]
        if any(row.get("budget") for row in some):
            text.append(budget_table(some, by))
    return "\n\n".join(text)


def put_between_markers(page, text, begin=BEGIN, end=END):
    whole = page.read_text()
    if begin not in whole or end not in whole:
        sys.exit(f"{page}: lacks the lines {begin} and {end}")
    before, rest = whole.split(begin, 1)
    page.write_text(f"{before}{begin}\n\n{text}\n\n{end}{rest.split(end, 1)[1]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("campaign")
    parser.add_argument("--by", default="base")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--page", type=pathlib.Path)
    arguments = parser.parse_args()
    rows = read_rows(arguments.campaign)
    if arguments.by not in rows[0]:
        sys.exit(f"--by: {arguments.campaign} has no column {arguments.by}; "
                 f"it has {', '.join(rows[0])}")
    stretches = {name: [row for row in rows if row["stretch"] == name] for name in STRETCHES}
    if arguments.json:
        print(json.dumps({name: summary(some) for name, some in stretches.items() if some}))
        return
    text = pages(stretches, arguments.by)
    print(text)
    if arguments.page:
        put_between_markers(arguments.page, text)


if __name__ == "__main__":
    main()
