"""What a result file says about where it came from: machine, versions, commit, command."""

import importlib.metadata
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PACKAGES = ("numpy", "scipy", "pypardiso", "mkl", "fast-matrix-market", "exudyn", "pyyeti", "matplotlib")


def origin(supel):
    """Pairs of a name and a text."""
    return [
        ("machine", machine()),
        ("load", "load average {:.2f} {:.2f} {:.2f} at the start".format(*os.getloadavg())),
        ("supel", f"{said([supel, '--version'])}, commit {commit()}"),
        ("versions", ", ".join([f"Python {platform.python_version()}", *packages(), *programs()])),
        ("command", " ".join([pathlib.Path(sys.argv[0]).name, *sys.argv[1:]])),
        ("date", time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime())),
    ]


def machine():
    facts = dict(line.split(":", 1) for line in lines("/proc/cpuinfo") if ":" in line)
    cpu = next((value.strip() for name, value in facts.items() if name.strip() == "model name"), platform.processor())
    memory = next((int(line.split()[1]) / 2**20 for line in lines("/proc/meminfo") if line.startswith("MemTotal")), 0)
    governor = "".join(lines("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor")) or "unknown"
    return f"{cpu}, {os.cpu_count()} cores, {memory:.0f} GiB, {platform.system()} {platform.release()}, governor {governor}"


def packages():
    for name in PACKAGES:
        try:
            yield f"{name} {importlib.metadata.version(name)}"
        except importlib.metadata.PackageNotFoundError:
            yield f"{name} absent"


def programs():
    if shutil.which("ccx"):
        yield said(["ccx", "-v"]).replace("This is ", "").replace("Version", "CalculiX")
    else:
        yield "CalculiX absent"


def commit():
    """The commit that was measured; results that were written since change nothing of it."""
    sources = [".", ":!benches/results"]
    changed = said(["git", "-C", str(ROOT), "status", "--porcelain", "--untracked-files=no", "--", *sources])
    return said(["git", "-C", str(ROOT), "rev-parse", "--short=12", "HEAD"]) + (" with changes" if changed else "")


def said(command):
    """What a program prints, without blank ends; nothing where it is missing."""
    try:
        return " ".join(subprocess.run(command, capture_output=True, text=True).stdout.split())
    except FileNotFoundError:
        return "absent"


def lines(path):
    try:
        return pathlib.Path(path).read_text().splitlines()
    except OSError:
        return []
