"""Reads what supel converted by the programs that own the formats: python oracle.py FOLDER REFERENCE.

The folder holds converted.{mtx,npz,op4,mat} and binary.op4. Each must be the matrix of the reference to the bit. Programs that
are not installed are named and left out.
"""

import importlib
import sys

import numpy as np
import scipy.io
import scipy.sparse as sparse

folder, reference = sys.argv[1:]
expected = scipy.io.mmread(reference).toarray()


def check(what, matrix):
    matrix = matrix.toarray() if sparse.issparse(matrix) else np.asarray(matrix)
    assert matrix.shape == expected.shape, (what, matrix.shape)
    assert (matrix.view("u8") == expected.view("u8")).all(), f"{what} differs"
    print(f"{what}: the same bits")


def have(module):
    try:
        return importlib.import_module(module)
    except ImportError:
        print(f"skipped: no {module}")
        return None


check("scipy.io.mmread", scipy.io.mmread(f"{folder}/converted.mtx"))
check("scipy.sparse.load_npz", sparse.load_npz(f"{folder}/converted.npz"))
if have("pyyeti.nastran.op4"):
    from pyyeti.nastran import op4

    for name in ["converted", "binary"]:
        check(f"pyyeti {name}.op4", np.ascontiguousarray(op4.load(f"{folder}/{name}.op4", into="list", sparse=False)[1][0]))
if have("h5py"):
    import h5py

    with h5py.File(f"{folder}/converted.mat") as file:
        group = file["converted"]
        assert group.attrs["MATLAB_class"] == b"double", group.attrs["MATLAB_class"]
        n = int(group.attrs["MATLAB_sparse"])
        parts = (group["data"][:], group["ir"][:], group["jc"][:])
        check("h5py, MATLAB v7.3", sparse.csc_matrix(parts, shape=(n, n)))
    with open(f"{folder}/converted.mat", "rb") as file:
        assert file.read(10) == b"MATLAB 7.3", "the head by which MATLAB knows its files"
