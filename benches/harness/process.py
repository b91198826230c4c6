"""Whole processes: wall time and peak memory."""

import dataclasses
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

THREAD_VARIABLES = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "RAYON_NUM_THREADS")
LAUNCHER = [sys.executable, "-I", "-S", str(pathlib.Path(__file__).resolve().parent / "launch.py")]
# A peer that does not do a job ends with this code and says so in its last line.
DECLINED = 3


@dataclasses.dataclass
class Run:
    """One process from start to exit."""

    seconds: float
    peak_mib: float
    # Empty where it ended well, else what went wrong.
    failure: str


def run(command, folder, threads, timeout):
    """Runs a program; one that takes longer than the timeout in seconds is ended and counts as failed."""
    environment = dict(os.environ, **{name: str(threads) for name in THREAD_VARIABLES})
    with tempfile.NamedTemporaryFile("r") as counted:
        process = subprocess.Popen(
            [*LAUNCHER, counted.name, *command], cwd=folder, env=environment, text=True, errors="replace",
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True,
        )
        try:
            output, _ = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return Run(timeout, 0.0, f"not done after {timeout:.0f} s")
        result = json.load(counted)
    last = ([line.strip() for line in output.splitlines() if line.strip()] or [""])[-1][:160]
    if last.startswith("ModuleNotFoundError"):
        last = f"absent: {last}"
    says = {0: "", DECLINED: last}
    failure = says.get(result["code"], f"exit code {result['code']}: {last}")
    return Run(result["seconds"], result["peak_mib"], failure)
