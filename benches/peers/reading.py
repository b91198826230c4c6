#!/usr/bin/env python3
"""How fast files are read: Matrix Market next to SciPy and fast_matrix_market, OUTPUT4 next to pyYeti, decks next to meshio.

    benches/peers/reading.py --megabytes 100 [--repeats 5] [--what mtx op4 inp]

Needs scipy, fast_matrix_market, pyyeti and meshio. Each run is a process of its own; programs take turns, so that what else the machine
does meets all of them. Every program reads the same file. A matrix ends in compressed rows with both triangles: what the others give as
coordinates is converted, and the time of that is part of theirs in one column and left out in another. Of a deck supel keeps nodes and
groups, meshio the cells as well, so that one row of supel reads the faces of a patch, too. Writes the medians to benches/results as CSV
and SVG, with how many times as fast supel is.
"""

import argparse
import csv
import json
import os
import pathlib
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESULTS = ROOT / "benches" / "results"

PEER = """
import json, os, resource, sys, time
name, path, threads = sys.argv[1], sys.argv[2], int(sys.argv[3])
os.environ["OMP_NUM_THREADS"] = str(threads)
if name == "fast_matrix_market":
    import fast_matrix_market as module
    read = lambda: module.mmread(path, parallelism=threads)
elif name == "scipy.io.mmread":
    import threadpoolctl, scipy.io as module
    def read():
        with threadpoolctl.threadpool_limits(limits=threads):
            return module.mmread(path)
elif name == "pyYeti":
    from pyyeti.nastran import op4
    read = lambda: op4.read(path, justmatrix=True, sparse=True)["kaa"]
elif name == "meshio":
    import meshio
    read = lambda: meshio.read(path)
start = time.perf_counter()
found = read()
middle = time.perf_counter()
items = len(found.points) if name == "meshio" else int(found.tocsr().nnz)
end = time.perf_counter()
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
print(json.dumps({"seconds": end - start, "as_read": middle - start, "items": items, "peak_bytes": peak}))
"""

PEERS = {"mtx": ["fast_matrix_market", "scipy.io.mmread"], "op4": ["pyYeti"], "inp": ["meshio"]}
TITLES = {
    "mtx": "Matrix Market of {} MB into compressed rows, both triangles",
    "op4": "OUTPUT4 in text of {} MB into compressed rows",
    "inp": "deck of {} MB: nodes and groups (meshio: and cells)",
}


def write_mtx(path, megabytes):
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


def write_op4(path, megabytes):
    """A banded matrix with both triangles as sparse columns of OUTPUT4 in text.

    The bytes are those that pyYeti writes of the matrix with `binary=False, sparse="bigmat", digits=16`. pyYeti takes a time that grows with
    the square of the order.
    """
    import numpy as np

    per_column, per_line = 81, 3
    n, half = megabytes * 1_000_000 // (per_column * 24), per_column // 2
    rng = np.random.default_rng(7)
    # Column c of the matrix is row c of the band, from half an element above the diagonal to as many below it.
    band = np.zeros((n, per_column))
    for k in range(half + 1):
        diagonal = rng.standard_normal(n - k)
        band[: n - k, half + k] = diagonal
        band[k:, half - k] = diagonal

    def lines(count):
        return "".join("%23.16E" * min(per_line, count - at) + "\n" for at in range(0, count, per_line))

    whole = lines(per_column)
    with open(path, "w") as out:
        out.write(f"{n:8}{-n:8}{6:8}{2:8}{'KAA':8}1P,{per_line}E23.16\n")
        for column in range(n):
            first, end = max(0, column - half), min(n, column + half + 1)
            count, skipped = end - first, first - (column - half)
            out.write(f"{column + 1:8}{0:8}{2 * count + 2:8}\n{2 * count + 1:8}{first + 1:8}\n")
            numbers = band[column, skipped : skipped + count].tolist()
            out.write((whole if count == per_column else lines(count)) % tuple(numbers))
        out.write(f"{n + 1:8}{1:8}{1:8}\n{2**0.5:23.16E}\n")


def write_inp(path, megabytes):
    """A block of quadratic tetrahedra by number: nodes, elements of ten nodes, a set of nodes."""
    n = megabytes * 1_000_000 // (62 + 75)
    with open(path, "w") as out:
        out.write("*NODE, NSET=ALL\n")
        out.writelines(f"{k + 1}, {k * 1e-3:.10e}, {k % 97 * 1e-2:.10e}, {k % 89 * 1e-2:.10e}\n" for k in range(n))
        out.write("*ELEMENT, TYPE=C3D10, ELSET=BODY\n")
        out.writelines(f"{k + 1}, {', '.join(str((k + 7 * j) % n + 1) for j in range(10))}\n" for k in range(n))
        out.write("*NSET, NSET=FACE\n")
        out.writelines(f"{k + 1}, {k + 2}, {k + 3}, {k + 4}\n" for k in range(0, min(n, 4000), 4))


WRITERS = {"mtx": write_mtx, "op4": write_op4, "inp": write_inp}


def run(command):
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    if ended.returncode != 0:
        raise SystemExit(f"{command}: {ended.stderr}")
    return json.loads(ended.stdout.strip().splitlines()[-1])


def measured(what, arguments):
    """Medians of all programs on the file of a format."""
    folder = ROOT / "target" / "parts"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"reading-{arguments.megabytes}.{what}"
    if not path.exists():
        WRITERS[what](path, arguments.megabytes)
    with open(path, "rb") as file:
        while file.read(1 << 24):
            pass
    own = [arguments.bench] if arguments.bench else ["cargo", "bench", "--quiet", "--bench", "reading", "--"]
    runs = {}
    for _ in range(arguments.repeats):
        for threads in (1, 2):
            for program in ("supel", *PEERS[what]):
                # Programs with one thread are measured once.
                if threads == 2 and program in ("pyYeti", "meshio"):
                    continue
                words = [*own, str(path), str(threads)] if program == "supel" else [sys.executable, "-c", PEER, program, str(path), str(threads)]
                # One thread has one core: supel reads the file in a thread of its own.
                words = ["taskset", "-c", "0", *words] if threads == 1 else words
                runs.setdefault((program, threads), []).append(run(words))
    items = {found["items"] for all_runs in runs.values() for found in all_runs}
    assert len(items) == 1, f"the programs read different files: {items}"
    median = lambda found, key: statistics.median(item[key] for item in found if key in item)
    rows = []
    for (program, threads), found in runs.items():
        seconds = median(found, "seconds")
        against = median(runs["supel", threads], "seconds")
        is_peer = program != "supel"
        size = path.stat().st_size
        rows.append({
            "file": what,
            "megabytes": round(size / 1e6),
            "program": program,
            "threads": threads,
            "seconds": round(seconds, 3),
            "seconds_as_coordinates": round(median(found, "as_read"), 3) if is_peer and what != "inp" else "",
            "megabytes_per_s": round(size / 1e6 / seconds, 1),
            "supel_times_as_fast": round(seconds / against, 2) if is_peer else "",
            "supel_times_as_fast_as_coordinates": round(median(found, "as_read") / against, 2) if is_peer and what != "inp" else "",
            "peak_over_matrix": round(median(found, "peak_bytes") / (12 * items.copy().pop()), 2) if what != "inp" else "",
            "peak_mib": round(median(found, "peak_bytes") / 2**20),
        })
    return rows


def svg(rows, path):
    """Bars of megabytes a second, a group for each file."""
    left, width, y, parts = 230, 680, 8, []
    for what in dict.fromkeys(row["file"] for row in rows):
        group = [row for row in rows if row["file"] == what]
        largest = max(row["megabytes_per_s"] for row in group)
        parts.append(f'<text x="8" y="{y + 16}" font-weight="bold">{TITLES[what].format(group[0]["megabytes"])}</text>')
        y += 26
        for row in group:
            length = (width - left - 90) * row["megabytes_per_s"] / largest
            colour = "#1b6ca8" if row["program"] == "supel" else "#b0b7bf"
            label = f'{row["program"]}, {row["threads"]} thread{"s" if row["threads"] > 1 else ""}'
            parts.append(f'<text x="{left - 8}" y="{y + 14}" text-anchor="end">{label}</text>')
            parts.append(f'<rect x="{left}" y="{y}" width="{length:.1f}" height="18" fill="{colour}"/>')
            parts.append(f'<text x="{left + length + 6:.1f}" y="{y + 14}">{row["megabytes_per_s"]:.3g} MB/s</text>')
            y += 24
        y += 10
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{y}" font-family="sans-serif" font-size="12">'
    path.write_text("\n".join([head, f'<rect width="{width}" height="{y}" fill="white"/>', *parts, "</svg>"]) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--megabytes", type=int, default=100)
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--what", nargs="+", choices=list(WRITERS), default=list(WRITERS))
    parser.add_argument("--bench", help="the program of benches/reading.rs, where it is built already")
    arguments = parser.parse_args()
    load = os.getloadavg()[0]
    rows = [row for what in arguments.what for row in measured(what, arguments)]
    git = ["git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"]
    commit = subprocess.run(git, capture_output=True, text=True, check=False).stdout.strip()
    path = RESULTS / f"reading-{'-'.join(arguments.what)}-{arguments.megabytes}.csv"
    command = f"benches/peers/reading.py --megabytes {arguments.megabytes} --repeats {arguments.repeats} --what {' '.join(arguments.what)}"
    with open(path, "w", newline="") as out:
        out.write(f"# {command}; commit {commit}; {os.cpu_count()} cores, load {load:.1f} before; {time.strftime('%Y-%m-%d')}\n")
        writer = csv.DictWriter(out, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    svg(rows, path.with_suffix(".svg"))
    print(path.read_text())


if __name__ == "__main__":
    main()
