#!/bin/sh
# Random scenes are equal, and a fault of the RTL is caught: samples on an edge count as outside in a tile's first column.
# usage: test.sh HALFPLANE LIBRARY FOLDER [CONFIG]
set -eu
here=$(cd "$(dirname "$0")" && pwd)
halfplane=$1 library=$2 folder=$3 config=${4:-tiny}
rm -rf "$folder"
mkdir -p "$folder/own"
sed 's/value_i\[WIDTH-1\]/(value_i[WIDTH-1] || (value_i == '"'0"' \&\& $test$plusargs("fault") != 0))/' "$here/../../rtl_ref/lib/edge_columns.sv" >"$folder/own/edge_columns.sv"
grep -q plusargs "$folder/own/edge_columns.sv"
# A file of up to 50 primitives each.
"$halfplane" convert --random 200 --config "$config" --quiet -o "$folder/scene.hpt"
OWN=$folder/own "$here/run.sh" "$halfplane" "$library" "$folder" "$folder/scene-1.hpt" "$config"
for scene in "$folder"/scene-[2-9].hpt; do "$folder/obj/testbench" "+scene=$scene"; done
text=$("$folder/obj/testbench" "+scene=$folder/scene-1.hpt" +fault 2>&1) && { echo "the fault is not caught"; exit 1; }
case $text in *"the model: address"* | *"the model has none"*) ;; *) echo "$text"; exit 1 ;; esac
echo "$text" | grep "the model"
