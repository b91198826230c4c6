#!/bin/sh
# Makes the peers' Python environment where it is missing and compares:
#   benches/peers/compare.sh PAIR target/release/supel [options of compare.py]
set -eu
here=$(dirname "$0")
environment=${PEERS_VENV:-${TMPDIR:-/tmp}/supel-peers}
pair=$1
supel=$2
shift 2
if [ ! -x "$environment/bin/python" ]; then
    python3 -m venv "$environment"
    "$environment/bin/pip" install --quiet -r "$here/requirements.txt"
fi
exec "$environment/bin/python" "$here/compare.py" "$pair" --supel "$supel" "$@"
