#!/bin/sh
# example_test.sh TRIANGLE DRAW_WORDS FOLDER: the picture of the example has its background and a triangle of a quarter of it.
set -eu
"$1" >"$3/triangle.words"
"$2" embedded "$3/triangle.words" "$3/triangle.ppm"
# 320x240 pixels of 3 bytes after a header of 15; the background is 33, 32, 49 in rgb565.
tail -c +16 "$3/triangle.ppm" | od -An -v -tu1 -w3 | awk '
  { if ($1 == 33 && $2 == 32 && $3 == 49) background++; else drawn++ }
  END { print background, "pixels of background,", drawn, "of the triangle"; exit !(background + drawn == 76800 && drawn > 9000 && drawn < 10200) }'
