"""The commands init and check.

Usage: check_test.py PROGRAM [unittest arguments]
"""

import csv
import json
import re
import shutil

from support import DemoFolder, run, main


class Check(DemoFolder):
    def test_a_draft_asks_for_what_only_the_user_knows(self):
        maps = self.folder / "maps"
        maps.mkdir()
        for index, level in enumerate((0, 500, 1000, 2000)):
            shutil.copy(self.out / f"experiment/h{index:02d}.gsf", maps / f"x_{level}Pa.gsf")
        run("init", maps, check_code=0)
        told = run("check", maps, check_code=2).stderr
        self.assertRegex(told, r"instrument\.pressure_noise.*placeholder.*\"10 Pa\".*"
                               r"\"0 Pa\" claims an exact gauge")
        self.assertRegex(told, r"channel\.width.*like \"1\.7 mm\"")
        self.assertRegex(told, r"channel\.height.*like \"175 um\"")
        path = maps / "experiment.toml"
        text = path.read_text()
        for old, new in (("? mm", "15.5 mm"), ("? mm", "1.7 mm"), ("? um", "175 um"),
                         ("? Pa", "10 Pa")):
            text = text.replace(old, new, 1)
        path.write_text(text)
        self.assertEqual(run("check", maps, check_code=0).stderr, "")

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

    def test_labels_without_uncertainty_are_warned_of_once(self):
        bare = self.renamed("bare_labels")
        with open(bare / "hydrostatic.csv", newline="") as table:
            rows = list(csv.DictReader(table))
        lines = [f"{row['map']},{row['pressure [Pa]']}" for row in rows]
        (bare / "hydrostatic.csv").write_text("\n".join(["map,pressure [Pa]"] + lines) + "\n")
        path = bare / "experiment.toml"
        toml = path.read_text()
        path.write_text(re.sub(r"(?m)^pressure_noise = .*\n", "", toml))
        done = run("check", bare, check_code=0)
        self.assertIn("No pressure label has an uncertainty", done.stderr)
        self.assertIn("no fault found", done.stdout)
        self.assertEqual(run("check", bare, "--quiet", check_code=0).stderr, "")
        [doubt] = json.loads(run("check", bare, "--json", check_code=0).stdout)["warnings"]
        self.assertIn("instrument.pressure_noise", doubt)
        out = self.folder / "bare_labels_out"
        done = run("measure", bare, "-o", out, check_code=0)
        # Beside notes on single maps, whose cross-sections are looked at whatever the labels.
        notes = [line for line in done.stderr.splitlines()
                 if line.startswith("note:") and "cross-section" not in line]
        self.assertEqual(len(notes), 1, notes)
        self.assertIn("No pressure label has an uncertainty", notes[0])
        self.assertIn("No pressure label has an uncertainty", (out / "report.html").read_text())
        path.write_text(toml)  # with instrument.pressure_noise, and no column
        self.assertEqual(json.loads(run("check", bare, "--json").stdout)["warnings"], [])


if __name__ == "__main__":
    main()
