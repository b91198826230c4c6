"""Diagram B: error of reduced models under foreign boundaries against their size, for every method.

Three components with two rigid patches: a brick, a connecting rod of the corpus (SUPEL_CORPUS; left out where that is absent)
and a slender frame. The truth is the full model (harness/boundaries.py); supel takes no part in it.
"""

import csv
import dataclasses
import gzip
import os
import pathlib

import numpy as np
import scipy.io

from diagrams import figure, own
from harness import part, structures
from harness.boundaries import BOUNDARIES, ETA, Pencil, decibels, frequency_error

# The band ends 2 % above this elastic frequency of the free component, and starts at this share of the first one.
N_BAND, NEAR_ZERO, N_GRID = 8, 0.1, 40
# Modes are kept up to these multiples of the band's end.
FACTORS = (0.5, 1, 1.5, 2, 3, 4)
# Radius of gyration of the mass on the tip, as a share of the distance of the two nodes.
GYRATION = 0.2
# Errors of frequencies below this are rounding.
LEAST = 1e-10
COLUMNS = ("model", "n", "method", "modes_up_to_over_band", "n_reduced", "bytes", "boundary", "error_db", "relative_error", "frequency_error")
RELIEF = "--inertia-relief"
# Name, flags, with modes, colour, mark. Rubin's points are rings around those of Herting, whose space is the same.
METHODS = (
    ("guyan", ["--method", "guyan"], False, "C7", "s"),
    ("guyan, inertia relief", ["--method", "guyan", RELIEF], False, "C3", "x"),
    ("craig-bampton", ["--method", "craig-bampton"], True, "C0", "o-"),
    ("craig-bampton, inertia relief", ["--method", "craig-bampton", RELIEF], True, "C1", "^-"),
    ("mixed-interface, base held", ["--method", "mixed-interface", "--held", "base"], True, "C5", "D-"),
    ("macneal", ["--method", "macneal"], True, "C4", "P-"),
    ("herting", ["--method", "herting"], True, "C2", "v-"),
    ("rubin (Herting's space)", ["--method", "rubin"], True, "k", "o"),
)
JOB = """[model]
stiffness = "stiffness.mtx"
mass      = "mass.mtx"
nodes     = "nodes.csv"
dofs      = "model.dof"

[[interface]]
name     = "base"
nodes    = {base}
coupling = "rigid"

[[interface]]
name     = "tip"
nodes    = {tip}
coupling = "rigid"

[reduction]
method = "guyan"

[write]
superelement = "part.supel"
"""


@dataclasses.dataclass
class Component:
    """A model in a folder and the nodes of its two patches, counted from zero."""

    name: str
    title: str
    model: structures.Model
    patches: list

    def write(self, folder):
        self.model.write(folder)
        base, tip = ([int(node) + 1 for node in patch] for patch in self.patches)
        (folder / "job.toml").write_text(JOB.format(base=base, tip=tip) + own.LEAN)

    def condensed(self):
        """The pencil on the dofs of the two nodes and of the interior; the tip's mass is that of the component."""
        what = part.condensed(self.model.points, self.model.directions, self.patches)
        k, m = ((what.t.T @ a @ what.t).tocsr() for a in (self.model.stiffness, self.model.mass))
        weight = what.u[:, 0] @ (m @ what.u[:, 0])
        length = float(np.linalg.norm(what.hubs[1] - what.hubs[0]))
        return Pencil(k, m, weight * np.diag([1.0] * 3 + [(GYRATION * length) ** 2] * 3), length)


def brick():
    model = structures.brick((16, 8, 6), (120.0, 60.0, 40.0), 2.1e5, 0.3, 7.85e-9)
    x = model.points[:, 0]
    return Component("brick", "steel brick, 120 x 60 x 40 mm, end faces rigid", model, [np.flatnonzero(x == at) for at in (0.0, 120.0)])


def slender_frame(bays=8, width=0.3):
    """A mast of steel bars: four posts, a ring at the end of each bay, a diagonal on each side; two elements a bar."""
    corners = width / 2 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    points = [[*corner, width * level] for level in range(bays + 1) for corner in corners]
    bars = [(4 * level + i, 4 * level + (i + 1) % 4) for level in range(bays + 1) for i in range(4)]
    for level in range(bays):
        bars += [(4 * level + i, 4 * level + 4 + i) for i in range(4)]
        bars += [(4 * level + i, 4 * level + 4 + (i + 1) % 4) for i in range(4)]
    edges = []
    for a, b in bars:
        points.append((np.array(points[a]) + points[b]) / 2)
        edges += [(a, len(points) - 1), (len(points) - 1, b)]
    model = structures.frame(np.array(points), edges, structures.round_bar(0.01, 2.1e11, 0.3, 7850.0))
    patches = [np.arange(4), np.arange(4 * bays, 4 * bays + 4)]
    return Component("frame", f"mast of steel bars, {bays} bays of {width:g} m, end corners rigid", model, patches)


def rod():
    """The connecting rod of the corpus with its two bores; None where the corpus is absent."""
    folder = pathlib.Path(os.environ.get("SUPEL_CORPUS", part.ROOT / "corpus")) / "pairs" / "ccx_exudyn_conrod"
    if not folder.exists():
        return None
    with (folder / "nodes.csv").open() as file:
        nodes = {row["node"]: [float(row[d]) for d in "xyz"] for row in csv.DictReader(file)}
    dofs = [line.split(".") for line in (folder / "model.dof").read_text().split()]
    labels = [node for node, direction in dofs if direction == "1"]
    if dofs != [[node, str(d + 1)] for node in labels for d in range(3)]:
        raise SystemExit(f"{folder}: rows are not in the order of nodes")
    points = np.array([nodes[label] for label in labels])
    k, m = (structures.symmetric(scipy.io.mmread(gzip.open(folder / f"{name}.mtx.gz"))) for name in "KM")
    radius = lambda y: np.hypot(points[:, 0], points[:, 1] - y)
    patches = [np.flatnonzero(np.abs(radius(y) - 0.005) < 1e-5) for y in (0.0, 0.08)]
    return Component("rod", "connecting rod, bores rigid", structures.Model(points, 3, k, m), patches)


class Truth:
    """Frequencies and dynamic stiffness of the full model in the band."""

    def __init__(self, pencil):
        self.pencil = pencil
        k, m = pencil.stiffness.diagonal(), pencil.mass.diagonal()
        # Far below zero first, then, where ARPACK finds every copy of zero, near the spectrum.
        first = pencil.frequencies("free", 1, -1e-6 * np.median(k / m))[0]
        self.shift = -((2 * np.pi * first) ** 2) / 4
        free = pencil.frequencies("free", N_BAND, self.shift)
        self.band = 1.02 * free[N_BAND - 1]
        self.frequencies = {name: pencil.frequencies(name, 2 * N_BAND, self.shift) for name in BOUNDARIES}
        found = [hz for hzs in self.frequencies.values() for hz in hzs if hz <= self.band]
        self.samples = np.unique([*np.geomspace(NEAR_ZERO * free[0], self.band, N_GRID), *found])
        self.stiffness = [pencil.dynamic_stiffness(hz) for hz in self.samples]

    def errors(self, stiffness, mass):
        """Of a reduced model, for each boundary: dB, relative error of the response, relative error of the frequencies."""
        reduced = dataclasses.replace(self.pencil, stiffness=stiffness, mass=mass)
        both = [(hz, full, reduced.dynamic_stiffness(hz)) for hz, full in zip(self.samples, self.stiffness)]
        for name in BOUNDARIES:
            pairs = [[self.pencil.response(name, d, hz) for d in (full, found)] for hz, full, found in both]
            relative = max(self.pencil.relative_error(name, *pair) for pair in pairs)
            shift = frequency_error(self.frequencies[name], reduced.frequencies(name, 0, self.shift), self.band)
            yield name, max(decibels(*pair) for pair in pairs), relative, shift


def rows_of(settings, component, folder, truth):
    for method, flags, has_modes, *_ in METHODS:
        for factor in FACTORS if has_modes else [""]:
            modes = ["--up-to-hz", repr(float(factor * truth.band))] if has_modes else []
            result = own.reduce(settings.supel, folder, "job.toml", settings.threads, settings.timeout, *flags, *modes)
            if not result.tensors:
                raise SystemExit(f"{component.name}, {method}, {factor}: {result.run.failure}")
            stiffness, mass = result.tensors["stiffness"], result.tensors["mass"]
            size = (folder / "run.supel").stat().st_size
            common = [component.name, component.model.stiffness.shape[0], method, factor, len(mass), size]
            for errors in truth.errors(stiffness, mass):
                yield dict(zip(COLUMNS, [*common, *errors]))


def draw(settings):
    every = []
    for component in (brick(), rod(), slender_frame()):
        if component is None:
            print("the connecting rod is left out: SUPEL_CORPUS names no folder with pairs/ccx_exudyn_conrod")
            continue
        folder = (settings.work / f"foreign-{component.name}").resolve()
        component.write(folder)
        truth = Truth(component.condensed())
        rows = list(rows_of(settings, component, folder, truth))
        figure.write_rows(settings.out / f"B-{component.name}.csv", rows, settings.origin)
        draw_one(settings, component, truth, rows)
        every += rows
    summarise(settings, every)


def summarise(settings, rows):
    """Writes a table of the largest errors over all components for each method, number of modes and boundary."""
    components = list(dict.fromkeys(row["model"] for row in rows))
    lines = [f"## B. Largest errors of the response over {', '.join(components)}", ""]
    lines += [f"- {name}: {text}" for name, text in settings.origin]
    lines += ["", "In each cell: of the worst pair of dofs in dB / of the whole response, relative.", ""]
    lines.append(f"| method | modes up to × the band's end | coordinates: {', '.join(components)} | {' | '.join(BOUNDARIES)} |")
    lines.append("|---" * (3 + len(BOUNDARIES)) + "|")
    for method, factor in dict.fromkeys((row["method"], row["modes_up_to_over_band"]) for row in rows):
        those = [row for row in rows if (row["method"], row["modes_up_to_over_band"]) == (method, factor)]
        sizes = [next(str(row["n_reduced"]) for row in those if row["model"] == name) for name in components]
        worst = lambda key, boundary: max(row[key] for row in those if row["boundary"] == boundary)
        errors = [f"{worst('error_db', name):.2g} / {percent(worst('relative_error', name))}" for name in BOUNDARIES]
        lines.append(f"| {' | '.join([method, str(factor), ', '.join(sizes), *errors])} |")
    path = settings.out / "B-summary.md"
    path.write_text("\n".join([*lines, ""]))
    print(path)


def percent(share):
    """Two digits, without an exponent: 0.0012 is 0.12 %."""
    text = f"{float(f'{100 * share:.2g}'):.6f}"
    return f"{text.rstrip('0').rstrip('.')} %"


# Rows of the figure: what is drawn over what; errors below the least are drawn there.
RESPONSE = ("error_db", 1e-4, "error of the worst pair of dofs (dB)")
WHOLE = ("relative_error", 1e-6, "relative error of the whole response")
FREQUENCY = ("frequency_error", LEAST, "error of a frequency (1: missing)")
COORDINATES = ("n_reduced", 1, "coordinates of the superelement")
KIB = ("bytes", 1024, "file (KiB)")
# Curves whose points have their numbers, and where these stand.
LABELLED = {"craig-bampton": (0, 7), "herting": (-8, -7)}
DRAWN = ((RESPONSE, COORDINATES), (WHOLE, COORDINATES), (FREQUENCY, COORDINATES), (RESPONSE, KIB))


def draw_one(settings, component, truth, rows):
    n = component.model.stiffness.shape[0]
    title = f"B. {component.title[0].upper()}{component.title[1:]}, {n} dofs: errors up to {truth.band:.0f} Hz under four boundaries"
    fig, axes = figure.grid(title, len(DRAWN), len(BOUNDARIES), panel=(3.1, 2.7))
    for column, boundary in enumerate(BOUNDARIES):
        for line, (y, x) in enumerate(DRAWN):
            ax = axes[line][column]
            draw_curves(ax, [row for row in rows if row["boundary"] == boundary], y, x)
            ax.set_xlabel(x[2], fontsize=8)
            if column == 0:
                ax.set_ylabel(y[2], fontsize=8)
        axes[0][column].set_title({"both held": "both held, driven there"}.get(boundary, boundary), fontsize=9)
    axes[0][-1].legend(fontsize=7, loc="upper left", bbox_to_anchor=(1.02, 1.0))
    note = "numbers: modes are kept up to\nthis multiple of the band's end\n\nthe mass on the tip is that of\nthe component itself\n\n"
    note += f"structural damping {ETA:g}\n\nwhere no free mode is kept herting\nis guyan with inertia relief"
    axes[1][-1].text(1.04, 0.98, note, transform=axes[1][-1].transAxes, fontsize=7, va="top")
    figure.save(fig, settings.out / f"B-{component.name}.svg", settings.origin)


def draw_curves(ax, rows, y, x):
    """One boundary: a curve for each method. Where two coincide the ring of Rubin's lies around the mark of Herting's."""
    for method, _, has_modes, colour, mark in METHODS:
        shown = [row for row in rows if row["method"] == method]
        points = [(row[x[0]] / x[1], max(row[y[0]], y[1])) for row in shown]
        is_ring = method.startswith("rubin")
        style = {"markersize": 9, "fillstyle": "none"} if is_ring else {"markersize": 4 if has_modes else 7, "linewidth": 0.9, "zorder": 2 if has_modes else 4}
        ax.plot(*zip(*points), mark, color=colour, label=method, **style)
        if method in LABELLED and y is RESPONSE and x is COORDINATES:
            for row, point in zip(shown, points):
                place = {"xytext": LABELLED[method], "textcoords": "offset points", "ha": "center", "va": "center"}
                ax.annotate(f"{row['modes_up_to_over_band']:g}", point, color=colour, fontsize=6, **place)
