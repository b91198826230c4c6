"""Parts: made by `make-solid`, read from its files, condensed on their two rigid faces.

Shapes: K, M n x n as in the files; T n x n_c, with u = T (u_B, u_I) and 12 rows of u_B; hubs 2 x 3.
"""

import dataclasses
import json
import pathlib
import subprocess

import numpy as np
import scipy.sparse as sp

try:
    from fast_matrix_market import mmread
except ImportError:
    from scipy.io import mmread

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def make(family, dofs, folder):
    """Writes a part where the folder has none; returns the folder."""
    folder = pathlib.Path(folder)
    if not (folder / "model.json").exists():
        command = ["cargo", "run", "--quiet", "--release", "--locked", "-p", "supel-models", "--bin", "make-solid", "--"]
        command += ["--family", family, "--dofs", str(dofs), "--out", str(folder.resolve())]
        subprocess.run(command, check=True, cwd=ROOT, stdout=subprocess.DEVNULL)
    return folder


def facts(folder):
    """What model.json says: family, n, directions per node, axis, faces, tolerance, modes."""
    return json.loads((pathlib.Path(folder) / "model.json").read_text())


def read_matrices(folder):
    return [mmread(pathlib.Path(folder) / f"{name}.mtx").tocsr() for name in ("stiffness", "mass")]


def read_points(folder):
    return np.loadtxt(pathlib.Path(folder) / "nodes.csv", delimiter=",", skiprows=1)[:, 1:4]


def rigid_body_modes(points, directions):
    """Displacements of nodes with three or six directions under the six unit motions about the origin, rows x 6."""
    x, y, z = points.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    columns = [
        (one, zero, zero), (zero, one, zero), (zero, zero, one),
        (zero, -z, y), (z, zero, -x), (-y, x, zero),
    ]
    modes = np.stack([np.stack(column, axis=1) for column in columns], axis=2)
    if directions == 6:
        turning = np.concatenate([np.zeros((3, 3)), np.eye(3)], axis=1)
        modes = np.concatenate([modes, np.broadcast_to(turning, (len(points), 3, 6))], axis=1)
    return modes.reshape(directions * len(points), 6)


@dataclasses.dataclass
class Condensation:
    """u = T (u_B, u_I): one six-dof node at the centroid of each patch moves it as a rigid body."""

    t: sp.csr_matrix
    hubs: np.ndarray
    patches: list
    # Rigid-body modes of the condensed component, n_c x 6.
    u: np.ndarray


def condensation(folder, points):
    """The condensation of a part."""
    what = facts(folder)
    along = points[:, what["axis"]]
    return condensed(points, what["directions"], [np.flatnonzero(np.abs(along - at) <= what["tolerance"]) for at in what["faces"]])


def condensed(points, directions, patches):
    """The condensation on rigid patches of nodes, given by their places in the table of nodes."""
    hubs = np.array([points[patch].mean(axis=0) for patch in patches])
    is_free = np.ones(len(points), dtype=bool)
    rows, columns, values = [], [], []
    for k, (patch, hub) in enumerate(zip(patches, hubs)):
        is_free[patch] = False
        block = sp.coo_matrix(rigid_body_modes(points[patch] - hub, directions))
        rows.append(directions * patch[block.row // directions] + block.row % directions)
        columns.append(6 * k + block.col)
        values.append(block.data)
    free_rows = np.flatnonzero(np.repeat(is_free, directions))
    n_b = 6 * len(patches)
    rows.append(free_rows)
    columns.append(n_b + np.arange(len(free_rows)))
    values.append(np.ones(len(free_rows)))
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    t = sp.csr_matrix(entries, shape=(directions * len(points), n_b + len(free_rows)))
    u = np.vstack([rigid_body_modes(hubs, 6), rigid_body_modes(points[is_free], directions)])
    return Condensation(t, hubs, patches, u)
