"""Small finite element models in Python, for diagrams that need matrices of their own: bricks and beams.

Shapes: points n x 3; K, M (rows per node) n x the same, symmetric, free; rows are in the order of the nodes.
"""

import dataclasses
import pathlib

import numpy as np
import scipy.sparse as sp


@dataclasses.dataclass
class Model:
    """A free component; 3 or 6 directions at every node."""

    points: np.ndarray
    directions: int
    stiffness: sp.csr_matrix
    mass: sp.csr_matrix

    def write(self, folder):
        """stiffness.mtx, mass.mtx, nodes.csv and model.dof, nodes labelled from one."""
        folder = pathlib.Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        write_matrix(folder / "stiffness.mtx", self.stiffness, "symmetric")
        write_matrix(folder / "mass.mtx", self.mass, "symmetric")
        rows = [",".join(map(repr, [i + 1, *map(float, x)])) for i, x in enumerate(self.points)]
        (folder / "nodes.csv").write_text("\n".join(["node,x,y,z", *rows, ""]))
        dofs = [f"{i + 1}.{d + 1}" for i in range(len(self.points)) for d in range(self.directions)]
        (folder / "model.dof").write_text("\n".join([*dofs, ""]))


def write_matrix(path, matrix, symmetry):
    """Matrix Market with all digits; of a symmetric or skew-symmetric matrix the lower triangle."""
    entries = (matrix if symmetry == "general" else sp.tril(matrix)).tocoo()
    head = f"%%MatrixMarket matrix coordinate real {symmetry}\n{matrix.shape[0]} {matrix.shape[1]} {entries.nnz}\n"
    lines = (f"{i + 1} {j + 1} {float(value)!r}\n" for i, j, value in zip(entries.row, entries.col, entries.data))
    path.write_text(head + "".join(lines))


def assembled(n, blocks):
    """The sum of element matrices, given with the rows they belong to; symmetric to the bit where they are."""
    rows = np.concatenate([np.repeat(dofs, len(dofs)) for dofs, _ in blocks])
    columns = np.concatenate([np.tile(dofs, len(dofs)) for dofs, _ in blocks])
    values = np.concatenate([block.ravel() for _, block in blocks])
    return sp.csr_matrix((values, (rows, columns)), shape=(n, n))


def symmetric(matrix):
    return ((matrix + matrix.T) / 2).tocsr()


def rows_of(nodes, directions):
    return (directions * np.asarray(nodes)[:, None] + np.arange(directions)).ravel()


# Corners of the reference cube, and its Gauss points of two in each direction.
CORNERS = np.array([[i, j, k] for k in (-1, 1) for j in (-1, 1) for i in (-1, 1)], dtype=float)


def brick(cells, size, young, poisson, density):
    """A block of 8-node hexahedra with one corner at the origin; nodes x fastest."""
    counts = [n + 1 for n in cells]
    grid = [np.linspace(0.0, length, n) for length, n in zip(size, counts)]
    z, y, x = np.meshgrid(*grid[::-1], indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    k, m = hexahedron(np.array(size) / cells, young, poisson, density)
    number = np.arange(len(points)).reshape(counts[::-1])
    corners = [number[c : c + cells[2], b : b + cells[1], a : a + cells[0]] for c in (0, 1) for b in (0, 1) for a in (0, 1)]
    elements = np.stack([corner.ravel() for corner in corners], axis=1)
    n = 3 * len(points)
    stiffness, mass = (symmetric(assembled(n, [(rows_of(e, 3), block) for e in elements])) for block in (k, m))
    return Model(points, 3, stiffness, mass)


def hexahedron(edges, young, poisson, density):
    """K and M, 24 x 24, of a cuboid with trilinear shape functions, two Gauss points in each direction."""
    shear, lame = young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    elasticity = np.diag([2 * shear] * 3 + [shear] * 3)
    elasticity[:3, :3] += lame
    volume = np.prod(edges) / 8
    k, m = np.zeros((24, 24)), np.zeros((24, 24))
    for at in CORNERS / np.sqrt(3):
        factors = 1 + CORNERS * at
        shape = factors.prod(axis=1) / 8
        slopes = np.stack([CORNERS[:, d] * np.delete(factors, d, axis=1).prod(axis=1) for d in range(3)], axis=1) / 4 / edges
        strain = np.zeros((6, 8, 3))
        for d in range(3):
            strain[d, :, d] = slopes[:, d]
        for row, (a, b) in enumerate(((1, 2), (2, 0), (0, 1)), start=3):
            strain[row, :, a], strain[row, :, b] = slopes[:, b], slopes[:, a]
        strain = strain.reshape(6, 24)
        k += volume * strain.T @ elasticity @ strain
        m += volume * density * np.kron(np.outer(shape, shape), np.eye(3))
    return k, m


@dataclasses.dataclass
class Section:
    """Of a beam: EA, GJ, EI about the local y and z axes, mass and polar moment of inertia per length."""

    axial: float
    torsion: float
    bending_y: float
    bending_z: float
    mass: float
    polar: float


def round_bar(radius, young, poisson, density):
    area, second = np.pi * radius**2, np.pi * radius**4 / 4
    shear = young / (2 * (1 + poisson))
    return Section(young * area, 2 * shear * second, young * second, young * second, density * area, 2 * density * second)


# Deflection and slope at both ends of a beam: in the local x-y plane, and in x-z, where a positive rotation lowers the end.
BENDING = ((np.array([1, 5, 7, 11]), 1.0), (np.array([2, 4, 8, 10]), -1.0))


def with_slopes(shape, slope):
    """A matrix for deflections and slopes, whose slopes are multiplied."""
    scale = np.array([1.0, slope, 1.0, slope])
    return np.array(shape, dtype=float) * np.outer(scale, scale)


def local_beam(section, length):
    """K and consistent M of an Euler-Bernoulli beam in its own axes, 12 x 12."""
    k, m = np.zeros((12, 12)), np.zeros((12, 12))
    for rows, stiffness, inertia in (((0, 6), section.axial, section.mass), ((3, 9), section.torsion, section.polar)):
        place = np.ix_(rows, rows)
        k[place] += stiffness / length * np.array([[1, -1], [-1, 1]])
        m[place] += inertia * length / 6 * np.array([[2, 1], [1, 2]])
    for (rows, sign), bending in zip(BENDING, (section.bending_z, section.bending_y)):
        place = np.ix_(rows, rows)
        shape = [[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]
        k[place] += bending / length**3 * with_slopes(shape, sign * length)
        shape = [[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]
        m[place] += section.mass * length / 420 * with_slopes(shape, sign * length)
    return k, m


def turned(block, along):
    """A matrix of a beam in the axes of the model; the local y axis lies across the axis least aligned with the beam."""
    x = along / np.linalg.norm(along)
    z = np.cross(x, np.eye(3)[np.argmin(np.abs(x))])
    z /= np.linalg.norm(z)
    axes = np.kron(np.eye(4), np.array([x, np.cross(z, x), z]))
    return axes.T @ block @ axes


def frame(points, edges, section):
    """One beam for each pair of nodes."""
    stiffness, mass = [], []
    for a, b in edges:
        along = points[b] - points[a]
        for blocks, block in zip((stiffness, mass), local_beam(section, np.linalg.norm(along))):
            blocks.append((rows_of([a, b], 6), turned(block, along)))
    n = 6 * len(points)
    return Model(points, 6, *(symmetric(assembled(n, blocks)) for blocks in (stiffness, mass)))
