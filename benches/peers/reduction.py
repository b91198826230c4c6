"""A reduction with two rigid faces in SciPy; who factors and finds the modes is handed in.

The same job as job.toml of a part: read K and M from Matrix Market text, condense the faces by congruence, modes, constraint
and (Herting) inertia-relief modes from K_II, projection, one file out.

Shapes: K, M n x n after condensation, rows of the faces (12) first; psi_s n_I x 12; k_red, m_red with 12 + 50 rows
(Craig-Bampton) or 12 + 6 + 50 (Herting).
"""

import argparse
import json
import pathlib
import resource
import sys
import time

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as spla

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from harness import part, process

N_RIGID = 6
# Residuals of 1e-10 leave eigenvalues good to far more digits; asking for machine precision only costs time.
EIGEN_TOLERANCE = 1e-10


class Stages:
    """Wall-clock time of each stage."""

    def __init__(self):
        self.seconds, self._last = {}, time.perf_counter()

    def done(self, name):
        now = time.perf_counter()
        self.seconds[name] = self.seconds.get(name, 0.0) + now - self._last
        self._last = now


def arpack(k, m, count, shift, solve, tolerance):
    """The lowest pairs by ARPACK in shift-invert mode, ascending, and the number of solves."""
    solves = [0]

    def count_and_solve(b):
        solves[0] += 1
        return solve(b)

    inverse = spla.LinearOperator(k.shape, matvec=count_and_solve, dtype=float)
    start = np.random.default_rng(1).standard_normal(k.shape[0])
    lam, x = spla.eigsh(k, count, m, sigma=shift, OPinv=inverse, v0=start, tol=tolerance)
    order = np.argsort(lam)
    return lam[order], x[:, order], solves[0]


def reduce(folder, method, count, shift, solver, stages):
    """The whole job. `solver.factorise` takes a positive definite CSR matrix and gives back what solves with it;
    `solver.modes` finds pairs of a pencil, and is ARPACK on that where a solver has none of its own."""
    find = getattr(solver, "modes", arpack)
    k, m = part.read_matrices(folder)
    points = part.read_points(folder)
    stages.done("read")

    condensed = part.condensation(folder, points)
    t, u = condensed.t, condensed.u
    k, m = (t.T @ k @ t).tocsr(), (t.T @ m @ t).tocsr()
    n_b = 6 * len(condensed.hubs)
    k_ii, m_ii = k[n_b:, n_b:].tocsr(), m[n_b:, n_b:].tocsr()
    stages.done("prepare")

    if method == "herting":
        solve = solver.factorise((k - shift * m).tocsr())
        stages.done("factor")
        lam, x, n_solves = find(k, m, count + N_RIGID, shift, solve, EIGEN_TOLERANCE)
        lam, x = lam[N_RIGID:], x[:, N_RIGID:]
        del solve
        stages.done("modes")
    solve = solver.factorise(k_ii)
    stages.done("factor")
    if method == "craig-bampton":
        lam, x, n_solves = find(k_ii, m_ii, count, 0.0, solve, EIGEN_TOLERANCE)
        stages.done("modes")

    psi_s = -solve(k[n_b:, :n_b].toarray())
    if method == "herting":
        psi_d = np.hstack([solve((m @ u)[n_b:]), x[n_b:] - psi_s @ x[:n_b]])
        psi_d /= np.sqrt(np.einsum("ij,ij->j", psi_d, m_ii @ psi_d))
    else:
        psi_d = x
    stages.done("constraint")

    psi = np.block([[np.eye(n_b), np.zeros((n_b, psi_d.shape[1]))], [psi_s, psi_d]])
    k_red, m_red = psi.T @ (k @ psi), psi.T @ (m @ psi)
    k_red, m_red = (k_red + k_red.T) / 2, (m_red + m_red.T) / 2
    stages.done("project")
    return {"k": k_red, "m": m_red, "lam": lam, "solves": n_solves, "n": k.shape[0]}


def parsed(description):
    """The arguments every peer takes."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("folder", help="folder of a part")
    parser.add_argument("output", help="JSON file to write; reduced matrices go to OUTPUT.npz")
    parser.add_argument("--method", choices=["craig-bampton", "herting"], required=True)
    parser.add_argument("--modes", type=int, required=True)
    parser.add_argument("--shift-below", type=float, required=True, help="how far below zero, (rad/s)^2; for free modes")
    return parser.parse_args()


def decline(reason):
    """Ends a peer that does not do the job."""
    print(reason)
    sys.exit(process.DECLINED)


def write(output, stages, lam, **more):
    """The result of a peer: stage times, frequencies, what else it counted."""
    result = {
        "stages_s": stages.seconds,
        # Linux counts KiB.
        "peak_mib": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "frequencies_hz": [] if lam is None else (np.sqrt(np.abs(np.sort(lam))) / (2 * np.pi)).tolist(),
        **more,
    }
    pathlib.Path(output).write_text(json.dumps(result, indent=1))


def main(solver):
    arguments = parsed(solver.__doc__)
    stages = Stages()
    result = reduce(arguments.folder, arguments.method, arguments.modes, -arguments.shift_below, solver, stages)
    np.savez(arguments.output + ".npz", stiffness=result["k"], mass=result["m"])
    stages.done("write")
    write(arguments.output, stages, result["lam"], solves=result["solves"], n=result["n"])
