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
headers=$(stat -c '%n %Y %s' "$(dirname "$source")"/verilated*)
compiler=$1
[ "$1" != ccache ] || compiler=$2
kept=$folder/$(echo "$options $source $headers $("$compiler" --version)" | cksum | tr ' ' _).o
if [ ! -e "$kept" ]; then
  "$@"
  mkdir -p "$folder"
  cp "$object" "$kept.$$" # two tests may compile it at once
  mv "$kept.$$" "$kept"
else
  cp "$kept" "$object"
fi
