"""A square plate with a round hole in its middle, of 20-node hexahedra; what CalculiX says of it.

The mesh is rings of nodes between circle and square. Nodes and elements count from one; rows of matrices are in the order
of the nodes, three for each. Millimetre, tonne, second; steel. The hole's node is in the middle of the hole.
"""

import pathlib
import re
import subprocess

import numpy as np
import scipy.sparse as sp

HALF_SIDE, RADIUS, THICKNESS = 60.0, 15.0, 8.0
MATERIAL = ["*MATERIAL, NAME=STEEL", "*ELASTIC", "210000., 0.3", "*DENSITY", "7.85e-9"]
# Corners of an element in steps of half elements along radius and circle, in the order of CalculiX, and midpoints of its edges.
CORNERS, MIDDLES = ((0, 0), (2, 0), (2, 2), (0, 2)), ((1, 0), (2, 1), (1, 2), (0, 1))
# The face of an element that lies on the wall of the hole.
WALL_FACE = "S6"
NODES_OF_WALL_FACE = 8


class Plate:
    """Nodes (n x 3), elements of 20 nodes, nodes of the hole's wall and of the outer rim."""

    def __init__(self, n_around, n_radial, n_through):
        number, points = {}, []
        for k in range(2 * n_through + 1):
            for j in range(2 * n_radial + 1):
                for i in range(2 * n_around):
                    # Corners and midpoints of edges have at most one odd place.
                    if i % 2 + j % 2 + k % 2 <= 1:
                        number[j, i, k] = len(points) + 1
                        points.append(position(i / (2 * n_around), j / (2 * n_radial), k / (2 * n_through)))
        self.points = np.array(points)
        at = lambda j, i, k: number[j, i % (2 * n_around), k]
        layers = ((CORNERS, 0), (CORNERS, 2), (MIDDLES, 0), (MIDDLES, 2), (CORNERS, 1))
        self.elements = [
            [at(j + dj, i + di, k + dk) for places, dk in layers for dj, di in places]
            for j in range(0, 2 * n_radial, 2)
            for k in range(0, 2 * n_through, 2)
            for i in range(0, 2 * n_around, 2)
        ]
        self.wall = list(range(1, n_around * n_through + 1))
        self.hole = [node for (j, _, _), node in number.items() if j == 0]
        self.rim = [node for (j, _, _), node in number.items() if j == 2 * n_radial]

    def deck(self):
        """The lines of a CalculiX deck without steps."""
        # CalculiX reads twenty characters of a number; nine decimals of a millimetre are enough.
        lines = ["*NODE, NSET=ALL"]
        lines += [f"{i + 1}, " + ", ".join(f"{x + 0.0:.9f}" for x in point) for i, point in enumerate(self.points)]
        lines.append("*ELEMENT, TYPE=C3D20, ELSET=PLATE")
        for i, nodes in enumerate(self.elements):
            lines += [f"{i + 1}, " + ", ".join(map(str, nodes[:10])) + ",", ", ".join(map(str, nodes[10:]))]
        for kind, name, members in (("NSET", "HOLE", self.hole), ("NSET", "RIM", self.rim), ("ELSET", "WALL", self.wall)):
            lines.append(f"*{kind}, {kind}={name}")
            lines += [", ".join(map(str, members[i : i + 8])) for i in range(0, len(members), 8)]
        return [*lines, *MATERIAL, "*SOLID SECTION, ELSET=PLATE, MATERIAL=STEEL"]

    def wall_areas(self):
        """What each node of the hole has of its wall: the integral of its shape function, and the diagonal of the consistent
        mass matrix of the wall, scaled to the same sum. Faces are flat enough to count as rectangles."""
        place = {node: i for i, node in enumerate(self.hole)}
        of_face = [[1, 4, 8, 5], [12, 20, 16, 17]]
        integral, diagonal = np.zeros(len(self.hole)), np.zeros(len(self.hole))
        for element in self.wall:
            for local, share, square in ((of_face[0], -1 / 12, 3 / 76), (of_face[1], 1 / 3, 16 / 76)):
                for corner in local:
                    node = place[self.elements[element - 1][corner - 1]]
                    integral[node] += share
                    diagonal[node] += square
        return integral, diagonal


def position(turn, out, up):
    direction = np.array([np.cos(2 * np.pi * turn), np.sin(2 * np.pi * turn)])
    edge = HALF_SIDE / np.abs(direction).max()
    return [*(direction * (RADIUS + (edge - RADIUS) * out)), THICKNESS * (up - 0.5)]


def run(folder, name, lines):
    """Runs CalculiX on a deck; returns the text of its .dat file."""
    folder = pathlib.Path(folder)
    (folder / f"{name}.inp").write_text("\n".join([*lines, ""]))
    ended = subprocess.run(["ccx", name], cwd=folder, capture_output=True, text=True)
    errors = [line for line in ended.stdout.splitlines() if "ERROR" in line]
    if ended.returncode != 0 or errors:
        raise SystemExit(f"ccx {name}: exit code {ended.returncode} {' '.join(errors)[:200]}")
    return (folder / f"{name}.dat").read_text()


def matrices(folder, plate):
    """Has CalculiX write plate.sti, plate.mas and plate.dof of the free plate; reads K and M."""
    run(folder, "plate", [*plate.deck(), "*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE", "*END STEP"])
    n = 3 * len(plate.points)
    for kind in ("sti", "mas"):
        rows, columns, values = np.loadtxt(folder / f"plate.{kind}").T
        upper = sp.csr_matrix((values, (rows.astype(int) - 1, columns.astype(int) - 1)), shape=(n, n))
        yield (upper + upper.T - sp.diags(upper.diagonal())).tocsc()


def tables(text, what, name):
    """The tables `what` of a set of nodes in a .dat file, rows x 3, in the order of the steps."""
    for block in re.split(r"\n(?= *[a-z][^\n]* for set )", text):
        head, *rows = block.strip().splitlines() or [""]
        if head.startswith(what) and f"for set {name} " in head:
            yield np.array([[float(x) for x in row.split()[1:]] for row in rows if row.strip()])


LOAD = 1000.0


def distributing(folder, plate):
    """The stiffness of the hole's node, 6 x 6, by *DISTRIBUTING, with the rim held; and the forces of unit loads on the hole.

    Release 2.20 takes loads on the reference node and gives it no displacements: those are what the forces of each load
    do work on, F' U."""
    node = len(plate.points) + 1
    lines = [*plate.deck(), "*NODE, NSET=REF", f"{node}, 0., 0., 0."]
    lines += [f"*COUPLING, REF NODE={node}, SURFACE=BORE, CONSTRAINT NAME=HUB", "*DISTRIBUTING", "1, 6"]
    lines.insert(lines.index(MATERIAL[0]), f"*SURFACE, NAME=BORE, TYPE=ELEMENT\nWALL, {WALL_FACE}")
    lines += ["*BOUNDARY", "RIM, 1, 3"]
    for direction in range(1, 7):
        lines += ["*STEP", "*STATIC", "*CLOAD, OP=NEW", f"{node}, {direction}, {LOAD}", "*NODE PRINT, NSET=HOLE", "U, RF", "*END STEP"]
    text = run(folder, "distributing", lines)
    u, f = (np.stack([table.ravel() for table in tables(text, what, "HOLE")], axis=1) / LOAD for what in ("displacements", "forces"))
    return np.linalg.inv(f.T @ u), f


def rigid_lines(plate):
    """A deck with the hole as a rigid body, the number of its node and of the node whose displacements are its rotations."""
    node = len(plate.points) + 1
    lines = [*plate.deck(), "*NODE, NSET=REF", f"{node}, 0., 0., 0.", "*NODE, NSET=ROT", f"{node + 1}, 0., 0., 0."]
    return [*lines, f"*RIGID BODY, NSET=HOLE, REF NODE={node}, ROT NODE={node + 1}", "*BOUNDARY", "RIM, 1, 3"], node


def rigid_stiffness(folder, plate):
    """The stiffness of the hole's node by *RIGID BODY with the rim held."""
    lines, node = rigid_lines(plate)
    for at, direction in [(node + rotates, d) for rotates in (0, 1) for d in (1, 2, 3)]:
        lines += ["*STEP", "*STATIC", "*CLOAD, OP=NEW", f"{at}, {direction}, {LOAD}"]
        lines += ["*NODE PRINT, NSET=REF", "U", "*NODE PRINT, NSET=ROT", "U", "*END STEP"]
    text = run(folder, "rigid", lines)
    u = [np.stack([table.ravel() for table in tables(text, "displacements", name)], axis=1) for name in ("REF", "ROT")]
    return np.linalg.inv(np.vstack(u) / LOAD)
