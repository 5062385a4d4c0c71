#!/usr/bin/env python3
"""Tests of model_error_figure.py."""

import unittest

import model_error_figure as figure


def row(sample, flow_rate, reduced, model, error, drop, stated=""):
    return {"sample": sample, "flow_rate_mL_min": str(flow_rate), "reduced_reynolds": str(reduced),
            "model": model, "largest_error_percent": str(error), "section_drop_percent": str(drop),
            "stated_percent": str(stated)}


ROWS = [row("S1", 70, 8.0, "momentum", 5.5, 3.9), row("S1", 4, 0.5, "momentum", 0.25, -0.2),
        row("S1", 30, 3.0, "momentum", 2.0, 1.0), row("S1", 4, 0.5, "paper", 1.7, 2.5)]


class ModelErrorFigure(unittest.TestCase):
    def test_curves_ascend(self):
        self.assertEqual(figure.numbers_of(ROWS, "S1", "momentum"),
                         [(0.5, 0.25), (3.0, 2.0), (8.0, 5.5)])
        self.assertEqual(figure.numbers_of(ROWS, "S2", "momentum"), [])

    def test_the_script_holds_every_number(self):
        script = figure.script_of(ROWS)
        self.assertIn("$momentum_S1 << EOD\n0.5 0.25\n3 2\n8 5.5\nEOD", script)
        self.assertNotIn("S2 <<", script)

    def test_the_table_has_lowest_and_highest_flow_rate(self):
        lines = figure.table_of(ROWS).splitlines()
        self.assertEqual(len(lines), 4)
        self.assertIn("| S1 | 4 | 0.5 | 1.7 (+2.5) | - | 0.25 (-0.2) | - | - | - |", lines[2])
        self.assertIn("| S1 | 70 | 8 | - | - | 5.5 (+3.9) |", lines[3])

    def test_errors_beyond_what_the_model_states_are_found(self):
        within = row("S1", 4, 0.5, "momentum", 0.5, 0.1, 0.6)
        beyond = row("S1", 70, 8.0, "momentum", 6.5, 4.0, 6.4)
        self.assertEqual(figure.beyond_stated([*ROWS, within, beyond]), [beyond])

    def test_the_page_keeps_what_stands_around(self):
        page = f"a\n{figure.BEGIN}\nold\n{figure.END}\nb\n"
        self.assertEqual(figure.replaced(page, "new"),
                         f"a\n{figure.BEGIN}\n\nnew\n\n{figure.END}\nb\n")


if __name__ == "__main__":
    unittest.main()
