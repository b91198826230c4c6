"""Puts each fault of table.toml into a copy of the sources, runs the test named for it and demands that it fails.

    tests/mutations/run.sh [--suite-passed] [NAME ...]

The sources stay as they are: faults go into target/mutations. Every named test first has to pass there without a fault; where the whole
suite has just passed on the same sources, `--suite-passed` leaves that out.
Exit code: 0 where every fault was noticed, 1 where one was not.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
COPY = ROOT / "target" / "mutations"
TARGET = ROOT / "target" / "mutated"
# Each fault is a build and one test. Without optimisation a build takes a tenth of the time, and the dependencies, which do most of
# the arithmetic, stay optimised.
QUICK_BUILD = {"CARGO_PROFILE_DEV_OPT_LEVEL": "0", "CARGO_PROFILE_DEV_DEBUG": "0"}


def copy_sources():
    """A copy of all files of the repository, without those it ignores; unchanged ones keep their times, old ones go."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True
    )
    names = {name for name in listed.stdout.splitlines() if (ROOT / name).is_file()}
    for old in [path for path in COPY.rglob("*") if path.is_file()]:
        if old.relative_to(COPY).as_posix() not in names:
            old.unlink()
    for name in sorted(names):
        source, target = ROOT / name, COPY / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists() or target.read_bytes() != source.read_bytes():
            shutil.copyfile(source, target)


def run(member, target, tests):
    """Whether `cargo test` passes for a target and some of its tests of the package in a folder, and what it printed."""
    command = ["cargo", "test", "--manifest-path", str(COPY / member / "Cargo.toml"), "--test", target, "--", *tests]
    # A folder of its own: in a shared one cargo may take what a fault made for the work of the sources.
    environment = dict(os.environ, CARGO_TARGET_DIR=str(TARGET), RUST_BACKTRACE="0", **QUICK_BUILD)
    ended = subprocess.run(command, cwd=COPY, env=environment, capture_output=True, text=True)
    return ended.returncode == 0, ended.stdout + ended.stderr


def refuse_failing(chosen):
    """Ends where a named test does not exist or does not pass without a fault."""
    targets = {}
    for mutation in chosen:
        target, test = mutation["test"]
        targets.setdefault((mutation.get("member", ""), target), set()).add(test)
    for (member, target), tests in sorted(targets.items()):
        passed, text = run(member, target, sorted(tests))
        missing = [test for test in tests if not re.search(rf"^test (.*::)?{re.escape(test)}.* ok$", text, re.M)]
        if not passed or missing:
            sys.exit(f"{target} {' '.join(missing)} does not pass without a fault:\n{text[-3000:]}")


def outcome(mutation):
    """What came of one fault, in words, and whether it was noticed."""
    path = COPY / mutation["file"]
    sound = path.read_text()
    if sound.count(mutation["before"]) != 1:
        return "cannot be put in: the place is not there exactly once", False
    path.write_text(sound.replace(mutation["before"], mutation["after"]))
    try:
        target, test = mutation["test"]
        passed, text = run(mutation.get("member", ""), target, [test])
    finally:
        path.write_text(sound)
    if passed:
        return "NOT NOTICED", False
    failed = re.search(r"test result: FAILED", text)
    if failed is None and "error: test failed" in text:
        return "the test ended without a result", False
    if failed is None:
        message = next((line for line in text.splitlines() if line.startswith("error")), "no test ran")
        return f"does not compile: {message}", False
    return "noticed", True


def main():
    table = tomllib.loads((ROOT / "tests" / "mutations" / "table.toml").read_text())["mutation"]
    flags = {argument for argument in sys.argv[1:] if argument.startswith("--")}
    if flags - {"--suite-passed"}:
        sys.exit(f"no such flag: {', '.join(sorted(flags))}")
    wanted = [argument for argument in sys.argv[1:] if argument not in flags]
    chosen = [mutation for mutation in table if not wanted or mutation["name"] in wanted]
    unknown = set(wanted) - {mutation["name"] for mutation in table}
    if unknown:
        sys.exit(f"no such fault: {', '.join(sorted(unknown))}")
    copy_sources()
    if not flags:
        refuse_failing(chosen)
    print("| fact | fault | test that has to notice | outcome | s |\n|---|---|---|---|---|", flush=True)
    n_unnoticed = 0
    for mutation in chosen:
        begin = time.monotonic()
        words, noticed = outcome(mutation)
        n_unnoticed += not noticed
        seconds = time.monotonic() - begin
        test = "::".join(mutation["test"])
        print(f"| {mutation['fact']} | {mutation['name']} | `{test}` | {words} | {seconds:.0f} |", flush=True)
    print(f"\n{len(chosen) - n_unnoticed} of {len(chosen)} faults were noticed")
    sys.exit(1 if n_unnoticed else 0)


if __name__ == "__main__":
    main()
