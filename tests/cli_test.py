"""The command line as a user meets it: exit codes, messages, files, determinism, interruption.

Usage: cli_test.py PROGRAM [unittest arguments]
"""

import csv
import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = sys.argv.pop(1)


def run(*arguments, cwd=None, check_code=None):
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, text=True, encoding="utf-8",
                          capture_output=True, stdin=subprocess.DEVNULL, timeout=300)
    if check_code is not None:
        assert done.returncode == check_code, (done.returncode, done.stdout, done.stderr)
    return done


def hashes(folder):
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="manoscope_cli_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)


class Words(Folder):
    def test_help_and_version_are_answers(self):
        self.assertIn("measure", run("--help", check_code=0).stdout)
        self.assertRegex(run("--version", check_code=0).stdout, r"^manoscope \d+\.\d+\.\d+ \(")

    def test_every_command_explains_itself_with_its_common_options(self):
        commands = re.findall(r"^  ([a-z]+) ", run("--help", check_code=0).stdout, re.M)
        for known in ("demo", "init", "check", "inspect", "convert", "formats", "measure", "judge",
                      "report"):
            self.assertIn(known, commands)
        for command in commands:
            text = run(command, "--help", check_code=0).stdout
            for option in ("--threads", "--seed", "--quiet", "--json"):
                self.assertIn(option, text, command)

    def test_a_slip_in_a_command_is_the_users_and_is_answered_with_the_near_word(self):
        done = run("mesure", check_code=2)
        self.assertIn('did you mean "measure"', done.stderr)
        self.assertEqual(done.stdout, "")
        run(check_code=2)
        run("measure", check_code=2)
        run("measure", "x", "-o", "y", "--no-such-option", check_code=2)

    def test_a_length_without_unit_is_refused(self):
        done = run("measure", "x", "-o", "y", "--shift-uncertainty", "5", check_code=2)
        self.assertIn("has no unit", done.stderr)

    def test_a_missing_experiment_is_named(self):
        done = run("measure", self.folder / "absent", "-o", self.folder / "out", check_code=2)
        self.assertIn("absent", done.stderr)
        self.assertFalse((self.folder / "out").exists())

    def test_output_that_cannot_be_written_is_an_error(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("this machine has no /dev/full")
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, "formats"], stdout=full, stderr=subprocess.PIPE,
                                  text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("standard output", done.stderr)


class Maps(Folder):
    def write_csv_map(self):
        path = self.folder / "map.csv"
        path.write_text("1,2,3\n4,nan,6\n")
        return path

    def test_a_matrix_without_scale_is_refused_with_the_option_that_adds_it(self):
        path = self.write_csv_map()
        done = run("convert", path, self.folder / "map.gsf", check_code=2)
        self.assertIn("--height-unit", done.stderr)
        done = run("convert", path, self.folder / "map.gsf", "--height-unit", "nm", check_code=2)
        self.assertIn("--pitch-x", done.stderr)
        self.assertFalse((self.folder / "map.gsf").exists())

    def test_convert_and_inspect_keep_the_numbers(self):
        path = self.write_csv_map()
        scale = ["--pitch-x", "2um", "--pitch-y", "3um", "--height-unit", "nm"]
        for name in ("map.gsf", "map.nc", "again.csv"):
            out = self.folder / name
            run("convert", path, out, *scale, check_code=0)
            [summary] = json.loads(run("inspect", out, "--json", check_code=0).stdout)
            [channel] = summary["channels"]
            self.assertEqual((channel["nx"], channel["ny"], channel["missing"]), (3, 2, 1))
            # 32-bit floats of .gsf keep 24 bits.
            self.assertAlmostEqual(channel["size_x_m"], 6e-6, delta=6e-13)
            self.assertAlmostEqual(channel["size_y_m"], 6e-6, delta=6e-13)
            self.assertAlmostEqual(channel["max"], 6e-9, delta=6e-16)
            self.assertAlmostEqual(channel["mean"], 3.2e-9, delta=3.2e-16)

    def test_formats_lists_each_reader_once(self):
        names = [entry["name"] for entry in json.loads(run("formats", "--json").stdout)]
        self.assertEqual(len(names), len(set(names)))
        self.assertIn("gsf", names)


class Demo(unittest.TestCase):
    """One demo serves the tests that only look at it."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="manoscope_cli_"))
        cls.out = cls.folder / "demo"
        cls.done = run("demo", "-o", cls.out, check_code=0)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def test_prints_p_of_x_and_where_the_report_is(self):
        self.assertIn("p(x) Q70 [Pa]", self.done.stdout)
        self.assertIn(str(self.out / "report.html"), self.done.stdout)
        for name in ("result.nc", "pressure.csv", "drops.csv", "report.html",
                     "experiment/experiment.toml", "experiment/truth/truth.csv"):
            self.assertTrue((self.out / name).is_file(), name)
        self.assertTrue(list((self.out / "figures").glob("*.svg")))

    def test_measures_what_is_true(self):
        judged = json.loads(run("judge", self.out, self.out / "experiment", "--json",
                                check_code=0).stdout)["runs"]
        self.assertEqual(len(judged), 4)
        for run_ in judged:
            # Labels carry 10 Pa each; one station leans on two to four of them and on its own noise.
            self.assertLess(run_["rms_error_Pa"], max(20.0, 0.01 * run_["true_drop_Pa"]), run_)
            self.assertLess(abs(run_["drop_pull"]), 4.0, run_)

    def test_threads_change_no_byte(self):
        results = []
        for threads in (1, 2):
            out = self.folder / f"threads{threads}"
            run("measure", self.out / "experiment", "-o", out, "--threads", threads, check_code=0)
            results.append(hashes(out))
        self.assertEqual(results[0], results[1])

    def test_the_same_seed_makes_the_same_experiment_and_another_does_not(self):
        for seed in (1, 2):
            run("demo", "-o", self.folder / f"seed{seed}", "--seed", seed, check_code=0)
        first = hashes(self.folder / "seed1" / "experiment")
        self.assertEqual(first, hashes(self.out / "experiment"))
        self.assertNotEqual(first, hashes(self.folder / "seed2" / "experiment"))

    def test_report_is_made_again_from_the_result_alone(self):
        out = self.folder / "again"
        shutil.copytree(self.out, out)
        before = (out / "report.html").read_bytes()
        (out / "report.html").unlink()
        run("report", out, check_code=0)
        self.assertEqual((out / "report.html").read_bytes(), before)

    def test_measure_prints_json_that_agrees_with_the_table(self):
        out = self.folder / "json"
        done = run("measure", self.out / "experiment", "-o", out, "--json", check_code=0)
        printed = {entry["run"]: entry for entry in json.loads(done.stdout)["runs"]}
        with open(out / "drops.csv", newline="") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual(len(rows), len(printed))
        for row in rows:
            value = printed[row["run"]]["extracted_drop_Pa"]
            self.assertAlmostEqual(float(row["extracted_drop_Pa"]), value, delta=1e-6 * abs(value))

    def test_check_reports_faults_as_json_and_exits_with_2(self):
        broken = self.folder / "broken"
        shutil.copytree(self.out / "experiment", broken)
        text = (broken / "experiment.toml").read_text()
        (broken / "experiment.toml").write_text(re.sub(r'width\s*=\s*"[^"]*"', "widht = 3", text, 1))
        done = run("check", broken, "--json", check_code=2)
        faults = json.loads(done.stdout)["faults"]
        self.assertGreaterEqual(len(faults), 1)
        self.assertTrue(any("did you mean" in fault["found"] + fault["mend"] for fault in faults))
        run("check", self.out / "experiment", check_code=0)

    def test_a_place_left_out_of_the_file_is_found_from_the_maps(self):
        found = self.folder / "found"
        shutil.copytree(self.out / "experiment", found)
        path = found / "experiment.toml"
        kept = [line for line in path.read_text().splitlines()
                if not re.match(r"\s*(origin|flow|outward|rotation)\s*=", line)]
        path.write_text("\n".join(kept) + "\n")
        run("measure", found, "-o", self.folder / "found_out", check_code=0)
        judged = json.loads(run("judge", self.folder / "found_out", found, "--json",
                                check_code=0).stdout)["runs"]
        for run_ in judged:
            self.assertLess(run_["rms_error_Pa"], max(20.0, 0.01 * run_["true_drop_Pa"]), run_)

    def test_bare_matrices_are_measured_once_the_file_says_their_scale(self):
        bare = self.folder / "bare"
        shutil.copytree(self.out / "experiment", bare)
        [summary] = json.loads(run("inspect", bare / "h00.gsf", "--json").stdout)
        [channel] = summary["channels"]
        for path in bare.glob("*.gsf"):
            run("convert", path, path.with_suffix(".txt"), check_code=0)
            rows = [line for line in path.with_suffix(".txt").read_text().splitlines()
                    if not line.startswith("#")]
            path.with_suffix(".txt").write_text("\n".join(rows) + "\n")
            path.unlink()
        for name in ("hydrostatic.csv", "flow.csv"):
            path = bare / name
            path.write_text(path.read_text().replace(".gsf", ".txt"))
        done = run("measure", bare, "-o", self.folder / "bare_out", check_code=2)
        self.assertIn("instrument.height_unit", done.stderr)
        toml = (bare / "experiment.toml").read_text()
        scale = (f'[instrument]\nheight_unit = "m"\n'
                 f'pixel_pitch = ["{channel["pitch_x_m"]} m", "{channel["pitch_y_m"]} m"]\n')
        (bare / "experiment.toml").write_text(toml.replace("[instrument]\n", scale, 1))
        run("measure", bare, "-o", self.folder / "bare_out", check_code=0)
        for old, new in zip(self.pressures(self.out), self.pressures(self.folder / "bare_out")):
            # The text keeps the 24 bits of the .gsf to a few parts in 1e9 of a height.
            self.assertEqual(old == "", new == "")
            if old:
                self.assertAlmostEqual(float(old), float(new), delta=1e-3 + 1e-6 * abs(float(old)))

    @staticmethod
    def pressures(folder):
        with open(folder / "pressure.csv", newline="") as table:
            return [row["pressure_Pa"] for row in csv.DictReader(table)]

    def test_interruption_leaves_the_old_result_whole(self):
        out = self.folder / "stopped"
        run("measure", self.out / "experiment", "-o", out, check_code=0)
        before = hashes(out)
        statuses = set()
        for delay in (0.02, 0.1, 0.2, 0.3):
            process = subprocess.Popen([PROGRAM, "measure", str(self.out / "experiment"), "-o",
                                        str(out), "--threads", "1"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(delay)
            process.send_signal(signal.SIGINT)
            statuses.add(process.wait(timeout=60))
            self.assertEqual(hashes(out), before)
        self.assertLessEqual(statuses, {0, 130, -signal.SIGINT})
        self.assertTrue(statuses & {130, -signal.SIGINT}, statuses)

    def test_an_output_folder_that_cannot_be_made_is_named(self):
        blocked = self.folder / "file"
        blocked.write_text("not a folder")
        done = run("measure", self.out / "experiment", "-o", blocked / "out", check_code=2)
        self.assertIn("file", done.stderr)


if __name__ == "__main__":
    unittest.main()
