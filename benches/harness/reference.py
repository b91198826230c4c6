"""Reference frequencies and frequency responses of a part, independent of supel.

Frequencies: ARPACK to machine precision, one more inverse iteration, a Rayleigh-Ritz step, and Rayleigh quotients in
extended precision with the matrices as the files have them, u = T x. What is left is the square of the vectors' errors.

Responses: H(w) = [T' (K (1 + i eta) - w^2 M) T]^-1 on the twelve dofs of the faces, by a complex factorisation for each w.
"""

import json
import pathlib
import sys

import numpy as np
import scipy.linalg
import scipy.sparse.linalg as spla

from harness import part

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "peers"))
import reduction

try:
    import scipy_pardiso
except ImportError:
    scipy_pardiso = None
import scipy_superlu

N_RIGID = 6
# Structural damping: twice one per cent of critical.
ETA = 0.02
# Distance within which a frequency is that of the reference; solvers that converged at all are far nearer.
SAME = 1e-3
# The first shift, as a share of the median of K_ii / M_ii.
FIRST_SHIFT = 1e-6


def factorise(a):
    return (scipy_pardiso or scipy_superlu).factorise(a)


class Reference:
    """The condensed matrices of a part and what was computed from them, kept in reference.json next to its files."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.path = self.folder / "reference.json"
        self.known = json.loads(self.path.read_text()) if self.path.exists() else {}
        self._matrices = None

    def frequencies(self, method, count):
        """Hz, ascending: faces held (craig-bampton), or free and rigid (herting)."""
        key = f"{method} {count}"
        if key not in self.known:
            self._keep(key, self._frequencies(method, count))
        return np.array(self.known[key])

    def shift_below(self):
        """A quarter of the first elastic eigenvalue of the free part, (rad/s)^2."""
        return (2 * np.pi * self.frequencies("herting", 1)[0]) ** 2 / 4

    def response(self, frequencies_hz):
        """H on the faces, 12 x 12 for each frequency."""
        key = f"response at {list(map(float, frequencies_hz))}"
        if key not in self.known:
            responses = [self._response(2 * np.pi * hz) for hz in frequencies_hz]
            self._keep(key, [[h.real.tolist(), h.imag.tolist()] for h in responses])
        return [np.array(real) + 1j * np.array(imaginary) for real, imaginary in self.known[key]]

    def span(self):
        """Distance of the two faces, by which rotations are scaled."""
        a, b = part.facts(self.folder)["faces"]
        return abs(b - a)

    def _keep(self, key, value):
        self.known[key] = value
        self.path.write_text(json.dumps(self.known))

    def _load(self):
        if self._matrices is None:
            k, m = part.read_matrices(self.folder)
            t = part.condensation(self.folder, part.read_points(self.folder)).t
            self._matrices = k, m, t, (t.T @ k @ t).tocsr(), (t.T @ m @ t).tocsr()
        return self._matrices

    def _frequencies(self, method, count):
        k, m, t, k_c, m_c = self._load()
        if method == "craig-bampton":
            internal = slice(12, None)
            k_c, m_c, t = k_c[internal, internal].tocsr(), m_c[internal, internal].tocsr(), t[:, internal].tocsr()
            shifts, n_rigid = [0.0], 0
        else:
            ratio = np.median(k_c.diagonal() / m_c.diagonal())
            # The second shift is near the spectrum; one too far below it makes ARPACK miss copies of zero.
            shifts, n_rigid = [-FIRST_SHIFT * ratio, None], N_RIGID
        for shift in shifts:
            shift = -lam[n_rigid] / 4 if shift is None else shift
            solve = factorise((k_c - shift * m_c).tocsr())
            lam, x, _ = reduction.arpack(k_c, m_c, count + n_rigid + 1, shift, solve, 0.0)
        y = np.column_stack([solve(column) for column in (m_c @ x).T])
        _, mixing = scipy.linalg.eigh(y.T @ (k_c @ y), y.T @ (m_c @ y))
        u = t.astype(np.longdouble) @ (y @ mixing).astype(np.longdouble)
        k_u, m_u = (matrix.astype(np.longdouble) @ u for matrix in (k, m))
        quotients = np.einsum("ij,ij->j", u, k_u) / np.einsum("ij,ij->j", u, m_u)
        return (np.sqrt(np.sort(quotients)[n_rigid : n_rigid + count]) / (2 * np.pi)).astype(float).tolist()

    def _response(self, omega):
        *_, k_c, m_c = self._load()
        dynamic = k_c * (1 + 1j * ETA) - omega**2 * m_c
        loads = np.eye(k_c.shape[0], 12, dtype=complex)
        if scipy_pardiso:
            solution = scipy_pardiso.Factor(dynamic, scipy_pardiso.COMPLEX_SYMMETRIC).solve(loads)
        else:
            solution = spla.splu(dynamic.tocsc()).solve(loads)
        return solution[:12]


def judge(found, expected, same=SAME):
    """Largest relative error of the eigenvalues whose frequencies were found, and how many were missed: those of the
    reference with nothing found that near, relatively."""
    errors, j = [], 0
    for value in expected:
        while j < len(found) and found[j] < value * (1 - same):
            j += 1
        if j < len(found) and found[j] <= value * (1 + same):
            errors.append(abs((found[j] / value) ** 2 - 1))
            j += 1
    return max(errors, default=float("nan")), len(expected) - len(errors)


def reduced_response(stiffness, mass, frequencies_hz):
    """The same of a reduced model whose first twelve coordinates are the dofs of the faces."""
    loads = np.eye(len(stiffness), 12)
    dynamic = lambda hz: stiffness * (1 + 1j * ETA) - (2 * np.pi * hz) ** 2 * mass
    return [np.linalg.solve(dynamic(hz), loads)[:12] for hz in frequencies_hz]


def response_error(full, reduced, span):
    """Largest relative difference over the frequencies, in the Frobenius norm with rotations times the span."""
    scale = np.tile([1.0] * 3 + [span] * 3, 2)
    weigh = lambda h: h * np.outer(scale, scale)
    return max(np.linalg.norm(weigh(h - g)) / np.linalg.norm(weigh(h)) for h, g in zip(full, reduced))
