#!/usr/bin/env python3
"""The numpy side of the benchmark of the one-pass reduction: what maps::LinearPass does, vectorised.

Obeys compare.py line by line, as bench_linear does (see linear.cpp). Everything that depends on the
grid alone is computed once a run, not once a map; a map without a missing pixel costs one test for
it, one conversion to double and three matrix products with BLAS.
"""
import json
import sys
import time

import numpy as np

from reduction import LARGEST_GAP, NO_DATA, SMALLEST_COVERAGE, Geometry, peak_MB


def read_gsf(path):
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"\0")
    fields = dict(line.split(" = ", 1) for line in data[:end].decode().splitlines()[1:])
    nx, nz = int(fields["XRes"]), int(fields["YRes"])
    return np.frombuffer(data, "<f4", nx * nz, end + 4 - end % 4).reshape(nz, nx)


class Linear:
    """What all maps of one camera share."""

    def __init__(self, inputs):
        shape = inputs["nz"], inputs["nx"]
        g = self.g = Geometry(shape, inputs["pitch_x_m"], inputs["pitch_z_m"], inputs)
        half = 0.5 * g.width
        self.a, self.b = (g.x - g.x_centre) / g.scale_x, g.z / g.scale_z
        # The rim as four rectangles, each with its a and the rows 1 and b.
        full = g.rim.all(axis=1)
        rows, columns = np.flatnonzero(~full), np.flatnonzero(~g.rim[np.argmin(full)])
        above, below = slice(rows[0]), slice(rows[-1] + 1, None)
        middle, every = slice(rows[0], rows[-1] + 1), slice(None)
        self.blocks = [((z, x), self.a[x], np.stack([np.ones(shape[0])[z], self.b[z]]))
                       for z, x in ((above, every), (below, every),
                                    (middle, slice(columns[0])),
                                    (middle, slice(columns[-1] + 1, None)))]
        weight = g.inner_weight.copy()
        for outer, inner, limit in ((0, 1, -half), (-1, -2, half)):
            span = abs(g.nodes[inner] - g.nodes[outer])
            inside = abs(g.nodes[inner] - limit)
            weight[outer] += 0.5 * inside * inside / span
            weight[inner] += inside - 0.5 * inside * inside / span
        self.weight = weight / g.width
        self.normal = self._normal(*np.nonzero(g.rim))
        self.height = np.empty(shape)  # used again for every map

    def _normal(self, iz, ix):
        design = np.stack([np.ones(iz.size), self.a[ix], self.b[iz]])
        return design @ design.T

    def reduce(self, pixels):
        g = self.g
        height = self.height
        height[...] = pixels
        normal, bad = self.normal, None
        good = np.isfinite(pixels)
        if not good.all():
            bad = np.nonzero(~good)
            height[bad] = 0.0
            on_rim = g.rim[bad]
            normal = normal - self._normal(bad[0][on_rim], bad[1][on_rim])
        columns = self.weight @ height[g.low:g.high + 1]
        right, squares = np.zeros(3), 0.0
        for block, a, rows in self.blocks:
            part = height[block]
            total, b_total = rows @ part
            right += total.sum(), a @ total, b_total.sum()
            squares += np.einsum("ij,ij->", part, part)
        c = np.linalg.solve(normal, right)
        variance = max(0.0, squares - c @ right) / (normal[0, 0] - 3.0)
        unscale = 1.0 / np.array([1.0, g.scale_x, g.scale_z])
        offset, tilt_x, tilt_z = c * unscale
        covariance = variance * np.linalg.inv(normal) * np.outer(unscale, unscale)

        n = g.columns.size
        zeta = columns[g.columns]
        measured = np.full(n, self.weight.sum())
        mean_z = np.full(n, self.weight @ g.nodes)
        squares = np.full(n, self.weight @ self.weight)
        sixth, flags = np.zeros(n), np.zeros(n, int)
        if bad is not None:
            self._bridge(height, ~good, zeta, measured, mean_z, squares, sixth, flags)
        x = g.x[g.columns]
        zeta -= (offset + tilt_x * (x - g.x_centre)) * measured + tilt_z * mean_z
        independent = np.sqrt(squares * variance + (zeta / g.width ** 3) ** 2 * sixth)
        for values in (zeta, independent, measured, mean_z):
            values[flags != 0] = 0.0
        design = np.stack([measured, measured * (x - g.x_centre), mean_z], axis=1)
        modes = np.column_stack([design @ np.linalg.cholesky(covariance),
                                 zeta * (g.pitch_z / g.width) ** 2])
        return {"x_m": x, "zeta_m": zeta, "independent": independent, "modes": modes,
                "flags": flags, "noise_m": np.sqrt(variance)}

    def _bridge(self, height, missing, zeta, measured, mean_z, squares, sixth, flags):
        """What missing pixels change, in the columns that have one; see width_average()."""
        g, half = self.g, 0.5 * self.g.width
        missing = missing[g.low:g.high + 1, g.columns[0]:g.columns[-1] + 1]
        hit = np.flatnonzero(missing.any(axis=0))
        if hit.size == 0:
            return
        missing = missing[:, hit]
        top = missing.shape[0] - 1
        inside = (~missing[1:-1]).sum(axis=0)
        edge = [missing[0] | missing[1], missing[-1] | missing[-2]]
        absent = missing.copy()
        absent[0], absent[-1] = edge  # a good pixel beyond the edge is of no use there
        change = np.where(absent, -self.weight[:, None], 0.0)
        # Runs of absent pixels: their first and last, in the order of the columns.
        padded = np.zeros((hit.size, top + 3), bool)
        padded[:, 1:-1] = absent.T
        turn = padded[:, 1:] != padded[:, :-1]
        k, r = np.nonzero(turn)
        lower, upper, k = r[::2] - 1, r[1::2], k[::2]
        low_edge, high_edge = lower < 0, upper > top
        whole = low_edge & high_edge
        lower, upper, k = lower[~whole], upper[~whole], k[~whole]
        low_edge, high_edge = low_edge[~whole], high_edge[~whole]
        z_low = np.where(low_edge, -half, g.nodes[np.maximum(lower, 0)])
        z_high = np.where(high_edge, half, g.nodes[np.minimum(upper, top)])
        gap = z_high - z_low
        by = 0.5 * (gap - g.pitch_z) / g.width
        np.add.at(change, (lower[~low_edge], k[~low_edge]), by[~low_edge])
        np.add.at(change, (upper[~high_edge], k[~high_edge]), by[~high_edge])
        # Next to an edge the node gives up its share of the interval that the edge cuts.
        for at_edge, node, cut in ((low_edge, upper, 1), (high_edge, lower, top - 1)):
            near = at_edge & (node == cut)
            change[node[near], k[near]] += g.pitch_z / g.width - self.weight[cut]
        weight = self.weight[:, None] + change
        part = height[g.low:g.high + 1, g.columns[0]:g.columns[-1] + 1][:, hit]
        zeta[hit] += np.einsum("ij,ij->j", change, part)
        measured[hit] = weight.sum(axis=0)
        mean_z[hit] = g.nodes @ weight
        squares[hit] = np.einsum("ij,ij->j", weight, weight)
        wide = gap >= 1.5 * g.pitch_z
        np.add.at(sixth, hit[k[wide]], gap[wide] ** 6)
        bad = inside * g.pitch_z / g.width < SMALLEST_COVERAGE
        bad[k[gap > max(LARGEST_GAP * g.width, 2.5 * g.pitch_z)]] = True
        flags[hit[bad]] = NO_DATA


def as_json(reduced):
    result = {key: value.tolist() for key, value in reduced.items()}
    result["uncertainty_m"] = np.sqrt(reduced["independent"] ** 2 +
                                      (reduced["modes"] ** 2).sum(axis=1)).tolist()
    for name in ("independent", "modes"):
        del result[name]
    return result


def reduce_all(inputs, what):
    linear = Linear(inputs)
    shape = inputs["nz"], inputs["nx"]
    read = read_gsf if what == "gsf" else lambda path: np.fromfile(path, "<f4").reshape(shape)
    return [linear.reduce(read(path)) for path in inputs[what]]


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        inputs = json.load(file)
    last = []
    for line in sys.stdin:
        order = line.split()
        wall, cpu = time.perf_counter(), time.process_time()
        if order[:1] == ["reduce"]:
            last = reduce_all(inputs, order[1])
        elif order[:1] == ["save"]:
            with open(order[1], "w", encoding="utf-8") as file:
                json.dump([as_json(result) for result in last], file)
        else:
            sys.exit(f"unknown order: {line}")
        print(json.dumps({"wall_s": time.perf_counter() - wall,
                          "cpu_s": time.process_time() - cpu, "peak_MB": peak_MB()}), flush=True)


if __name__ == "__main__":
    main()
