#!/usr/bin/env python3
"""Sums up a campaign on the flow: are verdicts right, how far off are flow rate and drop.

usage: tools/verdict_table.py CAMPAIGN.csv [--json | --page PAGE]

CAMPAIGN.csv is what verdict_campaign writes: one row a run of a virtual experiment that obeys
section-march, held against the model that its runs chose. Prints three Markdown tables, a row for each sample, for each class of
Re h/l and for all: how often the verdict is a false alarm, by the drop (E_n > 1) and along x (p value
below 0.01), and how often a gap 3 % too large is caught by either; how far off the flow rate is that
the deflection tells; and the same of the drop predicted from calibration and flow rate. The runs of
an experiment share their errors: the figure behind a ± is the standard error over experiments. With
--page the tables replace what stands between the markers of that page.
"""

import argparse
import json
import math
import pathlib
import statistics

import coverage_table

BEGIN, END = "<!-- begin verdicts -->", "<!-- end verdicts -->"
ALONG_TAIL = 0.01  # CompareModelsOptions::along_tail
TRUE_MODEL = "section-march"
EXPANSION_95 = 1.959964
CLOSE = 0.02
CLASSES = ((1.0, "Re h/l below 1"), (3.0, "Re h/l 1 to 3"), (math.inf, "Re h/l above 3"))


def number(row, column):
    return float(row[column]) if row[column] else None


def alarms(row, prefix):
    """Whether the drop differs, p(x) along x differs, either; None without a verdict."""
    en_number, tail = number(row, prefix + "en_number"), number(row, prefix + "p_value")
    if en_number is None:
        return None
    by_drop, along = en_number > 1.0, tail is not None and tail < ALONG_TAIL
    return float(by_drop), float(along), float(by_drop or along)


def read_rows(path):
    """Rows with their verdicts as 0 or 1, and their class."""
    rows = coverage_table.read_runs(path)
    for row in rows:
        false, caught = alarms(row, ""), alarms(row, "wrong_")
        if false:
            row["false_drop"], row["false_along"], row["false"] = false
        if caught:
            row["caught"] = caught[2]
        reduced = number(row, "reduced_reynolds")
        row["class"] = None if reduced is None else next(
            name for limit, name in CLASSES if reduced < limit)
    return rows


def share(rows, column):
    told = [row for row in rows if column in row]
    if not told:
        return math.nan, math.nan
    return coverage_table.mean_and_error(told, column)[:2]


def errors(rows, what):
    """Of a number with its bar: relative rms, shares within 2 % and within 95 % bars, pulls."""
    told = [dict(row, error=number(row, what + "_error"), pull=number(row, what + "_pull"))
            for row in rows]
    told = [row for row in told if row["error"] is not None]
    if not told:
        return {"runs": 0, "silent": len(rows)}
    for row in told:
        row["close"] = float(abs(row["error"]) <= CLOSE)
        row["covered"] = float(abs(row["pull"]) <= EXPANSION_95)
    square, square_error, n = coverage_table.mean_and_error(told, "pull", square=True)
    width = math.sqrt(square)
    covered, covered_error, _ = coverage_table.mean_and_error(told, "covered")
    return {"experiments": n, "runs": len(told), "silent": len(rows) - len(told),
            "rms": math.sqrt(coverage_table.mean_and_error(told, "error", square=True)[0]),
            "within_2_percent": coverage_table.mean_and_error(told, "close")[0],
            "coverage_95": covered, "coverage_95_error": covered_error, "pull_rms": width,
            "pull_rms_error": 0.5 * square_error / width if width > 0 else math.nan}


def summary(rows):
    false, false_error = share(rows, "false")
    caught, caught_error = share(rows, "caught")
    wrong = [number(row, "wrong_en_number") for row in rows if row["wrong_en_number"]]
    return {"experiments": len({(row["base"], row["wall"], row["seed"]) for row in rows}),
            "chosen": statistics.fmean(row["model"] == TRUE_MODEL for row in rows),
            "wrong_chosen": statistics.fmean(row["wrong_model"] == TRUE_MODEL for row in rows),
            "runs": len(rows), "no_verdict": sum("false" not in row for row in rows),
            "false_drop": share(rows, "false_drop")[0], "false_along": share(rows, "false_along")[0],
            "false": false, "false_error": false_error, "caught": caught,
            "caught_error": caught_error,
            "wrong_en_median": statistics.median(wrong) if wrong else math.nan,
            "wrong_en_least": min(wrong) if wrong else math.nan,
            "flow_rate": errors(rows, "inferred"), "drop": errors(rows, "predicted")}


def groups(rows):
    named = [(base, [row for row in rows if row["base"] == base])
             for base in sorted({row["base"] for row in rows})]
    named += [(name, [row for row in rows if row["class"] == name]) for _, name in CLASSES]
    return [(name, chosen) for name, chosen in named if chosen] + [("all", rows)]


def percent(value, error):
    """A share with its standard error, which there is none of where all rows say the same."""
    return f"{100 * value:.1f}" + (f" ± {100 * error:.1f}" if error > 0 else "")


def verdict_lines(named):
    lines = ["| | experiments | runs (no verdict) | drop called different, % | p(x) along x called "
             "different, % | false alarms by either, % | gap 3 % too large caught, % "
             "| its E_n: median | least |", "|---|---|---|---|---|---|---|---|---|"]
    for name, s in named:
        lines.append(
            f"| {name} | {s['experiments']} | {s['runs']} ({s['no_verdict']}) "
            f"| {100 * s['false_drop']:.1f} | {100 * s['false_along']:.1f} "
            f"| {percent(s['false'], s['false_error'])} "
            f"| {percent(s['caught'], s['caught_error'])} "
            f"| {s['wrong_en_median']:.1f} | {s['wrong_en_least']:.1f} "
            f"| {100 * s['chosen']:.0f} ({100 * s['wrong_chosen']:.0f}) |")
    return lines


def error_lines(named, what, title):
    lines = [f"| {title} | runs (not told) | rms error, % | within 2 %, % of runs "
             "| in 95 % bars, % | pull rms |", "|---|---|---|---|---|---|"]
    for name, s in named:
        e = s[what]
        if e["runs"] == 0:
            lines.append(f"| {name} | 0 ({e['silent']}) | | | | |")
            continue
        lines.append(
            f"| {name} | {e['runs']} ({e['silent']}) | {100 * e['rms']:.2f} "
            f"| {100 * e['within_2_percent']:.1f} "
            f"| {percent(e['coverage_95'], e['coverage_95_error'])} "
            f"| {e['pull_rms']:.2f} ± {e['pull_rms_error']:.2f} |")
    return lines


def tables(rows):
    named = [(name, summary(chosen)) for name, chosen in groups(rows)]
    walls = len({(row["base"], row["wall"]) for row in rows})
    return "\n\n".join(
        [f"Of {named[-1][1]['experiments']} experiments with {walls} walls:",
         "\n".join(verdict_lines(named)),
         "\n".join(error_lines(named, "flow_rate", "flow rate from the deflection alone")),
         "\n".join(error_lines(named, "drop", "drop predicted from calibration and flow rate"))])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("campaign")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--page", type=pathlib.Path)
    arguments = parser.parse_args()
    rows = read_rows(arguments.campaign)
    if arguments.json:
        print(json.dumps({name: summary(chosen) for name, chosen in groups(rows)}))
        return
    text = tables(rows)
    print(text)
    if arguments.page:
        coverage_table.put_between_markers(arguments.page, text, BEGIN, END)


if __name__ == "__main__":
    main()
