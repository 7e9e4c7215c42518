#!/bin/sh
# The same test bench in Icarus Verilog, on raster_top as plain Verilog. usage: run_icarus.sh HALFPLANE FOLDER [CONFIG]
set -eu
halfplane=$1 folder=$2 config=${3:-embedded}
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$folder"
"$here/../../tools/plain_verilog.sh" "$halfplane" "$folder/raster_top.v" "$config"
"$halfplane" config --config "$config" --sv >"$folder/raster_pkg.sv"  # of the test bench
iverilog -g2012 -s testbench -o "$folder/testbench" "$folder/raster_pkg.sv" "$folder/raster_top.v" "$here/testbench.sv"
vvp -n "$folder/testbench" "+picture=$folder/picture.ppm"
"$here/ppm_to_png.py" "$folder/picture.ppm" "$folder/picture.png"
exec "$halfplane" compare "$here/triangle.hpt" --config "$config" --against "$folder/picture.png"
