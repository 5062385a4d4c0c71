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
        self.assertRegex(self.done.stdout, r"QR by eq\. \(4\) is friction alone\.")
        # The fluid's gain of speed is most of what QR lacks at the highest flow rate.
        [told] = re.findall(r"at Q70 about (\d+) Pa over the section, where dp_e - QR is\s+(-?\d+) Pa",
                            self.done.stdout)
        self.assertLess(abs(int(told[0]) - int(told[1])), 0.35 * int(told[1]))
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
