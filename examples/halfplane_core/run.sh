#!/bin/sh
# halfplane_core in the test bench draws the words of driver/example/triangle.c; its video is compared with Halfplane's picture.
# usage: run.sh HALFPLANE FOLDER [CONFIG]            Verilator
#        run.sh HALFPLANE FOLDER CONFIG icarus       Icarus Verilog, on halfplane_core as plain Verilog
# FOLDER is made; CONFIG: embedded. The status is that of `halfplane compare`.
set -eu
halfplane=$1 folder=$2 config=${3:-embedded} simulator=${4:-verilator}
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../..
mkdir -p "$folder"
"$halfplane" config --config "$config" --sv >"$folder/raster_pkg.sv"

# The words, from the driver of this configuration.
"$halfplane" config --config "$config" --c-header >"$folder/own_config.h"
cc -std=c99 -O1 "-DHALFPLANE_CONFIG_FILE=\"$folder/own_config.h\"" -I . "-I$root/driver" "$root"/driver/*.c \
  "$root/driver/example/triangle.c" -o "$folder/triangle"
"$folder/triangle" | od -An -v -tx4 -w4 >"$folder/words.hex"

case $simulator in
  verilator)
    if command -v ccache >/dev/null; then export OBJCACHE="${OBJCACHE:-ccache}"; fi
    core=$(ls "$root"/core/*.sv | grep -v -e _pkg -e _checker)
    verilator --binary --timing -Wno-fatal -Wno-lint -Wno-style -MAKEFLAGS "VM_PARALLEL_BUILDS=0 OPT_FAST=-O1 OPT_GLOBAL=-O0" --top-module testbench \
      --Mdir "$folder/obj" "-I$root/rtl_ref/lib" "-I$root/rtl_ref/stages" "$folder/raster_pkg.sv" "$root/core/core_pkg.sv" $core \
      "$root/rtl_ref/raster_top.sv" "$here/testbench.sv" -o testbench >"$folder/verilator.log" 2>&1 || { cat "$folder/verilator.log" >&2; exit 3; }
    "$folder/obj/testbench" "+words=$folder/words.hex" "+picture=$folder/picture.ppm" ;;
  icarus)
    TOP=halfplane_core "$root/tools/plain_verilog.sh" "$halfplane" "$folder/halfplane_core.v" "$config"
    iverilog -g2012 -s testbench -o "$folder/testbench" "$folder/raster_pkg.sv" "$folder/halfplane_core.v" "$here/testbench.sv"
    vvp -n "$folder/testbench" "+words=$folder/words.hex" "+picture=$folder/picture.ppm" ;;
esac
"$root/examples/raster_top/ppm_to_png.py" "$folder/picture.ppm" "$folder/picture.png"
exec "$halfplane" compare "$here/triangle.hpt" --config "$config" --against "$folder/picture.png"
