#!/usr/bin/env python3
"""Draws how far each flow model is from the march on sections, and tabulates it.

usage: tools/model_error_figure.py ERRORS.csv DOCS

ERRORS.csv is what the program model_errors writes. The figure goes to DOCS/images/flow_models.svg, the
table of the lowest and the highest flow rate of each sample into DOCS/flow-models.md, between its
markers. Needs gnuplot.
"""

import csv
import pathlib
import subprocess
import sys

BEGIN, END = "<!-- begin model errors -->", "<!-- end model errors -->"
# Model, its colour (Okabe and Ito: told apart by colour-blind eyes), what the key says.
MODELS = (("paper", "#D55E00", "eq. (4)"), ("creeping", "#E69F00", "creeping, true section"),
          ("momentum", "#0072B2", "momentum"), ("energy", "#56B4E9", "energy"),
          ("plane-march", "#009E73", "plane march"),
          ("uniform inlet", "#000000", "section march, uniform inlet"))
POINTS = {"S1": 7, "S2": 9, "S3": 5, "S4": 13, "S5": 11}


def read_rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def numbers_of(rows, sample, model):
    """(Re h/l, error in %) of one curve, ascending."""
    return sorted((float(row["reduced_reynolds"]), float(row["largest_error_percent"]))
                  for row in rows if row["sample"] == sample and row["model"] == model)


def script_of(rows):
    """The gnuplot script: data inside, SVG on standard output."""
    lines, plots = [], []
    for model, colour, key in MODELS:
        for sample, point in POINTS.items():
            numbers = numbers_of(rows, sample, model)
            if not numbers:
                continue
            name = f"${model.replace(' ', '_').replace('-', '_')}_{sample}"
            lines += [f"{name} << EOD", *(f"{x:.6g} {y:.6g}" for x, y in numbers), "EOD"]
            plots.append(f"{name} using 1:2 with linespoints lc rgb '{colour}' lw 1.3 pt {point} "
                         "ps 0.6 notitle")
        plots.append(f"NaN with lines lc rgb '{colour}' lw 3 title '{key}'")
    plots += [f"NaN with points lc rgb '#666666' pt {point} ps 0.8 title '{sample}'"
              for sample, point in POINTS.items()]
    return "\n".join([
        "set terminal svg size 900,520 font 'sans-serif,14' enhanced background '#ffffff'",
        "set logscale xy", "set format y '%g'", "set format x '%g'", "set grid lc rgb '#dddddd'",
        "set xlabel 'Re h/l'", "set ylabel 'largest error of p along x, % of the drop'",
        "set key outside right Left reverse", "set xrange [0.3:12]", "set yrange [0.01:60]", *lines,
        "plot " + ", \\\n  ".join(plots), ""])


def table_of(rows):
    """One row a sample and flow rate, the lowest and the highest of each."""
    names = [model for model, _, _ in MODELS]
    lines = ["| sample | Q, mL/min | Re h/l | " + " | ".join(key for _, _, key in MODELS) + " |",
             "|---|---|---|" + "---|" * len(names)]
    for sample in POINTS:
        flow_rates = sorted({float(row["flow_rate_mL_min"]) for row in rows
                             if row["sample"] == sample})
        for flow_rate in (flow_rates[:1] + flow_rates[-1:] if len(flow_rates) > 1 else flow_rates):
            found = {row["model"]: row for row in rows
                     if row["sample"] == sample and float(row["flow_rate_mL_min"]) == flow_rate}
            reduced = float(next(iter(found.values()))["reduced_reynolds"])
            cells = [f"{float(found[name]['largest_error_percent']):.2g} "
                     f"({float(found[name]['section_drop_percent']):+.1f})"
                     if name in found else "-" for name in names]
            lines.append(f"| {sample} | {flow_rate:g} | {reduced:.2g} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def beyond_stated(rows):
    """The rows whose error is larger than the error that the model states of itself."""
    return [row for row in rows
            if row["stated_percent"]
            and float(row["largest_error_percent"]) > float(row["stated_percent"])]


def replaced(page, table):
    """The page with another table between its markers."""
    before, rest = page.split(BEGIN)
    after = rest.split(END)[1]
    return f"{before}{BEGIN}\n\n{table}\n\n{END}{after}"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    rows, docs = read_rows(sys.argv[1]), pathlib.Path(sys.argv[2])
    for row in beyond_stated(rows):
        print("{sample} at {flow_rate_mL_min} mL/min: {model} is off by {largest_error_percent} %, "
              "and states {stated_percent} %".format(**row), file=sys.stderr)
    drawn = subprocess.run(["gnuplot"], input=script_of(rows), text=True, capture_output=True,
                           check=True)
    (docs / "images" / "flow_models.svg").write_text(drawn.stdout, encoding="utf-8")
    page = docs / "flow-models.md"
    page.write_text(replaced(page.read_text(encoding="utf-8"), table_of(rows)), encoding="utf-8")
    if beyond_stated(rows):
        sys.exit(1)


if __name__ == "__main__":
    main()
