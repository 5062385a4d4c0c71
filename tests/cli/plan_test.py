"""manoscope plan: levels for a wish, and a scenario that goes on to twin, measure and judge."""

import json

from support import Folder, TAUT_MEMBRANE, hashes, main, run

MEMBRANE = TAUT_MEMBRANE + """[gauge]
noise = "10 Pa"
"""
FLOW = """[fluid]
viscosity = "1 mPa s"
density = "998 kg/m3"
[flow]
flow_rates = ["2 mL/min", "5 mL/min"]
outlet_pressure = "300 Pa"
"""


class Plan(Folder):
    def scenario(self, text=MEMBRANE, name="wall.toml"):
        path = self.folder / name
        path.write_text(text)
        return path

    def refused(self, *arguments):
        done = run("plan", *arguments, check_code=2)
        self.assertEqual(done.stdout, "")
        return done.stderr

    def test_a_wall_a_channel_and_a_wish_are_enough(self):
        done = run("plan", self.scenario(), "--lowest", "300Pa", "--highest", "8kPa",
                   "--uncertainty", "14Pa", "--resolution", "0.5mm", check_code=0)
        for words in ("taut: p(x) from 300 to 8000 Pa, calibrated by", "Levels [Pa]\n  0, ",
                      "log-spaced from 300 Pa", "evenly spaced", "What matters", "p(x) to 14 Pa: met",
                      "resolution 0.5 mm", "note: no [fluid]: water"):
            self.assertIn(words, done.stdout)

    def test_json_tells_levels_uncertainties_and_verdicts(self):
        told = json.loads(run("plan", self.scenario(MEMBRANE + FLOW), "--levels", "8", "--json",
                              check_code=0).stdout)
        self.assertEqual(sum(level["repeats"] for level in told["planned"]["levels"]), 8)
        self.assertEqual(told["planned"]["maps"], 8)
        self.assertEqual(told["planned"]["levels"][0], {"pressure_Pa": 0.0, "repeats": 1})
        pressures = [level["pressure_Pa"] for level in told["planned"]["levels"]]
        self.assertEqual(pressures, sorted(pressures))
        self.assertGreaterEqual(pressures[-1], told["range_Pa"][1])
        over = told["planned"]["uncertainty"]
        self.assertLessEqual(over["rms_Pa"], over["worst_Pa"])
        self.assertEqual([one["run"] for one in told["planned"]["runs"]], ["Q2", "Q5"])
        for other in told["others"]:
            self.assertGreaterEqual(other["uncertainty"]["rms_Pa"], 0.98 * over["rms_Pa"])
        names = [one["name"] for one in told["what_matters"]]
        self.assertIn("gauge noise halved", names)
        self.assertIsNone(told["output"])
        self.assertEqual(told["wall"]["readings"][0]["pressure_Pa"], told["range_Pa"][0])
        # The same again, on another number of threads.
        again = run("plan", self.scenario(MEMBRANE + FLOW), "--levels", "8", "--json", "--threads",
                    "1", check_code=0).stdout
        self.assertEqual(json.loads(again), told)

    def test_the_planned_scenario_goes_on_to_twin_measure_and_judge(self):
        out = self.folder / "planned.toml"
        done = run("plan", self.scenario(MEMBRANE + FLOW), "--levels", "8", "-o", out, check_code=0)
        self.assertIn(f"manoscope twin {out}", done.stderr)
        self.assertTrue(out.read_text().startswith("# taut: p(x) from "))
        run("twin", out, "-o", self.folder / "twin", check_code=0)
        run("measure", self.folder / "twin", "-o", self.folder / "result", "--nonlocal", "false",
            check_code=0)
        judged = json.loads(run("judge", self.folder / "result", self.folder / "twin", "--json",
                                check_code=0).stdout)
        self.assertEqual(len(judged["runs"]), 2)

    def test_a_file_that_stands_there_is_not_replaced_unasked(self):
        out = self.folder / "planned.toml"
        out.write_text("mine")
        before = hashes(self.folder)
        told = self.refused(self.folder / "none.toml", "-o", out)
        self.assertIn("none.toml", told)
        path = self.scenario()
        told = self.refused(path, "--highest", "8kPa", "--levels", "6", "-o", out)
        self.assertIn("stands there already", told)
        self.assertIn("--overwrite", told)
        path.unlink()
        self.assertEqual(hashes(self.folder), before)
        run("plan", self.scenario(), "--highest", "8kPa", "--levels", "6", "-o", out,
            "--overwrite", check_code=0)
        self.assertIn("scenario = 1", out.read_text())

    def test_a_plan_that_fails_leaves_no_file(self):
        out = self.folder / "planned.toml"
        self.refused(self.scenario(), "-o", out)
        self.assertFalse(out.exists())
        self.assertEqual([path.name for path in self.folder.iterdir()], ["wall.toml"])
        told = self.refused(self.scenario(), "--highest", "8kPa", "-o",
                            self.folder / "nowhere" / "planned.toml")
        self.assertIn("nowhere", told)

    def test_faults_are_told_with_their_mend(self):
        without_wall = MEMBRANE[:MEMBRANE.index("[wall]")] + MEMBRANE[MEMBRANE.index("[camera]"):]
        self.assertIn("wall", self.refused(self.scenario(without_wall), "--highest", "8kPa"))
        typed = self.scenario(MEMBRANE.replace("thickness", "thikness"))
        told = self.refused(typed, "--highest", "8kPa")
        self.assertIn('did you mean "thickness"', told)
        self.assertIn("no range of pressure", self.refused(self.scenario()))
        self.assertIn("--uncertainty", self.refused(self.scenario(), "--uncertainty", "5"))
        self.assertIn("did you mean \"rms\"", self.refused(self.scenario(), "--highest", "8kPa",
                                                          "--minimise", "rmss"))
        self.assertIn("half-width", self.refused(self.scenario(), "--highest", "50MPa"))
        self.assertIn("no scenario of that name", self.refused("S9", "--highest", "8kPa"))

    def test_quiet_shows_levels_and_verdicts_alone(self):
        done = run("plan", self.scenario(), "--highest", "8kPa", "--levels", "6", "--quiet",
                   check_code=0)
        self.assertIn("Levels [Pa]", done.stdout)
        self.assertNotIn("What matters", done.stdout)
        self.assertEqual(done.stderr, "")


if __name__ == "__main__":
    main()
