#!/bin/sh
# One file of plain Verilog for one configuration of raster_top: no packages, no structs, for tools that read no SystemVerilog
# (Icarus, older FPGA tools). Made by Yosys; a port that was a struct is a vector, its first field highest, widths and fields as
# `halfplane config --sv` prints them. usage: plain_verilog.sh HALFPLANE FILE CONFIG [--set KEY=VALUE]...
set -eu
halfplane=$1 file=$2
shift 2
rtl=$(cd "$(dirname "$0")/../rtl_ref" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$halfplane" config --config "$@" --sv >"$work/raster_pkg.sv"
yosys -q -p "read_verilog -sv $work/raster_pkg.sv $rtl/lib/*.sv $rtl/stages/*.sv $rtl/raster_top.sv
  hierarchy -check -top raster_top; proc; opt_clean; write_verilog -noattr $work/raster_top.v" >"$work/log" 2>&1 ||
  { cat "$work/log" >&2; exit 3; }
{
  echo "// raster_top of Halfplane, $("$halfplane" --version | cut -d, -f1)), as plain Verilog; do not edit."
  echo "// tools/plain_verilog.sh build/halfplane raster_top.v $*"
  sed -n '/^  localparam logic \[63:0\] CONFIG_ID/s/.*= \(.*\);.*/\/\/ CONFIG_ID \1/p' "$work/raster_pkg.sv"
  cat "$work/raster_top.v"
} >"$file"
