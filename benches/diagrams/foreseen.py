"""Table M: the memory and the time that `supel plan` foresees against those of the run, for the scene of diagram F that asks for everything.

The plan counts the modes of the band; the peak and the seconds are those of the whole process. The machine is calibrated
once, before the first part.
"""

import json
import subprocess

from diagrams import figure, own, scenes
from harness import part


def row_of(settings, folder, family, calibrate):
    words = {"outputs": [], "up_to_hz": scenes.UP_TO_HZ[family]}
    _, tables, share, flags = scenes.SCENES[0]
    job = scenes.job_of(folder, words, tables, share)
    command = [settings.supel, "plan", job, "--json", "--count-modes", "--threads", str(settings.threads), *calibrate, *flags]
    plan = json.loads(subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout)
    found = own.reduce(settings.supel, folder, job, settings.threads, settings.timeout, *flags)
    foreseen = plan["memory"]["peak_bytes"] / 2**20
    seconds = plan["total"]["seconds"]
    return {
        "family": family,
        "n": part.facts(folder)["n"],
        "modes": len(found.tensors["frequencies"]),
        "foreseen_mib": round(foreseen),
        "peak_mib": round(found.run.peak_mib),
        "ratio": round(foreseen / found.run.peak_mib, 3),
        "foreseen_s": round(seconds, 2),
        "found_s": round(found.run.seconds, 2),
        "ratio_s": round(seconds / found.run.seconds, 2),
    }


def draw(settings, families, dofs):
    calibrate = ["--calibrate"]
    for family in families:
        rows = []
        # The part of the corpus has one size.
        for n in dofs[:1] if family == "onshape" else dofs:
            folder = scenes.folder_of(settings, family, n)
            if folder is None:
                continue
            rows.append(row_of(settings, folder, family, calibrate))
            calibrate = []
            print(*rows[-1].values(), flush=True)
        if rows:
            figure.write_rows(settings.out / f"M-{family}.csv", rows, settings.origin)
