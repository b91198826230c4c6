"""Diagram F: what a scene saves against everything: time, operations, memory, size of the file.

One part with two rigid patches. Everything is Herting's method with all modes up to twice the band, compared with the full model under
five boundaries and by its frequency response, and nothing skipped; each scene asks less, or runs with the cache that the job of everything
has left. Operations are those of the results, also where a cache had them.
"""

import gzip
import json
import os
import pathlib
import shutil

import numpy as np

from diagrams import figure, own
from harness import part

N_OUTPUTS = 1000
ENDS = ("base", "tip")
BOUNDARIES = ["free", *(f"fix:{end}" for end in ENDS), *(f"mass:{end}" for end in ENDS)]
# Modes are kept up to this frequency, in Hz; the band ends at half of it.
UP_TO_HZ = {"bulky": 60000.0, "slender": 3000.0, "lattice": 2000.0, "onshape": 40000.0}
# The part of the corpus: a bracket of 123,486 dofs between its two ends.
CORPUS = {"folder": "ccx_onshape_part", "axis": 1, "faces": [-63.5, 63.5], "tolerance": 1e-3, "directions": 3}

# Name, further tables of the job, share of the band, flags.
EVERYTHING = "[scene]\nband_hz = [0, {band}]\nboundaries = {boundaries}\n"
MODAL = "[scene]\nanalysis = \"modal\"\nband_hz = [0, {band}]\n"
TRANSIENT = "[scene]\nanalysis = \"transient\"\nband_hz = [0, {band}]\nboundaries = []\n"
RECOVERY = "[write.recovery]\nnodes = {outputs}\n\n"
SCENES = (
    ("everything", EVERYTHING, 1.0, ("--no-skip",)),
    ("static", "[scene]\nanalysis = \"static\"\n", 1.0, ()),
    ("interface stiffness alone", "[scene]\nanalysis = \"static\"\ngravity  = false\n", 1.0, ()),
    ("modal", MODAL, 1.0, ()),
    ("transient without recovery", TRANSIENT, 1.0, ()),
    ("1000 output nodes", RECOVERY + TRANSIENT, 1.0, ()),
    ("base at rest", TRANSIENT + "grounded = [\"base\"]\n", 1.0, ()),
    ("tip connected alone", TRANSIENT + "connected = [\"tip\"]\n", 1.0, ()),
    ("half the band", EVERYTHING, 0.5, ("--no-skip",)),
)
FILLING = ("filling the cache", EVERYTHING, 1.0, ("--no-skip",))
CACHED = (
    ("same job, cache", EVERYTHING, 1.0, ("--no-skip",)),
    ("1000 output nodes, cache", RECOVERY + EVERYTHING, 1.0, ("--no-skip",)),
    ("half the band, cache", EVERYTHING, 0.5, ("--no-skip",)),
    ("transient, half the band, cache", TRANSIENT, 0.5, ()),
)
COLUMNS = ("scene", "n", "seconds", "share", "flops", "solves", "peak_mib", "file_bytes", "taken", "parts", "modes", "verdict")


def job_of(folder, words, tables, share):
    """The part's job with the modes and the scene of a row."""
    given = (folder / "job.toml").read_text()
    up_to_hz = share * words["up_to_hz"]
    tables = tables.format(band=0.5 * up_to_hz, boundaries=json.dumps(BOUNDARIES), outputs=words["outputs"])
    reduction = f"[reduction]\nmethod = \"herting\"\nmodes  = {{ up_to_hz = {up_to_hz} }}\n\n[write]\nsuperelement = \"part.supel\"\n\n"
    (folder / "scene.toml").write_text(given[: given.index("[reduction]")] + reduction + tables)
    return "scene.toml"


def measured(settings, folder, scene, words):
    name, tables, share, flags = scene
    job, flags = job_of(folder, words, tables, share), list(flags)
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
    values = [scene[0], n, best.run.seconds, 0.0, flops, best.work["n_solves"], best.run.peak_mib, size, taken]
    values += [best.cache.get("parts", 0), len(best.tensors["frequencies"]), best.body["verdict"]]
    row = dict(zip(COLUMNS, values))
    print(*row.values(), flush=True)
    return row


def of_corpus(folder):
    """Writes the part of the corpus where the folder has none; returns the folder, or None where the corpus is absent."""
    source = pathlib.Path(os.environ.get("SUPEL_CORPUS", part.ROOT / "corpus")) / "pairs" / CORPUS["folder"]
    if not source.exists():
        print(f"the part of the corpus is left out: SUPEL_CORPUS names no folder with pairs/{CORPUS['folder']}")
        return None
    folder.mkdir(parents=True, exist_ok=True)
    names = {"K.mtx.gz": "stiffness.mtx", "M.mtx.gz": "mass.mtx", "model.dof.gz": "model.dof", "nodes.csv.gz": "nodes.csv"}
    for packed, name in names.items():
        if not (folder / name).exists():
            with gzip.open(source / packed) as read, (folder / name).open("wb") as written:
                shutil.copyfileobj(read, written)
    normal = [1.0 if axis == CORPUS["axis"] else 0.0 for axis in range(3)]
    points = [[at * part for part in normal] for at in CORPUS["faces"]]
    patches = "".join(
        f"[[interface]]\nname     = \"{end}\"\nnodes    = {{ within = {{ plane = {{ point = {point}, normal = {normal}, "
        f"tolerance = {CORPUS['tolerance']} }} }} }}\ncoupling = \"rigid\"\n\n"
        for end, point in zip(ENDS, points)
    )
    model = "[model]\nstiffness = \"stiffness.mtx\"\nmass      = \"mass.mtx\"\nnodes     = \"nodes.csv\"\ndofs      = \"model.dof\"\nunits     = \"mm-t-s\"\n\n"
    (folder / "job.toml").write_text(model + patches + "[reduction]\n")
    n = sum(1 for line in (folder / "model.dof").open() if line.strip())
    (folder / "model.json").write_text(json.dumps({"family": "onshape", "n": n, **{key: CORPUS[key] for key in ("directions", "axis", "faces", "tolerance")}}))
    return folder


def folder_of(settings, family, dofs):
    """The folder of a part, made where it is not there; None where the corpus is absent."""
    if family == "onshape":
        folder = of_corpus(settings.work / family)
    else:
        folder = part.make(family, dofs, settings.work / f"{family}-{dofs}")
    return folder and folder.resolve()


def draw(settings, family, dofs):
    folder = folder_of(settings, family, dofs)
    if folder is None:
        return
    facts = part.facts(folder)
    labels = np.loadtxt(folder / "nodes.csv", delimiter=",", skiprows=1)[:, 0].astype(int)
    outputs = labels[np.linspace(0, len(labels) - 1, N_OUTPUTS).astype(int)].tolist()
    words = {"outputs": outputs, "up_to_hz": UP_TO_HZ[family]}
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
    fig, all_axes = figure.plt.subplots(1, 3, figsize=(13, 5.0), sharey=True)
    shown = [row["scene"] for row in rows][::-1]
    for ax, column, unit in zip(all_axes, ("seconds", "peak_mib", "file_bytes"), ("seconds", "peak memory, MiB", "file, bytes")):
        values = [row[column] for row in rows][::-1]
        ax.barh(shown, values, color=["C1" if "cache" in scene else "C0" for scene in shown])
        ax.set(xlabel=unit, xscale="log" if column == "file_bytes" else "linear")
        ax.grid(True, axis="x", linewidth=0.3)
        for at, value in enumerate(values):
            ax.text(value, at, f" {value:.3g}" if value < 1000 else f" {value:,.0f}", va="center", fontsize=7)
        ax.margins(x=0.25)
    fig.suptitle(f"F. What a scene saves: {family} part of {facts['n']} dofs, {rows[0]['modes']} modes, Herting")
    figure.save(fig, settings.out / f"{name}.svg", settings.origin)
