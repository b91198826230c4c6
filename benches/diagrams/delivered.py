"""Diagram C: time of the whole job against the error of the frequency response it delivers, with the Pareto front.

The response is that of the twelve dofs of the faces, damped, free, in a band of the lowest ten frequencies; its reference
is a complex factorisation of the full model at each frequency (harness/reference.py). Of ours two
runs are shown: the default job, and one without any comparison and count. A job whose eigensolver missed modes is crossed.
"""

import json
import pathlib
import re
import subprocess
import sys

import numpy as np

from diagrams import figure, own
from harness import part, process
from harness.reference import Reference, judge, reduced_response, response_error

COUNTS = (5, 10, 20, 40, 80)
N_BAND, N_SAMPLES = 10, 25
COLUMNS = ("program", "method", "modes", "seconds", "n_reduced", "error", "own_error_db", "missed", "failure")
PEERS = pathlib.Path(__file__).resolve().parent.parent / "peers"
UNVERIFIED = own.LEAN.replace('"count"', '"none"')


def methods(supel):
    """The methods this supel has."""
    text = subprocess.run([supel, "reduce", "--help"], capture_output=True, text=True, check=True).stdout
    values = re.search(r"--method <METHOD>.*?\[possible values: ([^]]*)\]", text, re.S)
    return [" ".join(word.split()) for word in values.group(1).split(",")]


def ours(settings, folder, error_of):
    jobs = {"verified": "job.toml", "unverified": own.job_with(folder, "unverified.toml", UNVERIFIED)}
    for trust, job in jobs.items():
        for method in methods(settings.supel):
            for count in COUNTS:
                flags = ["--method", method, "--modes", count]
                result = own.reduce(settings.supel, folder, job, settings.threads, settings.timeout, *flags)
                row = {"program": f"supel, {trust}", "method": method, "modes": count, "seconds": result.run.seconds}
                if not result.tensors:
                    yield row | {"failure": result.run.failure}
                    continue
                response = (result.body.get("preservation") or {}).get("response") or {}
                yield row | {
                    "n_reduced": len(result.tensors["stiffness"]), "error": error_of(result.tensors),
                    "own_error_db": response.get("worst_db", ""),
                }


def scipy(settings, folder, reference, error_of):
    for method in ("craig-bampton", "herting"):
        for count in COUNTS:
            output = folder / "delivered.json"
            command = [sys.executable, str(PEERS / "scipy_pardiso.py"), str(folder), str(output), "--method", method]
            command += ["--modes", str(count), "--shift-below", str(reference.shift_below())]
            run = process.run(command, folder, settings.threads, settings.timeout)
            row = {"program": "SciPy + PARDISO", "method": method, "modes": count, "seconds": run.seconds}
            if run.failure:
                yield row | {"failure": run.failure}
                continue
            reduced = np.load(f"{output}.npz")
            found = json.loads(output.read_text())["frequencies_hz"]
            _, missed = judge(found, reference.frequencies(method, count))
            yield row | {"n_reduced": len(reduced["mass"]), "error": error_of(reduced), "missed": missed}


def front(points):
    """The points that no other beats in both; rounding does not make an error smaller."""
    best = []
    for seconds, error in sorted(points):
        if not best or error < 0.999 * best[-1][1]:
            best.append((seconds, error))
    return best


def draw(settings, family, dofs):
    folder = part.make(family, dofs, settings.work / f"{family}-{dofs}").resolve()
    reference, n = Reference(folder), part.facts(folder)["n"]
    band = reference.frequencies("herting", N_BAND)[-1]
    samples = np.linspace(band / N_SAMPLES, band, N_SAMPLES)
    full = reference.response(samples)
    def error_of(reduced):
        return float(response_error(full, reduced_response(reduced["stiffness"], reduced["mass"], samples), reference.span()))

    rows = [*ours(settings, folder, error_of), *scipy(settings, folder, reference, error_of)]
    rows = [dict.fromkeys(COLUMNS, "") | row for row in rows]
    name = f"C-{family}-{n}"
    figure.write_rows(settings.out / f"{name}.csv", rows, settings.origin)
    title = f"C. Whole jobs on the {family} part, {n} dofs, {settings.threads} threads"
    fig, (ax,) = figure.axes(title, "wall time of the job (s)", f"largest error of the response to {band:.0f} Hz")
    shown = [row for row in rows if not row["failure"]]
    for number, key in enumerate(dict.fromkeys((row["program"], row["method"]) for row in shown)):
        own_rows = [row for row in shown if (row["program"], row["method"]) == key]
        points = [(row["seconds"], row["error"]) for row in own_rows]
        ax.plot(*zip(*points), "o", color=f"C{number}", label=", ".join(key), markersize=4)
        for row in own_rows:
            ax.annotate(row["modes"], (row["seconds"], row["error"]), fontsize=6)
            if row["missed"]:
                ax.plot(row["seconds"], row["error"], "x", color="red", markersize=9)
                ax.annotate(f"  {row['missed']} missed", (row["seconds"], row["error"]), fontsize=6, va="top")
    ax.plot(*zip(*front([(row["seconds"], row["error"]) for row in shown if not row["missed"]])), "k--", linewidth=0.8, label="Pareto front")
    ax.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.01, 0.5))
    figure.save(fig, settings.out / f"{name}.svg", settings.origin)
