#!/usr/bin/env python3
"""Tests of coverage_table.py on small tables."""

import json
import unittest

import test_support

COLUMNS = ("base,wall,seed,run,stretch,label_noise_Pa,n_levels,n_along,nonlocal,drop_Pa,n_answered,"
           "n_silent,rms_Pa,largest_Pa,mean_Pa,pull_mean,pull_rms,coverage_68,coverage_95,"
           "within_band,budget\n")


def row(base, seed, pull, coverage, rms=4.0, stretch="inside", band="", budget="labels=9;noise=16"):
    return (f"{base},0,{seed},Q5,{stretch},10,24,512,1,8000,300,0,{rms},9,1,0.1,{pull},0.7,"
            f"{coverage},{band},{budget}\n")


class CoverageTable(test_support.CampaignTable):
    script, columns = "coverage_table.py", COLUMNS

    def test_means_are_over_experiments_and_pulls_are_root_mean_squares(self):
        self.campaign(row("S1", 1, 1.0, 1.0), row("S1", 1, 1.0, 1.0), row("S1", 2, 2.0, 0.5),
                      "S1,0,2,done,\n")
        inside = json.loads(self.ask("--json"))["inside"]
        self.assertEqual(inside["experiments"], 2)
        self.assertEqual(inside["runs"], 3)
        self.assertAlmostEqual(inside["coverage_95"], 0.75)
        self.assertAlmostEqual(inside["pull_rms"], 2.5 ** 0.5)
        self.assertAlmostEqual(inside["median_of_goal"], 0.8)  # 4 of max(5, 0.05 % of 8 kPa) Pa

    def test_the_page_gets_the_tables_between_its_markers(self):
        self.campaign(row("S1", 1, 1.0, 1.0), row("S4", 1, 1.0, 0.9),
                      row("S4", 1, 1.0, 0.9, stretch="whole", band="1", budget=""))
        text = self.page_between("<!-- begin generated -->", "<!-- end generated -->")
        self.assertIn("| labels | 3.0 | 3.0 | 3.0 |", text)
        self.assertIn("| all | 5.0 | 5.0 | 5.0 |", text)
        self.assertIn("in the simultaneous band, % |", text)

    def test_faults_are_told(self):
        self.campaign()
        self.assertIn("holds no run", self.ask(fails=True))
        self.campaign(row("S1", 1, 1.0, 1.0))
        self.assertIn("has no column colour", self.ask("--by", "colour", fails=True))


if __name__ == "__main__":
    unittest.main()
