#!/usr/bin/env python3
"""Reading Matrix Market: supel, SciPy and fast_matrix_market on files of one size, one and two threads, in turn.

    benches/peers/reading.py --megabytes 100 [--repeats 3]

Needs scipy and fast_matrix_market. Every program reads the same file into compressed rows with both triangles: what the others
give as coordinates is converted, and the time of that is part of theirs, once with it and once without in the table. Each run is a
process of its own; programs take turns, so that what else the machine does meets all of them. Writes the table to
benches/results as CSV and SVG.
"""

import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESULTS = ROOT / "benches" / "results"

PEER = """
import json, resource, sys, time
name, path, threads = sys.argv[1], sys.argv[2], int(sys.argv[3])
if name == "fast_matrix_market":
    import fast_matrix_market as module
    read = lambda: module.mmread(path, parallelism=threads)
else:
    import os
    os.environ["OMP_NUM_THREADS"] = str(threads)
    import threadpoolctl, scipy.io as module
    def read():
        with threadpoolctl.threadpool_limits(limits=threads):
            return module.mmread(path)
start = time.perf_counter()
matrix = read()
middle = time.perf_counter()
matrix = matrix.tocsr()
end = time.perf_counter()
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
print(json.dumps({"seconds": middle - start, "seconds_with_rows": end - start, "entries": int(matrix.nnz), "peak_bytes": peak}))
"""


def write(path, megabytes):
    """A symmetric matrix of a chain of blocks with numbers of seventeen digits, about so large."""
    import numpy as np

    rng = np.random.default_rng(7)
    per_row, size = 40, megabytes * 1_000_000
    n = size // (per_row * 36)
    with open(path, "w") as out:
        out.write(f"%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {sum(min(row + 1, per_row) for row in range(n))}\n")
        for row in range(n):
            first = max(0, row - per_row + 1)
            values = rng.standard_normal(row + 1 - first)
            out.write("".join(f"{row + 1} {first + k + 1} {value:.16e}\n" for k, value in enumerate(values)))


def run(command, environment=None):
    ended = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    if ended.returncode != 0:
        raise SystemExit(f"{command}: {ended.stderr}")
    return json.loads(ended.stdout.strip().splitlines()[-1])


def svg(rows, path, title):
    """Bars of megabytes a second."""
    width, height, left = 640, 40 + 26 * len(rows), 230
    largest = max(row["megabytes_per_s"] for row in rows)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">']
    parts.append(f'<rect width="{width}" height="{height}" fill="white"/><text x="8" y="20">{title}</text>')
    for at, row in enumerate(rows):
        y = 34 + 26 * at
        length = (width - left - 70) * row["megabytes_per_s"] / largest
        colour = "#1b6ca8" if row["program"] == "supel" else "#b0b7bf"
        label = f'{row["program"]}, {row["threads"]} thread{"s" if row["threads"] > 1 else ""}'
        parts.append(f'<text x="{left - 8}" y="{y + 14}" text-anchor="end">{label}</text>')
        parts.append(f'<rect x="{left}" y="{y}" width="{length:.1f}" height="18" fill="{colour}"/>')
        parts.append(f'<text x="{left + length + 6:.1f}" y="{y + 14}">{row["megabytes_per_s"]:.0f} MB/s</text>')
    path.write_text("\n".join(parts + ["</svg>"]) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--megabytes", type=int, default=100)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--bench", help="the program of benches/reading.rs, where it is built already")
    arguments = parser.parse_args()
    folder = ROOT / "target" / "parts"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"reading-{arguments.megabytes}.mtx"
    if not path.exists():
        write(path, arguments.megabytes)
    size = path.stat().st_size
    path.read_bytes()
    own = [arguments.bench] if arguments.bench else ["cargo", "bench", "--quiet", "--bench", "reading", "--"]
    runs = {}
    for _ in range(arguments.repeats):
        for threads in (1, 2):
            for program in ("supel", "fast_matrix_market", "scipy.io.mmread"):
                command = [*own, str(path), str(threads), "1"] if program == "supel" else [sys.executable, "-c", PEER, program, str(path), str(threads)]
                runs.setdefault((program, threads), []).append(run(command))
    assert len({found["entries"] for all_runs in runs.values() for found in all_runs}) == 1, "the programs read different matrices"
    load = os.getloadavg()
    rows = []
    for (program, threads), found in runs.items():
        best = min(item.get("seconds_with_rows", item["seconds"]) for item in found)
        as_read = min(item["seconds"] for item in found)
        final = 12 * found[0]["entries"]
        rows.append({
            "program": program,
            "threads": threads,
            "seconds": round(best, 3),
            "seconds_as_coordinates": round(as_read, 3) if program != "supel" else "",
            "megabytes_per_s": round(size / 1e6 / best, 1),
            "peak_over_matrix": round(min(item["peak_bytes"] for item in found) / final, 2),
        })
    RESULTS.mkdir(exist_ok=True)
    commit = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False).stdout.strip()
    name = f"reading-{arguments.megabytes}"
    with open(RESULTS / f"{name}.csv", "w", newline="") as out:
        out.write(f"# benches/peers/reading.py --megabytes {arguments.megabytes} --repeats {arguments.repeats}; commit {commit}; {os.cpu_count()} cores, load {load[0]:.1f}; {time.strftime('%Y-%m-%d')}\n")
        writer = csv.DictWriter(out, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    svg(rows, RESULTS / f"{name}.svg", f"Matrix Market of {size / 1e6:.0f} MB into compressed rows, both triangles")
    print((RESULTS / f"{name}.csv").read_text())


if __name__ == "__main__":
    main()
