"""Diagram D: eigenvalue error over eps * kappa, on chains and beams whose spectrum is known exactly.

K of a chain is D'D with first differences, of a beam with second differences, on n + 2 unit masses, of which the first and
the last are the interface: with these held, K_II is T or T^2 with T = tridiag(-1, 2, -1), and its eigenvalues are
4 sin^2(k pi / (2 n + 2)), or the squares of those. All entries are small integers: the data are exact.
"""

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from diagrams import figure, own

N_MODES = 5
SIZES = {"chain": (30, 300, 3000, 30000, 300000), "beam": (10, 30, 100, 300, 1000, 3000)}
DENSE_UP_TO = 1000
EPSILON = np.finfo(float).eps

JOB = """[model]
stiffness = "stiffness.mtx"
mass      = "mass.mtx"

[[interface]]
name  = "ends"
nodes = {{ rows = [0, {last}] }}

[reduction]
method = "craig-bampton"
modes  = {{ count = {count} }}

[write]
superelement = "chain.supel"
"""


def write(kind, n, folder):
    """The files of a model; returns K."""
    folder.mkdir(parents=True, exist_ok=True)
    ones = np.ones(n + 2)
    if kind == "chain":
        differences = sp.diags([-ones[:-1], ones[:-1]], [0, 1], shape=(n + 1, n + 2))
    else:
        differences = sp.diags([ones[:-2], -2 * ones[:-2], ones[:-2]], [0, 1, 2], shape=(n, n + 2))
    k = (differences.T @ differences).tocsr()
    for name, matrix in (("stiffness", k), ("mass", sp.eye(n + 2))):
        lower = sp.tril(matrix).tocoo()
        head = f"%%MatrixMarket matrix coordinate real symmetric\n{n + 2} {n + 2} {lower.nnz}\n"
        entries = zip(lower.row, lower.col, lower.data)
        text = "".join(f"{i + 1} {j + 1} {value:.0f}\n" for i, j, value in entries)
        (folder / f"{name}.mtx").write_text(head + text)
    (folder / "job.toml").write_text(JOB.format(last=n + 1, count=N_MODES) + own.LEAN)
    return k


def exact(kind, n):
    """The lowest eigenvalues, and kappa."""
    sine = lambda k: 2 * np.sin(k * np.pi / (2 * n + 2))
    power = 2 if kind == "chain" else 4
    return sine(np.arange(1, N_MODES + 1)) ** power, (sine(n) / sine(1)) ** power


def by_scipy(k_ii):
    factor = spla.splu(k_ii.tocsc(), permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    inverse = spla.LinearOperator(k_ii.shape, matvec=factor.solve, dtype=float)
    start = np.random.default_rng(1).standard_normal(k_ii.shape[0])
    return np.sort(spla.eigsh(k_ii, N_MODES, sigma=0.0, OPinv=inverse, v0=start, tol=0.0, return_eigenvectors=False))


def rows_of(settings, kind, n):
    folder = settings.work / f"{kind}-{n}"
    k_ii = write(kind, n, folder)[1:-1, 1:-1]
    expected, kappa = exact(kind, n)
    common = {"model": kind, "n": n, "kappa": kappa}

    def row(solver, found, bar="", failure=""):
        error = float(np.max(np.abs(found / expected - 1))) if len(found) else ""
        over = error / (EPSILON * kappa) if len(found) else ""
        return common | {"solver": solver, "error": error, "over_eps_kappa": over, "own_bar": bar, "failure": failure}

    for solver in ("lanczos", "arpack"):
        flags = ["--eigensolver", solver]
        result = own.reduce(settings.supel, folder, "job.toml", settings.threads, settings.timeout, *flags)
        if not result.tensors:
            yield row(f"supel {solver}", [], failure=result.run.failure)
            continue
        modes = result.body["reduction"]["modes"][:N_MODES]
        # Eigenvalues move by twice the share of frequencies.
        bar = max(2 * mode["error_bar_hz"] / mode["frequency_hz"] for mode in modes)
        failure = "" if result.is_verified() else "a check of its own failed"
        yield row(f"supel {solver}", result.tensors["frequencies"][:N_MODES] ** 2, bar, failure)
    yield row("SciPy ARPACK + SuperLU", by_scipy(k_ii))
    if n <= DENSE_UP_TO:
        subset = (0, N_MODES - 1)
        yield row("LAPACK (scipy.linalg.eigh)", scipy.linalg.eigh(k_ii.toarray(), eigvals_only=True, subset_by_index=subset))


def draw(settings):
    rows = [row for kind, sizes in SIZES.items() for n in sizes for row in rows_of(settings, kind, n)]
    figure.write_rows(settings.out / "D-accuracy.csv", rows, settings.origin)
    fig, (ax,) = figure.axes(
        "D. Error of the lowest eigenvalues against the condition of the model", "κ = λmax / λ1", "largest relative error / (ε κ)"
    )
    for number, solver in enumerate(dict.fromkeys(row["solver"] for row in rows)):
        for kind, mark in zip(SIZES, "os"):
            shown = [r for r in rows if (r["solver"], r["model"]) == (solver, kind) and r["error"] != ""]
            if not shown:
                continue
            x = [row["kappa"] for row in shown]
            y = [max(row["over_eps_kappa"], 1e-13) for row in shown]
            ax.plot(x, y, mark + "-", color=f"C{number}", label=f"{solver}, {kind}", markersize=4, linewidth=0.8)
            failed = [row for row in shown if row["failure"]]
            ax.plot([r["kappa"] for r in failed], [r["over_eps_kappa"] for r in failed], "x", color="red", markersize=9)
    ax.axhline(1.0, color="k", linewidth=0.8)
    ax.legend(fontsize=6, loc="center left", bbox_to_anchor=(1.01, 0.5))
    figure.save(fig, settings.out / "D-accuracy.svg", settings.origin)
