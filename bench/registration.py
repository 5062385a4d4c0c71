"""Where walls lie along and across the flow: the numpy side of what find_centre_line(),
find_placements() and register_maps() do."""
import numpy as np

NO_DATA = 1
SIDES = np.array([0.15, 0.3, 0.45, 0.6])
ENDS = np.array([0.1, 0.15, 0.2, 0.3, 0.4, 0.5])
STRETCHES, LEAST_STRETCHES, LEAST_ENDS, PASSES = 12, 4, 4, 4
LINE_START, LINE_END = 0.7, 1.3  # widths
LEAST_MOVEMENT, MODEL_SHARE, FLOOR = 0.1, 8.0, 0.1e-6
LEAST_FRACTIONS = 4


class Stretches:
    """Columns of the stretches along a channel, once a run."""

    def __init__(self, x, pitch_x, length, width):
        start = min(0.5 * width, 0.2 * length)
        low = start + (length - 2 * start) / STRETCHES * np.arange(STRETCHES + 1)
        at = np.clip(np.ceil((low - x[0]) / pitch_x), 0, x.size).astype(int)
        self.columns = slice(at[0], at[-1])
        self.starts, self.n = at[:-1] - at[0], np.diff(at)
        self.x = 0.5 * (x[at[:-1]] + x[at[1:] - 1]) - 0.5 * length


def centre_line(g, height, good, noise):
    """Offset, slope and their uncertainties, or None; `height` is 0 where not good."""
    s = g.stretches
    ok = good[:, s.columns]
    sums = np.add.reduceat(height[:, s.columns], s.starts, axis=1)
    count = np.add.reduceat(ok, s.starts, axis=1, dtype=np.int32)
    mean = np.where(2 * count > s.n - 1, sums / np.maximum(count, 1), np.nan)
    inner = np.nan_to_num(mean[np.abs(g.z) <= 0.3 * g.width])
    top = inner[np.abs(inner).argmax(axis=0), np.arange(STRETCHES)]
    shows = np.abs(top) > 10.0 * noise / np.sqrt(s.n)
    mean = mean / np.where(shows, top, 1.0)
    k = np.arange(STRETCHES)
    middles = np.zeros((SIDES.size, STRETCHES))
    for profile, z in ((mean, g.z), (mean[::-1], g.z[::-1])):
        here, following = profile[:-1], profile[1:]
        for i, level in enumerate(SIDES):
            crossed = (here <= level) & (following > level)
            at = crossed.argmax(axis=0)
            shows &= crossed[at, k]
            share = (level - here[at, k]) / np.where(shows, following[at, k] - here[at, k], 1.0)
            middles[i] += 0.5 * (z[at] + share * (z[1] - z[0]))
    if np.count_nonzero(shows) < LEAST_STRETCHES:
        return None
    weight = 1.0 / SIDES.size - SIDES.mean() * (SIDES - SIDES.mean()) / (
        (SIDES - SIDES.mean()) ** 2).sum()
    z, x = (weight @ middles)[shows], s.x[shows]
    n, spread = x.size, ((x - x.mean()) ** 2).sum()
    slope = ((x - x.mean()) * z).sum() / spread
    variance = ((z - z.mean() - slope * (x - x.mean())) ** 2).sum() / (n - 2)
    return (z.mean() - slope * x.mean(), slope,
            np.sqrt(variance * (1 / n + x.mean() ** 2 / spread)), np.sqrt(variance / spread))


def moved(lines, hydrostatic, length, pitch_z):
    """Which walls lie elsewhere than the others."""
    shown = [line for line, is_hydrostatic in zip(lines, hydrostatic) if line and is_hydrostatic]
    if not shown:
        return []
    common = np.median(np.array(shown), axis=0)
    found = []
    for i, line in enumerate(lines):
        if line:
            off = abs(line[0] - common[0]) + 0.5 * length * abs(line[1] - common[1])
            doubt = line[2] + 0.5 * length * line[3]
            if off > max(0.3 * pitch_z, 4.0 * doubt):
                found.append(i)
    return found


def find_end(distance, zeta, sigma, width):
    """Height, and where the wall passes the fractions ENDS of it, with variance and first one."""
    line = (distance >= LINE_START * width) & (distance <= LINE_END * width)
    x, y = distance[line] / width, zeta[line]
    if x.size < 5:
        return None
    slope = ((x - x.mean()) * (y - y.mean())).sum() / ((x - x.mean()) ** 2).sum()
    height = y.mean() - slope * x.mean()
    n = np.searchsorted(distance, LINE_START * width)
    if height == 0.0 or n < 4:
        return None
    y = (zeta[:n] - slope * distance[:n] / width) / height
    rises = (y[1:-2] < ENDS[:, None]) & (y[2:-1] >= ENDS[:, None])
    at, first, start = np.zeros(ENDS.size, int), 0, 0
    for k in range(ENDS.size):
        hits = np.flatnonzero(rises[k, start:])
        if hits.size:
            at[k] = start = start + hits[0]
        else:
            first, start = k + 1, 0
    if first > ENDS.size - LEAST_ENDS:
        return None
    at, level = at[first:], ENDS[first:]
    i = at[:, None] + np.arange(4)
    nodes, values = distance[i], y[i]
    between = nodes[:, :, None] - nodes[:, None, :] + np.eye(4)
    values = values / between.prod(axis=2)
    low, high = nodes[:, 1].copy(), nodes[:, 2].copy()
    for _ in range(40):
        middle = 0.5 * (low + high)
        off = middle[:, None] - nodes
        cubic = (values[:, 0] * off[:, 1] * off[:, 2] * off[:, 3] +
                 values[:, 1] * off[:, 0] * off[:, 2] * off[:, 3] +
                 values[:, 2] * off[:, 0] * off[:, 1] * off[:, 3] +
                 values[:, 3] * off[:, 0] * off[:, 1] * off[:, 2])
        below = cubic < level
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    place, variance = np.zeros(ENDS.size), np.zeros(ENDS.size)
    place[first:] = 0.5 * (low + high)
    noise = 0.5 * (sigma[at + 1] + sigma[at + 2]) / abs(height)
    variance[first:] = (noise * (distance[at + 2] - distance[at + 1]) / (y[at + 2] - y[at + 1])) ** 2
    return height, place, variance, first


def at_edge(values, variances, first):
    """Value at f = 0 of the straight line in f, and its uncertainty."""
    f, value, variance = ENDS[first:], values[first:], variances[first:]
    n, mean = f.size, f.mean()
    spread = ((f - mean) ** 2).sum()
    weight = 1.0 / n - mean * (f - mean) / spread
    slope, edge = ((f - mean) * value).sum() / spread, (weight * value).sum()
    rest = ((value - edge - slope * f) ** 2).sum() / (n - 2)
    model = MODEL_SHARE ** 2 * max(0.0, rest - variance.mean())
    return edge, np.sqrt((weight ** 2 * variance).sum() + model + FLOOR ** 2)


def crossing_at(known, k, height):
    """One fraction's distance at a height and its variance, by the maps that know it; or None.

    Between their heights by straight lines; up to one step beyond the outermost its value, with what
    it changes over that step as doubt.
    """
    above = sum(one[0] <= height for one in known)
    if 0 < above < len(known):
        low, high = known[above - 1], known[above]
        share = (height - low[0]) / (high[0] - low[0])
        return [(1.0 - share) * low[what][k] + share * high[what][k] for what in (1, 2)]
    if len(known) < 2:
        return None
    nearest, following = (known[0], known[1]) if above == 0 else (known[-1], known[-2])
    steps = abs((height - nearest[0]) / (following[0] - nearest[0]))
    if not steps <= 1.0:
        return None
    change = steps * (following[1][k] - nearest[1][k])
    return [nearest[1][k], nearest[2][k] + change * change]


def inset_at(insets, height):
    """The wall's inset at a height, its variance, and the first fraction from which it is known."""
    distance, variance, first = np.zeros(ENDS.size), np.zeros(ENDS.size), 0
    for k in range(ENDS.size):
        crossing = crossing_at([inset for inset in insets if inset[3] <= k], k, height)
        if crossing:
            distance[k], variance[k] = crossing
        else:
            first = k + 1
    return distance, variance, first


def ends_of(reduced, shift, length, width):
    x, zeta, sigma = reduced["good"]
    return (find_end(x - shift, zeta, sigma, width),
            find_end((length - (x - shift))[::-1], zeta[::-1], sigma[::-1], width))


def register(results, hydrostatic, length, width, pitch_x):
    """Finds the shift of every map along the flow and takes it back."""
    for reduced in results:
        ok = reduced["flags"] == 0
        reduced["good"] = reduced["x_m"][ok], reduced["zeta_m"][ok], reduced["independent"][ok]
    largest, shifts, insets = 0.0, [None] * len(results), []
    for reduced, is_hydrostatic in zip(results, hydrostatic):
        if is_hydrostatic:
            for end in ends_of(reduced, 0.0, length, width):
                if end:
                    largest = max(largest, abs(end[0]))
    for i, reduced in enumerate(results):
        if not hydrostatic[i]:
            continue
        shift = 0.0
        for last in range(PASSES):
            inlet, outlet = ends_of(reduced, shift, length, width)
            shifts[i] = None
            if not inlet or not outlet or inlet[0] * outlet[0] < 0.0 or (
                    min(abs(inlet[0]), abs(outlet[0])) < LEAST_MOVEMENT * largest):
                break
            variance, first = 0.25 * (inlet[2] + outlet[2]), max(inlet[3], outlet[3])
            more, doubt = at_edge(0.5 * (inlet[1] - outlet[1]), variance, first)
            shift += more
            shifts[i] = shift, doubt
            if last == PASSES - 1:
                insets.append((0.5 * (inlet[0] + outlet[0]), 0.5 * (inlet[1] + outlet[1]), variance,
                               first))
    found = np.array([shift for shift in shifts if shift])
    if found.size == 0:
        return
    weights = found[:, 1] ** -2
    offset = (weights * found[:, 0]).sum() / weights.sum()
    shifts = [(shift[0] - offset, shift[1]) if shift else None for shift in shifts]
    insets.sort(key=lambda inset: inset[0])
    for i, reduced in enumerate(results):
        if hydrostatic[i] or not insets:
            continue
        shift = 0.0
        for _ in range(PASSES):
            inlet, outlet = ends_of(reduced, shift, length, width)
            at_inlet = inlet and (not outlet or abs(inlet[0]) >= abs(outlet[0]))
            end = inlet if at_inlet else outlet
            shifts[i] = None
            if not end or abs(end[0]) < LEAST_MOVEMENT * largest:
                break
            inset = inset_at(insets, end[0])
            first = max(end[3], inset[2])
            if first > ENDS.size - LEAST_FRACTIONS:
                break
            more, doubt = at_edge(end[1] - inset[0], end[2] + inset[1], first)
            shift += more if at_inlet else -more
            shifts[i] = shift - offset, doubt
    assumed = pitch_x / np.sqrt(12.0)
    for reduced, shift in zip(results, shifts):
        reduced["shift_m"] = 0.0
        if shift and shift[1] < assumed:
            move(reduced, shift[0])
            reduced["shift"] = reduced["shift"] * (shift[1] / assumed)
            reduced["shift_m"] = shift[0]


def move(reduced, shift):
    """zeta(x + shift) by the cubic through four stations, a line beside a bad one."""
    zeta, good = np.pad(reduced["zeta_m"], 3), np.pad(reduced["flags"] == 0, 3)
    n = reduced["zeta_m"].size
    steps = shift / ((reduced["x_m"][-1] - reduced["x_m"][0]) / (n - 1))
    whole = int(np.floor(steps))
    at = np.clip(np.arange(n) + 3 + whole, 1, n + 3)
    u = np.arange(n) + steps
    u = u - np.floor(u)
    a, b, c, d = (zeta[at + k] for k in (-1, 0, 1, 2))
    line = (1.0 - u) * b + u * c
    cubic = (-u * (u - 1) * (u - 2) / 6 * a + (u + 1) * (u - 1) * (u - 2) / 2 * b -
             (u + 1) * u * (u - 2) / 2 * c + (u + 1) * u * (u - 1) / 6 * d)
    ok = good[at] & (good[at + 1] | (u == 0.0))
    value = np.where(good[at - 1] & good[at + 2], cubic, line)
    reduced["zeta_m"] = np.where(ok, value, 0.0)
    reduced["flags"] = np.where(ok, 0, NO_DATA)
