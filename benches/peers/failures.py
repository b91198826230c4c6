#!/usr/bin/env python3
"""Two silent failures of other programs and supel's answer to the same matrices, as one table.

    python3 benches/peers/failures.py [--supel PATH] [--calls N] [--keep FOLDER] [--check]

The test piece is a free steel bar of 1.0 x 0.05 x 0.05 m, 20 x 2 x 2 C3D8 elements, 567 dofs. CalculiX writes its K and M
(`*FREQUENCY, SOLVER=MATRIXSTORAGE`), all programs read those, and LAPACK (`scipy.linalg.eigh`) says what is right.

1. Exudyn computes the free modes N times (`FEMinterface.ComputeEigenmodes`). It factors K at shift zero, where the K of a free
   body is singular; its start vector is random, so every call may give other frequencies.
2. CalculiX condenses K on both ends (`*SUBSTRUCTURE GENERATE`).

Needed: the program `ccx` (Debian package calculix-ccx) and the Python packages of requirements-failures.txt; where they are missing,
the script makes an environment for them in the folder that PEERS_VENV names. `--check` says what is missing and changes
nothing. Exit code: 0 where supel's numbers are right, 1 where they are not, 2 where something is missing.
"""

import argparse
import importlib.util
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
CELLS = (20, 2, 2)
SIZE_M = (1.0, 0.05, 0.05)
N_ELASTIC = 12
N_RIGID = 6
# A frequency is called wrong past this relative difference: every digit an engineer reads.
WRONG = 1e-3
PACKAGES = ("exudyn", "numpy", "scipy")


def label(i, j, k):
    return 1 + i + (CELLS[0] + 1) * (j + (CELLS[1] + 1) * k)


def nodes():
    """Label and position of every node."""
    grid = [(i, j, k) for k in range(CELLS[2] + 1) for j in range(CELLS[1] + 1) for i in range(CELLS[0] + 1)]
    return [(label(*point), [SIZE_M[d] * point[d] / CELLS[d] for d in range(3)]) for point in grid]


def ends():
    """Labels of the nodes of both end faces."""
    return [n for n, x in nodes() if x[0] in (0.0, SIZE_M[0])]


def deck(step):
    """A CalculiX input deck of the bar with one step."""
    lines = ["*NODE, NSET=ALL"] + [f"{n}, {x[0]!r}, {x[1]!r}, {x[2]!r}" for n, x in nodes()]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=BAR")
    number = 0
    for k in range(CELLS[2]):
        for j in range(CELLS[1]):
            for i in range(CELLS[0]):
                number += 1
                face = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                corners = [label(a, b, k + up) for up in (0, 1) for a, b in face]
                lines.append(", ".join(str(n) for n in [number] + corners))
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "2.1e11, 0.3", "*DENSITY", "7800"]
    lines += ["*SOLID SECTION, ELSET=BAR, MATERIAL=STEEL", "*NSET, NSET=ENDS", ",\n".join(str(n) for n in ends())]
    return "\n".join(lines + ["*STEP"] + step + ["*END STEP", ""])


def run(command, folder):
    """Runs a program and gives back its exit code and what it printed; a missing one ends the script."""
    try:
        ended = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    except FileNotFoundError:
        sys.exit(f"{command[0]} is not installed")
    return ended.returncode, ended.stdout + ended.stderr


def by_calculix(folder):
    """K and M of the bar (files bar.sti, bar.mas, bar.dof) and what CalculiX calls the condensed K (ends.mtx)."""
    (folder / "bar.inp").write_text(deck(["*FREQUENCY, SOLVER=MATRIXSTORAGE", "10"]))
    substructure = ["*SUBSTRUCTURE GENERATE", "*RETAINED NODAL DOFS, SORTED=NO", "ENDS, 1, 3"]
    output = "*SUBSTRUCTURE MATRIX OUTPUT, STIFFNESS=YES, OUTPUT FILE=USER DEFINED, FILE NAME=ends"
    (folder / "substructure.inp").write_text(deck(substructure + [output]))
    said = {}
    for job, result in [("bar", "bar.mas"), ("substructure", "ends.mtx")]:
        code, text = run(["ccx", job], folder)
        if not (folder / result).exists():
            sys.exit(f"ccx wrote no {result}:\n{text}")
        words = [line for line in text.splitlines() if "WARNING" in line.upper() or "ERROR" in line.upper()]
        said[job] = f"exit {code}, {len(words)} warnings"
    return said


def triplets(path, n):
    """A symmetric matrix of which CalculiX writes one triangle as `row column value`."""
    import numpy as np

    rows = np.loadtxt(path)
    i, j = rows[:, 0].astype(int) - 1, rows[:, 1].astype(int) - 1
    matrix = np.zeros((n, n))
    matrix[i, j] = rows[:, 2]
    matrix[j, i] = rows[:, 2]
    return matrix


def user_element(path):
    """The matrix of an Abaqus `*USER ELEMENT` file and the (node, direction) of its rows."""
    import numpy as np

    def numbers(line):
        return [word for word in line.replace("**", "").split(",") if word.strip()]

    lines = path.read_text().splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("*MATRIX"))
    element = next(i for i, line in enumerate(lines) if "ELEMENT NODES" in line)
    labels = [int(word) for line in lines[element + 1 : at] if line.startswith("**") for word in numbers(line)]
    directions = [int(line.split(",")[-1]) for line in lines[element + 1 : at] if not line.startswith("**")]
    values = [float(word) for line in lines[at + 1 :] if not line.startswith("*") for word in numbers(line)]
    n = len(labels)
    matrix = np.zeros((n, n))
    matrix[np.tril_indices(n)] = values
    return matrix + np.tril(matrix, -1).T, list(zip(labels, directions, strict=True))


def by_exudyn(stiffness, mass, n_calls):
    """Elastic frequencies in Hz of every call."""
    import numpy as np
    from exudyn.FEM import FEMinterface
    from scipy.sparse import csr_matrix

    fem = FEMinterface()
    fem.nodes = {"Position": np.array([x for _, x in nodes()])}
    fem.stiffnessMatrix, fem.massMatrix = csr_matrix(stiffness), csr_matrix(mass)
    found = []
    for _ in range(n_calls):
        fem.ComputeEigenmodes(N_ELASTIC, excludeRigidBodyModes=N_RIGID, useSparseSolver=True)
        found.append(np.sqrt(np.sort(fem.eigenValues)) / (2 * np.pi))
    return np.array(found)


def by_supel(program, folder):
    """Exit code, verdict, tensors and metadata of a Herting reduction on both ends."""
    import numpy as np

    table = "\n".join(["node,x,y,z"] + [f"{n},{x[0]!r},{x[1]!r},{x[2]!r}" for n, x in nodes()])
    (folder / "nodes.csv").write_text(table + "\n")
    files = "--stiffness bar.sti --mass bar.mas --dofs bar.dof --nodes nodes.csv --output bar.supel"
    interface = "ends=" + ",".join(str(n) for n in ends())
    flags = ["--interface", interface, "--method", "herting", "--modes", str(N_ELASTIC), "--quiet"]
    code, text = run([program, "reduce", *files.split(), *flags], folder)
    if not (folder / "bar.supel").exists():
        sys.exit(f"supel wrote no superelement, exit {code}:\n{text}")
    content = (folder / "bar.supel").read_bytes()
    (length,) = struct.unpack("<Q", content[:8])
    header = json.loads(content[8 : 8 + length])
    metadata = json.loads(header.pop("__metadata__")["supel"])
    tensors = {}
    for name, entry in header.items():
        begin, end = (8 + length + offset for offset in entry["data_offsets"])
        tensors[name] = np.frombuffer(content[begin:end], dtype="<f8").reshape(entry["shape"])
    return code, metadata, tensors


def rigid_motions(dofs):
    """The six unit motions at dofs (node, direction from one), about the origin."""
    import numpy as np

    position = dict(nodes())
    motions = np.zeros((len(dofs), 6))
    for row, (node, direction) in enumerate(dofs):
        x, axis = position[node], direction - 1
        motions[row, axis] = 1.0
        for a in range(3):
            motions[row, 3 + a] = np.cross(np.eye(3)[a], x)[axis]
    return motions


def examine(folder, program, n_calls):
    """Everything the table needs."""
    import numpy as np
    import scipy.linalg as la

    said = by_calculix(folder)
    dofs = [tuple(int(word) for word in line.split(".")) for line in (folder / "bar.dof").read_text().split()]
    stiffness, mass = (triplets(folder / name, len(dofs)) for name in ("bar.sti", "bar.mas"))
    exact = np.sqrt(la.eigh(stiffness, mass, eigvals_only=True)[N_RIGID : N_RIGID + N_ELASTIC]) / (2 * np.pi)
    exudyn = by_exudyn(stiffness, mass, n_calls)
    code, metadata, tensors = by_supel(program, folder)

    condensed, retained = user_element(folder / "ends.mtx")
    row_of = {dof: row for row, dof in enumerate(dofs)}
    b = np.array([row_of[dof] for dof in retained])
    i = np.setdiff1d(np.arange(len(dofs)), b)
    raw = stiffness[np.ix_(b, b)]
    schur = raw - stiffness[np.ix_(b, i)] @ la.solve(stiffness[np.ix_(i, i)], stiffness[np.ix_(i, b)], assume_a="pos")
    own_order = [
        (node["label"], 1 + "ux uy uz".split().index(name)) for node in metadata["interface_nodes"] for name in node["dofs"]
    ]
    place = [own_order.index(dof) for dof in retained]
    own = tensors["stiffness"][np.ix_(place, place)]
    motions = rigid_motions(retained)
    return {
        "said": said,
        "exact": exact,
        "exudyn": exudyn,
        "supel": np.sort(tensors["frequencies"])[:N_ELASTIC] / (2 * np.pi),
        "code": code,
        "verdict": metadata["verification"]["verdict"],
        "difference": {name: relative(matrix, schur) for name, matrix in [("ccx", condensed), ("supel", own)]},
        "unreduced": relative(condensed, raw),
        "force": {
            name: np.abs(matrix @ motions).max() / np.abs(matrix).max()
            for name, matrix in [("ccx", condensed), ("supel", own), ("exact", schur)]
        },
    }


def relative(matrix, expected):
    import numpy as np

    return np.abs(matrix - expected).max() / np.abs(expected).max()


def table(result, n_calls):
    """The table and whether supel is right."""
    import numpy as np

    exact, exudyn, own = result["exact"], result["exudyn"], result["supel"]
    error = np.abs(exudyn / exact - 1)
    n_wrong = int((error.max(axis=1) > WRONG).sum())
    call, mode = np.unravel_index(np.argmax(error), error.shape)
    own_error = np.abs(own / exact - 1).max()
    verdict = f"{result['verdict']}, exit {result['code']}"

    def pair(frequencies):
        return " / ".join(f"{frequency:.3f}" for frequency in frequencies[:2])

    first = np.argmax(error[:, :2].max(axis=1))
    lines = [
        "| | exact (LAPACK) | the other program says | supel says |",
        "|---|---|---|---|",
        f"| first bending pair, Hz | {pair(exact)} | Exudyn: {pair(exudyn[first])} in call {first + 1} of {n_calls} | {pair(own)} |",
        f"| calls with a frequency wrong by more than {WRONG:.1%} | | Exudyn: {n_wrong} of {n_calls} | none: same input, same bytes |",
        f"| largest relative error of {N_ELASTIC} frequencies | | Exudyn: {error[call, mode]:.1e}, mode {mode + 1} | {own_error:.1e} |",
        "| what it says about that | | Exudyn: nothing, no exception | " + verdict + " |",
        f"| stiffness condensed on both ends, relative difference | 0 | CalculiX: {result['difference']['ccx']:.2g} | "
        f"{result['difference']['supel']:.1e} |",
        f"| its largest force under rigid-body motion / largest entry | {result['force']['exact']:.1e} | "
        f"CalculiX: {result['force']['ccx']:.2g} | {result['force']['supel']:.1e} |",
        f"| relative difference to the stiffness that was never condensed | | CalculiX: {result['unreduced']:.1e} | |",
        f"| what it says about that | | CalculiX: {result['said']['substructure']} | {verdict} |",
    ]
    # The dense reference carries the rounding of K and the shift of a singular pencil: eps * largest / smallest eigenvalue,
    # below 1e-7 for this bar; the condensed one eps times the condition of K_II, below 1e-9.
    is_right = own_error < 1e-7 and result["difference"]["supel"] < 1e-9
    return "\n".join(lines), is_right and result["code"] == 0 and result["verdict"] == "pass"


def environment():
    """The folder of the environment that the script makes for itself."""
    default = pathlib.Path(tempfile.gettempdir()) / "supel-peers-failures"
    return pathlib.Path(os.environ.get("PEERS_VENV", default))


def interpreter():
    """An interpreter that has the packages: this one, or the one of the environment; none where neither has."""
    if all(importlib.util.find_spec(name) for name in PACKAGES):
        return sys.executable
    python = environment() / "bin" / "python"
    return str(python) if python.exists() else None


def install():
    """Makes the environment and gives back its interpreter."""
    python = environment() / "bin" / "python"
    subprocess.run([sys.executable, "-m", "venv", str(environment())], check=True)
    requirements = str(HERE / "requirements-failures.txt")
    subprocess.run([str(python), "-m", "pip", "install", "--quiet", "-r", requirements], check=True)
    return str(python)


def missing(program):
    """What has to be installed before the script can run, a line each."""
    wanted = {"ccx": "the program ccx (Debian: apt-get install calculix-ccx)", program: f"the program {program}"}
    return [what for name, what in wanted.items() if shutil.which(name) is None]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--supel", default="supel", help="the supel program")
    parser.add_argument("--calls", type=int, default=50, help="how often Exudyn is asked for the same modes")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for decks, matrices and results")
    parser.add_argument("--check", action="store_true", help="say what is missing and end")
    arguments = parser.parse_args()
    python = interpreter()
    lacking = missing(arguments.supel)
    if arguments.check and python is None:
        lacking.append(f"the Python packages {', '.join(PACKAGES)} (without --check the script installs them)")
    for what in lacking:
        print(f"missing: {what}", file=sys.stderr)
    if lacking:
        sys.exit(2)
    if arguments.check:
        return
    if python != sys.executable:
        python = python or install()
        os.execv(python, [python, str(HERE / "failures.py"), *sys.argv[1:]])
    program = str(pathlib.Path(shutil.which(arguments.supel)).resolve())
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        result = examine(folder, program, arguments.calls)
    text, is_right = table(result, arguments.calls)
    print(text)
    sys.exit(0 if is_right else 1)


if __name__ == "__main__":
    main()
