"""What pyYeti does of the job: its `cbcheck` of a Craig-Bampton superelement that supel made (part.supel in the folder)."""

import io
import pathlib

import numpy as np
from pyyeti import cb
from pyyeti.nastran import n2p

import reduction
from harness import superelement


def main():
    arguments = reduction.parsed(__doc__)
    if arguments.method != "craig-bampton":
        reduction.decline("cbcheck takes Craig-Bampton models")
    stages = reduction.Stages()
    tensors = superelement.read(pathlib.Path(arguments.folder) / "part.supel")
    stages.done("read")
    nodes = None
    for label, position in enumerate(tensors["interface_positions"], start=1):
        nodes = n2p.addgrid(nodes, label, "b", 0, position.tolist(), 0)
    text = io.StringIO()
    n_b = 6 * len(tensors["interface_positions"])
    cb.cbcheck(text, tensors["mass"], tensors["stiffness"], np.arange(n_b), np.arange(6), nodes, uref=1)
    stages.done("verify")
    warnings = sum("WARNING" in line.upper() for line in text.getvalue().splitlines())
    reduction.write(arguments.output, stages, None, warnings=warnings)


if __name__ == "__main__":
    main()
