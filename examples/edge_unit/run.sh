#!/bin/sh
# Builds the edge unit with Verilator, runs it on vectors of fine_raster, and lets `halfplane check` judge what it gave.
# usage: run.sh HALFPLANE FOLDER [bug]     FOLDER is made; bug: with EDGE_UNIT_BUG. The status is that of check.
set -eu
halfplane=$1 folder=$2
here=$(cd "$(dirname "$0")" && pwd)
if [ "${3:-}" = bug ]; then set -- -DEDGE_UNIT_BUG; else set --; fi
mkdir -p "$folder"
"$halfplane" vectors --random 300 --config tiny --stage fine_raster --format hex -o "$folder/vectors" --quiet
"$halfplane" config --config tiny --sv >"$folder/raster_pkg.sv"
verilator --binary --timing -Wno-fatal -Wno-WIDTH -Wno-UNUSED -MAKEFLAGS "OPT_FAST=-O0 OPT_GLOBAL=-O0" --top-module testbench "$@" --Mdir "$folder/obj" \
  "$folder/raster_pkg.sv" "$here/edge_unit.sv" "$here/testbench.sv" -o testbench >"$folder/verilator.log" 2>&1 ||
  { cat "$folder/verilator.log" >&2; exit 3; }
"$folder/obj/testbench" "+folder=$folder/vectors" >"$folder/run.log"
exec "$halfplane" check --stage fine_raster "$folder/vectors"
