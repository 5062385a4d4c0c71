#!/usr/bin/env python3
"""Times manoscope against the same work in numpy, in one run, and prints the tables of README.md.

Two workers, one thread each, reduce the same maps in turn, so that both meet the same machine; their
results must agree, or nothing is printed and the exit code is 1.
"""
import argparse
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
# Both sides do the same sums in another order, on heights of up to 25 um.
ZETA_TOLERANCE_M = 1e-14
UNCERTAINTY_TOLERANCE = 1e-6  # relative
PLACE_TOLERANCE_M = 1e-12  # of where a wall lies, along and across the flow
# What the ratios ought to be; a miss is told and is no failure, for speed is no test.
GOAL_NUMPY_REDUCTION, GOAL_NUMPY_ONE_PASS = 5.0, 10.0
GOAL_OVER_READ, GOAL_TWO_THREADS = 1.5, 1.7
GOAL_SCIPY_READING, GOAL_READING_MS = 10.0, 20.0
GOAL_ANSWER_MS = 10.0  # 99 of 100 answers of the app, 8 connections at once
# scipy's curves have other slopes at their knots than ours: of a standard uncertainty, and of it.
READING_TOLERANCE, READING_UNCERTAINTY_TOLERANCE = 0.5, 0.2
# What the wall and the twin promise, on one core that does nothing else.
LIMITS = {"one wall state of S1": (0.5, "s"),
          "flow marched past 1000 stations": (1.0, "s"), "the whole virtual experiment": (60.0, "s"),
          "its peak memory": (2000.0, "MB")}
ONE_THREAD = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS",
                                     "BLIS_NUM_THREADS", "NUMEXPR_NUM_THREADS")}


class Worker:
    """A program that does one order a line and answers with its seconds and peak memory."""

    def __init__(self, *command):
        self.name = Path(command[-2]).name
        self.process = subprocess.Popen([str(word) for word in command], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True,
                                        env={**os.environ, **ONE_THREAD})

    def order(self, line):
        try:
            self.process.stdin.write(line + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass
        answer = self.process.stdout.readline()
        if not answer:
            sys.exit(f"{self.name} gave no answer to: {line}")
        return json.loads(answer)

    def close(self):
        self.process.stdin.close()
        if self.process.wait() != 0:
            sys.exit(f"{self.name} ended with exit code {self.process.returncode}")


def largest_difference(ours, theirs, key, relative=False):
    largest = 0.0
    for one, other in zip(ours, theirs, strict=True):
        for a, b in zip(one[key], other[key], strict=True):
            difference = abs(a - b) / (abs(b) if relative and b else 1.0)
            largest = difference if math.isnan(difference) else max(largest, difference)
    return largest


def check_agreement(ours, theirs):
    """Largest differences; ends the run if one is beyond round-off."""
    for one, other in zip(ours, theirs, strict=True):
        for key in ("hash", "flags", "moved"):
            if one.get(key) != other.get(key):
                sys.exit(f"the two sides differ in {key}: a benchmark of wrong results is void")
    stations = sum(flag == 0 for one in ours for flag in one["flags"])
    if stations < 0.9 * sum(len(one["flags"]) for one in ours):
        sys.exit("most stations are flagged: a benchmark of empty results is void")
    for one, other in zip(ours, theirs):
        for key in ("shift_m", "middle_m"):
            if abs(one.get(key, 0.0) - other.get(key, 0.0)) > PLACE_TOLERANCE_M:
                sys.exit(f"the two sides differ in {key}: a benchmark of wrong results is void")
    found = {"zeta_m": largest_difference(ours, theirs, "zeta_m"),
             "uncertainty_relative": largest_difference(ours, theirs, "uncertainty_m", True)}
    if not (found["zeta_m"] <= ZETA_TOLERANCE_M and
            found["uncertainty_relative"] <= UNCERTAINTY_TOLERANCE):
        sys.exit(f"the two sides differ: {found}: a benchmark of wrong results is void")
    return found


def time_reduction(programs, n_maps, repetitions, folder):
    subprocess.run([programs / "bench_inputs", "maps", folder, str(n_maps)], check=True)
    inputs = folder / "inputs.json"
    sides = {"manoscope": Worker(programs / "bench_reduction", inputs),
             "numpy": Worker(sys.executable, HERE / "reduction.py", inputs)}
    for worker in sides.values():  # fills the page cache, and whatever each side keeps
        worker.order("reduce")
    answers = {name: [] for name in sides}
    reads = []
    for _ in range(repetitions):
        reads.append(sides["manoscope"].order("read")["wall_s"])
        for name, worker in sides.items():
            answers[name].append(worker.order("reduce"))
    results = []
    for name, worker in sides.items():
        worker.order(f"save {folder / name}.json")
        worker.close()
        results.append(json.loads((folder / f"{name}.json").read_text(encoding="utf-8")))
    table = {"maps": n_maps, "repetitions": repetitions, "read_s": statistics.median(reads),
             "largest_difference": check_agreement(*results)}
    for name, given in answers.items():
        table[name] = {key: statistics.median(answer[key] for answer in given)
                       for key in ("wall_s", "cpu_s")}
        table[name]["peak_MB"] = max(answer["peak_MB"] for answer in given)
    table["ratio"] = table["numpy"]["wall_s"] / table["manoscope"]["wall_s"]
    table["ratio_cpu"] = table["numpy"]["cpu_s"] / table["manoscope"]["cpu_s"]
    return table


def time_linear(programs, size, n_maps, dropouts, repetitions, folder):
    """The one-pass reduction, raw floats and .gsf, against numpy and against reading the bytes."""
    folder.mkdir()
    subprocess.run([programs / "bench_inputs", "frames", folder, str(n_maps), str(size[0]),
                    str(size[1]), str(dropouts)], check=True)
    inputs = folder / "inputs.json"
    ours = Worker(programs / "bench_linear", inputs)
    numpy = Worker(sys.executable, HERE / "linear.py", inputs)
    orders = {"read": (ours, "read {}"), "one": (ours, "reduce {} 1"), "two": (ours, "reduce {} 2"),
              "numpy": (numpy, "reduce {}")}
    table = {"maps": n_maps, "size": size, "dropouts": dropouts, "repetitions": repetitions}
    for kind in ("raw", "gsf"):
        for worker, order in orders.values():  # fills the page cache
            worker.order(order.format(kind))
        answers = {name: [] for name in orders}
        for _ in range(repetitions):
            # Twice as often as numpy, whose share of the time is the larger by far.
            for name in ("read", "one", "two", "read", "one", "two", "numpy"):
                worker, order = orders[name]
                answers[name].append(worker.order(order.format(kind)))
        row = table[kind] = {}
        for name, given in answers.items():
            row[name] = {key: statistics.median(answer[key] for answer in given)
                         for key in ("wall_s", "cpu_s")}
            row[name]["least_s"] = min(answer["wall_s"] for answer in given)
        # Ratios of neighbours in time, which met the same machine.
        row["over_read"] = statistics.median(
            one["cpu_s"] / read["cpu_s"] for one, read in zip(answers["one"], answers["read"]))
        row["numpy_over"] = statistics.median(
            numpy_["cpu_s"] / one["cpu_s"]
            for one, numpy_ in zip(answers["one"][1::2], answers["numpy"]))
        saved = [folder / f"{name}.json" for name in ("one", "two")]
        for name, file in zip(("one", "two"), saved):
            ours.order(orders[name][1].format(kind))
            ours.order(f"save {file}")
        if saved[0].read_bytes() != saved[1].read_bytes():
            sys.exit("one thread and two differ: a benchmark of wrong results is void")
        results = []
        for name, worker in (("ours", ours), ("numpy", numpy)):
            worker.order(f"save {folder / name}.json")
            results.append(json.loads((folder / f"{name}.json").read_text(encoding="utf-8")))
        row["largest_difference"] = check_agreement(*results)
    for name, worker in (("ours_MB", ours), ("numpy_MB", numpy)):
        table[name] = worker.order(f"save {folder / 'last'}.json")["peak_MB"]
        worker.close()
    return table


def time_reading(programs, repetitions, folder):
    """One run's p(x) and its covariance from a finished calibration, against scipy."""
    inputs = folder / "reading.json"
    workers = {"manoscope": Worker(programs / "bench_reading", inputs)}
    workers["manoscope"].order("read")  # its inputs are written by then
    workers["scipy"] = Worker(sys.executable, HERE / "reading.py", inputs)
    workers["scipy"].order("read")
    answers = {name: [] for name in workers}
    for _ in range(repetitions):
        for name, worker in workers.items():
            answers[name].append(worker.order("read"))
    found = []
    for name, worker in workers.items():
        worker.order(f"save {folder / name}-reading.json")
        worker.close()
        found.append(json.loads((folder / f"{name}-reading.json").read_text(encoding="utf-8")))
    table = {name: {"cpu_s": statistics.median(answer["cpu_s"] for answer in given),
                    "peak_MB": max(answer["peak_MB"] for answer in given)}
             for name, given in answers.items()}
    table["ratio_cpu"] = table["scipy"]["cpu_s"] / table["manoscope"]["cpu_s"]
    ours, theirs = found
    table["difference"] = statistics.median(
        abs(a - b) / math.sqrt(v) for a, b, v in
        zip(ours["pressure_Pa"], theirs["pressure_Pa"], ours["variance_Pa2"], strict=True))
    table["uncertainty_difference"] = statistics.median(
        abs(math.sqrt(b / a) - 1.0) for a, b in
        zip(ours["variance_Pa2"], theirs["variance_Pa2"], strict=True))
    if not (table["difference"] <= READING_TOLERANCE and
            table["uncertainty_difference"] <= READING_UNCERTAINTY_TOLERANCE):
        sys.exit(f"the two readings differ: {table}: a benchmark of wrong results is void")
    return table


def run_measured(*command):
    """Runs a program: wall seconds, processor seconds and peak memory of its largest process."""
    start = time.perf_counter()
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE)
    message = process.stderr.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{command[0]} failed with exit code {process.returncode}: {message}")
    return {"wall_s": time.perf_counter() - start, "cpu_s": usage.ru_utime + usage.ru_stime,
            "peak_MB": usage.ru_maxrss / 1024.0}


def time_twin(manoscope, experiment):
    """The shipped S1 at full size, once a number of threads: wall states, coupled flows and maps."""
    table = {}
    for threads in sorted({1, os.cpu_count() or 1}):
        table[f"threads_{threads}"] = run_measured(manoscope, "twin", "S1", "-o", experiment,
                                                   "--overwrite", "--threads", threads)
    table["maps"] = len(list(experiment.glob("*.gsf")))
    return table


def time_stage(programs, name):
    """Processor seconds of one stage, by the benchmark of the stages."""
    done = subprocess.run([programs / "bench_stages", f"--benchmark_filter=^{name}$",
                           "--benchmark_format=json"], check=True, capture_output=True, text=True)
    figure, = json.loads(done.stdout)["benchmarks"]
    return figure["cpu_time"] * {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}[figure["time_unit"]]


def held_against_limits(wall_state_s, section_march_s, twin):
    """Lines that say what was found and allowed, and whether every limit is kept.

    Processor time: on a machine that is shared, wall time tells of the others.
    """
    one = twin["threads_1"]
    lines, kept = [], True
    for (what, (limit, unit)), found in zip(LIMITS.items(),
                                            (wall_state_s, section_march_s, one["cpu_s"],
                                             one["peak_MB"])):
        good = found <= limit
        kept = kept and good
        lines.append(f"{what:32}{found:9.3g} {unit:3} of {limit:g} {unit} allowed"
                     f"{'' if good else ': EXCEEDED'}")
    return lines, kept


def time_measure(manoscope, repetitions, experiment, out):
    table = {"maps": len(list(experiment.glob("*.gsf"))), "repetitions": repetitions}
    for threads in sorted({1, os.cpu_count() or 1}):
        runs = [run_measured(manoscope, "measure", experiment, "-o", out, "--threads", threads)
                for _ in range(repetitions)]
        table[f"threads_{threads}"] = {key: statistics.median(run[key] for run in runs)
                                       for key in ("wall_s", "cpu_s", "peak_MB")}
    judged = subprocess.run([manoscope, "judge", out, experiment / "truth", "--json"], check=True,
                            capture_output=True, text=True)
    table["judged"] = json.loads(judged.stdout)
    for run in table["judged"]["runs"]:
        allowed = max(0.01 * run["true_drop_Pa"], 20.0)  # what the measurement promises
        if not (run["answered"] > 0 and run["rms_error_Pa"] <= allowed):
            sys.exit(f"run {run['run']} is off by {run['rms_error_Pa']} Pa rms, {allowed:.0f} are "
                     "allowed: a benchmark of wrong results is void")
    return table


def time_serve(programs, manoscope, experiment):
    """How long a page of the app waits for an answer."""
    done = subprocess.run([programs / "bench_serve", manoscope, experiment.parent,
                           f"{experiment.name}/experiment.toml"],
                          stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def judged(ratio, goal, at_most=False):
    reached = ratio <= goal if at_most else ratio >= goal
    return (f"{ratio:.2f}, goal {'at most' if at_most else 'at least'} {goal:g}: "
            f"{'reached' if reached else 'MISSED'}")


def print_reduction(table):
    print(f"\nReduction and registration of {table['maps']} maps of 1024 x 192, from page cache, one "
          "thread; "
          f"median of {table['repetitions']}")
    print(f"{'':24}{'wall s':>9}{'cpu s':>9}{'ms a map':>10}{'peak MB':>9}")
    for name in ("manoscope", "numpy"):
        row = table[name]
        print(f"{name:24}{row['wall_s']:9.3f}{row['cpu_s']:9.3f}"
              f"{1e3 * row['wall_s'] / table['maps']:10.2f}{row['peak_MB']:9.1f}")
    print(f"{'numpy / manoscope':24}{table['ratio']:9.2f}{table['ratio_cpu']:9.2f}")
    print(f"{'reading the bytes alone':24}{table['read_s']:9.3f}")
    print(f"numpy / manoscope, processor time: {judged(table['ratio_cpu'], GOAL_NUMPY_REDUCTION)}")
    difference = table["largest_difference"]
    print(f"largest difference of zeta {difference['zeta_m']:.1g} m, of its uncertainty "
          f"{difference['uncertainty_relative']:.1g} relative")


def print_linear(table):
    nx, nz = table["size"]
    print(f"\nOne pass over {table['maps']} maps of {nx} x {nz}, {100 * table['dropouts']:g} % of "
          f"the pixels missing, from page cache; processor time, median of {table['repetitions']}")
    print(f"{'':24}{'read ms':>9}{'ms':>9}{'numpy ms':>10}{'/ read':>8}{'numpy /':>9}"
          f"{'2 threads':>11}")
    for kind in ("raw", "gsf"):
        row = table[kind]
        read, one, numpy = (1e3 * row[name]["cpu_s"] / table["maps"]
                            for name in ("read", "one", "numpy"))
        # Threads gain wall time; the least of it is what the machine does when it is left alone.
        gain = row["one"]["least_s"] / row["two"]["least_s"]
        print(f"{kind + ', a map':24}{read:9.3f}{one:9.3f}{numpy:10.3f}{row['over_read']:8.2f}"
              f"{row['numpy_over']:9.2f}{gain:11.2f}")
        print(f"  {kind}, manoscope / read(): {judged(row['over_read'], GOAL_OVER_READ, True)}\n"
              f"  {kind}, numpy / manoscope: {judged(row['numpy_over'], GOAL_NUMPY_ONE_PASS)}\n"
              f"  {kind}, one thread / two, wall time, which means something on an idle machine only: "
              f"{judged(gain, GOAL_TWO_THREADS)}")


def print_reading(table):
    print("\nReading one run, 974 stations and 25 levels, with its covariance; processor time, one "
          "thread")
    for name in ("manoscope", "scipy"):
        print(f"{name:24}{1e3 * table[name]['cpu_s']:9.2f} ms{table[name]['peak_MB']:9.1f} MB")
    print(f"manoscope, ms: {judged(1e3 * table['manoscope']['cpu_s'], GOAL_READING_MS, True)}\n"
          f"scipy / manoscope: {judged(table['ratio_cpu'], GOAL_SCIPY_READING)}\n"
          f"median difference {table['difference']:.2g} standard uncertainties, of the "
          f"uncertainties {100 * table['uncertainty_difference']:.1f} %")


def print_serve(table):
    print(f"\nAnswers of manoscope serve, {table['connections']} connections at once, "
          f"{table['requests']} requests each")
    print(f"{'':<20}{'':<24}{'p50 ms':>9}{'p99 ms':>9}{'most ms':>9}")
    for answer in table["answers"]:
        beside = "while maps are drawn" if answer["while_maps_are_drawn"] else ""
        times = "".join(f"{answer[key]:9.2f}" for key in ("p50_ms", "p99_ms", "most_ms"))
        # Writing waits for the disk, whatever that is.
        goal = ("" if answer["question"].startswith("writing") else
                f"  p99 {judged(answer['p99_ms'], GOAL_ANSWER_MS, True)}")
        print(f"{answer['question']:<20}{beside:<24}{times}{goal}")


def print_program(title, table):
    print(f"\n{title}")
    print(f"{'':24}{'wall s':>9}{'cpu s':>9}{'peak MB':>19}")
    for key, row in table.items():
        if key.startswith("threads_"):
            print(f"{key[8:] + ' thread(s)':24}{row['wall_s']:9.3f}{row['cpu_s']:9.3f}"
                  f"{row['peak_MB']:19.1f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", type=Path, required=True, help="folder of bench_inputs, ...")
    parser.add_argument("--manoscope", type=Path, required=True, help="the program")
    parser.add_argument("--maps", type=int, default=64)
    parser.add_argument("--repetitions", type=int, default=7)
    parser.add_argument("--reductions-only", action="store_true",
                        help="leave out the twin and the whole measurement")
    parser.add_argument("--reading-only", action="store_true", help="the reading against scipy alone")
    parser.add_argument("--json", type=Path, help="also write every figure here")
    arguments = parser.parse_args()
    arguments.manoscope = arguments.manoscope.resolve()
    arguments.programs = arguments.programs.resolve()
    with tempfile.TemporaryDirectory(prefix="manoscope-bench-") as name:
        if arguments.reading_only:
            reading = time_reading(arguments.programs, 4 * arguments.repetitions, Path(name))
            print_reading(reading)
            if arguments.json:
                arguments.json.write_text(json.dumps({"reading": reading}, indent=1) + "\n",
                                          encoding="utf-8")
            return
        reduction = time_reduction(arguments.programs, arguments.maps, arguments.repetitions,
                                   Path(name))
        print_reduction(reduction)
        reading = time_reading(arguments.programs, 4 * arguments.repetitions, Path(name))
        print_reading(reading)
        linear = []
        for size, n_maps, dropouts in (((1024, 192), arguments.maps, 0.0),
                                       ((1024, 192), arguments.maps, 0.01),
                                       ((4096, 768), max(2, arguments.maps // 4), 0.0)):
            frames = Path(name) / "frames"
            linear.append(time_linear(arguments.programs, size, n_maps, dropouts,
                                      2 * arguments.repetitions, frames))
            shutil.rmtree(frames)
            print_linear(linear[-1])
        if arguments.reductions_only:
            return
        experiment = Path(name) / "experiment"
        twin = time_twin(arguments.manoscope, experiment)
        print_program(f"manoscope twin S1: {twin['maps']} wall states, nine of them coupled to the "
                      "flow, and their maps of 1024 x 192; one run", twin)
        wall_state_s, section_march_s = (time_stage(arguments.programs, name)
                                         for name in ("wall_state", "section_march"))
        limits, kept = held_against_limits(wall_state_s, section_march_s, twin)
        print("\nLimits, processor time of one thread\n" + "\n".join(limits))
        measure = time_measure(arguments.manoscope, min(3, arguments.repetitions), experiment,
                               Path(name) / "result")
        print_program(f"manoscope measure: {measure['maps']} maps of 1024 x 192 to p(x), figures "
                      f"and report; median of {measure['repetitions']}", measure)
        serve = time_serve(arguments.programs, arguments.manoscope, experiment)
        print_serve(serve)
    if arguments.json:
        figures = {"reduction": reduction, "reading": reading, "linear": linear, "twin": twin,
                   "wall_state_s": wall_state_s, "section_march_s": section_march_s,
                   "limits_kept": kept, "measure": measure, "serve": serve}
        arguments.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    if not kept:
        sys.exit("a limit is exceeded: see above")


if __name__ == "__main__":
    main()
