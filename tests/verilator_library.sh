#!/bin/sh
# OBJCACHE of Verilator's makefiles: of Verilator's own library, most of what a small test bench compiles, the same object
# serves all tests that compile it with the same options.
# usage: verilator_library.sh FOLDER [ccache] COMPILER ARGUMENT...    -c and -o, as the makefiles have them. FOLDER is made.
set -eu
folder=$1
shift
object='' source='' options='' before=''
for word; do
  [ "$before" != -o ] || object=$word
  case $word in
    */include/verilated*.cpp) source=$word ;;
    *.o | -o) ;;
    *) options="$options $word" ;;
  esac
  before=$word
done
[ -n "$source" ] || exec "$@"
kept=$folder/$(echo "$options $source $(stat -c '%Y %s' "$source")" | cksum | tr ' ' _).o
if [ ! -e "$kept" ]; then
  "$@"
  mkdir -p "$folder"
  cp "$object" "$kept.$$" && mv "$kept.$$" "$kept" # two tests may compile it at once
fi
cp "$kept" "$object"
