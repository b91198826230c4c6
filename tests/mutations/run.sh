#!/bin/sh
# The checker is checked: puts each fault of table.toml into a copy of the sources and demands that its test fails.
#   tests/mutations/run.sh [--suite-passed] [NAME ...]     all of them take half an hour on two cores, with the build
set -eu
exec python3 -B "$(dirname "$0")/run.py" "$@"
