#!/bin/sh
# refused_test.sh GENERATE CC FOLDER: the compiler refuses a driver for what driver/internal.h names, and says why.
set -eu
generate=$1 compiler=$2 folder=$3
driver=$(dirname "$0")/../../driver
refused() { # configuration, part of the message
  "$generate" c "$1" "$folder/refused.h"
  if "$compiler" -std=c99 -fsyntax-only -DHALFPLANE_CONFIG_FILE="\"$folder/refused.h\"" -I "$driver" \
    "$driver/line.c" 2> "$folder/refused.txt"; then
    echo "a driver for '$1' is compiled" >&2
    exit 1
  fi
  grep "#error.*$2" "$folder/refused.txt"
}
refused full "16 bits for a coordinate"
refused resolved "wants a frame sorted by bins"
refused "embedded depth.bits=32" "one over a line's length"
refused "embedded subpixel.bits=2 guard.band=8192" "positions along a line"
