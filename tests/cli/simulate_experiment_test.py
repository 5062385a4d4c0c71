"""manoscope simulate EXPERIMENT --run RUN: Navier-Stokes in the measured shape of a run."""

import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

from support import PROGRAM, DemoFolder, hashes, main, run

SOLVER = pathlib.Path(PROGRAM).parent / "manoscope-navier-stokes"
NEEDS_SOLVER = unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
QUICK = ("--cells-along", "60", "--cells-up", "5")


def processes_with(text):
    """Process ids of solvers whose command line holds a text."""
    found = []
    for folder in pathlib.Path("/proc").iterdir():
        if not folder.name.isdigit():
            continue
        try:
            words = (folder / "cmdline").read_bytes()
        except OSError:
            continue
        if words.split(b"\0")[0].endswith(SOLVER.name.encode()) and text.encode() in words:
            found.append(int(folder.name))
    return found


class SimulateExperiment(DemoFolder):
    """The demo's flow obeys the march on sections; its true p(x) is at hand."""

    def setUp(self):
        self.experiment = self.out / "experiment"

    def truth(self, name, start, end):
        """True drop of a run between two places, by straight lines between the table's rows."""
        with open(self.experiment / "truth" / "truth.csv", encoding="utf-8") as file:
            rows = [(float(row["x_mm"]) * 1e-3, float(row[f"p_Pa_{name}"]))
                    for row in csv.DictReader(file)]

        def at(x):
            for (x0, p0), (x1, p1) in zip(rows, rows[1:]):
                if x0 <= x <= x1:
                    return p0 + (p1 - p0) * (x - x0) / (x1 - x0)
            raise ValueError(x)
        return at(start) - at(end)

    def test_what_is_missing_or_told_twice_is_said(self):
        shape = self.folder / "shape.csv"
        for arguments, text in (
                ((self.experiment,), "--run"),
                ((self.experiment, "--run", "Q5", "--shape", shape), "--shape"),
                (("--shape", shape, "--run", "Q5"), "--run"),
                (("--shape", shape, "--parasitic"), "--parasitic"),
                ((self.experiment, "--run", "Q5", "--height", "175um"), "--height"),
                # What it would be anyway is refused as well.
                ((self.experiment, "--run", "Q5", "--density", "998kg/m3"), "--density"),
                ((self.experiment, "--run", "Q5", "--csv", self.folder / "none" / "p.csv"),
                 "p.csv"),
                ((self.experiment, "--parasitic", "--checkpoint", "flow"), "--checkpoint"),
                ((self.experiment, "--parasitic", "--vtu", "flow.vtu"), "--vtu"),
                ((self.experiment, "--parasitic", "--dim", "3"), "--dim"),
                ((self.experiment, "--parasitic", "--cells-up", "6"), "--cells-up"),
                ((self.experiment, "--parasitic", "--inlet", "uniform"), "--inlet"),
                ((self.experiment, "--parasitic", "--smoothing", "50um"), "--smoothing"),
                ((self.experiment, "--run", "Q5", "--inlet", "slanted"), "--inlet"),
                ((self.experiment, "--run", "Q5", "--dim", "4"), "--dim"),
                ((self.experiment, "--run", "Q5", "--wall-shape", "parabola"), "measured"),
        ):
            done = run("simulate", *arguments, check_code=2)
            self.assertEqual(done.stdout, "")
            self.assertIn(text, done.stderr)

    def test_without_the_solver_it_says_what_to_make(self):
        program = self.folder / "manoscope"
        shutil.copy(PROGRAM, program)
        program.chmod(0o755)
        done = subprocess.run([program, "simulate", self.experiment, "--run", "Q5"], text=True,
                              capture_output=True, env={"PATH": "/nowhere"}, timeout=60,
                              check=False)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("make simulation", done.stderr)

    @NEEDS_SOLVER
    def test_an_unknown_run_is_told_those_there_are(self):
        done = run("simulate", self.experiment, "--run", "Q71", check_code=2)
        for word in ("Q71", "Q5", "Q20", "Q40", "Q70", "all"):
            self.assertIn(word, done.stderr)

    @NEEDS_SOLVER
    def test_an_experiment_without_flow_runs_is_refused(self):
        still = self.renamed("still")
        path = still / "experiment.toml"
        text = path.read_text(encoding="utf-8")
        path.write_text(text.replace('[flow]\nlist = "flow.csv"\n', ""), encoding="utf-8")
        done = run("simulate", still, "--run", "all", check_code=2)
        self.assertIn("no flow runs", done.stderr)

    @NEEDS_SOLVER
    def test_a_plane_flow_with_side_walls_added_agrees_with_the_truth(self):
        done = run("simulate", self.experiment, "--run", "all", "--json", check_code=0)
        runs = json.loads(done.stdout)
        self.assertEqual([one["run"] for one in runs], ["Q5", "Q20", "Q40", "Q70"])
        for one in runs:
            with self.subTest(run=one["run"]):
                start, end = one["test_section_m"]
                truth = self.truth(one["run"], start, end)
                plane, whole = one["test_section"]
                # The gap is known to 0.3 %, its one draw is in the bars: two standard uncertainties.
                self.assertLess(abs(whole["drop_Pa"] - truth), 2 * whole["drop_uncertainty_Pa"])
                self.assertLessEqual(whole["en_number"], 1)
                self.assertGreater(whole["p_value"], 0.01)
                # Side walls and curved roof of this channel, 0.1 as high as wide: 3 to 8 %.
                self.assertGreater(truth / plane["drop_Pa"], 1.02)
                self.assertLess(truth / plane["drop_Pa"], 1.10)
                self.assertEqual(one["mean_pressure_Pa"], plane["mean_pressure_Pa"])
                # A gauge pressure: at the end that of the outlet.
                self.assertAlmostEqual(one["mean_pressure_Pa"][-1], one["outlet_pressure_Pa"],
                                       places=6)
                self.assertAlmostEqual(
                    one["mean_pressure_Pa"][0] - one["mean_pressure_Pa"][-1], one["drop_Pa"],
                    places=6)
                # Noise was taken away, and nothing else.
                self.assertLess(one["smoothing_taken_m"], 1.2 * one["smoothing_noise_m"])
                parts = whole["drop_uncertainty_parts_Pa"]
                self.assertAlmostEqual(
                    sum(part * part for part in parts.values()) ** 0.5
                    / whole["drop_uncertainty_Pa"], 1, places=6)
                for name in ("numerical", "deflection", "channel height", "inlet profile"):
                    self.assertGreater(parts[name], 0)

    @NEEDS_SOLVER
    def test_passages_of_the_channels_own_section_cost_what_the_formula_says(self):
        ducts = self.renamed("ducts")
        path = ducts / "experiment.toml"
        text = path.read_text(encoding="utf-8").split("[rigid]")[0]
        passage = 'length = "2 mm", width = "1.7 mm", height = "175 um"'
        text += f"[rigid]\ninlet = {{{passage}}}\noutlet = {{{passage}}}\n"
        path.write_text(text, encoding="utf-8")
        table = self.folder / "passages.csv"
        done = run("simulate", ducts, "--parasitic", "--run", "Q5", "--run", "Q20", "--json",
                   "--csv", table, check_code=0)
        answer = json.loads(done.stdout)
        self.assertEqual(len(answer["passages"]), 2)
        for one in answer["passages"]:
            bar = one["parasitic_drop_uncertainty_Pa"]
            self.assertLess(bar, 0.01 * one["formula_drop_Pa"])
            # The formula of a duct is exact.
            self.assertLess(abs(one["parasitic_drop_Pa"] - one["formula_drop_Pa"]), bar)
            for passage in (one["inlet"], one["outlet"]):
                self.assertLess(abs(passage["drop_Pa"] - 0.5 * one["formula_drop_Pa"]),
                                passage["drop_numerical_uncertainty_Pa"])
        with open(table, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 2)
        self.assertAlmostEqual(float(rows[1]["parasitic_drop_Pa"]),
                               answer["passages"][1]["parasitic_drop_Pa"], places=4)
        # The lines go into the experiment file as they are.
        path.write_text(text + answer["experiment_file"], encoding="utf-8")
        self.assertNotIn("rigid", run("check", ducts).stderr)
        done = run("simulate", ducts, "--parasitic", "--run", "Q5", "-o", self.out,
                   check_code=2)
        self.assertIn("another version of the experiment file", done.stderr)

    @NEEDS_SOLVER
    def test_one_run_is_an_object_and_its_inlet_can_be_told(self):
        flows = {}
        for inlet in ("developed", "uniform", "both"):
            done = run("simulate", self.experiment, "--run", "Q20", "--inlet", inlet, "--json",
                       *QUICK, check_code=0)
            flows[inlet] = json.loads(done.stdout)
        drops = {inlet: flow["drop_Pa"] for inlet, flow in flows.items()}
        self.assertGreater(drops["uniform"], drops["developed"])
        self.assertEqual(drops["both"], drops["developed"])
        # What is not known is then all that lies between.
        self.assertAlmostEqual(flows["both"]["inlet_effect_Pa"][0],
                               drops["uniform"] - drops["developed"], places=6)
        self.assertEqual(set(flows["uniform"]["inlet_effect_Pa"]), {0.0})

    @NEEDS_SOLVER
    def test_in_three_dimensions_the_roof_is_the_map_or_one_shape(self):
        cells = ("--dim", "3", "--inlet", "developed", "--cells-along", "20", "--cells-up", "3",
                 "--cells-across", "4")
        flows = {}
        for shape in ("auto", "map", "response"):
            done = run("simulate", self.experiment, "--run", "Q5", "--wall-shape", shape, "--json",
                       *cells, check_code=0)
            flows[shape] = json.loads(done.stdout)
        roof, one = flows["map"], flows["response"]
        self.assertEqual(flows["auto"]["drop_Pa"], roof["drop_Pa"])
        self.assertTrue(roof["roof_map"])
        self.assertFalse(one["roof_map"])
        self.assertIsNone(one["roof_taken_m"])
        self.assertIn("its own maps", roof["shape"])
        self.assertIn("crest", one["shape"])
        # Noise was taken away, and nothing else.
        self.assertLess(roof["roof_taken_m"], 1.2 * roof["roof_noise_m"])
        self.assertLess(roof["roof_misfit"], 1.3)
        # What the resistance of the sections says of it: side layers and inertia are a part of it.
        change = roof["drop_Pa"] / one["drop_Pa"] - 1
        self.assertAlmostEqual(change, roof["roof_effect"], delta=0.2 * abs(change) + 2e-4)
        self.assertGreater(
            roof["test_section"][0]["drop_uncertainty_parts_Pa"]["roof across"], 0)

    @NEEDS_SOLVER
    def test_table_picture_and_terminal(self):
        table, picture = self.folder / "p.csv", self.folder / "flow.vtu"
        done = run("simulate", self.experiment, "--run", "Q5", "--csv", table, "--vtu", picture,
                   "--stations", "21", *QUICK, check_code=0)
        for words in ("read off the wall", "Navier-Stokes 2-D", "side walls added", "U of the drop",
                      "taken away", "p read"):
            self.assertIn(words, done.stdout)
        with open(table, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 21)
        self.assertEqual(rows[0]["run"], "Q5")
        self.assertEqual(rows[0]["read_pressure_Pa"], "")  # the rim tells nothing
        self.assertGreater(float(rows[10]["read_pressure_Pa"]), 0)
        self.assertGreater(float(rows[10]["uncertainty_by_channel_height_Pa"]), 0)
        self.assertIn(b"UnstructuredGrid", picture.read_bytes()[:400])
        short = run("simulate", self.experiment, "--run", "Q5", "--quiet", *QUICK, check_code=0)
        self.assertEqual(len(short.stdout.splitlines()), 5)

    @NEEDS_SOLVER
    def test_it_is_kept_beside_the_result_and_drawn_by_report(self):
        result = self.folder / "result"
        shutil.copytree(self.out, result)
        shutil.rmtree(result / "simulation")  # the demo's own
        before = hashes(result)
        run("simulate", self.experiment, "--run", "Q5", "--run", "Q70", "-o", result, check_code=0)
        files = {name: value for name, value in hashes(result).items() if name not in before}
        self.assertEqual(sorted(files), ["simulation/Q5_2d.nc", "simulation/Q70_2d.nc"])
        self.assertEqual(before, {name: value for name, value in hashes(result).items()
                                  if name in before})
        # Once more on other cells: its own file alone changes.
        run("simulate", self.experiment, "--run", "Q5", "-o", result, "--cells-along", "40",
            "--cells-up", "5", check_code=0)
        after = hashes(result)
        self.assertNotEqual(after["simulation/Q5_2d.nc"], files["simulation/Q5_2d.nc"])
        self.assertEqual(after["simulation/Q70_2d.nc"], files["simulation/Q70_2d.nc"])

        run("report", result, check_code=0)
        page = (result / "report.html").read_text(encoding="utf-8")
        self.assertIn("Navier-Stokes 2-D</th>", page)
        self.assertIn("Navier-Stokes flow below the measured wall", page)
        figure = result / "figures" / "fig3c_pressure_highest_flow.svg"
        if figure.exists():
            self.assertIn("Navier-Stokes 2-D", figure.read_text(encoding="utf-8"))

        # One that is damaged is refused by name, and the report stays.
        damaged = result / "simulation" / "Q5_2d.nc"
        damaged.write_bytes(damaged.read_bytes()[:500])
        done = run("report", result, check_code=2)
        self.assertIn("Q5_2d.nc", done.stderr)
        self.assertEqual((result / "report.html").read_text(encoding="utf-8"), page)

    @NEEDS_SOLVER
    def test_what_fails_leaves_nothing(self):
        result = self.folder / "untouched"
        shutil.copytree(self.out, result)
        before = hashes(result)
        # Another experiment's result.
        other = self.renamed("other")
        done = run("simulate", other, "--run", "Q5", "-o", result, *QUICK, check_code=2)
        self.assertIn("result of", done.stderr)
        # No result at all.
        run("simulate", self.experiment, "--run", "Q5", "-o", self.folder / "none", *QUICK,
            check_code=2)
        self.assertFalse((self.folder / "none").exists())
        self.assertEqual(hashes(result), before)
        # A gap that the wall closes: the wall of the demo bends inwards by 11 um.
        path = other / "experiment.toml"
        text = path.read_text(encoding="utf-8")
        path.write_text(text.replace('height = "175.15 um"', 'height = "10 um"'), encoding="utf-8")
        self.assertNotEqual(path.read_text(encoding="utf-8"), text)
        done = run("simulate", other, "--run", "Q5", check_code=2)
        self.assertIn("gap", done.stderr)

    def test_a_solver_that_finds_no_flow_is_quoted_and_leaves_nothing(self):
        # The program takes the solver beside it: here one that gives up.
        folder, result = self.folder / "beside", self.folder / "kept"
        folder.mkdir()
        shutil.copytree(self.out, result)
        before = hashes(result)
        program, solver = folder / "manoscope", folder / SOLVER.name
        shutil.copy(PROGRAM, program)
        program.chmod(0o755)
        solver.write_text("#!/bin/sh\necho '{\"error\":{\"where\":\"solver\",\"found\":"
                          "\"no steady flow\",\"mend\":\"Take more cells\"}}'\nexit 2\n",
                          encoding="utf-8")
        solver.chmod(0o755)
        done = subprocess.run([program, "simulate", self.experiment, "--run", "all", "-o", result],
                              text=True, capture_output=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("no steady flow. Take more cells", done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(hashes(result), before)

    @NEEDS_SOLVER
    def test_ctrl_c_ends_the_solver(self):
        self.stop_after_start()

    @NEEDS_SOLVER
    @unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed")
    def test_ctrl_c_ends_all_processes_of_the_solver(self):
        self.stop_after_start("--processes", "2")

    def stop_after_start(self, *options):
        """A Ctrl-C leaves neither processes nor files."""
        number = len(options)  # the class shares one folder
        scratch = self.folder / f"scratch{number}"
        result = self.folder / f"stopped{number}"
        scratch.mkdir()
        shutil.copytree(self.out, result)
        before = hashes(result)
        # Cells for minutes.
        child = subprocess.Popen(
            [PROGRAM, "simulate", self.experiment, "--run", "Q5", "-o", result, "--cells-along",
             "3000", "--cells-up", "40", *options],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**os.environ,
                                                                 "TMPDIR": str(scratch)})
        try:
            deadline = time.monotonic() + 120
            while not processes_with(str(scratch)):
                self.assertIsNone(child.poll(), "ended before it was stopped")
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.05)
            child.send_signal(signal.SIGINT)
            out, _ = child.communicate(timeout=60)
        finally:
            child.kill()
        self.assertEqual(child.returncode, 130)
        self.assertEqual(out, b"")
        self.assertEqual(processes_with(str(scratch)), [])
        self.assertEqual(list(scratch.iterdir()), [])
        self.assertEqual(hashes(result), before)


if __name__ == "__main__":
    main()
