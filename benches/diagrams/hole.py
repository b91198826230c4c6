"""Diagram H: what a coupling does to a plate with a hole, against the mesh: rigid, average, CalculiX's.

The rim is held, the hole has one node. Stiffness of that node, 6 x 6, and the first frequencies, with the node free and held.
All use the matrices of the plate that CalculiX writes, so that only the couplings differ.
"""

import shutil

import numpy as np
import scipy.linalg

import calculix
from diagrams import figure, own
from harness import part, plate
from harness.boundaries import factorised

# Elements around the hole, from hole to rim, and through the thickness: refined in all directions, and in the plane alone.
# Multiples of eight around it put nodes on the corners of the square.
MESHES = {
    "all": ((8, 2, 1), (16, 4, 2), (24, 6, 3), (40, 10, 4)),
    "plane": ((8, 2, 1), (16, 4, 1), (24, 6, 1), (40, 10, 1)),
}
N_FREQUENCIES = 4
STIFFNESSES = ("kx", "ky", "kz", "krx", "kry", "krz")
COLUMNS = ("refined", "n_around", "n_through", "n", "program", "coupling", *STIFFNESSES, "off_diagonal", "f1_free_hz", "f2_free_hz", "f4_free_hz", "f1_held_hz")
# Keys of the coupling in the job; the weights of the last are filled in.
COUPLINGS = {
    "rigid": 'coupling = "rigid"',
    "average, equal weights": 'coupling = "average"',
    "average, area weights": 'coupling = "average"\nweights = {weights}',
}
JOB = """[model]
stiffness = "plate.sti"
mass      = "plate.mas"
nodes     = "nodes.csv"
dofs      = "plate.dof"

[[interface]]
name   = "hole"
nodes  = {hole}
origin = [0, 0, 0]
{coupling}

[[fixed]]
name  = "rim"
nodes = {rim}

[reduction]
method = "herting"
modes  = {{ count = {count} }}

[write]
superelement = "plate.supel"
"""


def row(program, coupling, stiffness=None, free=None, held=None):
    """A row of the table; what is absent stays empty."""
    values = dict.fromkeys(COLUMNS, "") | {"program": program, "coupling": coupling}
    if stiffness is not None:
        scale = np.sqrt(np.diag(stiffness))
        relative = stiffness / np.outer(scale, scale) - np.eye(6)
        values |= dict(zip(STIFFNESSES, np.diag(stiffness))) | {"off_diagonal": np.abs(relative).max()}
    if free is not None:
        values |= {f"f{j}_free_hz": free[j - 1] for j in (1, 2, 4)}
    return values | ({} if held is None else {"f1_held_hz": held})


def ours(settings, folder, what):
    nodes = ["node,x,y,z", *(f"{i + 1}," + ",".join(f"{x:.9f}" for x in point) for i, point in enumerate(what.points))]
    (folder / "nodes.csv").write_text("\n".join([*nodes, ""]))
    _, diagonal = what.wall_areas()
    for name, keys in COUPLINGS.items():
        keys = keys.format(weights=diagonal.tolist())
        job = JOB.format(hole=what.hole, rim=what.rim, coupling=keys, count=N_FREQUENCIES)
        (folder / "job.toml").write_text(job + own.LEAN)
        reduce = lambda *flags: own.reduce(settings.supel, folder, "job.toml", settings.threads, settings.timeout, *flags)
        free, held = reduce(), reduce("--method", "craig-bampton", "--modes", 1)
        if not (free.tensors and held.tensors):
            raise SystemExit(f"{folder}, {name}: {free.run.failure} {held.run.failure}")
        k, m = free.tensors["stiffness"], free.tensors["mass"]
        frequencies = np.sqrt(scipy.linalg.eigh(k, m, eigvals_only=True)) / (2 * np.pi)
        yield row("supel", name, k[:6, :6], frequencies, held.tensors["frequencies"][0] / (2 * np.pi))


def calculixs(folder, what):
    """*RIGID BODY, and *DISTRIBUTING, which leaves the frequencies those of the plate alone."""
    def frequencies(lines):
        text = plate.run(folder, "modes", [*lines, "*STEP", "*FREQUENCY", str(N_FREQUENCIES), "*END STEP"])
        return np.sqrt(calculix.frequencies(text)) / (2 * np.pi)

    rigid, _ = plate.rigid_lines(what)
    yield row("CalculiX", "*RIGID BODY", plate.rigid_stiffness(folder, what), frequencies(rigid))
    alone = frequencies([*what.deck(), "*BOUNDARY", "RIM, 1, 3"])
    stiffness, _ = plate.distributing(folder, what)
    yield row("CalculiX", "*DISTRIBUTING", stiffness, alone)


def full_models(what, stiffness):
    """Averages by SciPy: a force on the node is shared out as f = W R (R' W R)^-1, and its displacements are f' K^-1 f."""
    rows = lambda nodes: (3 * (np.array(nodes)[:, None] - 1) + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(stiffness.shape[0]), rows(what.rim))
    solve = factorised(stiffness[free][:, free])
    motions = part.rigid_body_modes(what.points[np.array(what.hole) - 1], 3)
    integral, diagonal = what.wall_areas()
    for name, weights in (("equal weights", np.ones(len(integral))), ("area weights", diagonal), ("integrals of shape functions", integral)):
        shared = np.repeat(weights, 3)[:, None] * motions
        shared = shared @ np.linalg.inv(motions.T @ shared)
        force = np.zeros((stiffness.shape[0], 6))
        force[rows(what.hole)] = shared
        yield row("SciPy, full model", f"average, {name}", np.linalg.inv(force[free].T @ solve(force[free])))


def rows_of(settings):
    for refined, mesh in [(refined, mesh) for refined, meshes in MESHES.items() for mesh in meshes]:
        what = plate.Plate(*mesh)
        folder = (settings.work / "hole-{}-{}-{}".format(*mesh)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        stiffness, _ = plate.matrices(folder, what)
        for found in [*ours(settings, folder, what), *calculixs(folder, what), *full_models(what, stiffness)]:
            yield found | {"refined": refined, "n_around": mesh[0], "n_through": mesh[2], "n": 3 * len(what.points)}


# Program, coupling and how its curve looks: rings and crosses of CalculiX lie on curves of supel where the two agree.
CURVES = (
    ("supel", "rigid", "C0", "o-", {"markersize": 4}),
    ("CalculiX", "*RIGID BODY", "C0", "o", {"markersize": 10, "fillstyle": "none"}),
    ("supel", "average, equal weights", "C1", "v-", {"markersize": 4}),
    ("supel", "average, area weights", "C2", "^-", {"markersize": 4}),
    ("CalculiX", "*DISTRIBUTING", "k", "x--", {"markersize": 7, "linewidth": 0.7}),
)
# Key, what it is, and whether the axis starts at zero; differences of a few per cent would not be seen there.
PANELS = (
    ("kx", "stiffness along x, in the plane (N/mm)", None), ("kz", "stiffness along z, across it (N/mm)", 0.0),
    ("krx", "stiffness about x (N mm)", 0.0), ("krz", "stiffness about z, the hole's axis (N mm)", None),
    ("f1_free_hz", "first frequency, node free (Hz)", 0.0), ("f1_held_hz", "first frequency, node held (Hz)", 0.0),
)


def draw(settings):
    if not shutil.which("ccx"):
        print("diagram H is left out: it needs CalculiX (ccx)")
        return
    rows = list(rows_of(settings))
    figure.write_rows(settings.out / "H-hole.csv", rows, settings.origin)
    draw_one(settings, rows)


def draw_one(settings, rows):
    title = "H. A node for a hole of 30 mm in a plate of 120 x 120 x 8 mm held at its rim, against the mesh"
    fig, axes = figure.grid(title, 2, len(PANELS) // 2, sharey=False)
    for ax, (key, label, bottom) in zip(axes.flat, PANELS):
        for program, coupling, colour, mark, style in CURVES:
            own_rows = [row for row in rows if (row["program"], row["coupling"]) == (program, coupling) and row[key] != ""]
            draw_curve(ax, own_rows, key, f"{program}: {coupling}", {"color": colour, "fmt": mark} | style)
        ax.set(yscale="linear")
        ax.set_title(label, fontsize=9, pad=12)
        ax.set_xlabel("degrees of freedom of the plate", fontsize=8)
        ax.set_ylim(bottom=bottom)
    axes[0][-1].legend(fontsize=7, loc="upper left", bbox_to_anchor=(1.02, 1.0))
    figure.save(fig, settings.out / "H-hole.svg", settings.origin)


def draw_curve(ax, rows, key, label, style):
    """Meshes refined in all directions; of an average of supel, those of one element through the thickness too, dotted."""
    points = {refined: [(row["n"], row[key]) for row in rows if row["refined"] == refined] for refined in MESHES}
    if not rows:
        return
    fmt = style.pop("fmt")
    ax.plot(*zip(*points["all"]), fmt, label=label, **style)
    if "average" in label:
        ax.plot(*zip(*points["plane"]), ":", color=style["color"], linewidth=1.5, label=f"{label},\none element through the plate")
