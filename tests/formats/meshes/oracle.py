"""Prints what meshio reads of each mesh named: points, cells, and the points of every set, as JSON, one line a mesh.

A mesh that meshio does not read gives a line with the reason.
"""
import contextlib
import io
import json
import sys

import meshio
import numpy as np


# Kinds of cells that have faces, and that are read.
TYPES = (
    "triangle triangle6 quad quad8 tetra tetra10 pyramid pyramid13 wedge wedge15 hexahedron hexahedron20 "
    "triangle7 quad9 pyramid14 wedge18 hexahedron27"
).split()
FACELESS = {"vertex", "line", "line3", "line4"}


def groups(mesh):
    """Points of every set by its name; sets of cells as the points of their cells."""
    found = {name: sorted({int(point) for point in points}) for name, points in mesh.point_sets.items()}
    of_cells = {}
    for name, blocks in mesh.cell_sets.items():
        points = set()
        for block, cells in zip(mesh.cells, blocks):
            if cells is not None and len(cells):
                points.update(np.asarray(block.data)[np.asarray(cells, dtype=int)].ravel().tolist())
        of_cells[name] = sorted(int(point) for point in points)
    return found, of_cells


for path in sys.argv[1:]:
    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            mesh = meshio.read(path)
            points = np.zeros((len(mesh.points), 3))
            points[:, : mesh.points.shape[1]] = mesh.points
            of_points, of_cells = groups(mesh)
            cells = [[block.type, np.asarray(block.data).tolist()] for block in mesh.cells if block.type in TYPES]
            others = sorted({block.type for block in mesh.cells if len(block.data)} - set(TYPES) - FACELESS)
        line = {"points": points.tolist(), "point_sets": of_points, "cell_sets": of_cells, "cells": cells, "others": others}
    except BaseException as error:  # meshio leaves by sys.exit too
        line = {"error": f"{type(error).__name__}: {error}"[:200]}
    print(json.dumps(line))
