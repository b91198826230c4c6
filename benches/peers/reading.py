#!/usr/bin/env python3
"""How fast files are read, and in how much memory: next to SciPy, fast_matrix_market, pyYeti, h5py and meshio.

    benches/peers/reading.py --megabytes 100 [--repeats 5] [--what mtx op4 inp rua mat mat73 npz coo.npz]

Needs scipy, fast_matrix_market, pyyeti, h5py and meshio. Each run is a process of its own; programs take turns, so that what else the machine
does meets all of them. Every program reads the same file. A matrix ends in compressed rows with both triangles: what the others give as
coordinates is converted, and the time of that is part of theirs in one column and left out in another. Of a deck supel keeps nodes and
groups, meshio the cells as well, so that one row of supel reads the faces of a patch, too. The peak of memory over the matrix, of 12 bytes
for each entry, leaves out what the same program takes for a matrix of one row. Writes the medians to benches/results as CSV
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
import json, os, re, sys, time
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
elif name == "scipy.io.hb_read":
    import scipy.io
    read = lambda: scipy.io.hb_read(path)
elif name == "scipy.io.loadmat":
    import scipy.io
    read = lambda: scipy.io.loadmat(path)["K"]
elif name == "scipy.sparse.load_npz":
    import scipy.sparse
    read = lambda: scipy.sparse.load_npz(path)
elif name == "h5py":
    import h5py, scipy.sparse
    def read():
        with h5py.File(path) as file:
            part = file["K"]
            n = int(part.attrs["MATLAB_sparse"])
            return scipy.sparse.csc_matrix((part["data"][:], part["ir"][:], part["jc"][:]), (n, n))
elif name == "meshio":
    import meshio
    read = lambda: meshio.read(path)
start = time.perf_counter()
found = read()
middle = time.perf_counter()
items = len(found.points) if name == "meshio" else int(found.tocsr().nnz)
end = time.perf_counter()
# What the system counts of a child by getrusage begins with the memory of its parent.
peak = int(re.search("VmHWM:\\s*(\\d+)", open("/proc/self/status").read())[1]) * 1024
print(json.dumps({"seconds": end - start, "as_read": middle - start, "items": items, "peak_bytes": peak}))
"""

PEERS = {
    "mtx": ["fast_matrix_market", "scipy.io.mmread"],
    "op4": ["pyYeti"],
    "inp": ["meshio"],
    "rua": ["scipy.io.hb_read"],
    "mat": ["scipy.io.loadmat"],
    "mat73": ["h5py"],
    "npz": ["scipy.sparse.load_npz"],
    "coo.npz": ["scipy.sparse.load_npz"],
}
ONE_THREAD = {peer for what, peers in PEERS.items() if what != "mtx" for peer in peers}
TITLES = {
    "mtx": "Matrix Market of {} MB into compressed rows, both triangles",
    "op4": "OUTPUT4 in text of {} MB into compressed rows",
    "inp": "deck of {} MB: nodes and groups (meshio: and cells)",
    "rua": "Harwell-Boeing of {} MB into compressed rows",
    "mat": "MATLAB level 5 of {} MB into compressed rows",
    "mat73": "MATLAB v7.3 (HDF5) of {} MB into compressed rows",
    "npz": "NumPy archive of compressed rows, {} MB",
    "coo.npz": "NumPy archive of coordinates, {} MB, into compressed rows",
}


def banded(n):
    """A symmetric matrix of order n with up to 81 entries in a row, in compressed columns."""
    import numpy as np
    import scipy.sparse as sparse

    rng = np.random.default_rng(7)
    sides = [(k, rng.standard_normal(max(n - k, 0))) for k in range(41)]
    sides += [(-k, values) for k, values in sides[1:]]
    offsets = [k for k, values in sides if len(values)]
    return sparse.diags([values for _, values in sides if len(values)], offsets, shape=(n, n)).tocsc()


def order(megabytes, bytes_of_entry):
    return max(1, int(megabytes * 1e6 / (bytes_of_entry * 81)))


def write_rua(path, megabytes):
    """Harwell-Boeing with both triangles, in fields of 10 and 25 characters."""
    k = banded(order(megabytes, 35.7))

    def lines(numbers, form, per_line):
        texts = [form % number for number in numbers.tolist()]
        return ["".join(texts[at : at + per_line]) + "\n" for at in range(0, len(texts), per_line)]

    parts = [lines(k.indptr + 1, "%10d", 8), lines(k.indices + 1, "%10d", 8), lines(k.data, "%25.16E", 3)]
    counts = [len(part) for part in parts]
    with open(path, "w") as out:
        out.write(f"{'stiffness':72}{'K':8}\n{sum(counts):14}{counts[0]:14}{counts[1]:14}{counts[2]:14}{0:14}\n")
        out.write(f"{'RUA':14}{k.shape[0]:14}{k.shape[1]:14}{k.nnz:14}{0:14}\n{'(8I10)':16}{'(8I10)':16}{'(3E25.16)':20}\n")
        for part in parts:
            out.writelines(part)


def write_mat(path, megabytes):
    """What MATLAB saves by default, without compression."""
    import scipy.io

    scipy.io.savemat(path, {"K": banded(order(megabytes, 12))}, appendmat=False)


def write_mat73(path, megabytes):
    """What MATLAB saves with -v7.3: 64-bit indices."""
    import h5py

    k = banded(order(megabytes, 16))
    with h5py.File(path, "w") as file:
        part = file.create_group("K")
        part.attrs.create("MATLAB_sparse", k.shape[0], dtype="u8")
        for name, values in [("data", k.data), ("ir", k.indices.astype("u8")), ("jc", k.indptr.astype("u8"))]:
            part.create_dataset(name, data=values)


def write_npz(path, megabytes):
    import scipy.sparse as sparse

    with open(path, "wb") as out:
        sparse.save_npz(out, banded(order(megabytes, 12)).tocsr(), compressed=False)


def write_coo_npz(path, megabytes):
    import scipy.sparse as sparse

    with open(path, "wb") as out:
        sparse.save_npz(out, banded(order(megabytes, 16)).tocoo(), compressed=False)


def write_mtx(path, megabytes):
    """A symmetric matrix of a chain of blocks with numbers of seventeen digits, about so large."""
    import numpy as np

    rng = np.random.default_rng(7)
    per_row, size = 40, megabytes * 1_000_000
    n = max(1, size // (per_row * 36))
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
    n = max(1, megabytes * 1_000_000 // (per_column * 24))
    half = min(n - 1, per_column // 2)
    per_column = 2 * half + 1
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
    n = max(20, megabytes * 1_000_000 // (62 + 75))
    with open(path, "w") as out:
        out.write("*NODE, NSET=ALL\n")
        out.writelines(f"{k + 1}, {k * 1e-3:.10e}, {k % 97 * 1e-2:.10e}, {k % 89 * 1e-2:.10e}\n" for k in range(n))
        out.write("*ELEMENT, TYPE=C3D10, ELSET=BODY\n")
        out.writelines(f"{k + 1}, {', '.join(str((k + 7 * j) % n + 1) for j in range(10))}\n" for k in range(n))
        out.write("*NSET, NSET=FACE\n")
        out.writelines(f"{k + 1}, {k + 2}, {k + 3}, {k + 4}\n" for k in range(0, min(n, 4000), 4))


# The most memory over the matrix that supel may take.
MAX_PEAK = 2.5

WRITERS = {
    "mtx": write_mtx,
    "op4": write_op4,
    "inp": write_inp,
    "rua": write_rua,
    "mat": write_mat,
    "mat73": write_mat73,
    "npz": write_npz,
    "coo.npz": write_coo_npz,
}


def run(command):
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    if ended.returncode != 0:
        raise SystemExit(f"{command}: {ended.stderr}")
    return json.loads(ended.stdout.strip().splitlines()[-1])


def measured(what, arguments):
    """Medians of all programs on the file of a format."""
    folder = ROOT / "target" / "parts"
    folder.mkdir(parents=True, exist_ok=True)
    path, tiny = folder / f"reading-{arguments.megabytes}.{what}", folder / f"reading-0.{what}"
    for megabytes, file in ((arguments.megabytes, path), (0, tiny)):
        if not file.exists():
            WRITERS[what](file, megabytes)
    with open(path, "rb") as file:
        while file.read(1 << 24):
            pass
    own = [arguments.bench] if arguments.bench else ["cargo", "bench", "--quiet", "--bench", "reading", "--"]
    runs, bases = {}, {}
    for repeat in range(arguments.repeats):
        for threads in (1, 2):
            for program in ("supel", *PEERS[what]):
                # Programs with one thread are measured once.
                if threads == 2 and program in ONE_THREAD:
                    continue
                before = own if program == "supel" else [sys.executable, "-c", PEER, program]
                # One thread has one core: supel reads the file in a thread of its own.
                before = ["taskset", "-c", "0", *before] if threads == 1 else before
                runs.setdefault((program, threads), []).append(run([*before, str(path), str(threads)]))
                if repeat == 0:
                    bases[program, threads] = run([*before, str(tiny), str(threads)])["peak_bytes"]
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
            "peak_over_matrix": round((median(found, "peak_bytes") - bases[program, threads]) / (12 * items.copy().pop()), 2) if what != "inp" else "",
            "peak_mib": round(median(found, "peak_bytes") / 2**20),
            "base_mib": round(bases[program, threads] / 2**20),
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
    # Of small files the buffers of a reader are as large as the matrix.
    beyond = [row for row in rows if row["program"] == "supel" and row["peak_over_matrix"] != "" and row["peak_over_matrix"] > MAX_PEAK]
    if beyond and arguments.megabytes >= 100:
        raise SystemExit(f"more than {MAX_PEAK} times the matrix: {beyond}")


if __name__ == "__main__":
    main()
