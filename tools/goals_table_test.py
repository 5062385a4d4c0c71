#!/usr/bin/env python3
"""Tests of goals_table.py on small tables."""

import io
import json
import pathlib
import tempfile
import unittest
from contextlib import redirect_stdout

import goals_table
from coverage_table_test import COLUMNS, row


def document(*tests):
    return {"testsuites": [{"name": "AllProblems/NistStrd",
                            "testsuite": [{"name": f"Fits/{k}", "result": "COMPLETED", **test}
                                          for k, test in enumerate(tests)]}]}


class GoalsTable(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("bench.json", {"reading": {"manoscope": {"cpu_s": 0.011}, "ratio_cpu": 3.0}})
        self.write("tests.json", document({"parameter_digits_from_start_1": "7.5"},
                                          {"pixel_part_over_limit_inside": "1.1", "sample": "S1"}))
        self.campaign(row("S1", 1, 1.0, 0.95), row("S1", 2, 1.0, 0.95), row("S1b", 1, 9.0, 0.0, 90.0),
                      *(row("S1", seed, 1.0, 0.96, stretch=stretch)
                        for stretch in ("inlet", "whole", "drop") for seed in (1, 2)))

    def write(self, name, content):
        (self.folder / name).write_text(json.dumps(content), encoding="utf-8")

    def campaign(self, *rows):
        (self.folder / "campaign.csv").write_text(COLUMNS + "".join(rows), encoding="utf-8")

    def table(self, *options):
        out = io.StringIO()
        with redirect_stdout(out):
            goals_table.main([str(self.folder / name)
                              for name in ("campaign.csv", "bench.json", "tests.json")] + list(options))
        return out.getvalue()

    def test_each_goal_is_reached_or_missed(self):
        text = self.table()
        self.assertIn("| at most 20 ms | 11.0 ms | reached |", text)
        self.assertIn("| 10 times as fast | 3.0 times | missed |", text)
        self.assertIn("| 54 of 54 | 1 of 1 | missed |", text)
        self.assertIn("| at most 1.15 | S1 1.10 | reached |", text)
        self.assertIn("| at most 1 | S1 0.80 | reached |", text)  # 4 Pa of max(5 Pa, 0.05 % of 8 kPa)
        self.assertIn("| 93 to 97 % | 96.0 ± 0.0 % | reached |", text)

    def test_a_wall_that_snaps_is_left_out_of_the_worst(self):
        self.assertIn("| at most 1 | 0.44 | reached |", self.table())  # 4 Pa of max(9 Pa, 0.1 %)

    def test_what_was_skipped_or_failed_is_no_success(self):
        self.write("tests.json", document({"parameter_digits_from_start_1": "7.5", "result": "SKIPPED"}))
        self.assertNotIn("NIST", self.table())

    def test_the_page_gets_the_table_between_its_markers(self):
        page = self.folder / "page.md"
        page.write_text(f"above\n{goals_table.BEGIN}\nold\n{goals_table.END}\nbelow\n", encoding="utf-8")
        self.table("--page", str(page))
        text = page.read_text(encoding="utf-8")
        self.assertTrue(text.startswith("above\n") and text.endswith("below\n"))
        self.assertNotIn("old", text)
        self.assertIn("| what | goal | measured | |", text)


if __name__ == "__main__":
    unittest.main()
