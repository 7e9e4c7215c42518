#!/usr/bin/env bash
# The rasterizer draws what Halfplane draws; with each of its bugs, the bug is caught and called by its name.
#   test.sh HALFPLANE FOLDER
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
halfplane=$1 folder=$2
mkdir -p "$folder"

python3 "$here/rasterizer.py" "$here/scene.hpt" "$folder/right.png"
"$halfplane" compare "$here/scene.hpt" --against "$folder/right.png" --quiet --json="$folder/right.json" ||
  { echo 'test.sh: the picture without a bug is not equal' >&2; exit 1; }

for bug in edge_rule snap depth_func color; do
  python3 "$here/rasterizer.py" "$here/scene.hpt" "$folder/$bug.png" --bug "$bug"
  status=0
  "$halfplane" compare "$here/scene.hpt" --against "$folder/$bug.png" --quiet --json="$folder/$bug.json" || status=$?
  [[ $status == 1 ]] || { echo "test.sh: the bug '$bug' is not caught" >&2; exit 1; }
done

python3 - "$folder" <<'END'
import json, sys
def against(name):
    with open(f'{sys.argv[1]}/{name}.json', encoding='utf-8') as file:
        return json.load(file)['against']
assert against('right')['different'] == 0
for bug in ('edge_rule', 'snap', 'depth_func', 'color'):
    found = against(bug)
    named = found['kinds'][bug]['pixels']
    print(f"{bug}: {found['different']} pixels differ, {named} of them put down to it", {k: v for k, v in found['kinds'].items() if v['pixels']})
    assert found['different'] >= 10 and named >= 0.9 * found['different'], f'{bug} is not called by its name'
END
