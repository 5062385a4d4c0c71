"""The split of a difference into outlet, side walls and rest."""

import unittest

import side_walls


def flow(mean, read=None, bar=1.0):
    x = [0.0, 1e-3, 2e-3]
    return {"run": "Q5", "x_m": x, "mean_pressure_Pa": mean, "outlet_pressure_Pa": 10.0,
            "read_pressure_Pa": read or [None, 120.0, 60.0],
            "read_pressure_uncertainty_Pa": [None, bar, bar],
            "mean_pressure_uncertainty_Pa": [2.0, 2.0, 2.0], "test_section_m": [1e-3, 2e-3]}


class SideWalls(unittest.TestCase):
    plane, whole = flow([150.0, 100.0, 50.0]), flow([165.0, 110.0, 55.0])

    def test_parts_add_up_to_the_difference(self):
        part = side_walls.parts(self.plane, self.whole, 1.5e-3)
        self.assertEqual(part["read"], 90.0)
        self.assertEqual(part["gap"], 90.0 - 65.0)
        self.assertEqual(part["walls"], 7.5)
        self.assertAlmostEqual(part["gap"], part["outlet"] + part["walls"] + part["left"])

    def test_a_missing_neighbour_is_no_value(self):
        self.assertIsNone(side_walls.at(self.plane, "read_pressure_Pa", 0.5e-3))

    def test_table_has_a_row_a_place(self):
        text = side_walls.table({"Q5": self.plane}, {"Q5": self.whole})
        self.assertEqual(len(text.splitlines()), 2 + len(side_walls.PLACES))
        self.assertIn("| Q5 | 1.5 mm | 90 ± 2 | +25 | +10 | +8 | +8 ± 4 |", text)

    def test_script_draws_every_run(self):
        script = side_walls.script_of({"Q5": self.plane, "Q70": self.plane},
                                      {"Q5": self.whole, "Q70": self.whole})
        self.assertEqual(script.count("plot $run"), 2)
        self.assertIn("NaN", script)


if __name__ == "__main__":
    unittest.main()
