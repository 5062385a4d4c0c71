#!/usr/bin/env python3
"""What a plane simulation misses of a reading: figure and table of docs/side-walls.md.

usage: tools/side_walls.py PROGRAM EXPERIMENT DOCS [RUN...]     (default: Q5 Q70)

Simulates the runs below their measured walls between plates and in three dimensions, and splits the
difference of the reading and a plane simulation that ends at p = 0 into three parts: the pressure at
the outlet, the side walls, and what is left. Writes DOCS/images/side_walls.svg and the table between
the markers of DOCS/side-walls.md. Needs gnuplot and the Navier-Stokes solver; minutes.
"""

import bisect
import json
import pathlib
import subprocess
import sys

BEGIN, END = "<!-- begin generated -->", "<!-- end generated -->"
PLACES = (0.1, 0.25, 0.5, 0.75)  # of the test section


def simulated(program, experiment, runs, dim):
    words = [program, "simulate", experiment, "--dim", str(dim), "--json"]
    for run in runs:
        words += ["--run", run]
    done = subprocess.run(words, stdout=subprocess.PIPE, text=True, check=True)
    answer = json.loads(done.stdout)
    return {one["run"]: one for one in (answer if isinstance(answer, list) else [answer])}


def at(flow, name, x):
    """Value of a profile at x by linear interpolation; None where a neighbour is missing."""
    places, values = flow["x_m"], flow[name]
    k = min(max(bisect.bisect_right(places, x), 1), len(places) - 1)
    low, high = values[k - 1], values[k]
    if low is None or high is None:
        return None
    share = (x - places[k - 1]) / (places[k] - places[k - 1])
    return low + share * (high - low)


def parts(plane, whole, x):
    """The reading at x, and what the difference to a plane simulation that ends at 0 is made of."""
    read = at(plane, "read_pressure_Pa", x)
    return {
        "read": read,
        "bar": at(plane, "read_pressure_uncertainty_Pa", x),
        "gap": read - (at(plane, "mean_pressure_Pa", x) - plane["outlet_pressure_Pa"]),
        "outlet": plane["outlet_pressure_Pa"],
        "walls": at(whole, "mean_pressure_Pa", x) - at(plane, "mean_pressure_Pa", x),
        "left": read - at(whole, "mean_pressure_Pa", x),
        "doubt": at(whole, "mean_pressure_uncertainty_Pa", x),
    }


def places_of(plane):
    start, end = plane["test_section_m"]
    return [start + share * (end - start) for share in PLACES]


def table(planes, wholes):
    lines = ["| run | x | p read ± U | less a plane flow that ends at 0 | outlet | side walls | left "
             "± U |", "|---|---|---|---|---|---|---|"]
    for run, plane in planes.items():
        for x in places_of(plane):
            p = parts(plane, wholes[run], x)
            doubt = 2.0 * (p["bar"] ** 2 + p["doubt"] ** 2) ** 0.5
            lines.append(f"| {run} | {x * 1e3:.1f} mm | {p['read']:.0f} ± {2 * p['bar']:.0f} | "
                         f"{p['gap']:+.0f} | {p['outlet']:+.0f} | {p['walls']:+.0f} | "
                         f"{p['left']:+.0f} ± {doubt:.0f} |")
    return "\n".join(lines)


def script_of(planes, wholes):
    """The gnuplot script: data inside, SVG on standard output."""
    lines = ["set terminal svg size 860,380 font 'sans-serif,13' background 'white'",
             f"set multiplot layout 1,{len(planes)}", "set xlabel 'x [mm]'", "set key bottom left Left reverse samplen 1 font ',11'",
             "set grid lc rgb '#dddddd'", "set xrange [0:*]", "set yrange [0:*]"]
    for number, (run, plane) in enumerate(planes.items()):
        whole = wholes[run]
        rows = [f"$run{number} << END"]
        for i, x in enumerate(plane["x_m"]):
            read = plane["read_pressure_Pa"][i]
            shown = [x * 1e3, "NaN" if read is None else read / 1e3,
                     (plane["mean_pressure_Pa"][i] - plane["outlet_pressure_Pa"]) / 1e3,
                     plane["mean_pressure_Pa"][i] / 1e3, whole["mean_pressure_Pa"][i] / 1e3]
            rows.append(" ".join(str(value) for value in shown))
        lines += rows + ["END", f"set title '{run}'", "set ylabel 'p [kPa]'"]
        every = max(1, len(plane["x_m"]) // 20)
        lines.append(
            f"plot $run{number} u 1:3 every {every} w p pt 1 lc rgb '#999999' "
            "t 'between plates, p = 0 at the end', "
            f"'' u 1:4 every {every} w p pt 1 lc rgb '#d55e00' t 'between plates', "
            f"'' u 1:5 every {every} w p pt 2 lc rgb '#009e73' t 'three dimensions', "
            "'' u 1:2 w l lw 2 lc rgb '#0072b2' t 'read off the wall'")
    return "\n".join(lines) + "\nunset multiplot\n"


def main(program, experiment, docs, *runs):
    docs = pathlib.Path(docs)
    runs = runs or ("Q5", "Q70")
    planes, wholes = (simulated(program, experiment, runs, dim) for dim in (2, 3))
    drawn = subprocess.run(["gnuplot"], input=script_of(planes, wholes), text=True,
                           capture_output=True, check=True)
    (docs / "images" / "side_walls.svg").write_text(drawn.stdout, encoding="utf-8")
    page = docs / "side-walls.md"
    text = page.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    page.write_text(f"{before}{BEGIN}\n{table(planes, wholes)}\n{END}{rest.split(END)[1]}",
                    encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
