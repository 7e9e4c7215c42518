# shellcheck shell=bash
# Part of ./dev: demo.

# With a compiler and CMake only: the library alone, installed and used by a program that shows its own picture.
demo_library() {
  insist build
  local generator=Ninja
  have ninja || generator='Unix Makefiles'
  step 'build and install the library alone' cmake "-DSOURCE=$PWD" "-DWORK=$PWD/build/library" \
    "-DGENERATOR=$generator" -DCOMPILER=c++ -P tests/consumer/run.cmake
  build/library/consumer/consumer picture
  say "Program and RTL left out: not installed: $(lacking sim rtl test)"
}

demo_rtl() {
  local status=0
  say "== the same teapot in RTL: every packet between its stages against the model's"
  build/halfplane cosim teapot --size 320x240 --json=out/teapot-cosim.json
  say "== the RTL with one fault in it: caught, reduced to the fewest triangles, shown bit by bit"
  build/halfplane cosim teapot --size 320x240 --mutant 8 --save out/teapot-mutant.hpt || status=$?
  ((status == 1)) || { say "   the fault was not caught"; exit 1; }
}

# The kernels of the functional engine that this machine runs, for CMake.
best_kernels() {
  if grep -qsw avx512bw /proc/cpuinfo; then
    echo avx512
  elif grep -qsw avx2 /proc/cpuinfo; then
    echo avx2
  else
    echo 'portable;avx2;avx512'
  fi
}

# What a person sees stays on the screen, in a pipe too. One Verilated configuration is enough, one set of kernels, and no
# OpenGL driver, unless a build that has more is there.
demo() {
  ensure "${everyday[@]}"
  if [[ -n $(lacking sim) ]]; then
    demo_library
    return
  fi
  local less=(-DHALFPLANE_RTL_CONFIGS=embedded -DHALFPLANE_GL=OFF "-DHALFPLANE_KERNELS=$(best_kernels)")
  local cache=build/release/CMakeCache.txt
  [[ ! -f $cache ]] || grep -qx 'HALFPLANE_RTL_CONFIGS:STRING=embedded' $cache || less=()
  build_program "${less[@]}"
  mkdir -p out
  say "== the teapot in three ways: fixed-point model, exact oracle, float golden"
  build/halfplane compare teapot -o out/teapot.png --model out/teapot-model.png --golden-picture out/teapot-golden.png \
    --json=out/teapot.json
  if [[ -n $(lacking rtl) ]]; then
    say "RTL left out: not installed: $(lacking rtl)"
  else
    demo_rtl
  fi
  cat <<'END'

Look at   out/teapot.png   model, golden, and the error between them
          out/teapot.json  every figure
          out/teapot-mutant.hpt, .fst  the fault's capture and waveform (./dev mutants: all of them)
Try next  build/halfplane compare walk --config tiny --set guard.band=64 --set target.width=64 --set target.height=48 --size 64x48 -o out/walk.png
          build/halfplane render city --size 1280x720 -o out/city.png --repeat 20
          build/halfplane cosim --random 20000 --stalls 0.3 --seed 7
END
}
