#!/bin/sh
# The triangle is Halfplane's, and a picture with one other byte is not. usage: test.sh run.sh|run_icarus.sh HALFPLANE FOLDER [CONFIG]
set -eu
here=$(cd "$(dirname "$0")" && pwd)
run=$1 halfplane=$2 folder=$3 config=${4:-embedded}
rm -rf "$folder"
"$here/$run" "$halfplane" "$folder" "$config"
printf '\377' | dd of="$folder/picture.ppm" bs=1 seek=4000 conv=notrunc 2>/dev/null
"$here/ppm_to_png.py" "$folder/picture.ppm" "$folder/picture.png"
text=$("$halfplane" compare "$here/triangle.hpt" --config "$config" --against "$folder/picture.png") && exit 1
case $text in *"1 of 3,072 pixels differ"*) exit 0 ;; *) echo "$text" && exit 1 ;; esac
