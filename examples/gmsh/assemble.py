#!/usr/bin/env python3
"""Writes K and M of lug.msh as Matrix Market: scikit-fem, 10-node tetrahedra, three rows for each node of the mesh in its order."""
import gzip

import meshio
import numpy
import scipy.io
import scipy.sparse
import skfem
from scipy.spatial import KDTree
from skfem.helpers import ddot, dot, sym_grad, trace

YOUNG, POISSON, DENSITY = 70_000.0, 0.33, 2.7e-9  # MPa, -, t/mm3
LAME, SHEAR = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON), YOUNG / 2 / (1 + POISSON)

mesh = meshio.read("lug.msh")
corners, cells = numpy.unique(mesh.cells_dict["tetra10"][:, :4], return_inverse=True)
tetrahedra = skfem.MeshTet(mesh.points[corners].T, cells.reshape(-1, 4).T)
basis = skfem.Basis(tetrahedra, skfem.ElementVector(skfem.ElementTetP2()), intorder=4)


@skfem.BilinearForm
def stiffness(u, v, _):
    strain, virtual = sym_grad(u), sym_grad(v)
    return LAME * trace(strain) * trace(virtual) + 2 * SHEAR * ddot(strain, virtual)


@skfem.BilinearForm
def mass(u, v, _):
    return DENSITY * dot(u, v)


# Rows of scikit-fem in the order of the nodes of the mesh: x, y, z of the first, then of the second, and so on.
distance, node = KDTree(mesh.points).query(basis.doflocs.T)
assert distance.max() < 1e-9 and 3 * len(mesh.points) == len(node)
row = numpy.argsort(3 * node + numpy.arange(len(node)) % 3)
for name, form in [("stiffness", stiffness), ("mass", mass)]:
    matrix = form.assemble(basis).tocsr()[row][:, row]
    matrix = (matrix + matrix.T) / 2
    with gzip.GzipFile(f"{name}.mtx.gz", "wb", mtime=0) as file:
        scipy.io.mmwrite(file, scipy.sparse.tril(matrix), symmetry="symmetric", precision=17)
