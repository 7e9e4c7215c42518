#!/bin/sh
# FuseSoC lints halfplane.core, and simulates examples/raster_top on a configuration that its generator makes: the picture is
# Halfplane's. usage: fusesoc.sh HALFPLANE FOLDER    with build/python
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
HALFPLANE=$1 folder=$2
rm -rf "$folder"
mkdir -p "$folder" && touch "$folder/FUSESOC_IGNORE"  # FuseSoC looks for cores in all of the tree
cd "$folder"
export HALFPLANE PATH="$root/build/python/bin:$PATH"
if command -v ccache >/dev/null; then export OBJCACHE="${OBJCACHE:-ccache}"; fi
cat >fusesoc.conf <<END
[library.halfplane]
location = $root
sync-uri = $root
sync-type = local
auto-sync = false
END
run() { fusesoc --config fusesoc.conf run "$@" >log 2>&1 || { cat log >&2; exit 1; } }
run --target lint halfplane:graphics:raster
run --target lint halfplane:graphics:core
run --target sim halfplane:examples:raster_top --picture "$folder/picture.ppm"
grep -q 'CACHE_LINES = 8;' build/*/*/src/*raster_top-package*/raster_pkg.sv
"$root/examples/raster_top/ppm_to_png.py" picture.ppm picture.png
"$HALFPLANE" compare "$root/examples/raster_top/triangle.hpt" --config small --set cache.lines=8 --against picture.png >compare.log || {
  cat compare.log
  exit 1
}
grep '^against' compare.log
