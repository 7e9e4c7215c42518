#!/bin/sh
# Runs the edge unit in Icarus under cocotb, beside Halfplane's own stage, and compares them.
# usage: run.sh LIBRARY FOLDER [bug]    LIBRARY: libhalfplane_c.so; bug: with EDGE_UNIT_BUG. The status is 0 when they are
# equal, 1 when not, 3 when it did not run.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
examples=$(dirname "$here")
if [ "${3:-}" = bug ]; then extra=-DEDGE_UNIT_BUG; else extra=; fi
mkdir -p "$2"
HALFPLANE_LIBRARY=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
folder=$(cd "$2" && pwd)
export HALFPLANE_LIBRARY PYTHONPATH="$here:$examples/python${PYTHONPATH:+:$PYTHONPATH}" PYTHONDONTWRITEBYTECODE=1
results=$folder/results.xml
rm -f "$results"
make -C "$folder" -f "$here/Makefile" "EXAMPLES=$examples" "SIM_BUILD=$folder/sim" "COCOTB_RESULTS_FILE=$results" \
  "BUG=$extra" >"$folder/cocotb.log" 2>&1 || true
if ! grep -q '<testcase' "$results" 2>/dev/null; then
  cat "$folder/cocotb.log" >&2
  exit 3
fi
grep -o 'tile [0-9].*the model .*\|[0-9]* tiles of seed.*' "$folder/cocotb.log" | head -n 1
! grep -q '<failure\|<error' "$results"
