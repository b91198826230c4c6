#!/usr/bin/env python3
"""Writes crank.inp: a crank arm, 200 degrees of a ring of 20-node bricks, with its two ends as surfaces."""
import math

N_ROUND, N_OUT, N_UP = 8, 2, 1  # elements around, from the inside to the outside, through the thickness
INNER, OUTER, THICK, ANGLE = 30.0, 50.0, 12.0, math.radians(200.0)

labels, nodes, elements = {}, [], []


def node(i, j, k):
    """Label of the node at half steps i, j, k; made where it is not there."""
    if (i, j, k) not in labels:
        labels[i, j, k] = len(labels) + 1
        radius, angle = INNER + (OUTER - INNER) * j / (2 * N_OUT), ANGLE * i / (2 * N_ROUND)
        nodes.append((radius * math.cos(angle), radius * math.sin(angle), THICK * k / (2 * N_UP)))
    return labels[i, j, k]


# Corners and middles of the edges of a brick, in half steps: bottom, top, bottom edges, top edges, upright edges.
CORNERS = [(0, 0), (0, 2), (2, 2), (2, 0)]
MIDDLES = [(0, 1), (1, 2), (2, 1), (1, 0)]
BRICK = [(*at, z) for z, at in [(z, at) for z in (0, 2) for at in CORNERS]]
BRICK += [(*at, z) for z, at in [(z, at) for z in (0, 2) for at in MIDDLES]]
BRICK += [(*at, 1) for at in CORNERS]

for i in range(N_ROUND):
    for j in range(N_OUT):
        for k in range(N_UP):
            elements.append([node(2 * i + a, 2 * j + b, 2 * k + c) for a, b, c in BRICK])

with open("crank.inp", "w") as deck:
    deck.write("** A crank arm of steel in mm, t, s: 200 degrees of a ring, one end on a shaft, one on a pin.\n*NODE, NSET=ALL\n")
    deck.writelines(f"{label}, {x:.12g}, {y:.12g}, {z:.12g}\n" for label, (x, y, z) in enumerate(nodes, 1))
    deck.write("*ELEMENT, TYPE=C3D20, ELSET=ARM\n")
    for label, of in enumerate(elements, 1):
        deck.write(f"{label}, " + ", ".join(map(str, of[:10])) + ",\n" + ", ".join(map(str, of[10:])) + "\n")
    shaft = [label for (i, _, _), label in labels.items() if i == 0]
    deck.write("*NSET, NSET=SHAFT\n" + "".join(f"{label},\n" for label in sorted(shaft)))
    last = [label for label in range(1, len(elements) + 1) if label > len(elements) - N_OUT * N_UP]
    # The face of its last elements that looks along the ring: nodes 3, 4, 7 and 8.
    deck.write("*SURFACE, NAME=PIN\n" + "".join(f"{label}, S5\n" for label in last))
    deck.write("*MATERIAL, NAME=STEEL\n*ELASTIC\n210000, 0.3\n*DENSITY\n7.85E-9\n")
    deck.write("*SOLID SECTION, ELSET=ARM, MATERIAL=STEEL\n")
    deck.write("*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n*END STEP\n")
