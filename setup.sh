#!/usr/bin/env bash
# Prepares a machine, builds supel and shows that it works.
#
#   ./setup.sh        install what is missing, build the release program
#   ./setup.sh run    install and build, then reduce the bundled example
#   ./setup.sh test   install what is missing, build and run all tests; the bundled example is among them
#   ./setup.sh browser   install Chromium, in which the tests open the report page; without it they skip that
set -euo pipefail
cd "$(dirname "$0")"

# HDF5 and ARPACK-NG are linked; pkg-config finds them; build-essential compiles the vendored METIS.
readonly packages=(build-essential pkg-config libhdf5-dev libarpack2-dev)
readonly python_packages=(python3 python3-venv)
readonly browser_packages=(chromium)
readonly python_modules=(numpy safetensors blake3)
# The manifest says which Rust is needed.
rust_minor=$(sed -n 's/^rust-version = "1\.\([0-9]*\)"$/\1/p' Cargo.toml)
readonly rust_minor

say() { printf '\n== %s\n' "$*"; }
fail() { printf 'setup.sh: %s\n' "$*" >&2; exit 1; }

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"
    elif command -v sudo >/dev/null; then sudo "$@"
    else fail "needs root to run: $*"
    fi
}

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

install_packages() {
    local package missing=()
    if ! command -v dpkg-query >/dev/null; then
        say "not Debian or Ubuntu: make sure that the equivalents of these packages are installed"
        printf '   %s\n' "${packages[@]}" "${python_packages[@]} (for the Python tests only)"
        return
    fi
    for package in "$@"; do is_installed "$package" || missing+=("$package"); done
    [ ${#missing[@]} -eq 0 ] && return
    say "installing ${missing[*]}"
    as_root apt-get update -q
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}

has_rust() {
    local version
    version=$(cargo --version 2>/dev/null | sed -n 's/^cargo 1\.\([0-9]*\)\..*/\1/p')
    [ -n "$version" ] && [ "$version" -ge "$rust_minor" ]
}

install_rust() {
    # A toolchain installed by rustup in an earlier shell may not be on the path of this one.
    [ -f "${CARGO_HOME:-$HOME/.cargo}/env" ] && . "${CARGO_HOME:-$HOME/.cargo}/env"
    has_rust && return
    if ! command -v rustup >/dev/null && apt-cache show rustup >/dev/null 2>&1; then
        install_packages rustup
    fi
    if command -v rustup >/dev/null; then
        say "installing the stable Rust toolchain"
        rustup default stable
    fi
    has_rust || fail "needs cargo 1.$rust_minor or newer; see https://rustup.rs, then run this again"
}

# The tests that load superelements in Python need these modules; without them they are skipped with a message.
prepare_python() {
    install_packages "${python_packages[@]}"
    local python=$PWD/target/venv/bin/python
    if ! "$python" -c 'import numpy, safetensors, blake3' 2>/dev/null; then
        say "installing ${python_modules[*]} in target/venv"
        if ! { python3 -m venv target/venv && "$python" -m pip install --quiet "${python_modules[@]}"; }; then
            echo "setup.sh: target/venv could not be made: the Python tests will be skipped" >&2
            return
        fi
    fi
    export SUPEL_PYTHON=$python
}

# A browser of another name or origin will do: the tests look for these, too.
has_browser() {
    local browser
    for browser in ${SUPEL_BROWSER:+"$SUPEL_BROWSER"} chromium chromium-browser google-chrome; do
        "$browser" --version >/dev/null 2>&1 && return
    done
    return 1
}

install_browser() {
    has_browser || install_packages "${browser_packages[@]}"
}

build_release() {
    say "building supel"
    cargo build --release --locked
}

run_example() {
    say "supel reduce examples/bracket/job.toml"
    # The report is to appear on the terminal the second time as well.
    target/release/supel reduce examples/bracket/job.toml --force
}

# The profile for tests is optimised and checks arithmetic for overflow, so that no release build is needed here.
run_tests() {
    say "running the tests"
    cargo test --workspace --locked --features supel-models/med,supel-runtime/capi,validation/vtkhdf
}

main() {
    local goal=${1:-build}
    case $goal in
        build|run|test) ;;
        browser) install_browser; return ;;
        *) fail "unknown goal '$goal': expected run, test or browser" ;;
    esac
    install_packages "${packages[@]}"
    install_rust
    case $goal in
        build)
            build_release
            say "target/release/supel is ready"
            ;;
        run)
            build_release
            run_example
            say "done; the program is target/release/supel"
            ;;
        test)
            prepare_python
            run_tests
            say "all tests passed"
            ;;
    esac
}

main "$@"
