"""The eigenproblem of a part by SciPy's ARPACK for several counts and tolerances, one process, one factorisation.

    arpack_sweep.py FOLDER OUTPUT --solver pardiso|superlu --method herting --shift-below S --runs 50:1e-2,50:1e-4
"""

import argparse
import importlib
import json
import pathlib
import sys
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "peers"))
import reduction
from harness import part


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder")
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--solver", choices=["pardiso", "superlu"], required=True)
    parser.add_argument("--method", choices=["craig-bampton", "herting"], required=True)
    parser.add_argument("--shift-below", type=float, required=True)
    parser.add_argument("--runs", required=True, help="pairs COUNT:TOLERANCE with commas")
    arguments = parser.parse_args()
    solver = importlib.import_module(f"scipy_{arguments.solver}")
    k, m = part.read_matrices(arguments.folder)
    t = part.condensation(arguments.folder, part.read_points(arguments.folder)).t
    k, m = (t.T @ k @ t).tocsr(), (t.T @ m @ t).tocsr()
    shift, n_rigid = -arguments.shift_below, reduction.N_RIGID
    if arguments.method == "craig-bampton":
        k, m, shift, n_rigid = k[12:, 12:].tocsr(), m[12:, 12:].tocsr(), 0.0, 0
    begin = time.perf_counter()
    solve = solver.factorise((k - shift * m).tocsr())
    factor_seconds = time.perf_counter() - begin
    results = []
    for count, tolerance in (word.split(":") for word in arguments.runs.split(",")):
        begin = time.perf_counter()
        lam, _, solves = reduction.arpack(k, m, int(count) + n_rigid, shift, solve, float(tolerance))
        seconds = factor_seconds + time.perf_counter() - begin
        found = np.sqrt(np.abs(lam[n_rigid:])) / (2 * np.pi)
        results.append(
            {"count": int(count), "tolerance": tolerance, "seconds": seconds, "solves": solves, "hz": found.tolist()}
        )
    arguments.output.write_text(json.dumps(results))


if __name__ == "__main__":
    main()
