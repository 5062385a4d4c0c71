"""The command measure.

Usage: measure_test.py PROGRAM [unittest arguments]
"""

import csv
import json
import math
import re
import shutil
import signal
import subprocess
import time

from support import DemoFolder, PROGRAM, hashes, run, main


def measure(*words, **expected):
    """Reads each station on its own, in a third of the time: for what does not turn on the reading."""
    return run("measure", "--nonlocal", "false", *words, **expected)


def one_line(text):
    """Whatever lines it was broken to."""
    return " ".join(text.split())


class Measure(DemoFolder):
    def test_threads_change_no_byte(self):
        results = []
        for threads in (1, 2):
            out = self.folder / f"threads{threads}"
            run("measure", self.out / "experiment", "-o", out, "--threads", threads, check_code=0)
            results.append(hashes(out))
        self.assertEqual(results[0], results[1])

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

    def test_details_are_p_of_x_and_the_flow_of_every_run(self):
        out = self.folder / "printed"
        done = run("measure", self.out / "experiment", "-o", out, "--details", check_code=0)
        self.assertIn("± U, k = 2", done.stdout)
        by_model = done.stdout.split("By the flow model section-march\n")[1].split("\n\n")[0]
        for row in self.drops(out):
            self.assertIn(f"p(x) {row['run']} [Pa]", done.stdout)
            within = "within U" if float(row["en_number"]) <= 1.0 else "beyond U"
            # Beside it the verdict on eq. (4), its stated error in the bar.
            differs = float(row["paper_model_en_number"]) > 1.0
            verdict = "differs" if differs else "(agrees|only the drop)"
            self.assertRegex(done.stdout, rf"(?m)^{row['run']} .* {within} +{verdict}$")
            rate = float(row["inferred_flow_rate_m3_s"]) * 60e6
            [line] = [line for line in by_model.splitlines() if line.startswith(row["run"] + " ")]
            self.assertAlmostEqual(float(line.split()[1]), rate, delta=0.01 * rate)
        # The same numbers as the demo printed for the same maps.
        [line] = [line for line in self.done.stdout.splitlines() if re.match(r" *7\.7\d ", line)]
        self.assertIn(line, done.stdout)
        # The table of runs comes last of them: it stands next to where one types.
        self.assertGreater(done.stdout.index("dp_e ± U"), done.stdout.index("By the flow model"))

    def test_what_is_said_of_a_result_goes_to_standard_error(self):
        out = self.folder / "said"
        done = measure(self.out / "experiment", "-o", out, check_code=0)
        self.assertIn("result in", done.stderr)
        self.assertNotIn("result in", done.stdout)
        self.assertNotRegex(done.stdout, r"p\(x\) \S+ \[Pa\]")
        quiet = measure(self.out / "experiment", "-o", out, "--quiet", check_code=0)
        self.assertEqual(quiet.stderr, "")
        self.assertTrue(done.stdout.startswith(quiet.stdout))
        self.assertIn("agrees", quiet.stdout)
        self.assertNotIn("Checks", quiet.stdout)
        self.assertNotIn("dp_e ±",
                         measure(self.out / "experiment", "-o", out, "--json", check_code=0).stdout)

    def test_measure_tells_what_the_flow_models_say(self):
        out = self.folder / "models"
        runs = json.loads(measure(self.out / "experiment", "-o", out, "--json",
                                  check_code=0).stdout)["runs"]
        drops = self.drops(out)
        self.assertEqual(len(runs), len(drops))
        for run_, row in zip(runs, drops):
            self.assertEqual(run_["verdict"], row["verdict"])
            models = {model["name"]: model for model in run_["models"]}
            march = models["section-march"]
            for key in ("drop_Pa", "drop_uncertainty_Pa", "en_number", "p_value"):
                column = f"section_march_model_{key}"
                self.assertEqual(march[key], float(row[column]) if row[column] else None)
            # Each effect is what it adds to those before it: together they are the march's drop.
            effects = {effect["name"]: effect["drop_Pa"] for effect in run_["corrections"]}
            self.assertAlmostEqual(sum(effects.values()), march["drop_Pa"],
                                   delta=1e-6 * march["drop_Pa"])
            self.assertAlmostEqual(effects["mean-gap rectangle"], models["paper"]["drop_Pa"],
                                   delta=1e-6 * march["drop_Pa"])
            for key in ("inferred_flow_rate_m3_s", "inferred_flow_rate_uncertainty_m3_s",
                        "compliant_drop_Pa", "compliant_drop_uncertainty_Pa", "predicted_drop_Pa",
                        "predicted_drop_uncertainty_Pa",
                        "predicted_en_number", "friction_drag_N", "relative_friction_drag",
                        "reduced_reynolds", "parasitic_drop_uncertainty_Pa"):
                self.assertEqual(run_[key], float(row[key]) if row[key] else None, key)
            for key in ("inferred_viscosity_uncertainty_Pa_s", "transducer_drop_uncertainty_Pa",
                        "compliant_drop_uncertainty_Pa"):
                self.assertGreater(run_[key], 0.0, key)

    def test_a_drop_without_a_known_noise_has_no_uncertainty(self):
        folder = self.folder / "no_noise"
        shutil.copytree(self.out / "experiment", folder)
        toml = folder / "experiment.toml"
        toml.write_text(re.sub(r"pressure_drop_uncertainty.*\n", "", toml.read_text()))
        out = self.folder / "no_noise_out"
        told = json.loads(measure(folder, "-o", out, "--json", check_code=0).stdout)
        self.assertEqual(told["uncertainties"], "standard, k = 1")
        for run_, row in zip(told["runs"], self.drops(out)):
            self.assertGreater(run_["compliant_drop_Pa"], 0.0)
            for key in ("compliant_drop_uncertainty_Pa", "predicted_en_number"):
                self.assertEqual(row[key], "")
                self.assertIsNone(run_[key])
            self.assertIsNone(run_["transducer_drop_uncertainty_Pa"])

    def test_one_table_has_drops_and_verdict_of_every_run(self):
        # The demo prints the same table of its own measurement.
        table = "dp_e ± U" + self.done.stdout.split("dp_e ± U")[1].split("\n\n")[0]
        self.assertTrue(all(len(line) <= 80 for line in table.splitlines()), table)
        for row in self.drops(self.out):
            [line] = [line for line in table.splitlines() if line.startswith(row["run"] + " ")]
            en, p = row["section_march_model_en_number"], row["section_march_model_p_value"]
            word = ("no verdict" if en == "" else "differs" if float(en) > 1.0 else
                    "agrees" if float(p) >= 0.01 else "only the drop")
            self.assertRegex(line, rf"  {word}\*?$")
            self.assertIn(f"  {float(en):.2f}  " if en else " - ", line)
            for drop in ("extracted_drop", "section_march_model_drop"):
                bar = 2.0 * float(row[f"{drop}_uncertainty_Pa"])
                digits = max(0, 1 - math.floor(math.log10(bar)))
                self.assertRegex(re.sub(" +", " ", line),
                                 rf" {float(row[f'{drop}_Pa']):.{digits}f} ± {bar:.{digits}f} ")

    @staticmethod
    def drops(folder):
        with open(folder / "drops.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_measure_tells_its_checks_and_what_to_improve_first(self):
        out = self.folder / "checks"
        done = measure(self.out / "experiment", "-o", out, check_code=0)
        for line in ("Checks without truth", "Leaving one level out: rms ", "Cross-sections of the",
                     "Improve first: "):
            self.assertIn(line, done.stdout)
        self.assertTrue(all(len(line) <= 80 for line in done.stdout.splitlines()), done.stdout)
        told = json.loads(measure(self.out / "experiment", "-o", out, "--json", check_code=0).stdout)
        self.assertEqual({"left_out", "shapes", "repeats", "sweeps"}, set(told["checks"]))
        self.assertGreater(told["checks"]["left_out"]["rms_Pa"], 0.0)
        maps = [entry["map"] for entry in told["checks"]["shapes"]]
        self.assertEqual(len(maps), len(set(maps)))
        self.assertEqual({"pressure", "extracted_drop"}, set(told["improve_first"]))
        advice = told["improve_first"]["pressure"]
        self.assertIn(advice["source"], one_line(done.stdout))
        # Half of a source leaves a quarter of its variance.
        self.assertAlmostEqual(advice["bars_shrink_if_halved"],
                               1.0 - (1.0 - 0.75 * advice["share_of_variance"]) ** 0.5, delta=1e-12)

    def test_a_result_is_replaced_by_its_own_experiment_alone(self):
        out = self.folder / "kept"
        first = measure(self.out / "experiment", "-o", out, check_code=0)
        self.assertNotIn("replaced", first.stderr)
        before = hashes(out)
        again = measure(self.out / "experiment", "-o", out, check_code=0)
        self.assertIn("the earlier one is replaced", again.stderr)
        self.assertEqual(hashes(out), before)
        other = self.renamed("other")
        refused = measure(other, "-o", out, check_code=2)
        self.assertIn("another experiment's result stands there", refused.stderr)
        self.assertIn("--overwrite", refused.stderr)
        self.assertEqual((refused.stdout, hashes(out)), ("", before))
        run("demo", "-o", out, check_code=0)  # of the same name as its experiment
        measure(other, "-o", out, "--overwrite", check_code=0)
        self.assertNotEqual(hashes(out), before)
        self.assertIn("another experiment's", run("demo", "-o", out, check_code=2).stderr)
        self.assertIn("--overwrite", run("measure", "--help", check_code=0).stdout)

    def test_uncertainty_of_fluid_and_pump_widen_that_of_qr(self):
        before = json.loads(measure(self.out / "experiment", "-o", self.folder / "plain", "--json",
                                    check_code=0).stdout)["runs"]
        wide = self.renamed("fluid_and_pump")
        path = wide / "experiment.toml"
        text = path.read_text().replace("[fluid]\n", '[fluid]\nviscosity_uncertainty = "0.03 mPa s"\n')
        path.write_text(text.replace("[instrument]\n", "[instrument]\nflow_rate_uncertainty = 0.04\n"))
        self.assertIn('viscosity = "1 mPa s"', text)
        out = self.folder / "wide_out"
        after = json.loads(measure(wide, "-o", out, "--json", check_code=0).stdout)["runs"]
        for old, new in zip(before, after):
            qr, u = old["resistance_drop_Pa"], old["resistance_drop_uncertainty_Pa"]
            # 3 % and 4 % of QR are 5 % of it.
            self.assertAlmostEqual(new["resistance_drop_uncertainty_Pa"],
                                   (u * u + (0.05 * qr) ** 2) ** 0.5, delta=1e-8 * qr)
            self.assertLess(new["en_number"], old["en_number"])
        told = measure(wide, "-o", out, "--details", check_code=0).stdout
        self.assertIn("U(QR) holds gap, deflection, flow rate and viscosity.", one_line(told))
        self.assertIn("flow rate and viscosity count as exact", one_line(self.done.stdout))

    def test_a_place_left_out_of_the_file_is_found_from_the_maps(self):
        found = self.folder / "found"
        shutil.copytree(self.out / "experiment", found)
        path = found / "experiment.toml"
        kept = [line for line in path.read_text().splitlines()
                if not re.match(r"\s*(origin|flow|outward|rotation)\s*=", line)]
        path.write_text("\n".join(kept) + "\n")
        measure(found, "-o", self.folder / "found_out", check_code=0)
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
        done = measure(bare, "-o", self.folder / "bare_out", check_code=2)
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
        measure(self.out / "experiment", "-o", out, check_code=0)
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
        done = measure(self.out / "experiment", "-o", blocked / "out", check_code=2)
        self.assertIn("file", done.stderr)


if __name__ == "__main__":
    main()
