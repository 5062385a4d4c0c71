"""manoscope predict: flow rates that were not run."""

import csv
import json

from support import DemoFolder, main, run


class Predict(DemoFolder):
    def predict(self, *arguments, check_code=0):
        return run("predict", self.out / "experiment", *arguments, check_code=check_code)

    def truth(self):
        with open(self.out / "experiment" / "truth" / "truth_scalars.csv", encoding="utf-8") as file:
            return {float(row["Q_ml_min"]): float(row["dp_compliant_Pa"])
                    for row in csv.DictReader(file)}

    def test_a_flow_rate_that_was_run_is_met(self):
        table = self.folder / "predicted.csv"
        done = self.predict("--flow-rate", "20 mL/min,40 mL/min", "--flow-rate", "55mL/min",
                            "--json", "-o", table)
        flows = json.loads(done.stdout)
        self.assertEqual([round(flow["flow_rate_m3_s"] * 60e6, 6) for flow in flows],
                         [20, 40, 55])
        for flow, flow_rate in zip(flows, (20, 40)):
            self.assertAlmostEqual(flow["drop_Pa"] / self.truth()[flow_rate], 1, delta=0.02)
            self.assertGreater(flow["drop_uncertainty_Pa"], 0)
            self.assertEqual(len(flow["x_m"]), len(flow["pressure_Pa"]))
            self.assertEqual(len(flow["x_m"]), len(flow["deflection_m"]))
            self.assertAlmostEqual(flow["pressure_Pa"][0] - flow["pressure_Pa"][-1],
                                   flow["drop_Pa"], places=6)
        self.assertGreater(flows[2]["drop_Pa"], flows[1]["drop_Pa"])
        with open(table, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), sum(len(flow["x_m"]) for flow in flows))
        self.assertEqual(float(rows[0]["pressure_Pa"]), flows[0]["pressure_Pa"][0])

    def test_the_table_says_what_was_taken(self):
        done = self.predict("--flow-rate", "30mL/min", "--outlet-pressure", "400Pa")
        for text in ("Predicted from the calibration", "Flow model section-march",
                     "Pressure at the outlet: as given", "crest 1.5"):
            self.assertIn(text, done.stdout)
        self.assertIn("U leaves out, since no uncertainty is stated: the viscosity, the flow rate.",
                      done.stdout)
        short = self.predict("--flow-rate", "30mL/min", "--quiet")
        self.assertEqual(len(short.stdout.splitlines()), 3)

    def test_what_cannot_be_predicted_is_refused(self):
        for arguments, text in (
                ((), "--flow-rate"),
                (("--flow-rate", "30"), "unit"),
                (("--flow-rate", "30 Pa"), "flow"),
                (("--flow-rate=-30 mL/min",), "positive"),
                (("--flow-rate", "30mL/min", "--model", "momentun"), "momentum"),
                (("--flow-rate", "900mL/min", "--model", "paper"), "at most"),
        ):
            done = self.predict(*arguments, check_code=2)
            self.assertEqual(done.stdout, "")
            self.assertIn(text, done.stderr)


if __name__ == "__main__":
    main()
