"""Diagram F: what a scene saves against everything: time, operations, memory, size of the file.

One part with two rigid patches. Everything is Herting's method with all modes of the part, and nothing skipped; each scene asks less,
or runs with the cache that the job of everything has left. Operations are those of the results, also where a cache had them.
"""

import shutil

import numpy as np

from diagrams import figure, own
from harness import part

N_OUTPUTS = 1000
MODAL = "[scene]\nanalysis = \"modal\"\n"
# Name, tables at the end of the job, flags.
SCENES = (
    ("everything", "", ("--no-skip",)),
    ("static", "[scene]\nanalysis = \"static\"\n", ()),
    ("interface stiffness alone", "[scene]\nanalysis = \"static\"\ngravity  = false\n", ()),
    ("modal", MODAL, ()),
    ("transient without recovery", "[scene]\nanalysis = \"transient\"\nboundaries = []\n", ()),
    ("1000 output nodes", "{recovery}" + MODAL, ()),
    ("base at rest", "[scene]\nanalysis = \"modal\"\ngrounded = [\"base\"]\n", ()),
    ("tip connected alone", "[scene]\nanalysis = \"modal\"\nconnected = [\"tip\"]\n", ()),
)
FILLING = ("filling the cache", "", ("--no-skip",))
CACHED = (
    ("same job, cache", "", ("--no-skip",)),
    ("1000 output nodes, cache", "{recovery}", ("--no-skip",)),
    ("half the modes, cache", "", ("--no-skip", "--modes", "{half}")),
    ("modal, half the modes, cache", MODAL, ("--modes", "{half}")),
)
COLUMNS = ("scene", "n", "seconds", "share", "flops", "peak_mib", "file_bytes", "taken", "verdict")


def measured(settings, folder, scene, words):
    name, tables, flags = scene
    tables = "\n" + tables.format(**words)
    job = own.job_with(folder, "scene.toml", tables)
    flags = [flag.format(**words) for flag in flags]
    cache, filled = folder / "cache", folder / "filled-cache"
    if "cache" in name:
        # A run finds what the first job has left, and nothing of its own.
        shutil.rmtree(cache, ignore_errors=True)
        if filled.exists():
            shutil.copytree(filled, cache)
        flags += ["--cache", str(cache)]
    result = own.reduce(settings.supel, folder, job, settings.threads, settings.timeout, *flags)
    if result.run.failure and not result.tensors:
        raise SystemExit(f"{name}: {result.run.failure}")
    return result


def row_of(settings, folder, scene, words, n):
    """The fastest of the repeats."""
    results = [measured(settings, folder, scene, words) for _ in range(settings.repeats)]
    best = min(results, key=lambda result: result.run.seconds)
    flops = best.work["n_factorisations"] * best.work["factor_flops"]
    taken = sum(best.cache.get("taken", {}).values())
    size = (folder / "run.supel").stat().st_size
    values = [scene[0], n, best.run.seconds, 0.0, flops, best.run.peak_mib, size, taken, best.body["verdict"]]
    return dict(zip(COLUMNS, values))


def draw(settings, family, dofs):
    folder = part.make(family, dofs, settings.work / f"{family}-{dofs}").resolve()
    facts = part.facts(folder)
    labels = np.loadtxt(folder / "nodes.csv", delimiter=",", skiprows=1)[:, 0].astype(int)
    outputs = labels[np.linspace(0, len(labels) - 1, N_OUTPUTS).astype(int)].tolist()
    words = {"recovery": f"[write.recovery]\nnodes = {outputs}\n\n", "half": facts["modes"] // 2}
    rows = [row_of(settings, folder, scene, words, facts["n"]) for scene in SCENES]
    cache, filled = folder / "cache", folder / "filled-cache"
    shutil.rmtree(filled, ignore_errors=True)
    rows.append(row_of(settings, folder, FILLING, words, facts["n"]))
    cache.rename(filled)
    rows += [row_of(settings, folder, scene, words, facts["n"]) for scene in CACHED]
    shutil.rmtree(filled)
    shutil.rmtree(cache)
    for row in rows:
        row["share"] = row["seconds"] / rows[0]["seconds"]
    name = f"F-{family}-{facts['n']}"
    figure.write_rows(settings.out / f"{name}.csv", rows, settings.origin)
    fig, all_axes = figure.plt.subplots(1, 3, figsize=(13, 4.6), sharey=True)
    shown = [row["scene"] for row in rows][::-1]
    for ax, column, unit in zip(all_axes, ("seconds", "peak_mib", "file_bytes"), ("seconds", "peak memory, MiB", "file, bytes")):
        values = [row[column] for row in rows][::-1]
        ax.barh(shown, values, color=["C1" if "cache" in scene else "C0" for scene in shown])
        ax.set(xlabel=unit, xscale="log" if column == "file_bytes" else "linear")
        ax.grid(True, axis="x", linewidth=0.3)
        for at, value in enumerate(values):
            ax.text(value, at, f" {value:.3g}" if value < 1000 else f" {value:,.0f}", va="center", fontsize=7)
        ax.margins(x=0.25)
    fig.suptitle(f"F. What a scene saves: {family} part of {facts['n']} dofs, {facts['modes']} modes, Herting")
    figure.save(fig, settings.out / f"{name}.svg", settings.origin)
