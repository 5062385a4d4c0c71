#!/usr/bin/env python3
"""Tests of what accuracy_table.py works out by itself: python3 tools/accuracy_table_test.py"""

import random
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
import accuracy_table


class TableOne(unittest.TestCase):
    def test_what_lies_within_the_bounds_passes(self):
        self.assertEqual(accuracy_table.table_one_faults("S1", (71, 1225), 33.9), [])
        self.assertEqual(accuracy_table.table_one_faults("S3", (248, 1276), 34.1), [])
        self.assertEqual(accuracy_table.table_one_faults("S1b", (1, 2), 3.0), [])

    def test_what_has_left_them_is_named_with_its_numbers(self):
        fault, = accuracy_table.table_one_faults("S1", (71, 1225), 34.1)
        self.assertIn("S1: largest deflection 34.10 um, +3.3 %", fault)
        low, high = accuracy_table.table_one_faults("S4", (185, 845), 86.0)
        self.assertIn("lowest Reynolds number 185", low)
        self.assertIn("highest Reynolds number 845", high)
        self.assertEqual(len(accuracy_table.table_one_faults("S3", (248, 1276), 33.9)), 1)
        self.assertEqual(len(accuracy_table.table_one_faults("S2", (99, 1229), float("nan"))), 1)


class Power(unittest.TestCase):
    def test_a_power_law_without_noise_is_found_exactly(self):
        points = [(p, 0.01 * p, 1e-6 * p ** (1 / 3), 1e-9) for p in (1e3, 3e3, 1e4, 5e4)]
        self.assertAlmostEqual(accuracy_table.power(points)[0], 1 / 3, places=12)

    def test_its_uncertainty_is_the_scatter_of_many_draws(self):
        random.seed(3)
        pulls = []
        for _ in range(400):
            points = []
            for p in (5e3, 8e3, 13e3, 20e3, 31e3, 50e3):
                label = p * (1.0 + 0.01 * random.gauss(0, 1))
                z = 1e-6 * p ** 0.4 * (1.0 + 0.005 * random.gauss(0, 1))
                points.append((label, 0.01 * label, z, 0.005 * z))
            slope, uncertainty = accuracy_table.power(points)
            pulls.append((slope - 0.4) / uncertainty)
        # Five standard errors of a mean and a variance of 400 normal numbers.
        self.assertAlmostEqual(sum(pulls) / 400, 0.0, delta=5 / 20)
        self.assertAlmostEqual(sum(pull ** 2 for pull in pulls) / 400, 1.0, delta=5 * (2 / 400) ** .5)


if __name__ == "__main__":
    unittest.main()
