"""The job of a part in SciPy with MKL PARDISO through pypardiso, and ARPACK."""

import ctypes
import sys

import numpy as np
import scipy.sparse as sp
from pypardiso import PyPardisoSolver

import reduction

POSITIVE_DEFINITE, COMPLEX_SYMMETRIC = 2, 6
ANALYSE_AND_FACTOR, SOLVE, RELEASE = 12, 33, -1


class Factor:
    """One factorisation of a symmetric matrix, on its upper triangle, solved with many times.

    pypardiso's own `solve` compares and converts the whole matrix in every call; its library is called here with the arrays
    converted once, so that the solver and not the wrapper is measured.
    """

    def __init__(self, a, kind=POSITIVE_DEFINITE):
        upper = sp.triu(a, format="csr")
        upper.sort_indices()
        self.kind, self.n = kind, a.shape[0]
        self.values = upper.data.astype(complex if kind == COMPLEX_SYMMETRIC else float)
        self.rows, self.columns = upper.indptr.astype(np.int32) + 1, upper.indices.astype(np.int32) + 1
        self.library = PyPardisoSolver(mtype=kind)
        self._call(ANALYSE_AND_FACTOR, np.zeros((self.n, 1), dtype=self.values.dtype))

    def solve(self, b):
        return self._call(SOLVE, np.asfortranarray(b, dtype=self.values.dtype))

    def __del__(self):
        self._call(RELEASE, np.zeros((self.n, 1), dtype=self.values.dtype))

    def _call(self, phase, b):
        pointer = lambda array: array.ctypes.data_as(ctypes.c_void_p)
        integers = lambda array: array.ctypes.data_as(ctypes.POINTER(ctypes.c_int32))
        integer = lambda value: ctypes.byref(ctypes.c_int32(value))
        library, x, error = self.library, np.zeros_like(b, order="F"), ctypes.c_int32(0)
        library._mkl_pardiso(
            library.pt.ctypes.data_as(ctypes.POINTER(library._pt_type[0])),
            integer(1), integer(1), integer(self.kind), integer(phase), integer(self.n),
            pointer(self.values), integers(self.rows), integers(self.columns), integers(library.perm),
            integer(1 if b.ndim == 1 else b.shape[1]),
            integers(library.iparm),
            integer(0), pointer(b), pointer(x), ctypes.byref(error),
        )
        if error.value != 0:
            raise RuntimeError(f"PARDISO phase {phase}: error {error.value}")
        return x


def factorise(a):
    factor = Factor(a)
    return lambda b: factor.solve(b)


if __name__ == "__main__":
    reduction.main(sys.modules[__name__])
