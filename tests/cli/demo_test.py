"""The commands demo and report.

Usage: demo_test.py PROGRAM [unittest arguments]
"""

import re
import shutil

from support import DemoFolder, hashes, run, main


class Demo(DemoFolder):
    def test_prints_p_of_x_and_where_the_report_is(self):
        self.assertIn("p(x) Q70 [Pa]", self.done.stdout)
        self.assertIn(str(self.out / "report.html"), self.done.stdout)
        self.assertRegex(self.done.stdout, r"QR by eq\. \(4\) is friction alone,")
        # A flow on the bulged section: what QR leaves out and what it has too much nearly cancel.
        [told] = re.findall(r"at Q70\s+it leaves out about\s+(\d+) Pa .* has about (\d+) Pa too much",
                            self.done.stdout, re.DOTALL)
        left_out, too_much = (int(number) for number in told)
        self.assertGreater(left_out, 500)
        self.assertLess(abs(left_out - too_much), 0.35 * left_out)
        for name in ("result.nc", "pressure.csv", "drops.csv", "report.html",
                     "experiment/experiment.toml", "experiment/truth/truth.csv"):
            self.assertTrue((self.out / name).is_file(), name)
        self.assertTrue(list((self.out / "figures").glob("*.svg")))

    def test_the_same_seed_makes_the_same_experiment_and_another_does_not(self):
        for seed in (1, 2):
            run("demo", "-o", self.folder / f"seed{seed}", "--seed", seed, check_code=0)
        first = hashes(self.folder / "seed1" / "experiment")
        self.assertEqual(first, hashes(self.out / "experiment"))
        self.assertNotEqual(first, hashes(self.folder / "seed2" / "experiment"))

    def test_report_is_made_again_from_the_result_alone(self):
        out = self.folder / "again"
        shutil.copytree(self.out, out)
        before = (out / "report.html").read_bytes()
        (out / "report.html").unlink()
        run("report", out, check_code=0)
        self.assertEqual((out / "report.html").read_bytes(), before)


if __name__ == "__main__":
    main()
