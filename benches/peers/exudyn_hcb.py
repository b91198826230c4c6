"""The job of a part in Exudyn: Hurty-Craig-Bampton with two rigid faces (RBE2), then its reduced matrices."""

import numpy as np
from exudyn.FEM import FEMinterface, HCBstaticModeSelection, ObjectFFRFreducedOrderInterface

import reduction
from harness import part


def main():
    arguments = reduction.parsed(__doc__)
    if arguments.method != "craig-bampton":
        reduction.decline("Exudyn reduces by Hurty-Craig-Bampton only")
    what = part.facts(arguments.folder)
    if what["directions"] != 3:
        reduction.decline("Exudyn takes nodes of three displacements only")
    stages = reduction.Stages()
    fem = FEMinterface()
    fem.stiffnessMatrix, fem.massMatrix = part.read_matrices(arguments.folder)
    points = part.read_points(arguments.folder)
    fem.nodes = {"Position": points}
    stages.done("read")
    along = points[:, what["axis"]]
    faces = [np.flatnonzero(np.abs(along - at) <= what["tolerance"]).tolist() for at in what["faces"]]
    stages.done("prepare")
    fem.ComputeHurtyCraigBamptonModes(faces, arguments.modes, computationMode=HCBstaticModeSelection.RBE2)
    # Factor, modes and constraint modes in one call.
    stages.done("modes")
    reduced = ObjectFFRFreducedOrderInterface(fem)
    stages.done("project")
    np.savez(arguments.output + ".npz", stiffness=reduced.stiffnessMatrixReduced, mass=reduced.massMatrixReduced)
    stages.done("write")
    reduction.write(arguments.output, stages, fem.eigenValues)


if __name__ == "__main__":
    main()
