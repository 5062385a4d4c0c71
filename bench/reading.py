#!/usr/bin/env python3
"""The scipy side of the benchmark of the reading: p(x) of one run with its whole covariance.

Obeys compare.py line by line, as bench_reading does (see reading.cpp), whose INPUTS.json it reads.
All stations at once: curves by scipy's PchipInterpolator over the levels, in the coordinate that
our side chose; the reading by safeguarded Newton steps on its cubics; how a level moves the curve
by one-sided differences of the interpolant, for the three levels on either side alone that can;
covariance by one matrix product. What depends on the calibration alone is computed once a run.
"""
import json
import sys
import time

import numpy as np
from scipy.interpolate import PchipInterpolator

from reduction import peak_MB

STEP = 1e-6  # of the range, for differences
REACH = 2    # a PCHIP feels two knots on either side of an interval


def coordinate(pressure, scale):
    """u of p = p_s (u + u^3), by the formula of Cardano."""
    half = 0.5 * pressure / scale
    root = np.cbrt(half + np.sqrt(half * half + 1.0 / 27.0))
    return root - 1.0 / (3.0 * root)


class Calibration:
    def __init__(self, inputs):
        self.pressure = np.array(inputs["level_pressure_Pa"])
        self.scale = inputs["scale_Pa"]
        self.u = coordinate(self.pressure, self.scale)
        self.zeta = np.array([level["zeta_m"] for level in inputs["levels"]])  # (level, x)
        self.noise = np.array([level["noise_m"] for level in inputs["levels"]])
        self.modes = np.array([level["modes_m"] for level in inputs["levels"]])  # (level, mode, x)
        self.label_effect = np.array(inputs["label_effect_Pa"])
        self.curve = PchipInterpolator(self.u, self.zeta, axis=0)
        # How a change of one level's deflection or place moves every curve: as interpolants again.
        n = len(self.u)
        d_zeta, d_u = STEP * np.ptp(self.zeta), STEP * np.ptp(self.u)
        self.by_zeta, self.by_u = [], []
        for k in range(n):
            moved = self.zeta.copy()
            moved[k] += d_zeta
            self.by_zeta.append((PchipInterpolator(self.u, moved, axis=0).c - self.curve.c) / d_zeta)
            moved = self.u.copy()
            moved[k] += d_u
            self.by_u.append((PchipInterpolator(moved, self.zeta, axis=0), d_u))
        self.by_zeta = np.array(self.by_zeta)  # (level, 4, interval, x)

    def read(self, run):
        zeta = run["zeta_m"]
        n, m = self.zeta.shape
        column = np.arange(m)
        interval = np.clip((self.zeta < zeta).sum(axis=0) - 1, 0, n - 2)
        c = self.curve.c[:, interval, column]
        h = self.u[interval + 1] - self.u[interval]
        low, high = np.zeros(m), h.copy()
        t = 0.5 * h
        for _ in range(60):
            off = ((c[0] * t + c[1]) * t + c[2]) * t + c[3] - zeta
            slope = (3.0 * c[0] * t + 2.0 * c[1]) * t + c[2]
            high = np.where(off > 0.0, t, high)
            low = np.where(off > 0.0, low, t)
            newton = t - off / slope
            step = np.where((newton > low) & (newton < high), newton, 0.5 * (low + high))
            moved = np.abs(step - t).max()
            t = step
            if moved < 1e-13 * h.max():
                break
        u = self.u[interval] + t
        slope = (3.0 * c[0] * t + 2.0 * c[1]) * t + c[2]
        du_dp = 1.0 / (self.scale * (1.0 + 3.0 * u * u))
        inverse = 1.0 / (slope * du_dp)  # dp/dzeta
        powers = np.stack([t ** 3, t ** 2, t, np.ones(m)])
        weight = np.zeros((n, m))
        label = np.zeros((n, m))
        value = (c * powers).sum(axis=0)
        for k in range(n):
            near = np.flatnonzero((k >= interval - REACH + 1) & (k <= interval + REACH))
            if near.size == 0:
                continue
            weight[k, near] = (self.by_zeta[k][:, interval[near], near] * powers[:, near]).sum(axis=0)
            moved, d_u = self.by_u[k]
            inside = np.clip(np.searchsorted(moved.x, u[near], "right") - 1, 0, n - 2)
            at = u[near] - moved.x[inside]
            c_moved = moved.c[:, inside, near]
            there = ((c_moved[0] * at + c_moved[1]) * at + c_moved[2]) * at + c_moved[3]
            label[k, near] = (there - value[near]) / d_u
        by_level = weight * inverse
        level_du = 1.0 / (self.scale * (1.0 + 3.0 * self.u ** 2))
        by_label = -(label * level_du[:, None]) * inverse
        variance = (run["noise_m"] * inverse) ** 2 + ((by_level * self.noise) ** 2).sum(axis=0)
        effects = np.concatenate([run["modes_m"] * inverse,
                                  (-by_level[:, None, :] * self.modes).reshape(-1, m),
                                  self.label_effect.T @ by_label])
        covariance = effects.T @ effects
        covariance[np.diag_indices(m)] += variance
        return self.scale * (u + u ** 3), covariance


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        inputs = json.load(file)
    calibration = Calibration(inputs)
    run = {key: np.array(value) for key, value in inputs["run"].items()}
    pressure = covariance = None
    for line in sys.stdin:
        start, processor = time.perf_counter(), time.process_time()
        words = line.split()
        if words[0] == "read":
            pressure, covariance = calibration.read(run)
        else:
            middle = covariance[covariance.shape[0] // 2]
            with open(words[1], "w", encoding="utf-8") as file:
                json.dump({"pressure_Pa": pressure.tolist(),
                           "variance_Pa2": np.diagonal(covariance).tolist(),
                           "covariance_with_middle_Pa2": middle.tolist()}, file)
        print(json.dumps({"wall_s": time.perf_counter() - start,
                          "cpu_s": time.process_time() - processor, "peak_MB": peak_MB()}),
              flush=True)


if __name__ == "__main__":
    main()
