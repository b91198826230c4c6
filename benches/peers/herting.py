"""Herting's reduction with two rigid patches in SciPy; the direct solver is handed in.

The same job as onshape.toml: read K and M from gzipped Matrix Market text, condense the patches by congruence, free-free
modes by ARPACK in shift-invert mode, constraint and inertia-relief modes from K_II, projection, one file out.

Shapes: K, M n x n after condensation, rows of the patches (12) first; psi_s n_I x 12; x n x 56; k_red, m_red 68 x 68.
"""

import argparse
import gzip
import json
import resource
import time

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as spla

try:
    from fast_matrix_market import mmread
except ImportError:
    from scipy.io import mmread

# The planes of onshape.toml: foot and top of the hub, mm.
PATCH_PLANES = (-9.525, 66.675)
PLANE_TOLERANCE = 1e-3
N_MODES = 50
N_RIGID = 6
# Below zero by a quarter of the part's first elastic eigenvalue, 3.7e8 (rad/s)^2.
SHIFT = -1e8
# Residuals of 1e-10 leave eigenvalues good to far more digits; asking for machine precision only costs time.
EIGEN_TOLERANCE = 1e-10


class Stages:
    """Wall-clock time of each stage."""

    def __init__(self):
        self.seconds, self._last = {}, time.perf_counter()

    def done(self, name):
        now = time.perf_counter()
        self.seconds[name] = now - self._last
        self._last = now
        print(f"{name:12} {self.seconds[name]:8.2f} s", flush=True)


def rigid_body_modes(points):
    """Displacements of nodes under the six unit rigid motions about the origin, 3 k x 6."""
    x, y, z = points.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    columns = [
        (one, zero, zero), (zero, one, zero), (zero, zero, one),
        (zero, -z, y), (z, zero, -x), (-y, x, zero),
    ]
    return np.column_stack([np.column_stack(column).ravel() for column in columns])


def read_symmetric(path):
    with gzip.open(path) as text:
        return mmread(text).tocsr()


def condensation(points):
    """T of u = T (u_B, u_I), with one six-dof node at the centroid of each patch, and the positions of those nodes."""
    patches = [np.flatnonzero(np.abs(points[:, 2] - z) <= PLANE_TOLERANCE) for z in PATCH_PLANES]
    hubs = np.array([points[patch].mean(axis=0) for patch in patches])
    is_free = np.ones(len(points), dtype=bool)
    rows, columns, values = [], [], []
    for k, (patch, hub) in enumerate(zip(patches, hubs)):
        is_free[patch] = False
        block = sp.coo_matrix(rigid_body_modes(points[patch] - hub))
        rows.append(3 * patch[block.row // 3] + block.row % 3)
        columns.append(6 * k + block.col)
        values.append(block.data)
    free_rows = np.flatnonzero(np.repeat(is_free, 3))
    rows.append(free_rows)
    columns.append(6 * len(patches) + np.arange(len(free_rows)))
    values.append(np.ones(len(free_rows)))
    n_condensed = 6 * len(patches) + len(free_rows)
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    sizes = [len(patch) for patch in patches]
    return sp.csr_matrix(entries, shape=(3 * len(points), n_condensed)), hubs, is_free, sizes


def condensed_rigid_body_modes(points, hubs, is_free):
    at_hubs = [np.vstack([rigid_body_modes(hub[None]), np.hstack([np.zeros((3, 3)), np.eye(3)])]) for hub in hubs]
    return np.vstack(at_hubs + [rigid_body_modes(points[is_free])])


def reduce(pair, factorise, stages):
    """The whole job; `factorise` takes a positive definite CSR matrix and returns a function that solves with it."""
    k, m = read_symmetric(f"{pair}/K.mtx.gz"), read_symmetric(f"{pair}/M.mtx.gz")
    points = np.loadtxt(gzip.open(f"{pair}/nodes.csv.gz"), delimiter=",", skiprows=1)[:, 1:4]
    stages.done("read")

    t, hubs, is_free, sizes = condensation(points)
    k, m = (t.T @ k @ t).tocsr(), (t.T @ m @ t).tocsr()
    n_b = 6 * len(hubs)
    u = condensed_rigid_body_modes(points, hubs, is_free)
    stages.done("condense")

    solve = factorise((k - SHIFT * m).tocsr())
    stages.done("factor free")
    n = k.shape[0]
    solves = [0]

    def count_and_solve(b):
        solves[0] += 1
        return solve(b)

    inverse = spla.LinearOperator((n, n), matvec=count_and_solve, dtype=float)
    start = np.random.default_rng(1).standard_normal(n)
    lam, x = spla.eigsh(
        k, N_MODES + N_RIGID, m, sigma=SHIFT, OPinv=inverse, v0=start, tol=EIGEN_TOLERANCE
    )
    order = np.argsort(lam)
    lam, x = lam[order][N_RIGID:], x[:, order][:, N_RIGID:]
    del solve, inverse
    stages.done("modes")

    solve = factorise(k[n_b:, n_b:].tocsr())
    stages.done("factor K_II")
    psi_s = -solve(k[n_b:, :n_b].toarray())
    psi_irm = solve((m @ u)[n_b:])
    stages.done("static")

    psi_d = np.hstack([psi_irm, x[n_b:] - psi_s @ x[:n_b]])
    psi_d /= np.sqrt(np.einsum("ij,ij->j", psi_d, m[n_b:, n_b:] @ psi_d))
    psi = np.block([[np.eye(n_b), np.zeros((n_b, psi_d.shape[1]))], [psi_s, psi_d]])
    k_red, m_red = psi.T @ (k @ psi), psi.T @ (m @ psi)
    k_red, m_red = (k_red + k_red.T) / 2, (m_red + m_red.T) / 2
    reduced = scipy.linalg.eigh(k_red, m_red, eigvals_only=True)[N_RIGID : N_RIGID + N_MODES]
    stages.done("project")
    print(f"patches of {sizes} nodes, {n} dofs, {solves[0]} solves for the modes")
    return {"k": k_red, "m": m_red, "lam": lam, "reduced": reduced, "solves": solves[0], "n": n}


def main(solver, factorise):
    parser = argparse.ArgumentParser(description=f"Herting's reduction in SciPy with {solver}")
    parser.add_argument("pair", help="folder with K.mtx.gz, M.mtx.gz and nodes.csv.gz")
    parser.add_argument("output", help="JSON file to write; the reduced matrices go to OUTPUT.npz")
    arguments = parser.parse_args()
    stages = Stages()
    begin = time.perf_counter()
    result = reduce(arguments.pair, factorise, stages)
    np.savez(arguments.output + ".npz", stiffness=result["k"], mass=result["m"])
    report = {
        "solver": solver,
        "n": result["n"],
        "solves": result["solves"],
        "stages_s": stages.seconds,
        "total_s": time.perf_counter() - begin,
        # Linux counts KiB.
        "peak_mib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "frequencies_hz": (np.sqrt(result["lam"]) / (2 * np.pi)).tolist(),
        "reduced_frequencies_hz": (np.sqrt(result["reduced"]) / (2 * np.pi)).tolist(),
    }
    with open(arguments.output, "w") as file:
        json.dump(report, file, indent=1)
    print(f"total {report['total_s']:.2f} s, peak {report['peak_mib']:.0f} MiB")
