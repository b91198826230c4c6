"""What CalculiX does of the job of a part, from the same mesh: `frequency` or `substructure`.

`*FREQUENCY` finds the modes, with both faces held (Craig-Bampton) or rigid and free (Herting). `*SUBSTRUCTURE GENERATE`
condenses the stiffness on the nodes of the faces; it has no mass, no modes and no rigid faces.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

import reduction
from harness import part


def frequency(arguments):
    if arguments.method == "craig-bampton":
        held, count = ["*BOUNDARY", "BASE, 1, 3", "TIP, 1, 3"], arguments.modes
    else:
        # Reference and rotation node of each face.
        n = part.facts(arguments.folder)["n"] // 3
        hubs = part.condensation(arguments.folder, part.read_points(arguments.folder)).hubs
        held, count = [], arguments.modes + reduction.N_RIGID
        for k, (name, hub) in enumerate(zip(("BASE", "TIP"), hubs)):
            position = ", ".join(repr(float(x)) for x in hub)
            own = [n + 1 + 2 * k, n + 2 + 2 * k]
            held += ["*NODE"] + [f"{node}, {position}" for node in own]
            held.append(f"*RIGID BODY, NSET={name}, REF NODE={own[0]}, ROT NODE={own[1]}")
    return held + ["*STEP", "*FREQUENCY", str(count), "*END STEP"]


def substructure(_):
    output = "*SUBSTRUCTURE MATRIX OUTPUT, STIFFNESS=YES, OUTPUT FILE=USER DEFINED, FILE NAME=faces"
    retained = ["*RETAINED NODAL DOFS, SORTED=NO", "BASE, 1, 3", "TIP, 1, 3"]
    return ["*STEP", "*SUBSTRUCTURE GENERATE", *retained, output, "*END STEP"]


def frequencies(text):
    """The eigenvalues in (rad/s)^2 of a .dat file, without the rigid-body modes: complex ones are those below zero."""
    rows = re.findall(r"^\s+\d+\s+(\S+)\s+\S+\s+(\S+)\s+\S+\s*$", text.split("P A R T I C I P A T I O N")[0], re.M)
    return np.array([float(value) for value, _ in rows])


def main():
    step = {"frequency": frequency, "substructure": substructure}[sys.argv.pop(1)]
    arguments = reduction.parsed(__doc__)
    if not shutil.which("ccx"):
        reduction.decline("absent: ccx is not installed")
    mesh = pathlib.Path(arguments.folder).resolve() / "model.inp"
    if not mesh.exists():
        reduction.decline("the part is no solid")
    stages = reduction.Stages()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "model.inp").symlink_to(mesh)
        (folder / "job.inp").write_text("\n".join(["*INCLUDE, INPUT=model.inp", *step(arguments), ""]))
        ended = subprocess.run(["ccx", "job"], cwd=folder, capture_output=True, text=True)
        errors = [line for line in ended.stdout.splitlines() if "ERROR" in line]
        if ended.returncode != 0 or errors:
            raise SystemExit(f"ccx: exit code {ended.returncode} {' '.join(errors)[:120]}")
        stages.done("modes" if step is frequency else "constraint")
        lam = None
        if step is frequency:
            lam = frequencies((folder / "job.dat").read_text())[-arguments.modes :]
    reduction.write(arguments.output, stages, lam)


if __name__ == "__main__":
    main()
