"""Checks a superelement file from the outside, with nothing but numpy and the safetensors package.

    python superelement_file.py FILE

Recomputes from the numbers of the file: the digest (where the blake3 package is there), K̂ Û = 0, the frequencies that
the reduced matrices must have, and the mass properties. Prints one line for each; the first mismatch ends the program
with a message and exit code 1.
"""

import json
import sys

import numpy as np
from safetensors import safe_open
from safetensors.numpy import load_file

# What double precision leaves of K̂ Û = 0, of the mass properties and of frequencies in a well conditioned model.
RIGID_BODY_LIMIT = 1e-11
MASS_LIMIT = 1e-10
FREQUENCY_LIMIT = 1e-9


def main(path):
    tensors = load_file(path)
    with safe_open(path, "numpy") as file:
        metadata = json.loads(file.metadata()["supel"])
    check_digest(path, metadata["blake3"])
    check_layout(tensors, metadata)
    check_rigid_body_modes(tensors, metadata)
    check_frequencies(tensors, metadata)
    check_mass_properties(tensors, metadata)


def check_digest(path, recorded):
    try:
        from blake3 import blake3
    except ImportError:
        print("digest: skipped, the blake3 package is not there")
        return
    with open(path, "rb") as file:
        content = file.read()
    found = blake3(content.replace(recorded.encode(), b"0" * 64)).hexdigest()
    require(found == recorded, f"digest of the bytes is {found}, the file records {recorded}")
    print(f"digest: {found}")


def check_layout(tensors, metadata):
    r = len(metadata["coordinates"])
    for name in ("stiffness", "mass"):
        matrix = tensors[name]
        require(matrix.shape == (r, r), f"{name} has shape {matrix.shape} for {r} coordinates")
        require(np.array_equal(matrix, matrix.T), f"{name} is not symmetric")
    for name, values in tensors.items():
        require(np.isfinite(values).all(), f"{name} is not finite")
    print(f"layout: {r} coordinates, {tensors['rigid_body_modes'].shape[1]} rigid-body modes")


def check_rigid_body_modes(tensors, metadata):
    """|K̂ Û| against |K̂| |Û|, the scale of the terms that cancel."""
    stiffness, rigid = tensors["stiffness"], tensors["rigid_body_modes"]
    residual = np.abs(stiffness @ rigid)
    scale = np.abs(stiffness) @ np.abs(rigid)
    worst = np.max(residual / np.where(scale > 0, scale, 1), initial=0)
    limit = recorded_limit(metadata, "M-12", RIGID_BODY_LIMIT)
    require(worst <= limit, f"rigid-body motion is resisted: |K̂ Û| / |K̂||Û| is {worst:.2e}, limit {limit:.2e}")
    print(f"rigid-body modes: |K̂ Û| / |K̂||Û| = {worst:.2e}")


def check_frequencies(tensors, metadata):
    modes = [c for c in metadata["coordinates"] if "mode" in c]
    method = metadata["method"]
    if not modes or "singular_mass" in metadata["flags"]:
        print("frequencies: skipped, there are no modes or the mass matrix is singular")
        return
    stiffness, mass = tensors["stiffness"], tensors["mass"]
    n_rigid = tensors["rigid_body_modes"].shape[1]
    if method == "craig-bampton":
        # With the interface held only the modal amplitudes are left.
        eta = [k for k, c in enumerate(metadata["coordinates"]) if not c["kind"].startswith("interface")]
        stiffness, mass, n_rigid = stiffness[np.ix_(eta, eta)], mass[np.ix_(eta, eta)], 0
    eigenvalues = generalized_eigenvalues(stiffness, mass)
    found = np.sqrt(np.maximum(eigenvalues[n_rigid:], 0))
    named = sorted(c["mode"] for c in modes)
    expected = tensors["frequencies"][named]
    if named == list(range(len(named))):
        found = found[: len(named)]
    else:
        # Where modes below were left out, each frequency is looked for among all.
        found = found[np.abs(found[:, None] - expected).argmin(axis=0)]
    bars = {c["mode"]: 2 * np.pi * (c["error_bar_hz"] or 0) for c in modes}
    # Rounding moves every eigenvalue by ε times the largest; half of it, relatively, reaches the frequency.
    rounding = 10 * len(mass) * np.finfo(float).eps * eigenvalues[-1] / np.maximum(expected, 1e-300) ** 2
    limits = np.maximum(FREQUENCY_LIMIT, rounding) * expected + [bars[mode] for mode in named]
    require(len(found) == len(expected), f"{len(expected)} modes are named, the matrices have {len(found)}")
    difference = np.abs(found - expected)
    worst = int(np.argmax(difference / limits))
    require(
        difference[worst] <= limits[worst],
        f"mode {named[worst]} has {expected[worst]} rad/s, the reduced matrices give {found[worst]}",
    )
    print(f"frequencies: {len(named)} agree, worst relative difference {np.max(difference / expected):.2e}")


def generalized_eigenvalues(stiffness, mass):
    """Eigenvalues of K x = λ M x, ascending, after scaling the mass matrix to a unit diagonal."""
    scale = 1 / np.sqrt(np.diag(mass))
    lower = np.linalg.cholesky(mass * np.outer(scale, scale))
    half = np.linalg.solve(lower, stiffness * np.outer(scale, scale))
    whole = np.linalg.solve(lower, half.T)
    return np.linalg.eigvalsh((whole + whole.T) / 2)


def check_mass_properties(tensors, metadata):
    rigid, full = tensors["rigid_body_modes"], tensors["rigid_body_mass"]
    if "singular_mass" in metadata["flags"] or full.size == 0:
        print("mass properties: skipped, there are no rigid-body modes or the mass matrix is singular")
        return
    limit = recorded_limit(metadata, "M-16", MASS_LIMIT)
    reduced = rigid.T @ tensors["mass"] @ rigid
    scale = np.sqrt(np.outer(np.diag(full), np.diag(full)))
    worst = np.max(np.abs(reduced - full) / scale)
    require(worst <= limit, f"Ûᵀ M̂ Û differs from rigid_body_mass by {worst:.2e}, limit {limit:.2e}")
    print(f"rigid-body mass: Ûᵀ M̂ Û agrees, worst difference {worst:.2e}")
    expected = metadata["model"]["mass_properties"]
    if metadata["model"]["rigid_body_modes"] != "geometric" or full.shape != (6, 6) or expected is None:
        print("mass properties: skipped, the rigid-body modes are not six geometric ones")
        return
    mass, center, inertia = mass_properties(reduced)
    length = np.linalg.norm(expected["center_of_mass"]) + np.sqrt(np.trace(inertia) / mass)
    require(abs(mass - expected["mass"]) <= limit * mass, f"mass is {mass}, the file says {expected['mass']}")
    require(
        np.max(np.abs(center - expected["center_of_mass"])) <= limit * length,
        f"centre of mass is {center}, the file says {expected['center_of_mass']}",
    )
    require(
        np.max(np.abs(inertia - expected["inertia"])) <= limit * mass * length**2,
        f"inertia is {inertia.tolist()}, the file says {expected['inertia']}",
    )
    print(f"mass properties: mass {mass:.6g}, centre of mass {center}")


def mass_properties(m_f):
    """Mass, centre of mass and inertia about it, from the 6 × 6 mass of unit translations and unit rotations."""
    mass = np.trace(m_f[:3, :3]) / 3
    # The upper right block is −m c̃.
    coupling = m_f[:3, 3:]
    skew = (coupling.T - coupling) / 2
    center = np.array([skew[2, 1], skew[0, 2], skew[1, 0]]) / mass
    steiner = mass * (center @ center * np.eye(3) - np.outer(center, center))
    return mass, center, m_f[3:, 3:] - steiner


def recorded_limit(metadata, check_id, floor):
    """The limit of a check, where the generator had to widen it for the digits of its input."""
    limits = [c["limit"] for c in metadata["verification"]["checks"] if c["id"] == check_id]
    return max([floor, *limits])


def require(condition, message):
    if not condition:
        sys.exit(f"{sys.argv[1]}: {message}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: superelement_file.py FILE")
    main(sys.argv[1])
