#!/usr/bin/env python3
"""Tests of verdict_table.py on small tables."""

import json
import unittest

import test_support

COLUMNS = ("base,wall,seed,run,reduced_reynolds,flow_rate_mL_min,difference,en_number,p_value,"
           "agreement,wrong_difference,wrong_en_number,wrong_p_value,wrong_agreement,"
           "inferred_error,inferred_pull,predicted_error,predicted_pull,model,wrong_model,silent\n")


def row(base, seed, run="Q5", reduced="0.5", en="0.3", tail="0.4", wrong_en="3", wrong_tail="1e-9",
        inferred=("0.01", "1"), predicted=("0.01", "1"), models="section-march,paper"):
    return (f"{base},0,{seed},{run},{reduced},5,0.003,{en},{tail},agree,-0.08,{wrong_en},"
            f"{wrong_tail},differ,{','.join(inferred)},{','.join(predicted)},{models},\n")


class VerdictTable(test_support.CampaignTable):
    script, columns = "verdict_table.py", COLUMNS

    def test_alarms_are_by_the_drop_and_along_x_and_count_once(self):
        self.campaign(row("S1", 1, en="1.2", tail="1e-3"), row("S1", 2), row("S1", 3, tail="1e-3"),
                      row("S1", 4, wrong_en="0.9", wrong_tail="0.02"), "S1,0,4,done,\n")
        every = json.loads(self.ask("--json"))["all"]
        self.assertEqual((every["experiments"], every["runs"], every["no_verdict"]), (4, 4, 0))
        self.assertAlmostEqual(every["false_drop"], 0.25)
        self.assertAlmostEqual(every["false_along"], 0.5)
        self.assertAlmostEqual(every["false"], 0.5)
        self.assertAlmostEqual(every["caught"], 0.75)
        self.assertAlmostEqual(every["wrong_en_least"], 0.9)
        self.assertEqual((every["chosen"], every["wrong_chosen"]), (1.0, 0.0))

    def test_a_gap_is_caught_along_x_as_well(self):
        self.campaign(row("S1", 1, wrong_en="0.9", wrong_tail="1e-3"))
        self.assertEqual(json.loads(self.ask("--json"))["all"]["caught"], 1.0)

    def test_runs_of_an_experiment_are_one_and_what_is_not_told_is_counted(self):
        self.campaign(row("S1", 1, inferred=("0.01", "1")), row("S1", 1, inferred=("0.01", "1")),
                      row("S1", 2, inferred=("-0.03", "-3"), predicted=("", "")),
                      row("S3", 1, reduced="", en="", tail="", wrong_en="", wrong_tail="",
                          inferred=("", ""), predicted=("", "")))
        found = json.loads(self.ask("--json"))
        rate = found["S1"]["flow_rate"]
        self.assertAlmostEqual(rate["rms"], (0.5 * (1e-4 + 9e-4)) ** 0.5)
        self.assertAlmostEqual(rate["within_2_percent"], 0.5)
        self.assertAlmostEqual(rate["coverage_95"], 0.5)
        self.assertAlmostEqual(rate["pull_rms"], 5.0 ** 0.5)
        self.assertEqual(found["S1"]["drop"]["silent"], 1)
        self.assertEqual(found["all"]["no_verdict"], 1)
        self.assertEqual(found["S3"]["flow_rate"], {"runs": 0, "silent": 1})

    def test_the_page_gets_the_tables_between_its_markers(self):
        self.campaign(row("S1", 1), row("S4", 1, reduced="2", en="1.1"), row("S4", 2, reduced="4"))
        text = self.page_between("<!-- begin verdicts -->", "<!-- end verdicts -->")
        self.assertIn("Of 3 experiments with 2 walls:", text)
        self.assertIn("| Re h/l 1 to 3 | 1 | 1 (0) | 100.0 | 0.0 |", text)
        self.assertIn("| S1 | 1 (0) | 1.00 | 100.0 | 100.0 | 1.00 ± nan |", text)

    def test_faults_are_told(self):
        self.campaign()
        self.assertIn("holds no run", self.ask(fails=True))
        self.campaign(row("S1", 1))
        page = self.write("page.md", "no markers\n")
        self.assertIn("lacks the lines", self.ask("--page", str(page), fails=True))


if __name__ == "__main__":
    unittest.main()
