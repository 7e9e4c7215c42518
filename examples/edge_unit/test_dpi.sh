#!/bin/sh
# Through DPI-C too the edge unit is equal, and with its bug it is caught. usage: test_dpi.sh HALFPLANE LIBRARY FOLDER
set -u
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$3"
"$here/run_dpi.sh" "$1" "$2" "$3" || { echo "the edge unit is not equal" >&2; exit 1; }
text=$("$here/run_dpi.sh" "$1" "$2" "$3" bug 2>&1)
status=$?
echo "$text"
[ "$status" -eq 1 ] || { echo "the bug is not caught: status $status" >&2; exit 1; }
case $text in *"edge_unit says 0, the model 1"*) ;; *) echo "the bug is not named" >&2; exit 1 ;; esac
text=$("$here/run_dpi.sh" "$1" "$2" "$3" mixed 2>&1) && { echo "a package of other hardware is not refused" >&2; exit 1; }
case $text in *"raster_pkg is of another configuration"*) ;; *) echo "$text" >&2; exit 1 ;; esac
