"""Table M: the memory that `supel plan` foresees against the peak of the run, for the scene of diagram F that asks for everything.

The plan counts the modes of the band; the peak is that of the whole process.
"""

import json
import subprocess

from diagrams import figure, own, scenes
from harness import part


def row_of(settings, folder, family):
    words = {"outputs": [], "up_to_hz": scenes.UP_TO_HZ[family]}
    _, tables, share, flags = scenes.SCENES[0]
    job = scenes.job_of(folder, words, tables, share)
    command = [settings.supel, "plan", job, "--json", "--count-modes", "--threads", str(settings.threads), *flags]
    plan = json.loads(subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout)
    found = own.reduce(settings.supel, folder, job, settings.threads, settings.timeout, *flags)
    foreseen = plan["memory"]["peak_bytes"] / 2**20
    return {
        "family": family,
        "n": part.facts(folder)["n"],
        "modes": len(found.tensors["frequencies"]),
        "foreseen_mib": round(foreseen),
        "peak_mib": round(found.run.peak_mib),
        "ratio": round(foreseen / found.run.peak_mib, 3),
    }


def draw(settings, families, dofs):
    for family in families:
        rows = []
        # The part of the corpus has one size.
        for n in dofs[:1] if family == "onshape" else dofs:
            folder = scenes.folder_of(settings, family, n)
            if folder is None:
                continue
            rows.append(row_of(settings, folder, family))
            print(*rows[-1].values(), flush=True)
        if rows:
            figure.write_rows(settings.out / f"M-{family}.csv", rows, settings.origin)
