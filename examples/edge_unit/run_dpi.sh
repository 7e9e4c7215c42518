#!/bin/sh
# Builds the edge unit with Verilator beside Halfplane's own stage, which it calls through DPI-C, and compares them.
# usage: run_dpi.sh HALFPLANE LIBRARY FOLDER [bug|mixed]    LIBRARY: libhalfplane_c.so. The status is 0 when they are equal, 1
# when not. mixed: with a raster_pkg of other hardware, which the package notices.
set -eu
halfplane=$1 folder=$3
library=$(cd "$(dirname "$2")" && pwd)/$(basename "$2") # it is linked from another folder
here=$(cd "$(dirname "$0")" && pwd)
depth_bits=8
if [ "${4:-}" = mixed ]; then depth_bits=12; fi
if [ "${4:-}" = bug ]; then set -- -DEDGE_UNIT_BUG; else set --; fi
mkdir -p "$folder"
"$halfplane" config --config tiny --set depth.bits=$depth_bits --sv >"$folder/raster_pkg.sv"
"$halfplane" config --config tiny --dpi >"$folder/halfplane_dpi.sv"
verilator --binary --timing -Wno-fatal -Wno-WIDTH -Wno-UNUSED -MAKEFLAGS "OPT_FAST=-O0 OPT_GLOBAL=-O0" --top-module testbench_dpi "$@" --Mdir "$folder/obj" \
  "$folder/raster_pkg.sv" "$folder/halfplane_dpi.sv" "$here/edge_unit.sv" "$here/testbench_dpi.sv" \
  -LDFLAGS "$library -Wl,-rpath,$(dirname "$library")" -o testbench_dpi >"$folder/verilator.log" 2>&1 ||
  { cat "$folder/verilator.log" >&2; exit 3; }
"$folder/obj/testbench_dpi" || exit 1
