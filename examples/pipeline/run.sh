#!/bin/sh
# Verilates raster_top with the scoreboard, which calls Halfplane's pipeline through DPI-C, and draws a capture.
# usage: run.sh HALFPLANE LIBRARY FOLDER SCENE [CONFIG]    LIBRARY: libhalfplane_c.so; FOLDER is made; CONFIG: tiny.
# OWN, in the environment: a folder whose modules stand in for those of rtl_ref. The status is 0 when all is equal, 1 when not.
set -eu
halfplane=$1 folder=$3 scene=$4 config=${5:-tiny}
library=$(cd "$(dirname "$2")" && pwd)/$(basename "$2") # it is linked from another folder
here=$(cd "$(dirname "$0")" && pwd)
rtl=$here/../../rtl_ref
mkdir -p "$folder"
if command -v ccache >/dev/null; then export OBJCACHE="${OBJCACHE:-ccache}"; fi
"$halfplane" config --config "$config" --sv >"$folder/raster_pkg.sv"
"$halfplane" config --config "$config" --dpi >"$folder/halfplane_dpi.sv"
verilator --binary --timing -Wno-fatal -Wno-lint -Wno-style -MAKEFLAGS "OPT_FAST=-O0 OPT_GLOBAL=-O0" --top-module testbench --Mdir "$folder/obj" \
  ${OWN:+"-I$OWN"} "-I$rtl/lib" "-I$rtl/stages" "$folder/raster_pkg.sv" "$folder/halfplane_dpi.sv" "$rtl/raster_top.sv" "$here/scoreboard.sv" "$here/testbench.sv" \
  -LDFLAGS "$library -Wl,-rpath,$(dirname "$library")" -o testbench >"$folder/verilator.log" 2>&1 ||
  { cat "$folder/verilator.log" >&2; exit 3; }
"$folder/obj/testbench" "+scene=$scene" || exit 1
