#!/usr/bin/env bash
# Compares the cost of two small jobs with committed values, in figures that do not depend on the weather: work counters, bytes
# of the files written, and instructions as valgrind counts them on one thread.
#
#   benches/cost_guard.sh             compares with benches/cost_guard.json; exit code 1 where a cost has grown by over 2 %
#   benches/cost_guard.sh --refresh   writes the values of this commit there
#
# The development profile is measured, which the tests have built already. Instructions depend on the compiler: with another
# one than that of the values only the other costs are compared. Without valgrind likewise. The guard prints what it skipped.
set -euo pipefail
cd "$(dirname "$0")/.."
readonly values=benches/cost_guard.json
readonly supel=target/debug/supel

# As `.ci/run` builds the tests, so that after them there is nothing to do; these two need both programs. Instructions depend on how a
# crate is cut into units.
export CARGO_INCREMENTAL=0 CARGO_PROFILE_DEV_DEBUG=none CARGO_PROFILE_DEV_CODEGEN_UNITS=4
cargo test --quiet --workspace --locked --features supel-models/med,supel-runtime/capi,validation/vtkhdf --no-run --test readme --test parts
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Name, family, method and what else the job has. The first compares all it can with the full model; the second is a solid
# whose factor weighs, without comparisons.
job() {
    local name=$1 family=$2 method=$3 extra=$4 folder=$work/$1
    local counting=()
    if command -v valgrind >/dev/null; then
        counting=(valgrind --tool=callgrind --callgrind-out-file=/dev/null --log-file="$folder/callgrind.log")
    fi
    target/debug/make-solid --family "$family" --dofs 1000 --modes 12 --out "$folder" >/dev/null
    printf '%b' "$extra" >>"$folder/job.toml"
    "${counting[@]}" "$supel" reduce "$folder/job.toml" --quiet --threads 1 --method "$method"
}

job lattice lattice herting '' &
lattice=$!
job solid bulky craig-bampton '\n[scene]\nboundaries = []\n'
wait "$lattice"

python3 - "$work" "$values" "${1:-compare}" "$(rustc --version)" <<'PYTHON'
import json, pathlib, re, sys

work, values, goal, compiler = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3], sys.argv[4]
# What the same work may cost more.
MARGIN = 0.02


def costs(folder):
    report = json.loads((folder / "part.report.json").read_text())
    # Times have digits by chance; only the part of the report that repeats is weighed.
    found = dict(report["run"]["work"], report_bytes=len(json.dumps(report["body"])))
    found["superelement_bytes"] = (folder / "part.supel").stat().st_size
    log = folder / "callgrind.log"
    if log.exists():
        found["instructions"] = int(re.search(r"Collected : (\d+)", log.read_text()).group(1))
    return found


now = {"compiler": compiler, "jobs": {folder.name: costs(folder) for folder in sorted(work.iterdir())}}
if goal == "--refresh":
    values.write_text(json.dumps(now, indent=1) + "\n")
    print(f"{values} is written", "" if "instructions" in now["jobs"]["solid"] else "WITHOUT instructions: no valgrind")
    sys.exit()
then = json.loads(values.read_text())
skip = set()
if then["compiler"] != now["compiler"]:
    print(f"SKIPPED: instructions were counted with {then['compiler']}, this is {now['compiler']}")
    skip.add("instructions")
elif "instructions" not in now["jobs"]["solid"]:
    print("SKIPPED: instructions are not counted, valgrind is not installed")
    skip.add("instructions")
grown = 0
for job, expected in then["jobs"].items():
    for cost, before in expected.items():
        if cost in skip:
            continue
        after = now["jobs"][job][cost]
        change = (after - before) / before if before else float(after > 0)
        verdict = "GROWN" if change > MARGIN else "less: refresh the values" if change < -MARGIN else ""
        grown += change > MARGIN
        print(f"{job:8} {cost:20} {before:15.0f} {after:15.0f} {change:+8.2%} {verdict}")
if grown:
    sys.exit(f"{grown} costs have grown by over {MARGIN:.0%}; where that is worth it: benches/cost_guard.sh --refresh")
PYTHON
