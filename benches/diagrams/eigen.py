"""Diagram A: largest relative error of the eigenvalues against the time of the eigen stage, factorisation included.

Ours has one tolerance, the limit of the arithmetic; its points are numbers of modes. Of SciPy's ARPACK the points are
tolerances. The error is against the independent reference, not the solver's own residual; a run that missed modes is
a cross with their number.
"""

import json
import pathlib
import sys

import numpy as np

from diagrams import figure, own
from harness import part, process
from harness.reference import Reference, judge

COUNTS = (10, 20, 50, 100)
SWEEP_COUNT = 50
TOLERANCES = ("1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-12", "1e-14")
# The tolerance of ARPACK where numbers of modes are compared.
TIGHT = "1e-12"
FLOOR = 1e-17
HERE = pathlib.Path(__file__).resolve().parent


def ours(settings, folder, reference):
    job = own.job_with(folder, "lean.toml", own.LEAN)
    for solver in ("lanczos", "arpack"):
        for count in COUNTS:
            flags = ["--method", settings.method, "--modes", count, "--eigensolver", solver, "--certify", "none"]
            result = own.reduce(settings.supel, folder, job, settings.threads, settings.timeout, *flags)
            found, seconds, work = [], result.run.seconds, result.work
            if result.tensors:
                found, seconds = result.tensors["frequencies"] / (2 * np.pi), result.eigen_seconds()
            # A cluster at the end of the request is kept whole; what was asked for is judged.
            error, missed = judge(found, reference.frequencies(settings.method, max(COUNTS))[:count])
            yield {
                "solver": f"supel {solver}", "modes": count, "tolerance": "", "seconds": seconds, "error": error,
                "missed": missed, "solves": work.get("n_solves", ""), "flops": work.get("factor_flops", ""),
                "peak_mib": result.run.peak_mib, "failure": "" if result.tensors else result.run.failure,
            }


def scipy(settings, folder, reference):
    runs = [f"{SWEEP_COUNT}:{tolerance}" for tolerance in TOLERANCES] + [f"{count}:{TIGHT}" for count in COUNTS if count != SWEEP_COUNT]
    for solver in ("pardiso", "superlu"):
        output = folder / f"sweep-{solver}.json"
        command = [sys.executable, str(HERE / "arpack_sweep.py"), str(folder), str(output), "--solver", solver]
        command += ["--method", settings.method, "--shift-below", str(reference.shift_below()), "--runs", ",".join(runs)]
        run = process.run(command, folder, settings.threads, settings.timeout)
        name = f"SciPy ARPACK + {solver}"
        empty = dict.fromkeys(("seconds", "error", "missed", "solves"), "")
        if run.failure:
            yield {"solver": name, "modes": "", "tolerance": "", **empty, "flops": "", "peak_mib": "", "failure": run.failure}
            continue
        for result in json.loads(output.read_text()):
            expected = reference.frequencies(settings.method, max(COUNTS))[: result["count"]]
            error, missed = judge(result["hz"], expected)
            yield {
                "solver": name, "modes": result["count"], "tolerance": result["tolerance"], "seconds": result["seconds"],
                "error": error, "missed": missed, "solves": result["solves"], "flops": "", "peak_mib": run.peak_mib,
                "failure": "",
            }


def draw(settings, family, dofs):
    folder = part.make(family, dofs, settings.work / f"{family}-{dofs}").resolve()
    reference, n = Reference(folder), part.facts(folder)["n"]
    rows = [*ours(settings, folder, reference), *scipy(settings, folder, reference)]
    name = f"A-{family}-{n}-{settings.method}"
    figure.write_rows(settings.out / f"{name}.csv", rows, settings.origin)
    title = f"A. Eigenpairs of the {family} part, {n} dofs, {settings.method}, {settings.threads} threads"
    fig, axes = figure.axes(title, "largest relative eigenvalue error", "factor + modes (s)", 2)
    for ax, is_sweep in zip(axes, (True, False)):
        ax.set_title(f"{SWEEP_COUNT} modes, points are tolerances" if is_sweep else "points are numbers of modes")
        shown = [row for row in rows if not row["failure"]]
        if is_sweep:
            shown = [row for row in shown if row["modes"] == SWEEP_COUNT]
        else:
            shown = [row for row in shown if row["tolerance"] in ("", TIGHT)]
        for number, solver in enumerate(dict.fromkeys(row["solver"] for row in shown)):
            own_rows = [row for row in shown if row["solver"] == solver]
            own_rows.sort(key=lambda row: (row["modes"], -float(row["tolerance"] or 0)))
            complete = [row for row in own_rows if not row["missed"]]
            x = [max(row["error"], FLOOR) for row in complete]
            ax.plot(x, [row["seconds"] for row in complete], "o-", color=f"C{number}", label=solver, markersize=4)
            for row in complete:
                text = row["tolerance"] if is_sweep else row["modes"]
                ax.annotate(text, (max(row["error"], FLOOR), row["seconds"]), fontsize=6)
            for row in (row for row in own_rows if row["missed"]):
                at = (np.nan_to_num(max(row["error"], FLOOR), nan=1.0), row["seconds"])
                ax.plot(*at, "x", color=f"C{number}")
                ax.annotate(f"{row['missed']} missed", at, fontsize=6)
        ax.legend(fontsize=7)
    figure.save(fig, settings.out / f"{name}.svg", settings.origin)
