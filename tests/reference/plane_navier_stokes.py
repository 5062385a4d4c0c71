#!/usr/bin/env python3
"""Makes the reference flows plane_*.csv of this folder (needs numpy and scipy; about 20 s).

Steady 2-D Navier-Stokes flow between a flat floor and a roof y = h(x), by Galerkin's method with
Q3 velocities and Q2 pressures on a mesh mapped from a rectangle, Newton's iteration and a sparse
direct solver. Parabolic velocity with v = 0 at the inlet, do-nothing outlet (gradient form). Lengths
are in units of the gap H, pressures in rho (q/H)^2.

usage: tests/reference/plane_navier_stokes.py FOLDER
"""

import sys
from pathlib import Path

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import spsolve

DEGREE = 3
DENSITY, VISCOSITY, LENGTH, WIDTH = 998.0, 1e-3, 15.5e-3, 1.7e-3


def lagrange(degree, points):
    """Values and slopes at the points of the polynomials on Chebyshev-Lobatto nodes of [-1, 1]."""
    nodes = np.cos(np.pi * np.arange(degree, -1, -1) / degree)
    legendre = np.polynomial.legendre
    inverse = np.linalg.inv(legendre.legvander(nodes, degree))
    slopes = np.stack([legendre.legval(points, legendre.legder(row)) for row in np.eye(degree + 1)], 1)
    return legendre.legvander(points, degree) @ inverse, slopes @ inverse, nodes


def node_line(edges, nodes):
    inner = edges[:-1, None] + np.diff(edges)[:, None] * (nodes[1:] + 1) / 2
    return np.concatenate([edges[:1], inner.ravel()])


def numbering(degree, n_x, n_y):
    """Global numbers of the nodes of every element, (elements, nodes)."""
    e_x, e_y = [e.ravel() for e in np.meshgrid(np.arange(n_x), np.arange(n_y), indexing="ij")]
    a, b = [k.ravel() for k in np.meshgrid(*2 * [np.arange(degree + 1)], indexing="ij")]
    return (degree * e_x[:, None] + a) * (degree * n_y + 1) + degree * e_y[:, None] + b, e_x, e_y


def solve(gap, slope, x_edges, t_edges, reynolds, start=None):
    """Pressure at its nodes, (x, t), its mean over the gap, the x of the nodes, and the solution."""
    points, weights = np.polynomial.legendre.leggauss(DEGREE + 2)
    v_1d, dv_1d, v_nodes = lagrange(DEGREE, points)
    p_1d, _, p_nodes = lagrange(DEGREE - 1, points)
    n_x, n_y = len(x_edges) - 1, len(t_edges) - 1
    dof, e_x, e_y = numbering(DEGREE, n_x, n_y)
    dop, _, _ = numbering(DEGREE - 1, n_x, n_y)
    rows, columns = DEGREE * n_x + 1, DEGREE * n_y + 1
    n_v, n_p = rows * columns, ((DEGREE - 1) * n_x + 1) * ((DEGREE - 1) * n_y + 1)

    product = lambda a, b: np.einsum("ia,jb->ijab", a, b).reshape(len(points) ** 2, -1)
    S, S_xi, S_eta, S_p = product(v_1d, v_1d), product(dv_1d, v_1d), product(v_1d, dv_1d), product(p_1d, p_1d)
    weight = np.outer(weights, weights).ravel()
    xi, eta = np.repeat(points, len(points)), np.tile(points, len(points))
    half_x, half_t = np.diff(x_edges)[e_x][:, None] / 2, np.diff(t_edges)[e_y][:, None] / 2
    x = x_edges[e_x][:, None] + half_x * (xi + 1)
    t = t_edges[e_y][:, None] + half_t * (eta + 1)
    y_xi, y_eta = t * slope(x) * half_x, gap(x) * half_t
    area = half_x * y_eta * weight
    G_x = S_xi / half_x[:, :, None] - S_eta * (y_xi / (half_x * y_eta))[:, :, None]
    G_y = S_eta / y_eta[:, :, None]

    pairs = (np.repeat(dof, dof.shape[1], axis=1).ravel(), np.tile(dof, (1, dof.shape[1])).ravel())
    mixed = (np.repeat(dof, dop.shape[1], axis=1).ravel(), np.tile(dop, (1, dof.shape[1])).ravel())
    square = lambda block: sparse.coo_matrix((block.ravel(), pairs), shape=(n_v, n_v)).tocsr()
    inner = lambda a, b: np.einsum("eqa,eqb,eq->eab", a, b, area, optimize=True)
    friction = square((inner(G_x, G_x) + inner(G_y, G_y)) / reynolds)
    B_x, B_y = [sparse.coo_matrix((np.einsum("eqa,qp,eq->eap", G, S_p, area, optimize=True).ravel(), mixed),
                                  shape=(n_v, n_p)).tocsr() for G in (G_x, G_y)]

    nodes_x, nodes_t = node_line(x_edges, v_nodes), node_line(t_edges, v_nodes)
    grid = np.arange(n_v).reshape(rows, columns)
    parabola = 6 * nodes_t * (1 - nodes_t)
    state = (np.concatenate([np.outer(1 / gap(nodes_x), parabola).ravel(), np.zeros(n_v + n_p)])
             if start is None else start.copy())
    fixed = np.zeros(len(state), bool)
    for side in (grid[:, 0], grid[:, -1], grid[0, :]):
        fixed[side] = fixed[n_v + side] = True
    state[fixed] = 0.0
    state[grid[0, :]] = parabola / gap(nodes_x[:1])[0]
    free = np.where(~fixed)[0]
    for _ in range(15):
        u, v, p = state[:n_v], state[n_v:2 * n_v], state[2 * n_v:]
        at = lambda f, G: np.einsum("ea,eqa->eq", f[dof], G)
        u_q, v_q = u[dof] @ S.T, v[dof] @ S.T
        slopes = [[at(f, G) for G in (G_x, G_y)] for f in (u, v)]
        carried = u_q[:, :, None] * G_x + v_q[:, :, None] * G_y
        convection = np.einsum("qa,eqb,eq->eab", S, carried, area, optimize=True)
        mass = lambda c: np.einsum("qa,qb,eq->eab", S, S, area * c, optimize=True)
        matrix = sparse.bmat([
            [friction + square(convection + mass(slopes[0][0])), square(mass(slopes[0][1])), -B_x],
            [square(mass(slopes[1][0])), friction + square(convection + mass(slopes[1][1])), -B_y],
            [-B_x.T, -B_y.T, None]]).tocsr()
        forces = []
        for s, f, B in ((slopes[0], u, B_x), (slopes[1], v, B_y)):
            force = np.zeros(n_v)
            np.add.at(force, dof.ravel(), ((area * (u_q * s[0] + v_q * s[1])) @ S).ravel())
            forces.append(force + friction @ f - B @ p)
        rest = np.concatenate([*forces, -B_x.T @ u - B_y.T @ v])
        change = spsolve(matrix[free][:, free].tocsc(), -rest[free], permc_spec="COLAMD")
        state[free] += change
        if abs(change).max() < 1e-9 * abs(state).max():
            break
    pressure = state[2 * n_v:].reshape((DEGREE - 1) * n_x + 1, -1)
    mean_weights = np.zeros(pressure.shape[1])
    for j in range(n_y):
        at = (DEGREE - 1) * j
        mean_weights[at:at + DEGREE] += np.diff(t_edges)[j] / 2 * (weights @ p_1d)
    return node_line(x_edges, p_nodes), pressure, pressure @ mean_weights, state


def flow(height, deflection, mL_per_minute, lead_in):
    """x, floor, roof and mean pressure (Pa) at 41 stations; 0 mean at x = LENGTH."""
    q = mL_per_minute * 1e-6 / 60 / WIDTH
    reynolds, scale = q * DENSITY / VISCOSITY, DENSITY * (q / height) ** 2
    inside = lambda x: np.where((x > 0) & (x < LENGTH), deflection(np.clip(x, 0, LENGTH)), 0.0)
    gap = lambda X: 1 + inside(X * height) / height
    slope = lambda X: (gap(X + 1e-6) - gap(X - 1e-6)) / 2e-6
    s = np.linspace(0, 1, 81)
    x_edges = LENGTH / height * (s - 0.93 * np.sin(2 * np.pi * s) / (2 * np.pi))
    if lead_in:
        x_edges = np.concatenate([lead_in * (np.linspace(0, 1, 13) ** 0.7 - 1), x_edges[1:],
                                  LENGTH / height + np.array([1, 2.5, 5, 10])])
    t_edges = np.array([0, 0.08, 0.2, 0.35, 0.5, 0.65, 0.8, 0.92, 1])
    state = None
    for part in (0.25, 0.5, 1.0):
        x, pressure, mean, state = solve(gap, slope, x_edges, t_edges, part * reynolds, state)
    x = x * height
    outlet = np.interp(LENGTH, x, mean)
    inner = np.where((x >= -1e-12) & (x <= LENGTH * (1 + 1e-12)))[0][::4]
    table = np.stack([x, pressure[:, 0] - outlet, pressure[:, -1] - outlet, mean - outlet], 1)[inner]
    table[:, 1:] *= scale
    return table


def ends(size):
    return lambda x: (1 - np.exp(-x / size)) * (1 - np.exp(-(LENGTH - x) / size))


def clamped_ends(size):
    rise = lambda x: 1 - np.exp(-x / size) * (1 + x / size)
    return lambda x: rise(x) * rise(LENGTH - x)


def main(folder):
    bulge = lambda x: 33e-6 * (1 - 0.6 * x / LENGTH) * ends(0.6e-3)(x)
    steep = lambda x: 86e-6 * (1 - 0.75 * x / LENGTH) * ends(0.6e-3)(x)
    clamped = lambda x: 86e-6 * (1 - 0.75 * x / LENGTH) * clamped_ends(0.4e-3)(x)
    cases = (("bulge", 175e-6, bulge, 20), ("steep", 244e-6, steep, 50), ("clamped", 244e-6, clamped, 50))
    for name, height, deflection, rate in cases:
        for lead_in in (0, 10):
            table = flow(height, deflection, rate, lead_in)
            path = Path(folder) / f"plane_{name}_Q{rate}{'_lead_in' if lead_in else ''}.csv"
            np.savetxt(path, table, delimiter=",", fmt=["%.9e"] + 3 * ["%.4f"], comments="",
                       header="x_m,p_floor_Pa,p_roof_Pa,p_mean_Pa")


if __name__ == "__main__":
    main(sys.argv[1])
