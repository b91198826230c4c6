"""Diagram E: how time by stage, memory and work grow with n, on one thread and on two."""

import statistics

import numpy as np

from diagrams import figure, own
from harness import part


def measured(settings, family, dofs, threads):
    """The median of the repeats, stage by stage."""
    folder = part.make(family, dofs, settings.work / f"{family}-{dofs}").resolve()
    flags = ["--method", settings.method]
    results = [
        own.reduce(settings.supel, folder, "job.toml", threads, settings.timeout, *flags) for _ in range(settings.repeats)
    ]
    row = {"family": family, "n": part.facts(folder)["n"], "threads": threads}
    failure = next((result.run.failure for result in results if result.run.failure), "")
    if failure:
        return row | {"failure": failure}
    middle = lambda values: statistics.median(values)
    stages = {name: middle([result.stages[name] for result in results]) for name in results[0].stages}
    work = results[0].work
    return row | {
        "failure": "",
        "seconds": middle([result.run.seconds for result in results]),
        "peak_mib": max(result.run.peak_mib for result in results),
        "flops": work["factor_flops"], "factor_nonzeros": work["factor_nonzeros"],
        "factorisations": work["n_factorisations"], "solves": work["n_solves"],
        **stages,
    }


def slope(ax, x, y, values, label):
    """A line as steep as `values`, through the first point."""
    ax.plot(x, y * np.array(values) / values[0], ":", color="grey", linewidth=1, label=label)


def draw(settings, family, sizes):
    rows = [measured(settings, family, dofs, threads) for dofs in sizes for threads in (1, settings.threads)]
    good = [row for row in rows if not row["failure"]]
    columns = list(dict.fromkeys(name for row in rows for name in row))
    rows = [{name: row.get(name, "") for name in columns} for row in rows]
    name = f"E-{family}-{settings.method}"
    figure.write_rows(settings.out / f"{name}.csv", rows, settings.origin)
    all_threads = [row for row in good if row["threads"] == settings.threads]
    if len(all_threads) < 2:
        print(f"{name}: fewer than two sizes, no diagram")
        return
    stages = [name for name in columns if name in all_threads[0] and name not in NOT_STAGES]
    fig, (left, middle, right) = figure.axes(f"E. Growth on {family} parts, {settings.method}", "dofs", "seconds", 3)
    n = np.array([row["n"] for row in all_threads])
    left.set_title(f"stages, {settings.threads} threads")
    for number, stage in enumerate(stages):
        y = [max(row.get(stage, 0.0), 1e-4) for row in all_threads]
        left.plot(n, y, "o-", markersize=3, linewidth=0.9, color=f"C{number % 10}", label=stage, alpha=0.6 + 0.4 * (number < 10))
    # Room for the legend above the curves.
    left.set_ylim(top=20 * left.get_ylim()[1])
    slope(left, n, all_threads[0].get("factor", 1e-3), [row["flops"] for row in all_threads], "flops of the factor")
    middle.set_title("whole job")
    for threads in (1, settings.threads):
        shown = [row for row in good if row["threads"] == threads]
        middle.plot([row["n"] for row in shown], [row["seconds"] for row in shown], "o-", label=f"{threads} threads")
    start = all_threads[0]["seconds"]
    slope(middle, n, start, n, "n")
    slope(middle, n, start, n ** (4 / 3), "n^(4/3)")
    slope(middle, n, start, n.astype(float) ** 2, "n²")
    right.set(title=f"memory and factor, {settings.threads} threads", ylabel="MiB")
    right.plot(n, [row["peak_mib"] for row in all_threads], "o-", label="peak memory")
    right.plot(n, [8 * row["factor_nonzeros"] / 2**20 for row in all_threads], "s-", label="largest factor")
    left.legend(fontsize=6, ncols=3, loc="upper left")
    for ax in (middle, right):
        ax.legend(fontsize=6)
    figure.save(fig, settings.out / f"{name}.svg", settings.origin)


NOT_STAGES = (
    "family", "n", "threads", "failure", "seconds", "peak_mib", "flops", "factor_nonzeros", "factorisations", "solves",
)
