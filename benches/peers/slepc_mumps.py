"""The job of a part in Python with SLEPc's Krylov-Schur and MUMPS (Debian: python3-slepc4py, python3-scipy)."""

import glob
import sys

# Debian keeps both outside the usual folders.
sys.path.extend(glob.glob("/usr/lib/slepcdir/*/*-real/lib/python3/dist-packages"))
sys.path.extend(glob.glob("/usr/lib/petscdir/*/*-real/lib/python3/dist-packages"))

import numpy as np
import slepc4py

slepc4py.init([])
from petsc4py import PETSc
from slepc4py import SLEPc

import reduction


def petsc(a):
    a = a.tocsr()
    a.sort_indices()
    matrix = PETSc.Mat().createAIJ(a.shape, csr=(a.indptr.astype(np.int32), a.indices.astype(np.int32), a.data))
    matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    return matrix


def by_mumps(ksp):
    ksp.setType("preonly")
    ksp.getPC().setType("cholesky")
    ksp.getPC().setFactorSolverType("mumps")


def factorise(a):
    matrix = petsc(a)
    ksp = PETSc.KSP().create()
    ksp.setOperators(matrix)
    by_mumps(ksp)
    ksp.setUp()
    right, solution = matrix.createVecs()

    def solve(b):
        if b.ndim == 2:
            return np.column_stack([solve(column) for column in b.T])
        right.setArray(b)
        ksp.solve(right, solution)
        return solution.getArray().copy()

    return solve


def modes(k, m, count, shift, solve, tolerance):
    """The lowest pairs; SLEPc makes a factor of its own."""
    problem = SLEPc.EPS().create()
    problem.setOperators(petsc(k), petsc(m))
    problem.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    problem.setDimensions(count)
    problem.setTarget(shift)
    problem.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    problem.setTolerances(tol=tolerance)
    transformation = problem.getST()
    transformation.setType("sinvert")
    by_mumps(transformation.getKSP())
    problem.solve()
    if problem.getConverged() < count:
        raise RuntimeError(f"{problem.getConverged()} of {count} pairs converged")
    vector = problem.getOperators()[0].createVecs()[0]
    lam, x = [], []
    for i in range(count):
        lam.append(problem.getEigenpair(i, vector).real)
        x.append(vector.getArray().copy())
    order = np.argsort(lam)
    return np.array(lam)[order], np.column_stack(x)[:, order], problem.getIterationNumber()


if __name__ == "__main__":
    reduction.main(sys.modules[__name__])
