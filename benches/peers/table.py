#!/usr/bin/env python3
"""Runs supel and its peers on the very same files with the same number of threads and prints one table for each part.

    benches/peers/table.py [--family bulky] [--dofs 10000] [--peer pardiso] [--threads 2] [--repeats 3]

Times are of whole processes, from start to exit, medians of runs taken in turn (A B A B); stages are as each program
reports them. Peak memory is what the kernel counted. Eigenvalues are compared with an independent reference
(harness/reference.py). SciPy and SLEPc are given a good shift found beforehand, which is not in their times. A peer that is
absent, does not do the job or fails is shown as such. Tables go to --out as Markdown and CSV.
"""

import argparse
import csv
import json
import pathlib
import shutil
import statistics
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from harness import environment

environment.enter()

import numpy as np

from harness import machine, part, process, superelement
from harness.floor import ceilings, floor
from harness.reference import Reference, judge

FAMILIES = ("bulky", "slender", "lattice")
STAGES = ("read", "prepare", "factor", "modes", "constraint", "project", "verify", "write")
# Stages of supel's report by the words of the table.
OWN_STAGES = {
    "read": "read",
    "check": "prepare", "partition": "prepare", "rigid-body modes": "prepare",
    "factor": "factor",
    "modes": "modes",
    "constraint modes": "constraint",
    "basis": "project", "projection": "project",
    "certificate": "verify", "enclosures": "verify", "verification": "verify", "preservation": "verify",
    "write": "write",
}
# Distance within which a frequency counts as found: the elements of CalculiX integrate M less exactly than ours.
OTHER_ELEMENTS = 1e-2
# Name, script with its words, what it does of the job.
PEERS = [
    ("SciPy + PARDISO", ["scipy_pardiso.py"], "whole job"),
    ("SciPy + SuperLU", ["scipy_superlu.py"], "whole job"),
    ("SLEPc + MUMPS", ["slepc_mumps.py"], "whole job"),
    ("Exudyn", ["exudyn_hcb.py"], "whole job; factor, modes and constraint modes in one"),
    ("CalculiX *FREQUENCY", ["calculix.py", "frequency"], "mesh to modes, with its own element matrices"),
    ("CalculiX *SUBSTRUCTURE", ["calculix.py", "substructure"], "mesh to stiffness of the faces' nodes"),
    ("pyYeti cbcheck", ["pyyeti_check.py"], "checks of supel's file only"),
]


class Program:
    """One row: how it is started, and its runs."""

    def __init__(self, name, does, command, result, read):
        self.name, self.does, self.command, self.result, self.read = name, does, command, result, read
        self.runs = []

    def failure(self):
        return next((run.failure for run in self.runs if run.failure), "")

    def seconds(self):
        return statistics.median(run.seconds for run in self.runs)


def read_own(folder):
    """Stages and frequencies of supel's report and file."""
    stages = dict.fromkeys(STAGES, 0.0)
    for stage in json.loads((folder / "part.report.json").read_text())["run"]["stages"]:
        stages[OWN_STAGES.get(stage["name"], "verify")] += stage["seconds"]
    return stages, superelement.read(folder / "part.supel")["frequencies"] / (2 * np.pi)


def read_peer(path):
    result = json.loads(path.read_text())
    return result["stages_s"], np.array(result["frequencies_hz"])


def programs(arguments, folder, reference):
    count = str(arguments.modes)
    own = [arguments.supel, "reduce", "job.toml", "--force", "--quiet", "--method", arguments.method, "--modes", count]
    own += ["--threads", str(arguments.threads)]
    chosen = [Program("supel", "whole job, verified", own, folder / "part.supel", lambda: read_own(folder))]
    shift = str(reference.shift_below())
    wanted = [word.lower() for word in arguments.peer or [""]]
    for name, words, does in PEERS:
        if not any(word in name.lower() for word in wanted):
            continue
        python = arguments.slepc_python if "SLEPc" in name else sys.executable
        result = folder / f"{'-'.join(words)}.json"
        command = [python, str(HERE / words[0]), *words[1:], str(folder), str(result)]
        command += ["--method", arguments.method, "--modes", count, "--shift-below", shift]
        chosen.append(Program(name, does, command, result, lambda result=result: read_peer(result)))
    return chosen


def take_turns(chosen, arguments, folder):
    for turn in range(arguments.repeats):
        for program in chosen:
            if program.failure():
                continue
            program.result.unlink(missing_ok=True) if program.name != "supel" else None
            run = process.run(program.command, folder, arguments.threads, arguments.timeout)
            program.runs.append(run)
            print(f"{turn + 1}. {program.name}: {run.failure or f'{run.seconds:.2f} s'}", file=sys.stderr, flush=True)


def rows(chosen, expected):
    """One dictionary for each program."""
    for program in chosen:
        row = {"program": program.name, "does": program.does, "failure": program.failure()}
        if not row["failure"]:
            stages, found = program.read()
            times = [run.seconds for run in program.runs]
            row |= {"seconds": program.seconds(), "min": min(times), "max": max(times)}
            row["peak_mib"] = max(run.peak_mib for run in program.runs)
            row |= {stage: stages[stage] for stage in STAGES if stage in stages}
            if len(found):
                row["eigenvalue_error"], row["missed"] = judge(found[: len(expected)], expected, OTHER_ELEMENTS)
        yield row


def markdown(table, title, origin):
    own = table[0].get("seconds")
    lines = [f"## {title}", ""] + [f"- {name}: {text}" for name, text in origin] + [""]
    heads = ["program", "does", "time (s)", "min–max", "× supel", "peak (MiB)", *STAGES, "eigenvalue error"]
    lines += ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    for row in table:
        if row["failure"]:
            cells = [row["program"], row["does"], row["failure"]] + [""] * (len(heads) - 3)
        else:
            number = lambda key, form: f"{row[key]:{form}}" if key in row else "–"
            ratio = f"{row['seconds'] / own:.2f}" if own else "–"
            cells = [row["program"], row["does"], number("seconds", ".2f"), f"{row['min']:.2f}–{row['max']:.2f}", ratio]
            cells += [number("peak_mib", ".0f"), *(number(stage, ".2f") for stage in STAGES)]
            missed = f"{row['missed']} missed, " if row.get("missed") else ""
            cells.append(missed + number("eigenvalue_error", ".1e"))
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def write(out, name, table, title, origin):
    out.mkdir(parents=True, exist_ok=True)
    text = markdown(table, title, origin)
    (out / f"{name}.md").write_text(text)
    with (out / f"{name}.csv").open("w", newline="") as file:
        file.writelines(f"# {key}: {value}\n" for key, value in origin)
        fields = ["program", "does", "seconds", "min", "max", "peak_mib", *STAGES, "missed", "eigenvalue_error", "failure"]
        writer = csv.DictWriter(file, fields)
        writer.writeheader()
        writer.writerows(table)
    print(text)


def own_floor(folder, rates):
    """A line on how near supel is to what this machine allows."""
    report = json.loads((folder / "part.report.json").read_text())["run"]
    seconds = floor(folder, report["work"], rates)
    took = sum(stage["seconds"] for stage in report["stages"])
    rated = f"products {rates[0] / 1e9:.0f} GFLOP/s, reading {rates[1] / 1e9:.0f} GB/s"
    return f"{seconds:.2f} s by the counters of the last run, which took {took:.2f} s; {rated}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--family", action="append", choices=FAMILIES, help="default: all")
    parser.add_argument("--dofs", action="append", type=int, help="default: 10000")
    parser.add_argument("--peer", action="append", help="part of a peer's name; default: all")
    parser.add_argument("--method", choices=["craig-bampton", "herting"], default="craig-bampton")
    parser.add_argument("--modes", type=int, default=50)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--timeout", type=float, default=1800.0, help="seconds for one process")
    parser.add_argument("--supel", default=str(machine.ROOT / "target/release/supel"))
    parser.add_argument("--slepc-python", default="/usr/bin/python3", help="interpreter that has slepc4py")
    parser.add_argument("--work", type=pathlib.Path, default=machine.ROOT / "target/parts", help="where parts are kept")
    parser.add_argument("--out", type=pathlib.Path, default=HERE.parent / "results")
    arguments = parser.parse_args()
    if not shutil.which(arguments.supel):
        sys.exit(f"{arguments.supel} is missing: cargo build --release")
    arguments.supel = str(pathlib.Path(shutil.which(arguments.supel)).resolve())
    for dofs in arguments.dofs or [10000]:
        for family in arguments.family or FAMILIES:
            origin = machine.origin(arguments.supel)
            folder = part.make(family, dofs, arguments.work / f"{family}-{dofs}").resolve()
            reference = Reference(folder)
            expected = reference.frequencies(arguments.method, arguments.modes)
            chosen = programs(arguments, folder, reference)
            take_turns(chosen, arguments, folder)
            n = part.facts(folder)["n"]
            title = f"{family}, {n} dofs, {arguments.method}, {arguments.modes} modes, {arguments.threads} threads"
            name = f"peers-{family}-{n}-{arguments.method}-{arguments.threads}"
            if not chosen[0].failure():
                origin.append(("floor of supel's run", own_floor(folder, ceilings(arguments.threads))))
            write(arguments.out, name, list(rows(chosen, expected)), title, origin)


if __name__ == "__main__":
    main()
