"""Diagram S: frequencies of a spinning beam against its speed, full model and superelement.

A beam along x turns about z through its root, which is held. About steady rotation at w, in axes that turn with it,

    M u" + w G u' + (K + w^2 (K_s - S)) u = 0

with the Coriolis matrix G = 2 int m N' [z x] N (skew), the geometric stiffness K_s of the tension w^2 int_x^L m s ds and the
softening S = int m N' diag(1, 1, 0) N. The superelement has all of them by [[matrix]]; the reference is dense algebra on the
full model. Units: length, mass per length and EI across the plane of rotation are one. Mass moments of the section about its
axis are small, and what rotation does to torsion is left out.
"""

import numpy as np

from diagrams import figure, own
from harness import structures

N_ELEMENTS, N_MODES, N_SHOWN = 32, 6, 4
SECTION = structures.Section(axial=1e5, torsion=100.0, bending_y=1.0, bending_z=4.0, mass=1.0, polar=1e-3)
SPEEDS = np.arange(0.0, 12.5, 1.0)
# Flapping frequencies at the speeds 0, 4, 8 and 12: Wright, Smith, Thresher, Wang, Journal of Applied Mechanics 49 (1982).
PUBLISHED = {0.0: (3.5160, 22.0345), 4.0: (5.5850, 24.2734), 8.0: (9.2568, 29.9954), 12.0: (13.1702, 37.6031)}
MATRICES = (("stiffening", "geometric-stiffness", "symmetric"), ("coriolis", "gyroscopic", "skew-symmetric"), ("softening", "other", "symmetric"))
# Label, method, modes, and whether the geometric stiffness takes part.
REDUCED = (
    ("craig-bampton, 4 modes", "craig-bampton", 4, 1.0),
    ("craig-bampton, 8 modes", "craig-bampton", 8, 1.0),
    ("craig-bampton, 16 modes", "craig-bampton", 16, 1.0),
    ("herting, 8 modes", "herting", 8, 1.0),
    ("craig-bampton, 8 modes, without geometric stiffness", "craig-bampton", 8, 0.0),
)
# Errors of the first frequencies below this are rounding of the reference.
LEAST = 1e-9
JOB = """[model]
stiffness = "stiffness.mtx"
mass      = "mass.mtx"
nodes     = "nodes.csv"
dofs      = "model.dof"

[[interface]]
name  = "root"
nodes = [1]

[reduction]
method = "craig-bampton"
modes  = { count = 4 }

[write]
superelement = "beam.supel"
"""


def shapes(length, t):
    """Displacements N, 3 x 12, and slopes along x of a beam at the share t of its length."""
    n, slope = np.zeros((3, 12)), np.zeros((3, 12))
    n[0, [0, 6]], slope[0, [0, 6]] = (1 - t, t), (-1 / length, 1 / length)
    deflection = np.array([1 - 3 * t**2 + 2 * t**3, t - 2 * t**2 + t**3, 3 * t**2 - 2 * t**3, t**3 - t**2])
    derivative = np.array([6 * t**2 - 6 * t, 1 - 4 * t + 3 * t**2, 6 * t - 6 * t**2, 3 * t**2 - 2 * t]) / length
    for axis, (rows, sign) in zip((1, 2), structures.BENDING):
        scale = np.array([1.0, sign * length, 1.0, sign * length])
        n[axis, rows], slope[axis, rows] = deflection * scale, derivative * scale
    return n, slope


def matrices(points):
    """K_s, G and S of the beam."""
    x, n = points[:, 0], 6 * len(points)
    at, weights = np.polynomial.legendre.leggauss(5)
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 0]])
    plane, across = np.diag([1.0, 1, 0]), np.diag([0.0, 1, 1])
    blocks = [[], [], []]
    for e in range(len(points) - 1):
        length, sums = x[e + 1] - x[e], np.zeros((3, 12, 12))
        for t, weight in zip((at + 1) / 2, weights / 2 * length):
            shape, slope = shapes(length, t)
            tension = SECTION.mass * (x[-1] ** 2 - (x[e] + t * length) ** 2) / 2
            sums += weight * np.array([
                tension * slope.T @ across @ slope,
                2 * SECTION.mass * shape.T @ turn @ shape,
                SECTION.mass * shape.T @ plane @ shape,
            ])
        for block, element in zip(blocks, sums):
            block.append((structures.rows_of([e, e + 1], 6), element))
    stiffening, coriolis, softening = (structures.assembled(n, block) for block in blocks)
    return structures.symmetric(stiffening), ((coriolis - coriolis.T) / 2).tocsr(), structures.symmetric(softening)


def frequencies(k, m, stiffening, coriolis, softening, speed, share=1.0):
    """The lowest frequencies, of dense matrices; `share` of the geometric stiffness takes part."""
    k = k + speed**2 * (share * stiffening - softening)
    n = len(m)
    first_order = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(m, k), -np.linalg.solve(m, speed * coriolis)]])
    values = np.linalg.eigvals(first_order)
    return np.sort(values.imag[values.imag > 0])[:N_MODES]


def reduced(settings, folder, method, count):
    """K, M and the further matrices of a superelement with its root held."""
    flags = ["--method", method, "--modes", count]
    result = own.reduce(settings.supel, folder, "job.toml", settings.threads, settings.timeout, *flags)
    if not result.tensors:
        raise SystemExit(f"{folder}, {method}: {result.run.failure}")
    tensors = result.tensors
    return [a[6:, 6:] for a in (tensors["stiffness"], tensors["mass"], *tensors["matrices"])]


def rows_of(settings):
    points = np.column_stack([np.linspace(0.0, 1.0, N_ELEMENTS + 1), np.zeros((N_ELEMENTS + 1, 2))])
    model = structures.frame(points, [(e, e + 1) for e in range(N_ELEMENTS)], SECTION)
    further = matrices(points)
    folder = (settings.work / "spinning").resolve()
    model.write(folder)
    job = JOB
    for (name, kind, symmetry), matrix in zip(MATRICES, further):
        structures.write_matrix(folder / f"{name}.mtx", matrix, symmetry)
        job += f'\n[[matrix]]\nname = "{name}"\nkind = "{kind}"\nfile = "{name}.mtx"\n'
    (folder / "job.toml").write_text(job + own.LEAN)
    full = [a.toarray()[6:, 6:] for a in (model.stiffness, model.mass, *further)]
    models = [("full model", full, 1.0)]
    models += [(label, reduced(settings, folder, method, count), share) for label, method, count, share in REDUCED]
    for speed in SPEEDS:
        truth = frequencies(*full, speed)
        for label, own_matrices, share in models:
            found = frequencies(*own_matrices, speed, share)
            error = np.abs(found[:N_SHOWN] / truth[:N_SHOWN] - 1).max()
            row = {"speed": speed, "model": label, "coordinates": len(own_matrices[0])}
            yield row | {f"frequency_{j + 1}": value for j, value in enumerate(found[:N_SHOWN])} | {"largest_error": error}


def draw(settings):
    rows = list(rows_of(settings))
    figure.write_rows(settings.out / "S-spinning.csv", rows, settings.origin)
    draw_one(settings, rows)


# Superelements among the frequencies: places in REDUCED and marks.
MARKED = ((1, "o"), (4, "x"))


def draw_one(settings, rows):
    title = "S. A spinning beam, root held: full model and superelements with further matrices"
    fig, ((left, right),) = figure.grid(title, 1, 2, sharey=False, panel=(4.4, 4.4))
    of = lambda label, key: [row[key] for row in rows if row["model"] == label]
    once = lambda j, label: label if j == 0 else None
    for j in range(N_SHOWN):
        key = f"frequency_{j + 1}"
        left.plot(of("full model", "speed"), of("full model", key), "k-", linewidth=0.9, label=once(j, "full model"))
        for number, mark in MARKED:
            label, style = REDUCED[number][0], {"color": f"C{number}", "markersize": 5, "fillstyle": "none"}
            left.plot(of(label, "speed"), of(label, key), mark, label=once(j, label), **style)
    for j in (0, 1):
        published = [(speed, values[j]) for speed, values in PUBLISHED.items()]
        left.plot(*zip(*published), "+", color="C3", markersize=10, label=once(j, "published, across the plane of rotation"))
    left.set(xscale="linear", yscale="linear", ylim=(0, 90))
    for number, (label, *_) in enumerate(REDUCED):
        errors = np.maximum(of(label, "largest_error"), LEAST)
        held = f"{label},\n{of(label, 'coordinates')[0]} amplitudes"
        right.plot(of(label, "speed"), errors, "o-", color=f"C{number}", markersize=3, linewidth=0.9, label=held)
    right.set(xscale="linear")
    for ax, label in ((left, "frequency × √(m L⁴/EI)"), (right, f"largest relative error of the first {N_SHOWN} frequencies")):
        ax.set_xlabel("speed × √(m L⁴/EI), EI across the plane of rotation", fontsize=8)
        ax.set_ylabel(label, fontsize=8)
    left.legend(fontsize=6, loc="upper left")
    right.legend(fontsize=7, loc="upper left", bbox_to_anchor=(1.02, 1.0))
    figure.save(fig, settings.out / "S-spinning.svg", settings.origin)
