"""The least time a job could take: what its run read, multiplied and moved, at the best rates of this machine.

    text bytes / 750 MB/s + flops of all factorisations / rate of dense products
    + solves / 8 × 2 × 8 bytes × nonzeros of L / rate of reading      blocks of eight, once down and once up
    + 4 n (vectors)² / rate of dense products                          orthogonalisation in two passes
    + 3 × 12 bytes × nonzeros of M × vectors / 8 / rate of reading

Ordering, analysis and the checks have no floor of their own here: they count as if they took no time.
"""

import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# A plain parser of bytes, two threads.
TEXT_RATE = 750e6
BLOCK = 8
DOUBLE, ENTRY = 8, 12


def ceilings(threads):
    """Rates of this machine: flops of dense products and bytes read, per second."""
    command = ["cargo", "bench", "--quiet", "--bench", "ceilings", "--", str(threads)]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    found = json.loads(run.stdout.splitlines()[-1])
    return found["product_gflops"] * 1e9, found["read_gb_per_s"] * 1e9


def floor(folder, work, rates):
    """Seconds; `work` are the counters of the report."""
    flops, reads = rates
    n, in_triangle = size(folder / "mass.mtx")
    mass_nonzeros = 2 * in_triangle - n
    text = sum((folder / name).stat().st_size for name in ("stiffness.mtx", "mass.mtx"))
    vectors = work["n_solves"]
    factor = work["n_factorisations"] * work["factor_flops"] / flops
    solve = vectors / BLOCK * 2 * DOUBLE * work["factor_nonzeros"] / reads
    basis = 4 * n * vectors**2 / flops
    mass = 3 * ENTRY * mass_nonzeros * vectors / BLOCK / reads
    return text / TEXT_RATE + factor + solve + basis + mass


def size(path):
    """Rows and entries that the header of a Matrix Market file declares."""
    with path.open() as file:
        rows, _, entries = next(line for line in file if not line.startswith("%")).split()
    return int(rows), int(entries)
