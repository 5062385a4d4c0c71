"""The command twin, and what is measured and judged of it.

Usage: twin_test.py PROGRAM [unittest arguments]
"""

import csv
import json
import os
import pathlib
import signal
import subprocess
import time
import unittest

from support import Folder, PROGRAM, hashes, run, main


class Twin(Folder):
    SIZE = ["--size", "256x48"]

    def short_plate(self, **changes):
        """A clamped wall on few cells, with changed values by key."""
        values = {"height": '"60 um"', "thickness": '"1 um"', "prestress": '"10 MPa"',
                  "viscosity": '"1.0 mPa s"', "flow_rates": '["5 mL/min", "20 mL/min"]',
                  "youngs_modulus": '"250 GPa"', "poisson_ratio": "0.23", "cells": "12, 4",
                  "levels": '["0 Pa", "1 kPa", "5 kPa", "20 kPa"]', **changes}
        values["n_cells_x"], values["n_cells_z"] = values.pop("cells").split(", ")
        path = self.folder / "plate.toml"
        path.write_text("""scenario = 1
name = "plate"
[channel]
length = "3 mm"
width = "1.7 mm"
height = {height}
[wall]
thickness = {thickness}
youngs_modulus = {youngs_modulus}
poisson_ratio = {poisson_ratio}
prestress = {prestress}
n_cells_x = {n_cells_x}
n_cells_z = {n_cells_z}
[fluid]
viscosity = {viscosity}
density = "998 kg/m3"
[hydrostatic]
levels = {levels}
[flow]
flow_rates = {flow_rates}
outlet_pressure = "300 Pa"
""".format(**values), encoding="utf-8")
        return path

    def test_a_wall_or_flow_that_cannot_be_is_told_before_anything_is_written(self):
        out = self.folder / "none"
        for words, changes in {
                "thickness": {"thickness": '"-1 um"'},
                "the channel chokes: at": {"viscosity": '"0.01 mPa s"',
                                           "flow_rates": '["20 mL/min", "300 mL/min"]'},
        }.items():
            done = run("twin", self.short_plate(**changes), "-o", out, check_code=2)
            self.assertIn(words, done.stderr)
            self.assertFalse(out.exists())

    SOFT = {"height": '"300 um"', "thickness": '"100 um"', "youngs_modulus": '"1 MPa"',
            "poisson_ratio": "0.49", "prestress": '"0 Pa"'}

    def test_a_wall_beyond_its_theory_is_told_with_scenario_and_level_or_run(self):
        out = self.folder / "none"
        told = self.refused(self.short_plate(**self.SOFT, levels='["0 Pa", "10 kPa", "30 kPa"]'),
                            "-o", out)
        for words in ('level of 30000 Pa of "plate"', "0.4 of its half-width",
                      "Give levels up to about"):
            self.assertIn(words, told)
        # The levels are low enough; the flow is not.
        told = self.refused(self.short_plate(**self.SOFT, levels='["0 Pa", "5 kPa"]',
                                             viscosity='"1000 mPa s"', flow_rates='["60 mL/min"]'),
                            "-o", out)
        self.assertIn('scenario "plate", Q60', told)
        self.assertIn("beyond its theory", told)
        self.assertFalse(out.exists())

    def test_a_soft_wall_within_its_theory_is_made_in_seconds(self):
        # Steps of round-off of the coupled flow were once halved a thousand times, for minutes.
        path = self.short_plate(**self.SOFT, levels='["0 Pa", "5 kPa"]',
                                flow_rates='["1 mL/min", "5 mL/min"]')
        started = os.times()
        run("twin", path, "-o", self.folder / "soft", "--size", "64x32", check_code=0)
        spent = os.times()
        # 0.5 s of processor time on a quiet machine.
        self.assertLess(spent.children_user - started.children_user, 20.0)
        text = (self.folder / "soft/experiment.toml").read_text()
        self.assertIn('youngs_modulus = "1 MPa"', text)
        self.assertIn('name = "plate, seed 1"', text)

    def test_a_stop_is_prompt_and_leaves_nothing(self):
        path = self.short_plate(cells="80, 24")  # a second or more for one solution
        for stop in (signal.SIGINT, signal.SIGTERM):
            out = self.folder / "stopped"
            process = subprocess.Popen([PROGRAM, "twin", str(path), "-o", str(out)], text=True,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            time.sleep(1.5)
            sent = time.monotonic()
            process.send_signal(stop)
            told = process.communicate(timeout=60)[1]
            self.assertEqual(process.returncode, 130, told)
            self.assertIn("nothing was half-written", told)
            # Under a second where nothing else runs: one factorisation, of 0.3 s. The whole work
            # would take minutes; a crowded machine stretches either.
            self.assertLess(time.monotonic() - sent, 30.0)
            self.assertFalse(out.exists())

    def test_another_seed_is_another_experiment(self):
        one, two, out = self.folder / "one", self.folder / "two", self.folder / "out"
        for folder, seed in ((one, 1), (two, 2)):
            run("twin", self.short_plate(), "-o", folder, "--size", "160x80", "--seed", seed,
                check_code=0)
        run("measure", one, "-o", out, check_code=0)
        run("judge", out, one, check_code=0)
        done = run("judge", out, two, check_code=2)
        for words in ("6 of the 6 maps", "plate, seed 1", "plate, seed 2", "--other-maps"):
            self.assertIn(words, done.stderr)
        self.assertEqual(done.stdout, "")
        run("judge", out, two / "truth/truth.csv", check_code=0)  # which knows no maps
        run("judge", out, one, "--other-maps", check_code=0)
        # Nor does the result of one replace that of the other.
        done = run("measure", two, "-o", out, check_code=2)
        self.assertIn("another experiment's result stands there", done.stderr)

    def test_makes_measures_and_judges_a_shipped_scenario(self):
        made, out = self.folder / "s1", self.folder / "out"
        told = json.loads(run("twin", "S1", "-o", made, *self.SIZE, "--json", check_code=0).stdout)
        self.assertEqual((told["maps"], len(told["runs"])), (33, 9))
        for name in ("experiment.toml", "truth/truth.nc", "truth/truth.csv"):
            self.assertTrue((made / name).is_file(), name)
        run("check", made, check_code=0)
        run("measure", made, "-o", out, check_code=0)
        table = self.folder / "stations.csv"
        judged = json.loads(run("judge", out, made, "--json", "--stations", table,
                                check_code=0).stdout)
        self.assertEqual((len(judged["runs"]), len(judged["levels"])), (9, 24))
        for run_ in judged["runs"]:
            # Labels carry 10 Pa each; one station leans on two to four of them and on its own noise.
            self.assertLess(run_["rms_error_Pa"], max(20.0, 0.01 * run_["true_drop_Pa"]), run_)
            self.assertLess(abs(run_["drop_pull"]), 4.0, run_)
            # 50 um pixels across err by 1e-3 of up to 33 um.
            self.assertLess(run_["deflection"]["rms_error_m"], 40e-9, run_)
        with open(table, newline="") as rows:
            errors = [float(row["error_Pa"]) for row in csv.DictReader(rows)
                      if row["in_section"] == "1" and row["error_Pa"] and row["run"] == "Q70"]
        rms = (sum(error * error for error in errors) / len(errors)) ** 0.5
        # Nine digits of pressures up to 18 kPa.
        self.assertAlmostEqual(rms, judged["runs"][-1]["rms_error_Pa"], delta=1e-4)
        self.check_split(judged, table)
        self.check_bars(judged["runs"])

    def check_bars(self, runs):
        """Bars of p(x) off a clamped wall: neither too narrow nor idle.

        Held for S1, whose locality is within its bars; for thick elastomers (S5), where it is the
        largest part, the bars are known to be too narrow: see docs/accuracy.md.
        """
        # Stations of a run share labels and maps: of nine runs with 8 to 15 independent errors each,
        # 95 % scatter by 5 % (one run) and 2 % (their mean), twice that is allowed.
        coverage = [run_["coverage"] for run_ in runs]
        self.assertGreater(min(coverage), 0.85)
        self.assertGreater(sum(coverage) / len(coverage), 0.91)
        # rms of the pulls over the runs: 1 if the bars were exact; those of interpolation are
        # cautious. Nine runs with some ten errors each scatter by 8 %.
        mean_square = sum(run_["pull_rms"] ** 2 for run_ in runs) / len(runs)
        self.assertLess(mean_square ** 0.5, 1.25)
        self.assertGreater(mean_square ** 0.5, 0.5)
        # Runs share the errors of the labels: the mean of their means scatters by about 0.3.
        self.assertLess(abs(sum(run_["pull_mean"] for run_ in runs)) / len(runs), 0.6)

    def check_split(self, judged, table):
        parts = ("neighbourhood_Pa", "label_error_Pa", "map_error_Pa", "curve_shape_error_Pa", "locality_error_Pa")
        n_split = {}
        with open(table, newline="") as rows:
            for row in csv.DictReader(rows):
                self.assertEqual({row[part] == "" for part in parts}, {row[parts[0]] == ""})
                if row[parts[0]] == "":
                    continue
                # Nine digits of errors up to some kPa at the ends.
                total = sum(float(row[part]) for part in parts)
                self.assertAlmostEqual(total, float(row["error_Pa"]), delta=1e-4)
                n_split[row["run"]] = n_split.get(row["run"], 0) + int(row["in_section"])
        for run_ in judged["runs"]:
            split = run_["split"]
            self.assertEqual(split["stations"], n_split[run_["run"]])
            self.assertEqual(split["left_out"], 0)
            self.assertAlmostEqual(split["total"]["rms_error_Pa"], run_["rms_error_Pa"], delta=1e-6)
            self.assertGreater(split["labels"]["rms_error_Pa"], 1.0)
            # The clamped wall feels its neighbourhood: pascals inside, tens at the section's edge.
            self.assertGreater(split["locality"]["largest_error_Pa"], 1.0)
            self.assertGreater(split["neighbourhood"]["largest_error_Pa"], 1.0)
            self.assertLess(split["locality"]["largest_error_Pa"], 100.0)
            self.assertEqual(len(run_["stations"]["x_m"]), len(run_["stations"]["map_error_Pa"]))

    def test_the_same_seed_gives_the_same_bytes_on_any_number_of_threads(self):
        scenario = self.short_plate()
        made = {}
        for name, words in {"one": ["--threads", 1], "two": ["--threads", 2],
                            "other": ["--seed", 2]}.items():
            run("twin", scenario, "-o", self.folder / name, "--size", "64x32", *words,
                check_code=0)
            made[name] = hashes(self.folder / name)
        self.assertEqual(made["one"], made["two"])
        self.assertNotEqual(made["one"], made["other"])

    def test_without_noise_the_labels_are_true(self):
        run("twin", self.short_plate(), "-o", self.folder / "clean", "--size", "64x32",
            "--noise-free", check_code=0)
        with open(self.folder / "clean/truth/truth_levels.csv", newline="") as rows:
            for row in csv.DictReader(rows):
                self.assertEqual(float(row["label_Pa"]), float(row["true_pressure_Pa"]))

    def test_lists_what_ships(self):
        names = [s["name"] for s in json.loads(run("twin", "--list", "--json",
                                                   check_code=0).stdout)["scenarios"]]
        self.assertEqual(names, ["S1", "S1b", "S2", "S3", "S4", "S5"])
        self.assertIn("S1", run("twin", "--list", check_code=0).stdout)

    def refused(self, *words):
        done = run("twin", *words, check_code=2)
        self.assertEqual(done.stdout, "")
        return done.stderr

    def test_bad_words_are_answered(self):
        out = self.folder / "out"
        self.assertIn('did you mean "S1"', self.refused("S11", "-o", out))
        self.assertIn("no folder", self.refused("S1"))
        self.assertIn("--list", self.refused())
        self.assertIn("is no size", self.refused("S1", "-o", out, "--size", "big"))
        self.assertFalse(out.exists())
        blocked = self.folder / "file"
        blocked.write_text("not a folder")
        self.assertIn("file", self.refused("S1", "-o", blocked / "out"))
        plate = self.short_plate()
        run("twin", plate, "-o", out, "--size", "64x32", check_code=0)
        self.assertIn("stands there already", self.refused(plate, "-o", out))
        run("twin", plate, "-o", out, "--size", "64x32", "--overwrite", check_code=0)

    @unittest.skipUnless(hasattr(os, "geteuid"), "needs users")
    def test_a_folder_that_may_not_be_written_to_is_told(self):
        closed = self.folder / "closed"
        closed.mkdir()
        closed.chmod(0o555)
        self.folder.chmod(0o755)
        # Permissions do not bind the superuser: it steps back to nobody.
        user = {"user": 65534, "group": 65534, "extra_groups": []} if os.geteuid() == 0 else {}
        try:
            done = subprocess.run([PROGRAM, "twin", str(self.short_plate()), "-o",
                                   str(closed / "out"), "--size", "64x32"], text=True,
                                  capture_output=True, **user)
        except PermissionError:
            self.skipTest("nobody may not run the program where it lies")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(str(closed), done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(list(closed.iterdir()), [])

    # 1 um of nitride, compressed to three times what buckles it; rests a little inward.
    BUCKLED = {"height": '"60 um"', "prestress": '"-1.6 MPa"\ninitial_crest = "-0.05 um"',
               "levels": '["0 Pa", "80 Pa", "160 Pa", "1 kPa"]', "flow_rates": '["5 mL/min"]'}

    def test_a_wall_that_snaps_through_is_told(self):
        path = self.short_plate(**self.BUCKLED)
        done = run("twin", path, "-o", self.folder / "a", "--size", "64x32", check_code=0)
        self.assertIn("The wall snapped through on the way to\n  80 Pa (h01.gsf): 1 snap, the "
                      "furthest of +", done.stdout)
        told = json.loads(run("twin", path, "-o", self.folder / "b", "--size", "64x32", "--json",
                              check_code=0).stdout)
        self.assertEqual([level["snaps"]["n"] for level in told["levels"]], [0, 1, 0, 0])
        self.assertGreater(told["levels"][1]["snaps"]["jump_m"], 0.1e-6)
        self.assertEqual([run_["snaps"]["n"] for run_ in told["runs"]], [1])
        # A taut one does not, and nothing is said.
        done = run("twin", self.short_plate(), "-o", self.folder / "c", "--size", "64x32",
                   check_code=0)
        self.assertNotIn("snapped", done.stdout)

    def scenario(self, *changes):
        """S1 as a file, with changes."""
        source = pathlib.Path(__file__).parents[2] / "src/manoscope/twin/scenarios/S1.toml"
        text = source.read_text()
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        path = self.folder / "mine.toml"
        path.write_text(text)
        return path

    def test_faults_of_a_scenario_are_told_together(self):
        path = self.scenario(('thickness = "0.2 um"', 'thickness = "-0.2 um"'),
                             ('noise = "20 nm"', 'noize = "20 nm"'))
        told = self.refused(path, "-o", self.folder / "out")
        self.assertIn("wall.thickness", told)
        self.assertIn('did you mean "noise"', told)
        self.assertIn(str(path), told)

    def test_a_channel_that_closes_is_told_with_its_place(self):
        path = self.scenario(('height = "175 um"', 'height = "8 um"'))
        told = self.refused(path, "-o", self.folder / "out", "--size", "64x32")
        self.assertIn("touches the floor at x =", told)
        self.assertFalse((self.folder / "out" / "experiment.toml").exists())


if __name__ == "__main__":
    main()
