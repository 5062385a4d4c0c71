#!/usr/bin/env python3
"""Tests of tools/long_tests.py."""

import pathlib
import re
import tempfile
import unittest

import long_tests


class LongTests(unittest.TestCase):
    COSTS = {"A.Quick": 0.1, "A.Long": 3.0, 'Of/B.Long/"S1"': 2.0, "B.LongButKept": 9.0}

    def test_finds_the_long_ones_alone(self):
        found = re.compile(long_tests.expression(self.COSTS, 1.0, "Kept$"))
        self.assertEqual([name for name in self.COSTS if found.search(name)],
                         ["A.Long", 'Of/B.Long/"S1"'])

    def test_finds_none_where_none_is_long_or_known(self):
        for costs in ({}, {"A.Quick": 0.1}):
            self.assertEqual(long_tests.expression(costs, 1.0, ""), long_tests.NONE)

    def test_reads_what_ctest_keeps(self):
        with tempfile.TemporaryDirectory() as build:
            self.assertEqual(long_tests.read_costs(build), {})
            folder = pathlib.Path(build, "Testing", "Temporary")
            folder.mkdir(parents=True)
            (folder / "CTestCostData.txt").write_text("A.Quick 2 0.25\nA b/c 1 4\n---\nA.Failed\n",
                                                      encoding="utf-8")
            self.assertEqual(long_tests.read_costs(build), {"A.Quick": 0.25, "A b/c": 4.0})


if __name__ == "__main__":
    unittest.main()
