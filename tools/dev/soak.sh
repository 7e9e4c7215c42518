# shellcheck shell=bash
# Part of ./dev: soak and soak-cosim.

# fuzz FILE RUNS: what is found is kept in out/fuzz; a hang is 10 s, memory is bounded.
fuzz() {
  local name corpus
  name=$(basename "$1" .cpp)
  corpus=out/fuzz/$name
  mkdir -p "$corpus"
  local seeds=() dictionary=()
  [[ ! -d tests/fuzz/corpus/${name#fuzz_} ]] || seeds=("tests/fuzz/corpus/${name#fuzz_}")
  [[ ! -e tests/fuzz/${name#fuzz_}.dict ]] || dictionary=("-dict=tests/fuzz/${name#fuzz_}.dict")
  "build/fuzz/tests/fuzz/$name" -runs="$2" -len_control=0 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$corpus-" "${dictionary[@]}" "$corpus" "${seeds[@]}"
}

soak() {
  local seconds=${1:-600} file
  [[ $seconds =~ ^[1-9][0-9]*$ ]] || { say "./dev soak: SECONDS is a whole number, not '$seconds'"; exit 2; }
  ensure "${everyday[@]}" soak
  insist build sim test rtl
  step 'configure' configure release
  step 'build program and tests' build release halfplane_unit_tests
  step 'build the tests of the RTL' build release halfplane_cosim_tests
  link_program release
  step "the stress list for $seconds s" build/halfplane stress --seconds "$seconds" --threads "$(jobs)" \
    --seed "$(date +%s)" --json=build/stress.json
  step "stress tests for $seconds s" env HALFPLANE_SOAK="$seconds" \
    build/release/tests/halfplane_unit_tests --gtest_filter='Stress*' --gtest_brief=1
  step 'lint of random configurations' env HALFPLANE_SOAK="$seconds" \
    build/release/tests/halfplane_cosim_tests --gtest_filter='Stress*' --gtest_brief=1
  [[ -z $(lacking soak) ]] || { say "Fuzzers left out: clang is not installed"; return; }
  step 'configure the fuzzers' configure fuzz
  for file in tests/fuzz/fuzz_*.cpp; do
    [[ -e $file ]] || continue
    step "build $file" build fuzz "$(basename "$file" .cpp)"
    step 'run it on 100,000 inputs' fuzz "$file" 100000
  done
}

# soak_run CONFIG COUNT SEED STALLS: one line when all is equal, else the whole report. 255 when it is interrupted: xargs
# then begins no other.
soak_run() {
  local settings text status=0 began=$SECONDS
  read -ra settings <<<"--config ${1// / --set }"
  text=$(build/soak/halfplane cosim "${settings[@]}" --random "$2" --seed "$3" --stalls "$4" 2>&1) || status=$?
  if ((status == 0)); then
    printf '%s, seed %s, stalls %s: %s primitives equal, %s, %s s\n' "$1" "$3" "$4" "$2" \
      "$(sed -n 's/^cycles *\([0-9,]*\) in all.*/\1 cycles/p' <<<"$text")" $((SECONDS - began))
  elif ((status == 130)) && [[ $text != *MISMATCH* ]]; then
    printf '%s, seed %s, stalls %s: interrupted after %s s, equal so far\n' "$1" "$3" "$4" $((SECONDS - began))
    return 255
  else
    printf '%s, seed %s, stalls %s: FAILED\n%s\n' "$1" "$3" "$4" "$text"
    return 1
  fi
}

# In pieces of 100,000 primitives, each with its own seed, half of them with stalls. `full`, whose stamp of 4x4 is wide,
# gets a twentieth.
soak_cosim() {
  local primitives=${1:-1150000} config i words labels=() left piece seed status=0
  local sizes=('embedded stamp.size=1' 'embedded stamp.size=4' 'full stamp.size=2' 'embedded texture.unit=bilinear'
    'embedded texture.unit=nearest' 'embedded texture.unit=bilinear texture.lanes=4 perspective.colors=1'
    'embedded hiz.bits=8 texture.unit=nearest setup.plane_clocks=2'
    'embedded texture.unit=trilinear texture.lanes=4'
    'embedded msaa.samples=2' 'embedded msaa.samples=8' 'embedded msaa.samples=4 compress.unit=1')
  # Each of the sizes that the RTL takes at a second value, for the cycles as well as for the bits.
  local corners=('embedded tile.size=16 stamp.size=4 cache.lines=4 context.slots=2 hiz.bits=6 depth.bits=24'
    'embedded tile.size=4 stamp.size=1 cache.lines=64 context.slots=8 hiz.bits=0'
    'small lines.unit=1 tile.size=16 context.slots=4 hiz.bits=5'
    'embedded stamp.size=4 memory.port_bits=32 texture.unit=nearest texture.cache_kb=1 texture.queue=8 texture.constant=1 texture.border=1'
    'full msaa.samples=2' 'full msaa.samples=4' 'full stamp.size=2 msaa.samples=8'
    'full msaa.samples=8 stamp.size=2 compress.unit=1 blend.lanes=1 logic.unit=1 memory.port_bits=512'
    'embedded stamp.size=1 msaa.samples=4 compress.unit=1 memory.port_bits=32'
    'embedded texture.unit=bilinear texture.lanes=4 alpha.unit=1 blend.lanes=4 logic.unit=1 dither.unit=1 fog.unit=1 shade.unit=1 stencil.bits=8 msaa.samples=4'
    'embedded texture.unit=trilinear texture.constant=1 texture.border=1 alpha.unit=1 blend.lanes=4 fog.unit=1 shade.unit=1'
    'embedded setup.plane_clocks=2' 'full setup.plane_clocks=2' 'tiny setup.plane_clocks=2'
    'embedded texture.unit=trilinear perspective.colors=1 setup.plane_clocks=2'
    'embedded texture.unit=trilinear texture.lanes=4 texture.ways=2 texture.cache_kb=1 memory.port_bits=32 perspective.colors=1 fog.unit=1 alpha.unit=1 blend.lanes=4 stencil.bits=8 msaa.samples=4'
    'full texture.unit=trilinear texture.lanes=4 texture.cache_kb=1 memory.port_bits=128 perspective.colors=1 texture.constant=1 texture.border=1'
    'full texture.unit=trilinear' 'full texture.unit=nearest texture.lanes=4 texture.cache_kb=1 texture.ways=2 texture.queue=8')
  [[ $primitives =~ ^[1-9][0-9]*$ ]] || { say "./dev soak-cosim: N is a whole number, not '$primitives'"; exit 2; }
  ensure "${everyday[@]}"
  insist build sim rtl
  build_program
  for config in "${sizes[@]}" "${corners[@]}"; do
    read -ra words <<<"${config// / --set }"
    labels+=("$(rtl_label "${words[@]}")") || exit 2
  done
  step "configure ${#labels[@]} more configurations" configure release -B build/soak \
    -DHALFPLANE_RTL_CONFIGS= "-DHALFPLANE_RTL_EXTRA=$(IFS=';' && echo "${labels[*]}")"
  step 'build them' cmake --build build/soak --parallel "$(jobs)" --target halfplane_program
  say "== $primitives random primitives per configuration; a twentieth of it for full with its stamp of 4, and for corners"
  local whole=(small tiny embedded 'embedded perspective.colors=1 texture.unit=trilinear texture.ways=2' "${sizes[@]}") all
  all=("${whole[@]}" full "${corners[@]}")
  for i in "${!all[@]}"; do
    config=${all[i]} left=$primitives
    ((i < ${#whole[@]})) || left=$(((primitives + 19) / 20))
    for ((seed = 1; left > 0; ++seed, left -= piece)); do
      piece=$((left < 100000 ? left : 100000))
      ((seed > 1 || piece == 1)) || piece=$(((piece + 1) / 2))  # so that there are two at least
      printf '%s\0%s\0%s\0%s\0' "$config" "$piece" "$seed" "0.$((seed % 2 == 0 ? 3 : 0))"
    done
  done | xargs -0 -n 4 -P "$(jobs)" ./dev soak-run || status=$?
  ((status != 124 && status != 130)) || { say 'interrupted'; exit 130; }
  ((status == 0)) || exit 1
}
