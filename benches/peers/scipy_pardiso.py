"""The benchmark job in SciPy with MKL PARDISO through pypardiso, Cholesky on the upper triangle."""

import ctypes

import numpy as np
import scipy.sparse as sp
from pypardiso import PyPardisoSolver

import herting

POSITIVE_DEFINITE = 2
ANALYSE_AND_FACTOR, SOLVE, RELEASE = 12, 33, -1


class Cholesky:
    """One factorisation, solved with many times.

    pypardiso's own `solve` compares and converts the whole matrix in every call; its library is called here with the arrays
    converted once, so that the solver and not the wrapper is measured.
    """

    def __init__(self, a):
        upper = sp.triu(a, format="csr")
        upper.sort_indices()
        self.n, self.values = a.shape[0], upper.data
        self.rows, self.columns = upper.indptr.astype(np.int32) + 1, upper.indices.astype(np.int32) + 1
        self.library = PyPardisoSolver(mtype=POSITIVE_DEFINITE)
        self._call(ANALYSE_AND_FACTOR, np.zeros((self.n, 1)))

    def solve(self, b):
        return self._call(SOLVE, np.asfortranarray(b))

    def __del__(self):
        self._call(RELEASE, np.zeros((self.n, 1)))

    def _call(self, phase, b):
        pointer = lambda array: array.ctypes.data_as(ctypes.c_void_p)
        integer = lambda value: ctypes.byref(ctypes.c_int32(value))
        library, x, error = self.library, np.zeros_like(b, order="F"), ctypes.c_int32(0)
        library._mkl_pardiso(
            library.pt.ctypes.data_as(ctypes.POINTER(library._pt_type[0])),
            integer(1), integer(1), integer(POSITIVE_DEFINITE), integer(phase), integer(self.n),
            pointer(self.values),
            self.rows.ctypes.data_as(ctypes.POINTER(ctypes.c_int32)),
            self.columns.ctypes.data_as(ctypes.POINTER(ctypes.c_int32)),
            library.perm.ctypes.data_as(ctypes.POINTER(ctypes.c_int32)),
            integer(1 if b.ndim == 1 else b.shape[1]),
            library.iparm.ctypes.data_as(ctypes.POINTER(ctypes.c_int32)),
            integer(0), pointer(b), pointer(x), ctypes.byref(error),
        )
        if error.value != 0:
            raise RuntimeError(f"PARDISO phase {phase}: error {error.value}")
        return x


def factorise(a):
    factor = Cholesky(a)
    return lambda b: factor.solve(b)


if __name__ == "__main__":
    herting.main("PARDISO", factorise)
