"""Diagram G: what the scene accepts, what supel promises, and what is found on the full model.

Four components with two rigid patches, three limits on the frequency response, two methods, `modes = { accept = true }`. What is found comes
from the full model by SciPy alone (harness/boundaries.py), on a grid of its own, at the resonances, and where the report says that the
error is largest.
"""

import numpy as np

from diagrams import figure, foreign, own
from harness import structures
from harness.boundaries import ETA, decibels

LIMITS_DB = (3.0, 1.0, 0.3)
METHODS = (("herting", "C2", "v"), ("craig-bampton", "C0", "o"))
# Points of the grid between the ends of the band.
N_GRID = 80
COLUMNS = ("model", "n", "method", "asked_db", "promised_db", "found_db", "at_hz", "modes", "modes_by_rule", "verdict")
# Modes of the rule of thumb: up to this multiple of the band.
RULE = 2.0
SCENE = """
[scene]
band_hz    = [{low}, {high}]
boundaries = ["free"]
damping    = {{ ratio = {ratio} }}
{accept}

[run]
certify = "count"
"""


def plate():
    model = structures.brick((24, 12, 1), (240.0, 120.0, 6.0), 2.1e5, 0.3, 7.85e-9)
    x = model.points[:, 0]
    return foreign.Component("plate", "steel plate, 240 x 120 x 6 mm, end faces rigid", model, [np.flatnonzero(x == at) for at in (0.0, 240.0)])


class Truth(foreign.Truth):
    """The response of the free component, computed once at each frequency."""

    def __init__(self, pencil):
        super().__init__(pencil)
        self.low = self.samples[0]
        grid = np.geomspace(self.low, self.band, N_GRID)
        free = self.frequencies["free"]
        self.samples = np.unique([*grid, *free[free <= self.band]])
        self.full = {}

    def found(self, stiffness, mass, at_hz):
        """The largest error of a reduced model in dB."""
        reduced = foreign.dataclasses.replace(self.pencil, stiffness=stiffness, mass=mass)
        return max(self.error(reduced, hz) for hz in [*self.samples, at_hz])

    def error(self, reduced, hz):
        if hz not in self.full:
            self.full[hz] = self.pencil.dynamic_stiffness(hz)
        full, found = (self.pencil.response("free", d, hz) for d in (self.full[hz], reduced.dynamic_stiffness(hz)))
        return decibels(full, found)


def job_of(folder, truth, accept):
    text = (folder / "job.toml").read_text().replace(own.LEAN, "")
    scene = SCENE.format(low=repr(float(truth.low)), high=repr(float(truth.band)), ratio=ETA / 2, accept=accept)
    (folder / "accepted.toml").write_text(text + scene)
    return "accepted.toml"


def reduce(settings, component, folder, job, *flags):
    result = own.reduce(settings.supel, folder, job, settings.threads, settings.timeout, *flags)
    if not result.tensors:
        raise SystemExit(f"{component.name}, {flags}: {result.run.failure}")
    return result


def rows_of(settings, component, folder, truth):
    for method, *_ in METHODS:
        plain = job_of(folder, truth, "")
        ruled = reduce(settings, component, folder, plain, "--method", method, "--up-to-hz", repr(float(RULE * truth.band)))
        for limit in LIMITS_DB:
            job = job_of(folder, truth, f"accept     = {{ response_db = {limit} }}")
            text = (folder / job).read_text().replace('method = "guyan"', f'method = "{method}"\nmodes  = {{ accept = true }}')
            (folder / job).write_text(text)
            result = reduce(settings, component, folder, job)
            promised = next(a["error"] for a in result.body["preservation"]["accuracy"] if a["measure"] == "response")
            at_hz = result.body["preservation"]["response"]["worst_at_hz"]
            found = truth.found(result.tensors["stiffness"], result.tensors["mass"], at_hz)
            counts = [len(run.tensors["frequencies"]) for run in (result, ruled)]
            common = [component.name, component.model.stiffness.shape[0], method]
            yield dict(zip(COLUMNS, [*common, limit, promised, found, at_hz, *counts, result.body["verdict"]]))


def draw(settings):
    rows = []
    for component in (foreign.brick(), foreign.rod(), foreign.slender_frame(), plate()):
        if component is None:
            print("the connecting rod is left out: SUPEL_CORPUS names no folder with pairs/ccx_exudyn_conrod")
            continue
        folder = (settings.work / f"accepted-{component.name}").resolve()
        component.write(folder)
        rows += rows_of(settings, component, folder, Truth(component.condensed()))
    figure.write_rows(settings.out / "G-accepted.csv", rows, settings.origin)
    fig, (errors, modes) = figure.axes("G. Error of the response: accepted, promised, found", "accepted (dB)", "found on the full model (dB)", 2)
    for method, colour, mark in METHODS:
        those = [row for row in rows if row["method"] == method]
        errors.plot([r["asked_db"] for r in those], [r["found_db"] for r in those], mark, color=colour, fillstyle="none", label=f"{method}, found")
        errors.plot([r["asked_db"] for r in those], [r["promised_db"] for r in those], ".", color=colour, markersize=4, label=f"{method}, promised")
        for limit, size in zip(LIMITS_DB, (11, 8, 5)):
            kept = [r for r in those if r["asked_db"] == limit]
            modes.plot([r["modes_by_rule"] for r in kept], [r["modes"] for r in kept], mark, color=colour, fillstyle="none", markersize=size, label=f"{method}, {limit:g} dB")
    ends = [min(LIMITS_DB) / 2, 2 * max(LIMITS_DB)]
    errors.plot(ends, ends, "k-", linewidth=0.8, label="accepted")
    errors.plot(ends, [end / 10 for end in ends], "k:", linewidth=0.8, label="a tenth of that")
    ends = [4, 200]
    modes.plot(ends, ends, "k-", linewidth=0.8)
    modes.set(xlabel=f"modes up to {RULE:g} times the band", ylabel="modes kept")
    errors.legend(fontsize=7)
    modes.legend(fontsize=7)
    figure.save(fig, settings.out / "G-accepted.svg", settings.origin)
