"""The Python environment of the benchmarks, made where it is missing."""

import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile

REQUIREMENTS = pathlib.Path(__file__).resolve().parent.parent / "peers" / "requirements.txt"
# Modules without which nothing runs; the other peers are shown as absent.
NEEDED = ("numpy", "scipy", "matplotlib")


def enter():
    """Runs this program again in the environment (PEERS_VENV, default in the temporary folder) where modules are missing."""
    if all(importlib.util.find_spec(name) for name in NEEDED):
        return
    folder = pathlib.Path(os.environ.get("PEERS_VENV", pathlib.Path(tempfile.gettempdir()) / "supel-peers"))
    python = folder / "bin" / "python"
    if not python.exists():
        print(f"making {folder}", file=sys.stderr)
        subprocess.run([sys.executable, "-m", "venv", str(folder)], check=True)
        subprocess.run([str(python), "-m", "pip", "install", "--quiet", "-r", str(REQUIREMENTS)], check=True)
    if pathlib.Path(sys.executable) == python:
        sys.exit(f"{folder} lacks one of {', '.join(NEEDED)}: remove it and run this again")
    os.execv(python, [str(python), *sys.argv])
