#!/usr/bin/env python3
"""Tests of coverage_table.py on small tables."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(__file__).with_name("coverage_table.py")
COLUMNS = ("base,wall,seed,run,stretch,label_noise_Pa,n_levels,n_along,nonlocal,drop_Pa,n_answered,"
           "n_silent,rms_Pa,largest_Pa,mean_Pa,pull_mean,pull_rms,coverage_68,coverage_95,"
           "within_band,budget\n")


def row(base, seed, pull, coverage, rms=4.0, stretch="inside", band="", budget="labels=9;noise=16"):
    return (f"{base},0,{seed},Q5,{stretch},10,24,512,1,8000,300,0,{rms},9,1,0.1,{pull},0.7,"
            f"{coverage},{band},{budget}\n")


class CoverageTable(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = pathlib.Path(self.folder.name) / "campaign.csv"

    def ask(self, *options, fails=False):
        done = subprocess.run([sys.executable, PROGRAM, self.file, *options], text=True,
                              capture_output=True, check=False)
        self.assertEqual(done.returncode != 0, fails, done.stderr)
        return done.stderr if fails else done.stdout

    def test_means_are_over_experiments_and_pulls_are_root_mean_squares(self):
        self.file.write_text(COLUMNS + row("S1", 1, 1.0, 1.0) + row("S1", 1, 1.0, 1.0) +
                             row("S1", 2, 2.0, 0.5) + "S1,0,2,done,\n")
        inside = json.loads(self.ask("--json"))["inside"]
        self.assertEqual(inside["experiments"], 2)
        self.assertEqual(inside["runs"], 3)
        self.assertAlmostEqual(inside["coverage_95"], 0.75)
        self.assertAlmostEqual(inside["pull_rms"], 2.5 ** 0.5)
        self.assertAlmostEqual(inside["median_of_goal"], 0.8)  # 4 of max(5, 0.05 % of 8 kPa) Pa

    def test_the_page_gets_the_tables_between_its_markers(self):
        self.file.write_text(COLUMNS + row("S1", 1, 1.0, 1.0) + row("S4", 1, 1.0, 0.9) +
                             row("S4", 1, 1.0, 0.9, stretch="whole", band="1", budget=""))
        page = pathlib.Path(self.folder.name) / "page.md"
        page.write_text("above\n<!-- begin generated -->\nold\n<!-- end generated -->\nbelow\n")
        self.ask("--page", str(page))
        text = page.read_text()
        self.assertTrue(text.startswith("above\n") and text.endswith("\nbelow\n"))
        self.assertNotIn("old", text)
        self.assertIn("| labels | 3.0 | 3.0 | 3.0 |", text)
        self.assertIn("| all | 5.0 | 5.0 | 5.0 |", text)
        self.assertIn("in the simultaneous band, % |", text)

    def test_faults_are_told(self):
        self.file.write_text(COLUMNS)
        self.assertIn("holds no run", self.ask(fails=True))
        self.file.write_text(COLUMNS + row("S1", 1, 1.0, 1.0))
        self.assertIn("has no column colour", self.ask("--by", "colour", fails=True))


if __name__ == "__main__":
    unittest.main()
