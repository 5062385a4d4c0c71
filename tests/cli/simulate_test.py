"""manoscope simulate: Navier-Stokes in a given shape."""

import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import unittest

from support import PROGRAM, Folder, main, run

SOLVER = pathlib.Path(PROGRAM).parent / "manoscope-navier-stokes"
CHANNEL = ("--height", "175um", "--width", "1.7mm", "--flow-rate", "5mL/min")


class Simulate(Folder):
    def shape(self, zeta_um=33.0):
        """A bulge, as a table in millimetres and micrometres."""
        path = self.folder / "shape.csv"
        length = 15.5
        with open(path, "w", encoding="utf-8") as file:
            file.write("x [mm],zeta [um]\n")
            for i in range(201):
                x = length * i / 200
                zeta = (zeta_um * (1 - 0.6 * x / length) * (1 - math.exp(-x / 0.6))
                        * (1 - math.exp(-(length - x) / 0.6)))
                file.write(f"{x:.6f},{zeta:.9f}\n")
        return path

    def map(self, askew=0.0, dent_um=0.0):
        """The same bulge as a map, a parabola across, seen by a camera whose rows are 17 um."""
        path = self.folder / f"map_{askew}_{dent_um}.csv"
        length, rows = 15.5, 100
        with open(path, "w", encoding="utf-8") as file:
            file.write("x [mm],z [mm],zeta [um]\n")
            for i in range(201):
                x = length * i / 200
                mean = (33.0 * (1 - 0.6 * x / length) * (1 - math.exp(-x / 0.6))
                        * (1 - math.exp(-(length - x) / 0.6)))
                for k in range(rows):
                    s = (2 * k + 1) / rows - 1
                    zeta = 1.5 * mean * (1 - s * s) * (1 + askew * s)
                    if dent_um and i == 100 and k == 30:
                        zeta = dent_um
                    file.write(f"{x:.6f},{0.85 * s:.6f},{zeta:.9f}\n")
        return path

    def test_what_is_missing_or_wrong_is_said(self):
        shape = self.shape()
        for arguments, text in (
                ((), "--shape"),
                (("--shape", shape), "--height"),
                (("--shape", shape, "--height", "175"), "unit"),
                (("--shape", shape, *CHANNEL, "--dim", "4"), "--dim"),
                (("--shape", shape, *CHANNEL, "--inlet", "slanted"), "developed"),
        ):
            done = run("simulate", *arguments, check_code=2)
            self.assertEqual(done.stdout, "")
            self.assertIn(text, done.stderr)

    def test_without_the_solver_it_says_what_to_install(self):
        program = self.folder / "manoscope"
        shutil.copy(PROGRAM, program)
        program.chmod(0o755)
        done = subprocess.run([program, "simulate", "--shape", self.shape(), *CHANNEL], text=True,
                              capture_output=True, env={"PATH": "/nowhere"}, timeout=60,
                              check=False)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("make simulation", done.stderr)

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    def test_a_plane_flow_is_solved(self):
        table, picture = self.folder / "p.csv", self.folder / "flow.vtu"
        done = run("simulate", "--shape", self.shape(), *CHANNEL, "--json", "-o", table,
                   "--vtu", picture, "--stations", "11", check_code=0)
        flow = json.loads(done.stdout)
        self.assertEqual(flow["dim"], 2)
        self.assertTrue(flow["converged"])
        # An independent solution of this shape has 1212.455 Pa.
        self.assertAlmostEqual(flow["drop_Pa"] / 1212.455, 1, delta=5e-4)
        self.assertLess(flow["drop_numerical_uncertainty_Pa"], 1e-3 * flow["drop_Pa"])
        self.assertEqual(len(flow["x_m"]), 11)
        self.assertAlmostEqual(flow["mean_pressure_Pa"][0], flow["drop_Pa"], places=6)
        self.assertAlmostEqual(flow["mean_pressure_Pa"][-1], 0, places=6)
        self.assertGreater(flow["wall_shear_Pa"][5], 0)
        for name in ("unknowns", "seconds", "peak_MB"):
            self.assertGreater(flow[name], 0)
        with open(table, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 11)
        self.assertAlmostEqual(float(rows[3]["wall_pressure_Pa"]), flow["wall_pressure_Pa"][3],
                               places=4)
        self.assertIn(b"UnstructuredGrid", picture.read_bytes()[:400])

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    def test_the_terminal_shows_drop_and_stations(self):
        arguments = ("simulate", "--shape", self.shape(), *CHANNEL, "--cells-along", "20",
                     "--cells-up", "3")
        done = run(*arguments, check_code=0)
        self.assertIn("Navier-Stokes, 2-D: drop 12", done.stdout)
        self.assertIn("p wall [Pa]", done.stdout)
        short = run(*arguments, "--quiet", check_code=0)
        self.assertEqual(len(short.stdout.splitlines()), 1)
        doubtful = run(*arguments, "--tolerance", "1e-9", check_code=0)
        self.assertIn("NOT CONVERGED", doubtful.stdout)
        self.assertIn("--cells-along", doubtful.stderr)

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    def test_a_gap_that_closes_is_the_users_fault(self):
        done = run("simulate", "--shape", self.shape(-300.0), *CHANNEL, check_code=2)
        self.assertIn("gap", done.stderr)
        self.assertEqual(done.stdout, "")

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    @unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed")
    def test_two_processes_answer_as_one_does(self):
        # Two may be more than there are cores, and containers run tests as root.
        environment = os.environ | {
            "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_rmaps_base_oversubscribe": "1"}
        for mesh in (("--cells-along", "20", "--cells-up", "3"),
                     ("--dim", "3", "--cells-along", "8", "--cells-up", "2", "--cells-across", "3")):
            flows = []
            for starter in ((), ("mpirun", "-n", "2")):
                done = subprocess.run([*starter, SOLVER, self.shape(), *CHANNEL, *mesh,
                                       "--stations", "5"], text=True, capture_output=True,
                                      env=environment, timeout=300, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                flows.append(json.loads(done.stdout))
            one, two = flows
            self.assertEqual((one["processes"], two["processes"]), (1, 2))
            self.assertEqual(one["unknowns"], two["unknowns"])
            for name in ("drop_Pa", "coarse_drop_Pa"):
                self.assertAlmostEqual(two[name] / one[name], 1, delta=1e-9)
            for name in ("mean_pressure_Pa", "wall_pressure_Pa"):
                for alone, shared in zip(one[name], two[name], strict=True):
                    self.assertAlmostEqual(alone, shared, delta=1e-9 * one["drop_Pa"])
            for name in ("wall_shear_Pa", "floor_shear_Pa"):
                for alone, shared in zip(one[name], two[name], strict=True):
                    self.assertAlmostEqual(alone, shared, delta=1e-9 * max(one[name]))


    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    def test_a_map_is_the_roof_in_three_dimensions_and_its_mean_in_two(self):
        solve = lambda *arguments: json.loads(  # noqa: E731
            run("simulate", *CHANNEL, "--json", *arguments, check_code=0).stdout)
        plane = ("--cells-along", "40", "--cells-up", "4")
        whole = ("--dim", "3", "--cells-along", "20", "--cells-up", "2", "--cells-across", "4")
        shape, roof = self.shape(), self.map()
        for cells, kind in ((plane, ""), (whole, "map")):
            by_shape = solve("--shape", shape, *cells)
            by_map = solve("--shape", roof, *cells)
            # Between the rows the map is known to spacing^4, at the sides by two rows.
            self.assertAlmostEqual(by_map["drop_Pa"] / by_shape["drop_Pa"], 1, delta=2e-5)
            self.assertEqual(by_map["roof_across"], kind)
        self.assertLess(by_map["roof_odd_m"], 1e-9)
        self.assertLess(by_map["roof_misfit"], 1e-3)
        askew = self.map(askew=0.2)
        told = run("simulate", *CHANNEL, "--shape", askew, *whole, check_code=0)
        self.assertIn("what is odd across", told.stdout)
        # Its even part is the parabola, and half the channel is solved.
        half = solve("--shape", askew, *whole)
        self.assertAlmostEqual(half["drop_Pa"] / by_map["drop_Pa"], 1, delta=1e-9)
        self.assertGreater(half["roof_odd_m"], 1e-6)

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    def test_a_map_that_cannot_be_is_the_users_fault(self):
        for arguments, text in (
                (("--shape", self.map(dent_um=-200.0)), "x = 7.75 mm, z = -0.3315 mm"),
                (("--shape", self.map(), "--wall-shape", "1,-2,1"), "beside a map"),
                (("--shape", self.map(), "--wall-shape", "response"), "experiment"),
                (("--shape", self.map(), "--width", "2.4mm"), "side to side"),
                (("--shape", self.shape(), "--wall-shape", "map"), "column z"),
        ):
            done = run("simulate", *CHANNEL[:2], *CHANNEL[4:], "--dim", "3",
                       *(("--width", "1.7mm") if "--width" not in arguments else ()), *arguments,
                       check_code=2)
            self.assertIn(text, done.stderr)
            self.assertEqual(done.stdout, "")


if __name__ == "__main__":
    main()
