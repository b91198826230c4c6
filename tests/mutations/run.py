"""Puts each fault of table.toml into a copy of the sources, runs the test named for it and demands that it fails.

    tests/mutations/run.sh [--suite-passed] [NAME ...]

The sources stay as they are: faults go into target/mutations. Most faults are branches of one build (switched.py), and a run of a test
chooses one; what is no branch, as a fault in a constant, is put in and built alone, and nothing is built for what a test reads while it
runs. Every named test first has to pass there without a fault; where the whole suite has just passed on the same sources,
`--suite-passed` leaves that out.
Exit code: 0 where every fault was noticed, 1 where one was not.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor

import switched

ROOT = pathlib.Path(__file__).resolve().parents[2]
COPY = ROOT / "target" / "mutations"
TARGET = ROOT / "target" / "mutated"
# A folder of its own for what is built: in a shared one cargo may take what a fault made for the work of the sources.
ENVIRONMENT = dict(os.environ, CARGO_TARGET_DIR=str(TARGET), RUST_BACKTRACE="0", CARGO_PROFILE_DEV_DEBUG="0")
# The one build of all branches is optimised, since many tests run in it. What is built alone is built for one test: without optimisation
# that takes a tenth of the time, and the dependencies, which do most of the arithmetic, stay optimised.
QUICK_BUILD = {"CARGO_PROFILE_DEV_OPT_LEVEL": "0"}
# All of the workspace, since that is what the suite builds: dependencies have the same features.
CARGO_TEST = ["cargo", "test", "--workspace", "--locked", "--features", "supel-models/med,supel-runtime/capi,validation/vtkhdf"]
# A test that runs ten times as long as the slowest one does will not end.
PATIENCE_SECONDS = 1200


def copy_sources(texts=None):
    """A copy of all files of the repository, without those it ignores and with `texts` in the place of some; unchanged ones keep their
    times, so that nothing is built again for them, and old ones go."""
    texts = {name: text.encode() for name, text in (texts or {}).items()}
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True
    )
    names = {name for name in listed.stdout.splitlines() if (ROOT / name).is_file()}
    for old in [path for path in COPY.rglob("*") if path.is_file()]:
        if old.relative_to(COPY).as_posix() not in names:
            old.unlink()
    for name in sorted(names):
        wanted, target = texts.get(name) or (ROOT / name).read_bytes(), COPY / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists() or target.read_bytes() != wanted:
            target.write_bytes(wanted)


def place_of(mutation):
    """The package of the test of a fault, as its folder, and the test target."""
    return mutation.get("member", ""), mutation["test"][0]


def crate_root(mutation):
    """The file of the root of the crate that a fault is in, relative to the repository."""
    folder = mutation["file"].split("/")[0]
    return "src/lib.rs" if folder == "src" else f"{folder}/src/lib.rs"


def write_switched(numbered):
    """Writes the faults into the copy as branches, and gives the numbers of those that fit and the switched texts by file."""
    by_file, texts, fitting = {}, {}, set()
    for number, mutation in numbered.items():
        text = (ROOT / mutation["file"]).read_text()
        if text.count(mutation["before"]) == 1 and (ROOT / crate_root(mutation)).is_file():
            by_file.setdefault(mutation["file"], []).append((number, mutation))
    for name, faults in by_file.items():
        texts[name], numbers = switched.switched((ROOT / name).read_text(), faults)
        fitting |= numbers
    for name in {crate_root(numbered[number]) for number in fitting}:
        texts[name] = texts.get(name, (ROOT / name).read_text()) + switched.CHOICE
    copy_sources(texts)
    return fitting, texts


def build(places):
    """The programs of test targets, by package and target, and the messages of the compiler where it refused."""
    targets = [word for target in sorted({target for _, target in places}) for word in ("--test", target)]
    command = [*CARGO_TEST, "--no-run", "--message-format", "json", *targets]
    ended = subprocess.run(command, cwd=COPY, env=ENVIRONMENT, capture_output=True, text=True)
    programs, errors = {}, []
    for line in ended.stdout.splitlines():
        message = json.loads(line) if line.startswith("{") else {}
        if message.get("reason") == "compiler-artifact" and message.get("executable") and "test" in message["target"]["kind"]:
            member = pathlib.Path(message["manifest_path"]).parent.relative_to(COPY)
            programs["" if member == pathlib.Path() else str(member), message["target"]["name"]] = message["executable"]
        if message.get("reason") == "compiler-message" and message["message"]["level"] == "error":
            errors.append(message["message"])
    if ended.returncode and not errors:
        sys.exit(f"the sources cannot be built:\n{ended.stderr[-3000:]}")
    return programs, errors


def build_switched(numbered):
    """The programs of all faults that need no build of their own, and the numbers of those that are branches; those that the compiler
    refuses are left out and the others built again."""
    left = {number: mutation for number, mutation in numbered.items() if not mutation.get("is_text")}
    places_of_texts = {place_of(mutation) for mutation in numbered.values() if mutation.get("is_text")}
    while True:
        fitting, texts = write_switched(left)
        places = places_of_texts | {place_of(left[number]) for number in fitting}
        if not places:
            return {}, fitting
        programs, errors = build(places)
        if not errors:
            return programs, fitting
        refused = {
            number
            for error in errors
            for span in error["spans"]
            if span["is_primary"] and span["file_name"] in texts
            for number in switched.faults_at(texts[span["file_name"]], span["line_start"])
        }
        if not refused:
            sys.exit("\n".join(error["rendered"] for error in errors))
        left = {number: mutation for number, mutation in left.items() if number not in refused}


def run_program(programs, place, tests, number):
    """Whether a built test program passes with a fault, 0 for none, and what it printed."""
    member, _ = place
    environment = ENVIRONMENT | {switched.VARIABLE: str(number)}
    command = [programs[place], *tests]
    try:
        ended = subprocess.run(
            command, cwd=COPY / member, env=environment, capture_output=True, text=True, errors="replace", timeout=PATIENCE_SECONDS
        )
    except subprocess.TimeoutExpired:
        return False, "error: test failed to end"
    return ended.returncode == 0, ended.stdout + ended.stderr + ("error: test failed" if ended.returncode else "")


def run_cargo(place, tests):
    """Whether `cargo test` passes for a target and some of its tests, built as they are in the copy, and what it printed."""
    command = [*CARGO_TEST, "--test", place[1], "--", *tests]
    ended = subprocess.run(command, cwd=COPY, env=ENVIRONMENT | QUICK_BUILD, capture_output=True, text=True, errors="replace")
    return ended.returncode == 0, ended.stdout + ended.stderr


def refuse_failing(mutations, passes):
    """Ends where a named test does not exist or does not pass without a fault."""
    targets = {}
    for mutation in mutations:
        targets.setdefault(place_of(mutation), set()).add(mutation["test"][1])
    for place, tests in sorted(targets.items()):
        passed, text = passes(place, sorted(tests))
        missing = [test for test in tests if not re.search(rf"^test (.*::)?{re.escape(test)}.* ok$", text, re.M)]
        if not passed or missing:
            sys.exit(f"{place[1]} {' '.join(missing)} does not pass without a fault:\n{text[-3000:]}")


def judged(passed, text):
    """What came of one fault, in words, and whether it was noticed."""
    if passed:
        return "NOT NOTICED", False
    if re.search(r"test result: FAILED", text):
        return "noticed", True
    if "error: test failed" in text:
        return "the test ended without a result", False
    message = next((line for line in text.splitlines() if line.startswith("error")), "no test ran")
    return f"does not compile: {message}", False


def alone(mutation, run):
    """What comes of a fault that is put into the sources, where `run` gives whether its test passes and what it printed."""
    path = COPY / mutation["file"]
    sound = path.read_text()
    if sound.count(mutation["before"]) != 1:
        return "cannot be put in: the place is not there exactly once", False
    path.write_text(sound.replace(mutation["before"], mutation["after"]))
    try:
        return judged(*run(place_of(mutation), [mutation["test"][1]]))
    finally:
        path.write_text(sound)


def told(mutation, outcome):
    """Prints the line of one fault once `outcome` is known, and whether the fault was noticed."""
    begin = time.monotonic()
    words, noticed = outcome()
    seconds = time.monotonic() - begin
    print(f"| {mutation['fact']} | {mutation['name']} | `{'::'.join(mutation['test'])}` | {words} | {seconds:.0f} |", flush=True)
    return noticed


def main():
    table = tomllib.loads((ROOT / "tests" / "mutations" / "table.toml").read_text())["mutation"]
    flags = {argument for argument in sys.argv[1:] if argument.startswith("--")}
    if flags - {"--suite-passed"}:
        sys.exit(f"no such flag: {', '.join(sorted(flags))}")
    wanted = [argument for argument in sys.argv[1:] if argument not in flags]
    numbered = {number: mutation for number, mutation in enumerate(table, 1) if not wanted or mutation["name"] in wanted}
    unknown = set(wanted) - {mutation["name"] for mutation in table}
    if unknown:
        sys.exit(f"no such fault: {', '.join(sorted(unknown))}")

    programs, fitting = build_switched(numbered)

    def run_sound(place, tests):
        return run_program(programs, place, tests, 0)

    rest = [mutation for number, mutation in numbered.items() if number not in fitting]
    texts = [mutation for mutation in rest if mutation.get("is_text")]
    own_builds = [mutation for mutation in rest if not mutation.get("is_text")]
    if not flags:
        refuse_failing([numbered[number] for number in fitting], run_sound)
    print("| fact | fault | test that has to notice | outcome | s |\n|---|---|---|---|---|", flush=True)

    def branch(number):
        mutation = numbered[number]
        test = mutation["test"][1]
        return told(mutation, lambda: judged(*run_program(programs, place_of(mutation), [test], number)))

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        n_noticed = sum(pool.map(branch, sorted(fitting)))
    if rest:
        copy_sources()
    for group, run in [(texts, run_sound), (own_builds, run_cargo)]:
        if not flags:
            refuse_failing(group, run)
        n_noticed += sum(told(mutation, lambda: alone(mutation, run)) for mutation in group)
    print(f"\n{n_noticed} of {len(numbered)} faults were noticed")
    sys.exit(0 if n_noticed == len(numbered) else 1)


if __name__ == "__main__":
    main()
