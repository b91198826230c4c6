"""A component with two interface nodes of six dofs under boundaries that its reduction was not made for.

Everything follows from the dynamic stiffness of the interface, D(w) = D_BB - D_BI D_II^-1 D_IB of K (1 + i eta) - w^2 M, 12 x 12,
which the full model and a reduced one both have: full by a sparse complex factorisation (SuperLU) at each frequency, reduced
by a dense one.

    free       D^-1                     displacements per force at both nodes
    base held  (D of the tip)^-1        displacements per force at the tip
    both held  D                        forces of the supports per displacement of theirs
    mass       (D - w^2 M_tip)^-1       displacements per force, with a rigid mass on the tip
"""

import dataclasses

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as spla

N_B, N_NODE = 12, 6
# Structural damping: twice one per cent of critical.
ETA = 0.02
BOUNDARIES = ("free", "base held", "both held", "mass on tip")
N_HELD = {"free": 0, "base held": N_NODE, "both held": N_B, "mass on tip": 0}
N_RIGID = {"free": 6, "base held": 0, "both held": 0, "mass on tip": 6}
# A pair that responds this much less than its two driving points do is judged by them, as in M-20: symmetry uncouples such
# pairs, and what is left of them is rounding.
UNCOUPLED = 1e-3
# Eigenvalues of the inverse relative to the largest that are rounding of motions without mass.
NO_MASS = 1e-13
# What a reduced frequency may lie below that of the full model by rounding; a reduction is stiffer otherwise.
ROUNDING = 1e-6


@dataclasses.dataclass
class Pencil:
    """K and M, dense or sparse, whose first twelve rows are the dofs of base and tip; what a mass on the tip adds."""

    stiffness: object
    mass: object
    tip_mass: np.ndarray
    # By which rotations are scaled where they are compared with displacements: the distance of the two nodes.
    length: float

    def dynamic_stiffness(self, hz):
        """D, 12 x 12."""
        a = self.stiffness * (1 + 1j * ETA) - (2 * np.pi * hz) ** 2 * self.mass
        coupling = a[N_B:, :N_B]
        if not sp.issparse(a):
            return a[:N_B, :N_B] - coupling.T @ np.linalg.solve(a[N_B:, N_B:], coupling)
        solve = factorised(a[N_B:, N_B:])
        return a[:N_B, :N_B].toarray() - coupling.T @ solve(coupling.toarray())

    def response(self, boundary, d, hz):
        """Responses of pairs of dofs, from D."""
        if boundary == "both held":
            return d
        if boundary == "base held":
            return np.linalg.inv(d[N_NODE:, N_NODE:])
        load = np.zeros((N_B, N_B))
        if boundary == "mass on tip":
            load[N_NODE:, N_NODE:] = (2 * np.pi * hz) ** 2 * self.tip_mass
        return np.linalg.inv(d - load)

    def relative_error(self, boundary, full, reduced):
        """The relative difference of two responses in the Frobenius norm."""
        scale = np.tile([1.0] * 3 + [self.length] * 3, len(full) // N_NODE)
        weight = np.outer(scale, scale) ** (-1 if boundary == "both held" else 1)
        return float(np.linalg.norm((full - reduced) * weight) / np.linalg.norm(full * weight))

    def frequencies(self, boundary, count, shift):
        """The lowest elastic frequencies in Hz, ascending; of a dense pencil all. `shift` in (rad/s)^2 lies below zero."""
        held = N_HELD[boundary]
        k, m = self.stiffness[held:, held:], self.mass[held:, held:]
        if boundary == "mass on tip":
            m = m.copy() if not sp.issparse(m) else m.tolil()
            m[N_NODE:N_B, N_NODE:N_B] += self.tip_mass
        skipped = N_RIGID[boundary]
        if not sp.issparse(k):
            # Of the inverse, 1 / (lambda - shift): motions without mass, as MacNeal's method has them, are at zero.
            inverse = scipy.linalg.eigh(m, k - shift * m, eigvals_only=True) if len(k) else np.zeros(0)
            lam = shift + 1 / inverse[inverse > NO_MASS * inverse.max(initial=0.0)]
        else:
            m = m.tocsc()
            inverse = spla.LinearOperator(k.shape, matvec=factorised(k - shift * m), dtype=float)
            start = np.random.default_rng(1).standard_normal(k.shape[0])
            lam = spla.eigsh(k.tocsc(), count + skipped, m, sigma=shift, OPinv=inverse, v0=start, return_eigenvectors=False)
        return np.sqrt(np.maximum(np.sort(lam)[skipped:], 0.0)) / (2 * np.pi)


def factorised(a):
    options = {"SymmetricMode": True}
    return spla.splu(a.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.1, options=options).solve


def decibels(full, reduced):
    """The worst pair's difference of levels or, where that is larger, the level that the complex difference adds."""
    size = np.abs(full)
    driving = np.sqrt(np.outer(np.diag(size), np.diag(size)))
    size, other = np.maximum(size, UNCOUPLED * driving), np.maximum(np.abs(reduced), UNCOUPLED * driving)
    levels = np.abs(20 * np.log10(other / size))
    return float(np.maximum(levels, 20 * np.log10(1 + np.abs(reduced - full) / size)).max())


def frequency_error(full, reduced, band):
    """The largest relative error of the frequencies of the full model in the band; 1 where the reduced one has fewer."""
    wanted = full[full <= band]
    found = reduced[: len(wanted)]
    if len(found) < len(wanted):
        return 1.0
    errors = found / wanted - 1
    if len(errors) and errors.min() < -ROUNDING:
        raise SystemExit(f"a reduced frequency lies below that of the full model: {errors.min():e}")
    return float(np.abs(errors).max(initial=0.0))
