"""manoscope simulate: Navier-Stokes in a given shape."""

import csv
import json
import math
import os
import pathlib
import resource
import shutil
import subprocess
import time
import unittest
import xml.etree.ElementTree

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

    def solve_by(self, n_processes, *arguments, shape=None):
        """The solver alone, or under mpirun."""
        starter = () if n_processes == 1 else ("mpirun", "-n", str(n_processes))
        # Two may be more than there are cores, and containers run tests as root.
        environment = os.environ | {
            "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_rmaps_base_oversubscribe": "1"}
        return subprocess.run([*starter, SOLVER, shape or self.shape(), *CHANNEL, *arguments],
                              text=True, capture_output=True, env=environment, timeout=300,
                              check=False)

    def test_what_is_missing_or_wrong_is_said(self):
        shape = self.shape()
        for arguments, text in (
                ((), "--shape"),
                (("--shape", shape), "--height"),
                (("--shape", shape, "--height", "175"), "unit"),
                (("--shape", shape, *CHANNEL, "--dim", "4"), "--dim"),
                (("--shape", shape, *CHANNEL, "--inlet", "slanted"), "developed"),
                (("--shape", shape, *CHANNEL, "-o", "p.csv", "--csv", "q.csv"), "--csv"),
                (("--shape", shape, *CHANNEL, "--smoothing", "50um"), "--smoothing"),
        ):
            done = run("simulate", *arguments, check_code=2)
            self.assertEqual(done.stdout, "")
            self.assertIn(text, done.stderr)

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    def test_files_that_cannot_be_written_are_told_before_the_solution(self):
        nowhere = self.folder / "none" / "flow.csv"
        # Cells for an hour.
        mesh = ("--cells-along", "8000", "--cells-up", "300")
        for option in ("-o", "--csv", "--vtu"):
            done = run("simulate", "--shape", self.shape(), *CHANNEL, *mesh, option, nowhere,
                       check_code=2)
            self.assertIn(str(nowhere), done.stderr)
            self.assertEqual(done.stdout, "")
        done = subprocess.run([SOLVER, self.shape(), *CHANNEL, *mesh, "--vtu", nowhere], text=True,
                              capture_output=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("none", json.loads(done.stdout)["error"]["where"])

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    def test_a_fault_of_the_solver_is_told_in_its_words(self):
        # Corners of the coarser mesh alone take more than that.
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))  # noqa: E731
        arguments = ("--shape", self.shape(), *CHANNEL, "--cells-along", "10000", "--cells-up",
                     "10000")
        done = subprocess.run([PROGRAM, "simulate", *map(str, arguments)], text=True,
                              capture_output=True, preexec_fn=limit, timeout=120, check=False)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("take fewer cells", done.stderr)
        self.assertEqual(done.stdout, "")

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
        # Beyond laminar flow that is told beside it.
        fast = run("simulate", "--shape", self.shape(), "--height", "175um", "--width", "1.7mm",
                   "--flow-rate", "120mL/min", "--cells-along", "20", "--cells-up", "3",
                   "--tolerance", "1e-9", check_code=0)
        self.assertIn("turbulent", fast.stderr)
        self.assertIn("--cells-along", fast.stderr)

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    def test_a_gap_that_closes_is_the_users_fault(self):
        done = run("simulate", "--shape", self.shape(-300.0), *CHANNEL, check_code=2)
        self.assertIn("gap", done.stderr)
        self.assertEqual(done.stdout, "")

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    @unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed")
    def test_two_processes_answer_as_one_does(self):
        for mesh in (("--cells-along", "20", "--cells-up", "3"),
                     ("--dim", "3", "--cells-along", "8", "--cells-up", "3", "--cells-across", "3")):
            flows = []
            for n in (1, 2):
                done = self.solve_by(n, *mesh, "--stations", "5")
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
    @unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed")
    def test_two_processes_go_on_where_one_was_stopped(self):
        mesh = ("--dim", "3", "--cells-along", "16", "--cells-up", "3", "--cells-across", "3",
                "--solver", "iterative", "--stations", "5", "--flow-rate", "40mL/min")
        folder = self.folder / "a & b"
        folder.mkdir()
        state, coarse = folder / "flow", folder / "flow.coarse"
        alone = json.loads(self.solve_by(1, *mesh).stdout)
        child = subprocess.Popen([SOLVER, self.shape(), *CHANNEL, *mesh, "--checkpoint", state],
                                 stdout=subprocess.DEVNULL)
        deadline = time.monotonic() + 120
        while not coarse.exists() and child.poll() is None and time.monotonic() < deadline:
            time.sleep(0.002)
        child.kill()
        child.wait()
        self.assertTrue(coarse.exists(), "ended before it was stopped")
        picture = folder / "flow & more.vtu"
        done = self.solve_by(2, *mesh, "--checkpoint", state, "--vtu", picture)
        self.assertEqual(done.returncode, 0, done.stderr)
        two = json.loads(done.stdout)
        self.assertLess(two["newton_steps"], alone["newton_steps"])
        # Systems are solved to 1e-6 of their right-hand side, and Newton's method squares the rest.
        for name in ("drop_Pa", "coarse_drop_Pa"):
            self.assertAlmostEqual(two[name] / alone[name], 1, delta=1e-7)
        # The checkpoints are gone; the picture's pieces are named by an index that is XML.
        self.assertEqual(sorted(path.name for path in folder.iterdir()),
                         ["flow & more.pvtu", "flow & more_0.vtu", "flow & more_1.vtu"])
        pieces = xml.etree.ElementTree.parse(picture.with_suffix(".pvtu")).iter("Piece")
        self.assertEqual([piece.get("Source") for piece in pieces],
                         ["flow & more_0.vtu", "flow & more_1.vtu"])

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    @unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed")
    def test_two_processes_tell_a_fault_as_one_does(self):
        lost = self.folder / "lost"
        lost.mkdir()
        for zeta_um, options, text in (
                (-300.0, (), "gap"),
                (33.0, ("--stations", "1"), "--stations"),
                (33.0, ("--checkpoint", lost), "lost"),
                (33.0, ("--vtu", lost / "none" / "flow.vtu"), "none"),
        ):
            done = self.solve_by(2, "--cells-along", "12", "--cells-up", "3", *options,
                                 shape=self.shape(zeta_um))
            self.assertEqual(done.returncode, 2, done.stderr)
            error = json.loads(done.stdout)["error"]
            self.assertIn(text, error["where"] + error["found"])

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    @unittest.skipUnless(shutil.which("mpirun"), "mpirun is not installed")
    def test_manoscope_starts_several_processes(self):
        done = run("simulate", "--shape", self.shape(), *CHANNEL, "--cells-along", "20",
                   "--cells-up", "3", "--processes", "2", "--json", check_code=0)
        self.assertEqual(json.loads(done.stdout)["processes"], 2)

    @unittest.skipUnless(SOLVER.exists(), "manoscope-navier-stokes is not built")
    def test_a_map_is_the_roof_in_three_dimensions_and_its_mean_in_two(self):
        solve = lambda *arguments: json.loads(  # noqa: E731
            run("simulate", *CHANNEL, "--json", *arguments, check_code=0).stdout)
        plane = ("--cells-along", "40", "--cells-up", "4")
        whole = ("--dim", "3", "--cells-along", "20", "--cells-up", "3", "--cells-across", "4")
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
