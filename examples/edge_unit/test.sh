#!/bin/sh
# The edge unit is judged equal, and with its bug it is caught. usage: test.sh HALFPLANE FOLDER
set -u
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$2"
"$here/run.sh" "$1" "$2" || { echo "the edge unit is not judged equal" >&2; exit 1; }
text=$("$here/run.sh" "$1" "$2" bug)
status=$?
echo "$text"
[ "$status" -eq 1 ] || { echo "the bug is not caught: status $status" >&2; exit 1; }
case $text in *"DIFFERENT"*"stamp"*) exit 0 ;; *) echo "the bug is not named" >&2; exit 1 ;; esac
