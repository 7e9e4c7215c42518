#!/bin/sh
# A broken rule of the stream ends a simulation with its message; a right stream ends it well. usage: test.sh RTL_REF FOLDER
set -u
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$2"
verilator --binary --timing --assert -Wno-fatal -Wno-lint --top-module testbench --Mdir "$2/obj" \
  -MAKEFLAGS "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0" "$1/raster_pkg.sv" "$1/primitive_stream_checker.sv" \
  "$here/testbench.sv" -o testbench >"$2/verilator.log" 2>&1 || { cat "$2/verilator.log" >&2; exit 3; }

# expect STATUS TEXT +ARGS...: the simulation says TEXT, and stops (1) or does not (0).
expect() {
  stops=$1 said=$2
  shift 2
  text=$("$simulation" "$@" 2>&1) && stopped=0 || stopped=1
  case $text in *"$said"*) ;; *) echo "$*: '$said' is not said: $text" >&2; exit 1 ;; esac
  [ "$stopped" -eq "$stops" ] || { echo "$*: stopped $stopped, wanted $stops" >&2; exit 1; }
}
simulation=$2/obj/testbench
expect 1 "primitive 0 is drawn before the first clear; send a fast clear" +flush
expect 1 "the stream ends with 2 primitives after the last flush" +clear
expect 1 "written 0" +clear
expect 0 "written 1" +clear +flush
