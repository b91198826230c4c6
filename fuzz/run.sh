#!/usr/bin/env bash
# Runs every target for a minute, or for as many seconds as are given, from the fixtures and what earlier runs found.
# Needs cargo-fuzz: cargo install cargo-fuzz
set -euo pipefail
cd "$(dirname "$0")"
seconds="${1:-60}"
# cargo-fuzz asks for options of the compiler that a stable one has behind this variable.
export RUSTC_BOOTSTRAP=1

seeds() { # target, then patterns of fixtures
    mkdir -p "corpus/$1" "seeds/$1"
    local target="$1"
    shift
    for file in "$@"; do cp "$file" "seeds/$target/"; done
}

matrices=../fixtures/matrices
text=../fixtures/text
seeds matrix_market $matrices/[km].mtx $matrices/[km]_short.mtx
seeds coordinate $text/truss.sti $text/truss.mas
seeds abaqus_labels $matrices/*_labels.mtx
seeds user_element $matrices/user_element.mtx
seeds dmig $matrices/*.pch $matrices/*.bdf
seeds op4 $matrices/*.op4
seeds harwell_boeing $matrices/*.rsa $matrices/*.rua
seeds npz $matrices/*.npz
seeds npy $matrices/*.npy
seeds matlab5 $matrices/*.mat
seeds any_matrix $matrices/k.mtx $matrices/k_labels.mtx $matrices/small.bdf $matrices/string_little.op4 $matrices/k.rsa $matrices/k_csr.npz $matrices/sparse.mat
seeds dof_map $text/truss.dof $matrices/small.bdf seeds_own/dof_map/*
seeds node_table $text/truss.csv
seeds mesh ../fixtures/mesh/*.msh ../fixtures/mesh/*.vtk ../fixtures/mesh/*.vtu ../fixtures/calculix/*.inp ../fixtures/calculix/*.frd
seeds modes modes/*
seeds expansion ../fixtures/calculix/*.12d
seeds job ../examples/*/*.toml
seeds assembly seeds_own/assembly/*
seeds states seeds_own/states/*
seeds values seeds_own/values/*
# A superelement is made by the program itself, so that it is one of this version.
mkdir -p seeds/superelement corpus/superelement
cargo run --quiet --release --manifest-path ../Cargo.toml -- reduce ../examples/bracket/job.toml --modes 2 --force --quiet \
    --output "$PWD/seeds/superelement/bracket.supel" && rm -f seeds/superelement/*.json

# What earlier runs found begins every run anew, and the test fuzz_regressions holds it.
for folder in regressions/*/; do
    target="$(basename "$folder")"
    mkdir -p "seeds/$target"
    cp "$folder"* "seeds/$target/"
done

for target in seeds/*/; do
    target="$(basename "$target")"
    printf '\n#### %s for %s s\n' "$target" "$seconds"
    cargo fuzz run "$target" "corpus/$target" "seeds/$target" -- -max_total_time="$seconds" -rss_limit_mb=4096 -timeout=20 -max_len=65536
done
