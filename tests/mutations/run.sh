#!/bin/sh
# The checker is checked: puts each fault of table.toml into a copy of the sources and demands that its test fails.
#   tests/mutations/run.sh [NAME ...]     all of them take some ten minutes
set -eu
exec python3 "$(dirname "$0")/run.py" "$@"
