#!/usr/bin/env python3
"""Makes the diagrams of errors, sizes and run times, as SVG and CSV, by one command.

    benches/diagrams/run.py [A B C D E F G H M S] [--family bulky] [--dofs 10000] [--threads 2]

A eigen stage against eigenvalue error; B error under foreign boundaries against size; C whole job against the delivered
frequency response; D error over eps * kappa; E growth with n; F what scenes and a cache save; G accepted, promised and
found errors; H couplings of a hole against the mesh; M memory that is foreseen against that of the run; S a spinning beam.

Needs a release build of supel; parts are generated and kept in --work, Python packages come into an environment of its own
(PEERS_VENV). --family, --dofs, --method and --repeats are of A, C, E, F and M: without options a short run on small parts; the
documents' series is `--dofs 89000` for A and C, `F --family slender --dofs 297000`, `F --family onshape` with SUPEL_CORPUS, and
`E --dofs 10000 --dofs 30000 --dofs 89000 --dofs 297000 --dofs 878000 --repeats 5`. B and G leave out what needs SUPEL_CORPUS
where that is absent, H needs CalculiX.
"""

import argparse
import pathlib
import shutil
import sys

BENCHES = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(BENCHES), str(BENCHES / "peers")]
from harness import environment, machine

environment.enter()

from diagrams import accepted, accuracy, delivered, eigen, foreign, foreseen, hole, scaling, scenes, spin

FAMILIES = ("bulky", "slender", "lattice")
# Parts of one size, of F and M alone.
OF_CORPUS = ("onshape",)
LETTERS = ("A", "B", "C", "D", "E", "F", "G", "H", "M", "S")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("letters", nargs="*", choices=[[], *LETTERS], help="default: all")
    parser.add_argument("--family", action="append", choices=(*FAMILIES, *OF_CORPUS), help="default: all that are generated")
    parser.add_argument("--dofs", action="append", type=int, help="default: 10000; for E 2500, 5000, 10000")
    parser.add_argument("--method", choices=["craig-bampton", "herting"], default="herting", help="of A and E")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--repeats", type=int, default=1, help="of E and F; medians are drawn, of F the fastest")
    parser.add_argument("--timeout", type=float, default=3600.0, help="seconds for one process")
    parser.add_argument("--supel", default=str(machine.ROOT / "target/release/supel"))
    parser.add_argument("--work", type=pathlib.Path, default=machine.ROOT / "target/parts", help="where parts are kept")
    parser.add_argument("--out", type=pathlib.Path, default=BENCHES / "results")
    settings = parser.parse_args()
    if not shutil.which(settings.supel):
        sys.exit(f"{settings.supel} is missing: cargo build --release")
    settings.supel = str(pathlib.Path(shutil.which(settings.supel)).resolve())
    settings.origin = machine.origin(settings.supel)
    letters, families = settings.letters or LETTERS, settings.family or FAMILIES
    for family in families:
        if family in OF_CORPUS:
            if "F" in letters:
                scenes.draw(settings, family, None)
            continue
        for dofs in settings.dofs or [10000]:
            if "A" in letters:
                eigen.draw(settings, family, dofs)
            if "C" in letters:
                delivered.draw(settings, family, dofs)
            if "F" in letters:
                scenes.draw(settings, family, dofs)
        if "E" in letters:
            scaling.draw(settings, family, settings.dofs or [2500, 5000, 10000])
    if "M" in letters:
        foreseen.draw(settings, families, settings.dofs or [3000, 10000])
    for letter, diagram in (("B", foreign), ("D", accuracy), ("G", accepted), ("H", hole), ("S", spin)):
        if letter in letters:
            diagram.draw(settings)


if __name__ == "__main__":
    main()
