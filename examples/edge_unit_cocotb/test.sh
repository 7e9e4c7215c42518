#!/bin/sh
# In Icarus too the edge unit is equal, and with its bug it is caught. usage: test.sh LIBRARY FOLDER
set -u
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$2"
"$here/run.sh" "$1" "$2/good" || { echo "the edge unit is not equal" >&2; exit 1; }
text=$("$here/run.sh" "$1" "$2/bug" bug)
status=$?
echo "$text"
[ "$status" -eq 1 ] || { echo "the bug is not caught: status $status" >&2; exit 1; }
case $text in *"edge_unit says False, the model True"*) exit 0 ;; *) echo "the bug is not named" >&2; exit 1 ;; esac
