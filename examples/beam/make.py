"""Makes the files of this folder: python examples/beam/make.py, with scikit-fem and scipy.

A free steel beam of 8 bricks, 0.4 x 0.03 x 0.02 m, with the modes that eigsh finds of it; modes_lost.mtx lacks the second bending mode.
"""

import pathlib

import numpy as np
import scipy.io
import scipy.sparse as sparse
from scipy.sparse.linalg import eigsh
from skfem import Basis, BilinearForm, ElementHex1, ElementVector, MeshHex, asm
from skfem.helpers import dot
from skfem.models.elasticity import lame_parameters, linear_elasticity

FOLDER = pathlib.Path(__file__).parent
N_MODES, LOST = 14, 7

mesh = MeshHex.init_tensor(np.linspace(0, 0.4, 9), np.linspace(0, 0.03, 2), np.linspace(0, 0.02, 2))
basis = Basis(mesh, ElementVector(ElementHex1()), intorder=3)
stiffness = asm(linear_elasticity(*lame_parameters(210e9, 0.3)), basis)
mass = asm(BilinearForm(lambda u, v, w: 7850.0 * dot(u, v)), basis)
stiffness, mass = (0.5 * (matrix + matrix.T) for matrix in (stiffness, mass))
for name, matrix in (("K", stiffness), ("M", mass)):
    scipy.io.mmwrite(FOLDER / f"{name}.mtx", sparse.tril(matrix), symmetry="symmetric", precision=17)

rows = [None] * basis.N
for node in range(mesh.p.shape[1]):
    for axis in range(3):
        rows[basis.nodal_dofs[axis, node]] = (node + 1, axis + 1)
(FOLDER / "dofs.txt").write_text("".join(f"{node}.{axis}\n" for node, axis in rows))
table = [f"{node + 1},{x!r},{y!r},{z!r}\n" for node, (x, y, z) in enumerate(mesh.p.T.tolist())]
(FOLDER / "nodes.csv").write_text("node,x,y,z\n" + "".join(table))

start = np.random.default_rng(1).standard_normal(basis.N)
values, shapes = eigsh(stiffness.tocsc(), N_MODES, mass.tocsc(), sigma=-1e6, v0=start)
hertz = np.sqrt(np.maximum(values, 0.0)) / (2 * np.pi)
kept = [mode for mode in range(N_MODES) if mode != LOST]
for name, modes in (("", list(range(N_MODES))), ("_lost", kept)):
    scipy.io.mmwrite(FOLDER / f"modes{name}.mtx", shapes[:, modes], precision=17)
    (FOLDER / f"frequencies{name}.txt").write_text("".join(f"{value!r}\n" for value in hertz[modes].tolist()))
