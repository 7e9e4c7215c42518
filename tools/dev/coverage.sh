# shellcheck shell=bash
# Part of ./dev: coverage.

# cover CONFIG RUN ARGS...: one co-simulation, whose counts go to build/coverage/data/CONFIG-RUN.
cover() {
  local name=$1-$2
  step "$name: ${*:3}" env HALFPLANE_RTL_COVERAGE="build/coverage/data/$name" \
    build/coverage/halfplane cosim --config "$1" "${@:3}" --quiet
}

coverage() {
  local config size primitives scenes scene
  ensure "${everyday[@]}"
  insist build sim rtl coverage
  step 'configure' configure coverage -DHALFPLANE_BUILD_TESTS=OFF
  step 'build the program' build coverage halfplane_program
  rm -rf build/coverage/data && mkdir -p build/coverage/data
  for config in tiny small embedded; do
    size=96x64 primitives=2000
    [[ $config != tiny ]] || size=16x16 primitives=20000
    cover "$config" random --random $primitives --seed 1
    cover "$config" stalls --random $((primitives / 2)) --seed 2 --stalls 0.3
    cover "$config" memory --random 1000 --seed 3 --stalls 0.1 --memory ddr3
    scenes=(teapot:4 city:40 walk star wires:8 wireframe:4)
    [[ $config != small ]] || scenes=("${scenes[@]:0:3}")  # no unit for lines
    for scene in "${scenes[@]}"; do
      cover "$config" "${scene%:*}" "$scene" --size "$size" --stalls 0.1
    done
  done
  # Upper bits of coordinates and of the primitives' numbers.
  cover embedded city-large city:40 --size 1920x1080 --stalls 0.1
  cover embedded scratches scratches:600 --size 1920x1080
  cover embedded dust dust:40000 --size 128x96
  verilator_coverage --write build/coverage/merged.dat build/coverage/data/*
  tools/coverage.py rtl --exceptions rtl_ref/coverage_exceptions.txt -o build/coverage/table.txt build/coverage/merged.dat
}
