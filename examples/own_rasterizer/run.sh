#!/bin/sh
# Verilates the rasterizer beside Halfplane's pipeline, which it calls through DPI-C, and draws a capture.
# usage: run.sh HALFPLANE LIBRARY FOLDER SCENE    LIBRARY: libhalfplane_c.so; FOLDER is made.
# RTL, in the environment: another file of the rasterizer. The status is 0 when all is equal, 1 when not.
set -eu
halfplane=$1 folder=$3 scene=$4
library=$(cd "$(dirname "$2")" && pwd)/$(basename "$2") # it is linked from another folder
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$folder"
if command -v ccache >/dev/null; then export OBJCACHE="${OBJCACHE:-ccache}"; fi
"$halfplane" config --config tiny --sv >"$folder/raster_pkg.sv"
"$halfplane" config --config tiny --dpi >"$folder/halfplane_dpi.sv"
verilator --binary --timing -Wno-fatal -Wno-lint -Wno-style -MAKEFLAGS "OPT_FAST=-O0 OPT_GLOBAL=-O0" --top-module testbench --Mdir "$folder/obj" \
  "$folder/raster_pkg.sv" "$folder/halfplane_dpi.sv" "${RTL:-$here/rasterizer.sv}" "$here/testbench.sv" \
  -LDFLAGS "$library -Wl,-rpath,$(dirname "$library")" -o testbench >"$folder/verilator.log" 2>&1 ||
  { cat "$folder/verilator.log" >&2; exit 3; }
"$folder/obj/testbench" "+scene=$scene" || exit 1
