"""Runs supel and the SciPy peers on the same job, one after the other, and prints a table.

    compare.py PAIR [--supel PATH] [--python PATH] [--peer superlu|pardiso ...] [--repeats N]

PAIR is a folder with K.mtx.gz, M.mtx.gz and nodes.csv.gz of the part onshape.toml was written for. Every program gets
OMP_NUM_THREADS=2. Times are of whole processes, from start to exit, the median of the repeats; runs are taken in
turn (A B A B), SuperLU once. Peak memory is what the kernel counted for the process.
"""

import argparse
import json
import os
import pathlib
import statistics
import struct
import subprocess
import sys
import tempfile
import time

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
THREADS = "2"
INPUTS = ("K.mtx.gz", "M.mtx.gz", "nodes.csv.gz")
N_MODES = 50


def run(command, folder):
    """Wall-clock seconds and peak memory in MiB of one process."""
    environment = dict(os.environ, OMP_NUM_THREADS=THREADS, RAYON_NUM_THREADS=THREADS, MKL_NUM_THREADS=THREADS)
    begin = time.perf_counter()
    process = subprocess.Popen(command, cwd=folder, env=environment, stdout=sys.stderr)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - begin
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{command[0]}: exit code {process.returncode}")
    return seconds, usage.ru_maxrss / 1024


def supel_frequencies(path):
    """The tensor `frequencies` (rad/s) of a superelement, by the safetensors layout: length, JSON header, data."""
    content = path.read_bytes()
    (header_length,) = struct.unpack("<Q", content[:8])
    begin, end = json.loads(content[8 : 8 + header_length])["frequencies"]["data_offsets"]
    data = content[8 + header_length :]
    return np.frombuffer(data[begin:end], dtype="<f8") / (2 * np.pi)


def peer_frequencies(path):
    return np.array(json.loads(path.read_text())["frequencies_hz"])


class Program:
    def __init__(self, name, command, result, read, repeats):
        self.name, self.command, self.result, self.read, self.repeats = name, command, result, read, repeats
        self.runs = []

    def seconds(self):
        return statistics.median(seconds for seconds, _ in self.runs)


def programs(arguments, folder):
    chosen = []
    if arguments.supel:
        supel = str(pathlib.Path(arguments.supel).resolve())
        command = [supel, "reduce", "onshape.toml", "--quiet"]
        chosen.append(Program("supel", command, folder / "onshape.supel", supel_frequencies, arguments.repeats))
    for peer in arguments.peer:
        repeats = 1 if peer == "superlu" else arguments.repeats
        result = folder / f"{peer}.json"
        command = [arguments.python, str(HERE / f"scipy_{peer}.py"), str(folder), str(result)]
        chosen.append(Program(f"SciPy + {peer}", command, result, peer_frequencies, repeats))
    return chosen


def table(chosen):
    fastest = chosen[0].seconds()
    frequencies = {program.name: program.read(program.result)[:N_MODES] for program in chosen}
    reference = frequencies[chosen[0].name]
    lines = [
        f"| program | time (s) | min–max | peak memory (MiB) | time / {chosen[0].name} | largest relative difference of "
        f"{N_MODES} frequencies to {chosen[0].name} |",
        "|---|---|---|---|---|---|",
    ]
    for program in chosen:
        times = [seconds for seconds, _ in program.runs]
        memory = max(memory for _, memory in program.runs)
        difference = np.max(np.abs(frequencies[program.name] / reference - 1))
        lines.append(
            f"| {program.name} | {program.seconds():.2f} | {min(times):.2f}–{max(times):.2f} | {memory:.0f} | "
            f"{program.seconds() / fastest:.2f} | {difference:.1e} |"
        )
    # Of all against all: the spread of each frequency.
    spread = np.array(list(frequencies.values()))
    worst = np.max((spread.max(axis=0) - spread.min(axis=0)) / spread.min(axis=0))
    return "\n".join(lines + ["", f"Largest relative difference between any two: {worst:.1e}"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pair", type=pathlib.Path, help="folder with " + ", ".join(INPUTS))
    parser.add_argument("--supel", help="the supel program; without it the peers are compared with each other")
    parser.add_argument("--python", default=sys.executable, help="interpreter with the peers' packages")
    parser.add_argument("--peer", action="append", choices=["superlu", "pardiso"], help="default: both")
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    arguments.peer = arguments.peer or ["pardiso", "superlu"]
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        for name in INPUTS:
            (folder / name).symlink_to((arguments.pair / name).resolve())
        (folder / "onshape.toml").write_text((HERE / "onshape.toml").read_text())
        chosen = programs(arguments, folder)
        for turn in range(max(program.repeats for program in chosen)):
            for program in chosen:
                if turn < program.repeats:
                    program.runs.append(run(program.command, folder))
                    seconds, memory = program.runs[-1]
                    print(f"{program.name}: {seconds:.2f} s, {memory:.0f} MiB", file=sys.stderr, flush=True)
        print(table(chosen))


if __name__ == "__main__":
    main()
