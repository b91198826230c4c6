#!/bin/sh
# Makes mesh and matrices of the lug: pip install gmsh scikit-fem meshio (which bring NumPy and SciPy).
set -e
cd "$(dirname "$0")"
python="${PYTHON:-python3}"
"$python" -c 'import gmsh; gmsh.initialize(); gmsh.open("lug.geo"); gmsh.model.mesh.generate(3); gmsh.write("lug.msh")'
"$python" assemble.py
