"""Runs of supel: what its report says of them."""

import dataclasses
import json
import pathlib

from harness import process, superelement

EIGEN_STAGES = ("factor", "modes")


@dataclasses.dataclass
class OwnRun:
    """One reduction: the process, the stages, the work, the file."""

    run: process.Run
    stages: dict
    work: dict
    body: dict
    tensors: dict
    # What was taken from a cache and kept in it.
    cache: dict

    def is_verified(self):
        return self.body.get("verdict") in ("pass", "warn")

    def eigen_seconds(self):
        return sum(self.stages.get(name, 0.0) for name in EIGEN_STAGES)


def reduce(supel, folder, job, threads, timeout, *flags):
    """Runs a job of a folder with flags; a run that ends without a file has no report, one whose checks failed has."""
    folder = pathlib.Path(folder).resolve()
    result = folder / "run.supel"
    result.unlink(missing_ok=True)
    command = [supel, "reduce", job, "--quiet", "--threads", str(threads), "--output", str(result), "--allow-unverified"]
    command += map(str, flags)
    run = process.run(command, folder, threads, timeout)
    if not result.exists():
        return OwnRun(run, {}, {}, {}, {}, {})
    report = json.loads((folder / "run.report.json").read_text())
    stages = {stage["name"]: stage["seconds"] for stage in report["run"]["stages"]}
    facts = report["run"]
    return OwnRun(run, stages, facts["work"], report["body"], superelement.read(result), facts.get("cache", {}))


def job_with(folder, name, extra):
    """Writes a variant of the folder's job with more tables at its end; returns its name."""
    folder = pathlib.Path(folder)
    (folder / name).write_text((folder / "job.toml").read_text() + extra)
    return name


# No comparison with the full model: what is measured is not judged by it.
LEAN = '\n[scene]\nboundaries = []\n\n[run]\ncertify = "count"\n'
