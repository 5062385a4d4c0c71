#!/usr/bin/env python3
"""Holds what a measurement reaches against what it was to reach, in one Markdown table.

usage: tools/goals_table.py CAMPAIGN.csv BENCH.json TESTS.json... [--page PAGE]

CAMPAIGN.csv is what coverage_campaign writes, BENCH.json what bench/compare.py --json does, and
each TESTS.json what a test program does with --gtest_output=json:TESTS.json. With --page the table
replaces what stands between the markers of that page.
"""

import argparse
import json
import math
import pathlib
import statistics
import sys

import coverage_table

BEGIN, END = "<!-- begin goals -->", "<!-- end goals -->"
BARS, WIDTH, FINE_GAUGE = (0.93, 0.97), (0.95, 1.05), 1.0
BUCKLED = "S1b"


def read_tests(paths):
    """Every test that ran: its name, whether it passed, and the figures it recorded."""
    found = {}
    for path in paths:
        document = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
        for suite in document["testsuites"]:
            for test in suite["testsuite"]:
                if test.get("result") != "COMPLETED":  # skipped
                    continue
                figures = {"sample": test.get("sample", "")}
                for key, value in test.items():
                    try:
                        figures[key] = float(value)
                    except (TypeError, ValueError):
                        continue
                found[f"{suite['name']}.{test['name']}"] = ("failures" not in test, figures)
    return found


def share_of(row, floor, part):
    return float(row["rms_Pa"]) / max(floor, part * float(row["drop_Pa"]))


def medians(rows, goal):
    """Median share of the goal, sample by sample."""
    bases = sorted({row["base"] for row in rows})
    return {base: statistics.median(goal(row) for row in rows if row["base"] == base)
            for base in bases}


def told(by_base):
    return ", ".join(f"{base} {value:.2f}" for base, value in by_base.items())


def campaign_lines(rows):
    clamped = [row for row in rows if row["base"] != BUCKLED]
    inside = [row for row in clamped if row["stretch"] == "inside"]
    ends = [row for row in clamped if row["stretch"] in ("inlet", "outlet")]
    coarse = [row for row in inside if float(row["label_noise_Pa"]) > FINE_GAUGE]
    fine = [row for row in inside if float(row["label_noise_Pa"]) <= FINE_GAUGE]
    lines = []
    kinds = (("labels of 3 to 20 Pa: 5 Pa or 0.05 % of the drop", coarse, (5.0, 5e-4)),
             ("labels of 1 Pa: 2 Pa or 0.02 %", fine, (2.0, 2e-4)))
    for name, chosen, goal in kinds:
        if not chosen:
            continue
        by_base = medians(chosen, lambda row, goal=goal: share_of(row, *goal))
        lines.append(("rms of p(x), 1.6 to 13.9 mm, median over a sample's runs, over its goal; "
                      + name, "at most 1", told(by_base), max(by_base.values()) <= 1.0))
    worst = max(share_of(row, 9.0, 1e-3) for row in inside)
    lines.append(("the same, the worst run, over 9 Pa or 0.1 %", "at most 1", f"{worst:.2f}",
                  worst <= 1.0))
    by_base = medians(ends, lambda row: share_of(row, 10.0, 2e-3))
    largest = max(share_of(row, 10.0, 2e-3) for row in ends)
    lines.append(("rms at 0.3 to 1.6 and 13.9 to 15.2 mm over 10 Pa or 0.2 %: median over a "
                  "sample's runs (the worst run)", "at most 1", f"{told(by_base)} ({largest:.2f})",
                  max(by_base.values()) <= 1.0))
    for stretch, name in (("whole", "p(x), the whole channel"), ("drop", "dp_e")):
        s = coverage_table.summary([row for row in rows if row["stretch"] == stretch])
        share, error = 100 * s["coverage_95"], 100 * s["coverage_95_error"]
        lines.append((f"share within the 95 % interval, {name}, {s['experiments']} experiments",
                      "93 to 97 %", f"{share:.1f} ± {error:.1f} %",
                      BARS[0] <= s["coverage_95"] <= BARS[1]))
        lines.append((f"pull width, {name}", "0.95 to 1.05",
                      f"{s['pull_rms']:.2f} ± {s['pull_rms_error']:.2f}",
                      WIDTH[0] <= s["pull_rms"] <= WIDTH[1]))
        if s["within_band"] is not None:
            lines.append(("whole curves within the simultaneous 95 % band", "offered",
                          f"{100 * s['within_band']:.0f} %", True))
    return lines


def test_lines(tests):
    lines = []
    ratios = {figures["sample"]: figures["pixel_part_over_limit_inside"]
              for _, figures in tests.values() if "pixel_part_over_limit_inside" in figures}
    if ratios:
        lines.append(("pixels' part of the variance over the limit of Cramer and Rao, inside, "
                      "highest flow rate", "at most 1.15",
                      told(dict(sorted(ratios.items()))),
                      max(ratios.values()) <= 1.15))
    membranes = [figures for _, figures in tests.values() if "rms_hPa" in figures]
    if membranes:
        lines.append(("real membranes, one pressure left out, rms in hPa",
                      " / ".join(f"{f['reference_hPa']:.1f}" for f in membranes),
                      " / ".join(f"{f['rms_hPa']:.2f}" for f in membranes) + ", in 95 % bars "
                      + " / ".join(f"{100 * f['covered']:.0f} %" for f in membranes),
                      all(f["rms_hPa"] <= f["reference_hPa"] for f in membranes)))
    nist = [value for name, (_, figures) in tests.items() if name.startswith("AllProblems/NistStrd")
            for key, value in figures.items() if key.startswith("parameter_digits")]
    if nist:
        reached = sum(value >= 6.0 for value in nist)
        lines.append(("NIST StRD, nonlinear regression: fits with at least 6 digits", "54 of 54",
                      f"{reached} of {len(nist)}", reached == 54))
    printed = [passed for name, (passed, _) in tests.items()
               if "OfGumH" in name or "OfJcgm101" in name]
    if printed:
        lines.append(("GUM H.1 to H.3 and the examples of JCGM 101: printed digits", "all",
                      f"{sum(printed)} of {len(printed)} examples", all(printed)))
    return lines


def bench_lines(bench):
    reading = bench["reading"]
    ms = 1e3 * reading["manoscope"]["cpu_s"]
    return [("reading one run of 1024 x 192 with its covariance, station by station, one core",
             "at most 20 ms", f"{ms:.1f} ms", ms <= 20.0),
            ("the same against scipy", "10 times as fast", f"{reading['ratio_cpu']:.1f} times",
             reading["ratio_cpu"] >= 10.0)]


def table(lines):
    text = ["| what | goal | measured | |", "|---|---|---|---|"]
    for what, goal, measured, reached in lines:
        text.append(f"| {what} | {goal} | {measured} | {'reached' if reached else 'missed'} |")
    return "\n".join(text)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("campaign")
    parser.add_argument("bench")
    parser.add_argument("tests", nargs="+")
    parser.add_argument("--page", type=pathlib.Path)
    given = parser.parse_args(arguments)
    bench = json.loads(pathlib.Path(given.bench).read_text(encoding="utf-8"))
    text = table(campaign_lines(coverage_table.read_rows(given.campaign))
                 + test_lines(read_tests(given.tests)) + bench_lines(bench))
    print(text)
    if given.page:
        page = given.page.read_text(encoding="utf-8")
        start, end = page.index(BEGIN) + len(BEGIN), page.index(END)
        given.page.write_text(f"{page[:start]}\n\n{text}\n\n{page[end:]}", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
