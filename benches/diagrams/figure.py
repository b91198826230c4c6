"""Result files: CSV and SVG that say where they came from."""

import csv
import textwrap

import matplotlib

matplotlib.use("svg")
# The same marks for the same data: no random identifiers, text as text.
matplotlib.rcParams.update({"svg.hashsalt": "supel", "svg.fonttype": "none", "font.size": 9})
import matplotlib.pyplot as plt


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


def save(figure, path, origin):
    characters = int(22 * figure.get_figwidth())
    lines = [line for name, text in origin for line in textwrap.wrap(f"{name}: {text}", characters)]
    text = "\n".join(lines)
    figure.tight_layout(rect=(0, 0.04 + 0.018 * len(lines), 1, 1))
    figure.text(0.01, 0.01, text, fontsize=5, family="monospace", va="bottom")
    figure.savefig(path, metadata={"Date": None, "Description": text})
    plt.close(figure)
    print(path)
