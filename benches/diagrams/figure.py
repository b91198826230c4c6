"""Result files: CSV and SVG that say where they came from."""

import csv
import textwrap

import matplotlib

matplotlib.use("svg")
# The same marks for the same data: no random identifiers, text as text.
matplotlib.rcParams.update({"svg.hashsalt": "supel", "svg.fonttype": "none", "font.size": 9})
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

# Decades of an axis below which the powers of ten alone say too little.
FEW_DECADES = 2


def write_rows(path, rows, origin):
    """Rows as dictionaries; the first decides on the columns."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        file.writelines(f"# {name}: {text}\n" for name, text in origin)
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    print(path)


def axes(title, x, y, n=1):
    """A figure with n log-log axes side by side."""
    figure, all_axes = plt.subplots(1, n, figsize=(6.4 * n, 4.8), squeeze=False)
    for ax in all_axes[0]:
        ax.set(xscale="log", yscale="log", xlabel=x, ylabel=y)
        ax.grid(True, which="both", linewidth=0.3)
    figure.suptitle(title)
    return figure, list(all_axes[0])


def grid(title, rows, columns, sharey="row", panel=(3.1, 3.0)):
    """A figure with rows of log-log axes, each a panel of that size in inches; those of a row share y unless told otherwise."""
    figure, all_axes = plt.subplots(
        rows, columns, figsize=(panel[0] * columns + 1.6, panel[1] * rows), squeeze=False, sharey=sharey
    )
    for ax in all_axes.flat:
        ax.set(xscale="log", yscale="log")
        ax.tick_params(labelsize=7)
        ax.grid(True, which="both", linewidth=0.3)
    figure.suptitle(title, fontsize=10)
    return figure, all_axes


def label_short_axis(ax):
    """Plain numbers at 1, 2 and 5 of each decade along an x axis of few decades, at some more of a single one."""
    low, high = ax.get_xlim()
    if high < low * 10**FEW_DECADES:
        ax.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if high > 10 * low else (1, 1.5, 2, 3, 5, 7)))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.xaxis.set_minor_formatter(NullFormatter())


def save(figure, path, origin):
    for ax in figure.axes:
        label_short_axis(ax)
    characters = int(22 * figure.get_figwidth())
    lines = [line for name, text in origin for line in textwrap.wrap(f"{name}: {text}", characters)]
    text = "\n".join(lines)
    figure.tight_layout(rect=(0, 0.04 + 0.018 * len(lines), 1, 1))
    figure.text(0.01, 0.01, text, fontsize=5, family="monospace", va="bottom")
    figure.savefig(path, metadata={"Date": None, "Description": text})
    plt.close(figure)
    print(path)
