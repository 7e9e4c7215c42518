#!/bin/sh
# Verilates raster_top in the test bench, draws triangle.hpt, and compares the picture with Halfplane's.
# usage: run.sh HALFPLANE FOLDER [CONFIG]    FOLDER is made; CONFIG: embedded. The status is that of `halfplane compare`.
set -eu
halfplane=$1 folder=$2 config=${3:-embedded}
here=$(cd "$(dirname "$0")" && pwd)
rtl=$here/../../rtl_ref
mkdir -p "$folder"
if command -v ccache >/dev/null; then export OBJCACHE="${OBJCACHE:-ccache}"; fi
"$halfplane" config --config "$config" --sv >"$folder/raster_pkg.sv"
verilator --binary --timing -Wno-fatal -Wno-lint -Wno-style -MAKEFLAGS "VM_PARALLEL_BUILDS=0 OPT_FAST=-O0 OPT_GLOBAL=-O0" --top-module testbench --Mdir "$folder/obj" "-I$rtl/lib" "-I$rtl/stages" \
  "$folder/raster_pkg.sv" "$rtl/raster_top.sv" "$here/testbench.sv" -o testbench >"$folder/verilator.log" 2>&1 ||
  { cat "$folder/verilator.log" >&2; exit 3; }
"$folder/obj/testbench" "+picture=$folder/picture.ppm"
"$here/ppm_to_png.py" "$folder/picture.ppm" "$folder/picture.png"
exec "$halfplane" compare "$here/triangle.hpt" --config "$config" --against "$folder/picture.png"
