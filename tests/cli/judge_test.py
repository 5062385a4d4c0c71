"""The command judge.

Usage: judge_test.py PROGRAM [unittest arguments]
"""

import csv
import json
import re
import shutil

from support import DemoFolder, hashes, run, main


class Judge(DemoFolder):
    def test_measures_what_is_true(self):
        judged = json.loads(run("judge", self.out, self.out / "experiment", "--json",
                                check_code=0).stdout)["runs"]
        self.assertEqual(len(judged), 4)
        for run_ in judged:
            # Labels carry 10 Pa each; one station leans on two to four of them and on its own noise.
            self.assertLess(run_["rms_error_Pa"], max(20.0, 0.01 * run_["true_drop_Pa"]), run_)
            self.assertLess(abs(run_["drop_pull"]), 4.0, run_)

    def test_judge_leaves_tables_and_figures(self):
        out = self.folder / "verdict"
        run("judge", self.out, self.out / "experiment", "-o", out, check_code=0)
        names = ["judge.csv", "judge.json", "judge_deflections.csv"]
        if shutil.which("gnuplot"):
            names += [f"figures/judge_error_run0{i}.svg" for i in range(1, 5)]
            names += ["figures/judge_pulls.svg", "figures/judge_along.svg",
                      "figures/judge_coverage.svg"]
        self.assertEqual(sorted(hashes(out)), sorted(names))
        before = hashes(out)
        (out / "figures").mkdir(exist_ok=True)
        (out / "figures/judge_error_run99.svg").write_text("of an earlier result")
        (out / "figures/mine.svg").write_text("not ours")
        run("judge", self.out, self.out / "experiment", "-o", out, check_code=0)
        self.assertEqual(hashes(out).keys(), before.keys() | {"figures/mine.svg"})
        for name, value in before.items():
            self.assertEqual(hashes(out)[name], value, name)
        self.assertNotIn("stations", json.loads((out / "judge.json").read_text())["runs"][0])

    def test_judge_says_where_the_error_came_from_or_why_not(self):
        text = run("judge", self.out, self.out / "experiment", check_code=0).stdout
        self.assertIn("Where the error came from: rms (largest), Pa", text)
        self.assertIn("do not add in squares", text)
        truth = self.out / "experiment/truth/truth.csv"
        self.assertIn("tells of runs only", run("judge", self.out, truth, check_code=0).stdout)
        told = json.loads(run("judge", self.out, truth, "--json", check_code=0).stdout)
        self.assertIn("tells of runs only", told["split_not_offered"])
        self.assertIsNone(told["runs"][0]["split"])

    def test_judge_prints_the_worst_deflections_or_all_and_the_verdict_last(self):
        text = run("judge", self.out, self.out / "experiment", check_code=0).stdout
        self.assertIn("shape + locality", text)
        self.assertRegex(text, r"all \(4 runs, 24 levels\)")
        self.assertEqual(len(re.findall(r"(?m)^ *[\d.]+ Pa ", text)) +
                         len(re.findall(r"(?m)^ *Q\d+  +[+-]", text)), 3)
        last = text.rstrip().splitlines()
        self.assertTrue(last[-2].startswith("Verdict: p(x) of 4 run(s) errs by "), last)
        # A screen of 40 lines shows the whole verdict.
        self.assertLess(len(last), 40)
        every = run("judge", self.out, self.out / "experiment", "--all", check_code=0).stdout
        self.assertEqual(len(re.findall(r"(?m)^ *[\d.]+ Pa ", every)), 24)
        out = self.folder / "deflections"
        run("judge", self.out, self.out / "experiment", "-o", out, check_code=0)
        with open(out / "judge_deflections.csv", newline="") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual([row["kind"] for row in rows], ["run"] * 4 + ["level"] * 24)
        told = json.loads((out / "judge.json").read_text())
        for row, entry in zip(rows, told["runs"] + told["levels"]):
            rms = entry["deflection"]["rms_error_m"]
            self.assertAlmostEqual(float(row["rms_error_m"]), rms, delta=1e-8 * rms)

    def test_judge_names_a_folder_that_cannot_be_written(self):
        blocked = self.folder / "blocked"
        blocked.write_text("not a folder")
        for out in (blocked, blocked / "verdict"):
            done = run("judge", self.out, self.out / "experiment", "-o", out, check_code=2)
            self.assertIn("blocked", done.stderr)
            self.assertEqual(done.stdout, "")
        (self.folder / "taken/judge.csv").mkdir(parents=True)
        done = run("judge", self.out, self.out / "experiment", "-o", self.folder / "taken",
                   check_code=2)
        self.assertIn("judge.csv", done.stderr)
        self.assertEqual(hashes(self.folder / "taken"), {})


if __name__ == "__main__":
    main()
