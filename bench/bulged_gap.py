"""Flow through the bulged gap of README.md with dolfinx: prints the drop in Pa, the number of
unknowns and that of Newton's steps.

  bulged_gap.py ALONG UP

Taylor-Hood Q2-Q1 on quadrilaterals, MUMPS, Newton from the parabola of every section. Lengths in the
gap of the flat channel, velocities in the mean one there, pressures in eta U / gap.
"""
import os
import sys

# One process alone: neither a daemon of its own nor the drivers of fast networks, 0.3 s.
for name, value in (("ess_singleton_isolated", "1"), ("pml", "ob1"), ("btl", "self")):
    os.environ.setdefault(f"OMPI_MCA_{name}", value)

import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc

GAP, WIDTH, ETA, RHO, FLOW_RATE = 175e-6, 1.7e-3, 1e-3, 998.0, 70e-6 / 60
LENGTH, BULGE, RISE = 15.5e-3 / GAP, 33e-6 / GAP, 0.6e-3 / GAP
VELOCITY = FLOW_RATE / (WIDTH * GAP)
REYNOLDS = RHO * VELOCITY * GAP / ETA


def roof(x):
    return 1 + BULGE * (1 - 0.6 * x / LENGTH) * (1 - np.exp(-x / RISE)) * (
        1 - np.exp(-(LENGTH - x) / RISE))


def finer_at_both_ends(t, strength):
    return t - strength * np.sin(2 * np.pi * t) / (2 * np.pi)


def parabola(x):
    return np.stack((6 * x[1] * (roof(x[0]) - x[1]) / roof(x[0]) ** 3, np.zeros(x.shape[1])))


def main():
    along, up = (int(word) for word in sys.argv[1:])
    gap = mesh.create_rectangle(MPI.COMM_SELF, [(0, 0), (1, 1)], (along, up),
                                mesh.CellType.quadrilateral)
    nodes = gap.geometry.x
    nodes[:, 0] = LENGTH * finer_at_both_ends(nodes[:, 0], 0.85)
    nodes[:, 1] = roof(nodes[:, 0]) * finer_at_both_ends(nodes[:, 1], 0.5)

    cell = gap.ufl_cell()
    flow = fem.FunctionSpace(gap, ufl.MixedElement(ufl.VectorElement("Q", cell, 2),
                                                   ufl.FiniteElement("Q", cell, 1)))
    state = fem.Function(flow)
    state.sub(0).interpolate(parabola)
    u, p = ufl.split(state)
    v, q = ufl.TestFunctions(flow)
    residual = (ufl.inner(ufl.grad(u), ufl.grad(v)) + REYNOLDS * ufl.inner(ufl.grad(u) * u, v)
                - p * ufl.div(v) - q * ufl.div(u)) * ufl.dx(degree=5)
    slope = fem.form(ufl.derivative(residual, state))
    residual = fem.form(residual)

    # Velocities on floor, roof and inlet; the outlet is open.
    gap.topology.create_connectivity(1, 2)
    boundary = mesh.exterior_facet_indices(gap.topology)
    inlet = mesh.locate_entities_boundary(gap, 1, lambda x: np.isclose(x[0], 0.0))
    outlet = mesh.locate_entities_boundary(gap, 1, lambda x: np.isclose(x[0], LENGTH))
    walls = np.setdiff1d(boundary, outlet)
    velocities, _ = flow.sub(0).collapse()
    given = fem.Function(velocities)
    given.interpolate(parabola)
    nodes_there = fem.locate_dofs_topological((flow.sub(0), velocities), 1, walls)
    fixed = fem.dirichletbc(given, nodes_there, flow.sub(0))

    matrix, right = petsc.create_matrix(slope), petsc.create_vector(residual)
    solver = PETSc.KSP().create(MPI.COMM_SELF)
    solver.setType("preonly")
    solver.getPC().setType("lu")
    solver.getPC().setFactorSolverType("mumps")
    solver.setOperators(matrix)
    change = matrix.createVecRight()
    for steps in range(1, 13):
        matrix.zeroEntries()
        petsc.assemble_matrix(matrix, slope, bcs=[fixed])
        matrix.assemble()
        with right.localForm() as local:
            local.set(0.0)
        petsc.assemble_vector(right, residual)
        petsc.apply_lifting(right, [slope], [[fixed]], [state.vector], -1.0)
        petsc.set_bc(right, [fixed], state.vector, -1.0)
        solver.solve(right, change)
        state.vector.axpy(-1.0, change)
        if change.norm(PETSc.NormType.INFINITY) <= 1e-8 * state.vector.norm(PETSc.NormType.INFINITY):
            break
    else:
        sys.exit("Newton's iteration does not converge")

    facets = np.concatenate((inlet, outlet))
    names = np.repeat(np.int32((1, 2)), (len(inlet), len(outlet)))
    sorted_ = np.argsort(facets)
    ends = mesh.meshtags(gap, 1, facets[sorted_], names[sorted_])
    ds = ufl.Measure("ds", domain=gap, subdomain_data=ends)
    drop = fem.assemble_scalar(fem.form(p * ds(1) - p * ds(2)))  # over sections of height 1
    print(f"{ETA * VELOCITY / GAP * drop:.6f} {state.vector.size} {steps}")


main()
