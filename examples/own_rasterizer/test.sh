#!/bin/sh
# Random scenes are equal; a seeded fault is found in them and reduced to one triangle, which draws right without the fault.
# The fault: a level edge of a triangle that turns the other way owns the wrong ties.
# usage: test.sh HALFPLANE LIBRARY FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
halfplane=$1 library=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder"
sed 's/right > 0 : down < 0) != turns/(right > 0) != ($test$plusargs("fault") != 0 \&\& turns) : down < 0) != turns/' "$here/rasterizer.sv" >"$folder/seeded.sv"
grep -q plusargs "$folder/seeded.sv"
"$halfplane" convert --random 200 --random-only triangles,16x16,always,depth_write=off,color_write=on,shade=flat,no-cull,no-scissor,no-clears,ties=40 \
  --config tiny --quiet -o "$folder/scene.hpt"
RTL=$folder/seeded.sv "$here/run.sh" "$halfplane" "$library" "$folder" "$folder/scene-1.hpt"
for scene in "$folder"/scene-[2-9].hpt; do "$folder/obj/testbench" "+scene=$scene"; done
fails=
for scene in "$folder"/scene-[1-9].hpt; do "$folder/obj/testbench" "+scene=$scene" +fault >/dev/null 2>&1 || fails=$scene; done
[ -n "$fails" ] || { echo "the fault is not caught"; exit 1; }
"$halfplane" reduce "$fails" --config tiny --keep target,shade,depth_test,depth_write --command "$folder/obj/testbench +scene={} +fault" -o "$folder/small.hpt"
cat "$folder/small.hpt"
[ "$(grep -c '^t' "$folder/small.hpt")" = 2 ] || { echo "more than target and one triangle"; exit 1; }
"$folder/obj/testbench" "+scene=$folder/small.hpt" | grep "^1 triangles: equal"
