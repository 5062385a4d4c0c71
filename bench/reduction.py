#!/usr/bin/env python3
"""The numpy side of the reduction benchmark: the same work as maps::reduce_map() and
maps::register_maps(), vectorised.

Obeys compare.py line by line, as bench_reduction does (see reduction.cpp). Everything that depends
on the grid alone (rim, coordinates, width weights) is computed once a run, not once a map.
"""
import hashlib
import json
import sys
import time

import numpy as np

import registration

NO_DATA = 1
MAD = 1.482602218505602
TUKEY = 4.685
SPIKE_THRESHOLD, SPIKE_MARGIN = 6.0, 1.3
LARGEST_GAP, SMALLEST_COVERAGE = 0.1, 0.5
REACH = 4  # columns either side, for the slope along x


def median(values):
    """Median; `values` is reordered."""
    middle = values.size // 2
    values.partition(middle)
    if values.size % 2:
        return values[middle]
    return 0.5 * (values[middle] + values[:middle].max())


def mad_sigma(values):
    return MAD * median(np.abs(values))


def read_gsf(data):
    """Heights (nz, nx) in m as double, and the pitches."""
    end = data.index(b"\0")
    fields = dict(line.split(" = ", 1) for line in data[:end].decode().splitlines()[1:])
    nx, nz = int(fields["XRes"]), int(fields["YRes"])
    heights = np.frombuffer(data, "<f4", nx * nz, end + 4 - end % 4).reshape(nz, nx)
    return heights.astype(float), float(fields["XReal"]) / nx, float(fields["YReal"]) / nz


class Geometry:
    """What all maps of one camera share."""

    def __init__(self, shape, pitch_x, pitch_z, inputs):
        self.length, self.width = inputs["length_m"], inputs["width_m"]
        self.shape, self.pitch_x, self.pitch_z = shape, pitch_x, pitch_z
        nz, nx = shape
        self.x = (np.arange(nx) + 0.5) * pitch_x - inputs["origin_x_m"]
        self.z = (np.arange(nz) + 0.5) * pitch_z - inputs["origin_z_m"] - 0.5 * self.width
        half = 0.5 * self.width
        widest = max(-self.x[0], self.x[-1] - self.length, -self.z[0] - half, self.z[-1] - half)
        margin = min(max(3 * max(pitch_x, pitch_z), 0.02 * self.width), 0.5 * max(0.0, widest))
        channel = np.outer(np.abs(self.z) < half + margin,
                           (self.x > -margin) & (self.x < self.length + margin))
        self.rim = ~channel
        self.rim_index = np.flatnonzero(self.rim)
        self.x_centre = 0.5 * (self.x[0] + self.x[-1])
        self.scale_x = 0.5 * (self.x[-1] - self.x[0])
        self.scale_z = max(abs(self.z[0]), abs(self.z[-1]))
        iz, ix = np.unravel_index(self.rim_index, shape)
        self.a = (self.x[ix] - self.x_centre) / self.scale_x
        self.b = self.z[iz] / self.scale_z
        # Width average: rows inside the channel, one more on either side.
        self.columns = np.flatnonzero((self.x >= 0) & (self.x <= self.length))
        inside = np.flatnonzero((self.z > -half) & (self.z < half))
        self.low, self.high = inside[0] - 1, inside[-1] + 1
        self.n_inside = inside.size
        nodes = self.z[self.low:self.high + 1]
        weight = np.zeros(nodes.size)
        weight[1:-2] += 0.5 * np.diff(nodes[1:-1])
        weight[2:-1] += 0.5 * np.diff(nodes[1:-1])
        self.nodes, self.inner_weight = nodes, weight
        self.patch = self._crest_patch()
        self.stretches = registration.Stretches(self.x, pitch_x, self.length, self.width)

    def _crest_patch(self):
        reach_x = max(0.025 * self.width, 1.01 * self.pitch_x)
        reach_z = max(0.1 * self.width, 2.51 * self.pitch_z)
        a, b = (self.x - 0.5 * self.length) / reach_x, self.z / reach_z
        rows, columns = np.flatnonzero(np.abs(b) <= 1), np.flatnonzero(np.abs(a) <= 1)
        window = np.s_[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1]
        b, a = np.meshgrid(b[rows], a[columns], indexing="ij")
        return window, np.stack([np.ones_like(a), a, b, b * b], axis=-1)


def solve_weighted(a, b, v, w):
    """Weighted least squares of v = c0 + c1 a + c2 b: coefficients and normal matrix."""
    wa, wb = w * a, w * b
    sa, sb = wa.sum(), wb.sum()
    sab = wa @ b
    matrix = np.array([[w.sum(), sa, sb], [sa, wa @ a, sab], [sb, sab, wb @ b]])
    return np.linalg.solve(matrix, np.array([w @ v, wa @ v, wb @ v])), matrix


def fit_plane(a, b, v):
    """Tukey's biweight plane, started from least absolute deviations of 4000 points."""
    stride = v.size // 4000 + 1
    few = a[::stride], b[::stride], v[::stride]
    c, floor = np.zeros(3), 0.0
    for step in range(30):
        size = np.abs(few[2] - (c[0] + c[1] * few[0] + c[2] * few[1]))
        weight = np.ones_like(size) if step == 0 else 1.0 / np.maximum(size, floor)
        following, _ = solve_weighted(*few, weight)
        change = np.abs(following - c).max()
        c = following
        floor = max(1e-2 * median(size[::4].copy()), 1e-300)
        if change <= floor:
            break
    residual, term = np.empty_like(v), np.empty_like(v)
    for _ in range(20):
        np.multiply(a, c[1], out=residual)
        np.multiply(b, c[2], out=term)
        residual += term
        residual += c[0]
        np.subtract(v, residual, out=residual)
        sigma = mad_sigma(residual)
        residual /= TUKEY * max(sigma, 1e-300)
        residual *= residual
        np.subtract(1.0, residual, out=residual)
        np.maximum(residual, 0.0, out=residual)
        total, squares = residual.sum(), residual @ residual
        # sum (1 - t)(1 - 5 t) over sum (1 - t)^2, from the sums of 1 - t and its square
        stretch = 1.0 / np.clip((5.0 * squares - 4.0 * total) / squares, 0.6, 1.0)
        residual *= residual
        following, matrix = solve_weighted(a, b, v, residual)
        following = c + stretch * (following - c)
        change = np.abs(following - c).max()
        c = following
        if change <= 1e-6 * sigma / np.sqrt(v.size):
            break
    return c, sigma * sigma * np.linalg.inv(matrix), sigma


def correlation_length(height, good, axis):
    """1 + 2 sum rho_k; `height` is 0 where not good."""
    length, variance = 1.0, 0.0
    for lag in range(51):
        n = height.shape[axis] - lag
        if n < 1:
            break
        if axis == 0:
            first, second = np.s_[:n], np.s_[lag:]
        else:
            first, second = np.s_[:, :n], np.s_[:, lag:]
        pairs = np.count_nonzero(good[first] & good[second])
        if pairs == 0:
            break
        covariance = np.einsum("ij,ij->", height[first], height[second]) / pairs
        if lag == 0:
            variance = covariance
            if variance <= 0.0:
                break
            continue
        rho = covariance / variance
        if rho < 2.0 / np.sqrt(pairs):
            break
        length += 2.0 * rho
    return length


def steps_along(height, axis):
    """Distance from the mean of the pair at +-1 or +-2, the smaller; NaN where neither is good."""
    h = np.moveaxis(height, axis, 0)
    near, far = np.full_like(height, np.nan), np.full_like(height, np.nan)
    n, f = np.moveaxis(near, axis, 0), np.moveaxis(far, axis, 0)
    for step, reach in ((n[1:-1], 1), (f[2:-2], 2)):
        np.add(h[:-2 * reach], h[2 * reach:], out=step)
        step *= 0.5
        np.subtract(h[reach:-reach], step, out=step)
        np.abs(step, out=step)
    return np.fmin(near, far, out=near)


def lopsided_steps(height, iz, ix, axis):
    """The same for pixels with neither pair; NaN where fewer than two neighbours are good."""
    size, at = height.shape[axis], (iz, ix)[axis]
    here = height[iz, ix]
    value = {}
    for k in (-2, -1, 1, 2):
        j = np.clip(at + k, 0, size - 1)
        value[k] = height[(j, ix) if axis == 0 else (iz, j)]
        value[k][(at + k < 0) | (at + k >= size)] = np.nan
    use_near = {side: ~np.isnan(value[side]) for side in (-1, 1)}
    low, high = (np.where(use_near[s], value[s], value[2 * s]) for s in (-1, 1))
    k, m = np.where(use_near[-1], -1, -2), np.where(use_near[1], 1, 2)
    result = np.abs(here - (low * m - high * k) / (m - k))
    for side in (-1, 1):
        one, two = value[side], value[2 * side]
        flat = np.minimum(np.abs(here - one), np.abs(here - two))
        sided = np.minimum(flat, np.abs(here - (2 * one - two)))
        result = np.where(np.isnan(result), sided, result)
    return result


def flag_spikes(height, good, noise):
    """Flags spikes in `good`; returns how many."""
    h = np.where(good, height, np.nan)
    steps = steps_along(h, 1)
    for axis, along in ((1, steps), (0, steps_along(h, 0))):
        iz, ix = np.nonzero(np.isnan(along) & good)
        along[iz, ix] = lopsided_steps(h, iz, ix, axis)
        if axis == 0:
            np.minimum(steps, along, out=steps)
    iz, ix = np.nonzero(steps > SPIKE_THRESHOLD * noise)
    if iz.size == 0:
        return 0
    padded = np.pad(steps, 3, constant_values=np.nan)
    around = np.lib.stride_tricks.sliding_window_view(padded, (7, 7))[iz, ix].reshape(-1, 49)
    around = np.sort(around, axis=1)  # NaN last
    count = 49 - np.isnan(around).sum(axis=1)
    decile = around[np.arange(iz.size), (0.9 * (count - 1)).astype(int)]
    spike = steps[iz, ix] > SPIKE_THRESHOLD / SPIKE_MARGIN * decile
    good[iz[spike], ix[spike]] = False
    return int(spike.sum())


def width_average(g, height, good, noise, noise_length_z):
    """Trapezoid over the good pixels; weights of missing pixels go to those around them."""
    rows = np.s_[g.low:g.high + 1, g.columns[0]:g.columns[-1] + 1]
    present = good[rows].copy()
    half, top = 0.5 * g.width, g.nodes.size - 1
    count = present[1:-1].sum(axis=0)
    edge = [~(present[0] & present[1]), ~(present[-1] & present[-2])]
    present[0] = present[-1] = True
    value = np.where(present, height[rows], 0.0)
    value[0, edge[0]] = 0.0
    value[-1, edge[1]] = 0.0
    first = np.where(edge[0], -half, g.nodes[0])
    last = np.where(edge[1], half, g.nodes[-1])

    weight = np.repeat(g.inner_weight[:, None], present.shape[1], axis=1)
    for outer, inner, end, limit in ((0, 1, first, -half), (top, top - 1, last, half)):
        span, inside = np.abs(g.nodes[inner] - end), np.abs(g.nodes[inner] - limit)
        weight[outer] += 0.5 * inside * inside / span
        weight[inner] += inside - 0.5 * inside * inside / span

    r, c = np.nonzero(~present)
    below, above = r - 1, r + 1
    for node, step in ((below, -1), (above, 1)):
        while (open_ := ~present[node, c]).any():
            node[open_] += step
    z_below = np.where(below == 0, first[c], g.nodes[below])
    z_above = np.where(above == top, last[c], g.nodes[above])
    share = (g.nodes[r] - z_below) / (z_above - z_below)
    moved = weight[r, c]
    weight[r, c] = 0.0
    np.add.at(weight, (below, c), moved * (1.0 - share))
    np.add.at(weight, (above, c), moved * share)
    weight /= g.width

    zeta = np.einsum("ij,ij->j", weight, value)
    measured = weight.copy()
    measured[0, edge[0]] = 0.0
    measured[-1, edge[1]] = 0.0
    variance = np.einsum("ij,ij->j", measured, measured) * noise * noise * noise_length_z
    gap = z_above - z_below
    one = (r == below + 1) & (gap >= 1.5 * g.pitch_z)  # each gap once
    sag = np.abs(zeta[c[one]]) * gap[one] ** 3 / g.width ** 3
    np.add.at(variance, c[one], sag * sag)

    bad = count * g.pitch_z / g.width < SMALLEST_COVERAGE
    bad[c[gap > max(LARGEST_GAP * g.width, 2.5 * g.pitch_z)]] = True
    zeta[bad] = variance[bad] = 0.0
    measured[:, bad] = 0.0
    total = measured.sum(axis=0)
    x = g.x[g.columns]
    design = np.stack([total, total * (x - g.x_centre), g.nodes @ measured], axis=1)
    return zeta, np.sqrt(variance), np.where(bad, NO_DATA, 0), design


def slope_along(x, zeta, flags):
    """Slope of the line through the good stations within REACH."""
    windows = np.lib.stride_tricks.sliding_window_view
    ok = windows(np.pad((flags == 0).astype(float), REACH), 2 * REACH + 1)
    dx = windows(np.pad(x, REACH), 2 * REACH + 1) - x[:, None]
    y = windows(np.pad(zeta, REACH), 2 * REACH + 1)
    w = ok * dx
    n, sx, sy = ok.sum(axis=1), w.sum(axis=1), (ok * y).sum(axis=1)
    sxx, sxy = (w * dx).sum(axis=1), (w * y).sum(axis=1)
    determinant = n * sxx - sx * sx
    usable = (n >= 2) & (determinant > 0)
    return np.where(usable, n * sxy - sx * sy, 0.0) / np.where(usable, determinant, 1.0)


def crest(g, height, good, noise, shared, offset_variance):
    window, design = g.patch
    ok = good[window]
    rows = design[ok]
    normal = rows.T @ rows
    c = np.linalg.solve(normal, np.stack([rows.T @ height[window][ok], np.eye(4)[0]], axis=1))
    return c[0, 0], np.sqrt(noise * noise * min(1.0, shared * c[0, 1]) + offset_variance)


def reduce_map(data, geometry, inputs):
    digest = hashlib.sha256(data).hexdigest()
    height, pitch_x, pitch_z = read_gsf(data)
    if geometry is None:
        geometry = Geometry(height.shape, pitch_x, pitch_z, inputs)
    g = geometry
    good = np.isfinite(height)
    height[~good] = 0.0

    on_rim = good.ravel()[g.rim_index]
    c, covariance, sigma = fit_plane(g.a[on_rim], g.b[on_rim],
                                     height.ravel()[g.rim_index[on_rim]])
    offset, tilt_x, tilt_z = c / (1.0, g.scale_x, g.scale_z)
    height -= offset + tilt_x * (g.x - g.x_centre) + (tilt_z * g.z)[:, None]

    noise = mad_sigma(height.ravel()[g.rim_index[on_rim]])
    quiet = g.rim & good & (np.abs(height) <= 5.0 * noise)
    rim_height = np.where(quiet, height, 0.0)
    length_x = correlation_length(rim_height, quiet, 1)
    length_z = correlation_length(rim_height, quiet, 0)
    spikes = flag_spikes(height, good, max(noise, 1e-12))

    scale = 1.0 / np.array([1.0, g.scale_x, g.scale_z])
    shared = length_x * length_z
    covariance = covariance * np.outer(scale, scale) * shared * (noise / sigma) ** 2
    zeta, independent, flags, design = width_average(g, height, good, noise, length_z)
    x = g.x[g.columns]
    # Level plane, and what the trapezoid rule takes off a parabola across the width.
    quadrature = zeta * (pitch_z / inputs["width_m"]) ** 2
    modes = np.column_stack([design @ np.linalg.cholesky(covariance), quadrature])
    shift = slope_along(x, zeta, flags) * g.pitch_x / np.sqrt(12.0)
    height[~good] = 0.0  # spikes
    centre = registration.centre_line(g, height, good, noise)
    top, top_sigma = crest(g, height, good, noise, shared, covariance[0, 0])
    return geometry, {
        "hash": digest, "x_m": x, "zeta_m": zeta, "independent": independent, "modes": modes,
        "shift": shift, "flags": flags, "noise_m": noise, "noise_length_x": length_x,
        "noise_length_z": length_z, "spikes": spikes / height.size, "crest_m": top,
        "centre": centre,
        "crest_uncertainty_m": top_sigma}


def as_json(reduced):
    result = {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in reduced.items()
              if k not in ("centre", "good")}
    result["uncertainty_m"] = np.sqrt(reduced["independent"] ** 2 + reduced["shift"] ** 2 +
                                      (reduced["modes"] ** 2).sum(axis=1)).tolist()
    result["middle_m"] = reduced["centre"][0] if reduced["centre"] else 0.0
    for name in ("independent", "modes", "shift"):
        del result[name]
    return result


def peak_MB():
    with open("/proc/self/status", encoding="ascii") as status:
        return next(float(line.split()[1]) / 1024 for line in status if line.startswith("VmHWM"))


def reduce_all(inputs):
    geometry, results = None, []
    for path in inputs["maps"]:
        with open(path, "rb") as file:
            data = file.read()
        geometry, result = reduce_map(data, geometry, inputs)
        results.append(result)
    hydrostatic = [i % 2 == 0 for i in range(len(results))]
    lines = [result["centre"] for result in results]
    moved = registration.moved(lines, hydrostatic, geometry.length, geometry.pitch_z)
    for i, result in enumerate(results):
        result["moved"] = i in moved
    registration.register(results, hydrostatic, geometry.length, geometry.width, geometry.pitch_x)
    return results


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        inputs = json.load(file)
    last = []
    for line in sys.stdin:
        order = line.split()
        wall, cpu = time.perf_counter(), time.process_time()
        if order == ["reduce"]:
            last = reduce_all(inputs)
        elif order[:1] == ["save"]:
            with open(order[1], "w", encoding="utf-8") as file:
                json.dump([as_json(result) for result in last], file)
        else:
            sys.exit(f"unknown order: {line}")
        print(json.dumps({"wall_s": time.perf_counter() - wall,
                          "cpu_s": time.process_time() - cpu, "peak_MB": peak_MB()}), flush=True)


if __name__ == "__main__":
    main()
