"""The job of a part in SciPy with its own direct solver, SuperLU in symmetric mode, and ARPACK."""

import sys

import scipy.sparse.linalg as spla

import reduction


def factorise(a):
    """A positive definite matrix needs no pivoting: the diagonal is taken whatever its size."""
    factor = spla.splu(
        a.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    return factor.solve


if __name__ == "__main__":
    reduction.main(sys.modules[__name__])
