# shellcheck shell=bash
# Part of ./dev: configuring and building.

# configure PRESET [ARGS]: Ninja or, without it, make; what is not installed is left out. Every kernel, unless ARGS name some.
configure() {
  local cache=build/$1/CMakeCache.txt generator=Ninja fresh=() rtl=REQUIRED tests=ON
  have ninja || generator='Unix Makefiles'
  [[ -z $(lacking rtl) ]] || rtl=OFF
  [[ -z $(lacking test) ]] || tests=OFF
  # A cache from another generator or of a tree that was moved is of no use.
  if [[ -f $cache ]] && ! { grep -qxF "CMAKE_GENERATOR:INTERNAL=$generator" "$cache" &&
    grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" "$cache"; }; then
    fresh=(--fresh)
  fi
  cmake --preset "$1" -G "$generator" "${fresh[@]}" -DHALFPLANE_RTL=$rtl -DHALFPLANE_BUILD_TESTS=$tests -UHALFPLANE_KERNELS \
    "${@:2}"
}

# build PRESET [TARGET]: everything, or one target.
build() {
  cmake --build --preset "$1" --parallel "$(jobs)" ${2:+--target "$2"}
}

# build/halfplane is the program of the last optimised build.
link_program() { ln -sfn "$1/halfplane" build/halfplane; }

# build_program [ARGS]: ARGS go to CMake.
build_program() {
  insist build sim
  step 'configure' configure release "$@"
  step 'build the program' build release halfplane_program
  link_program release
}

# rtl_label CONFIG [--set K=V...]: that configuration as CMake takes it, "embedded stamp.size=4".
rtl_label() {
  local text
  text=$(build/halfplane config --config "$@" --sv) || return 2  # errexit is off where the caller tests this
  sed -n '1s/.*--config \(.*\) --sv.*/\1/p' <<<"$text" | sed 's/--set //g'
}

# build_release [--config C [--set K=V...]]: the program with the RTL of every design, and with that of C; the C interface, which
# test benches link with (docs/your-rtl.md).
build_release() {
  (($# == 0)) || [[ $1 == --config && $# -ge 2 ]] || { say "./dev build: --config C [--set K=V...], not '$*'"; exit 2; }
  build_program -DHALFPLANE_RTL_CONFIGS= -DHALFPLANE_GL=AUTO
  step 'build the C interface' build release halfplane_c
  (($# > 0)) || return 0
  insist rtl
  local extra
  extra=$(rtl_label "${@:2}") || exit 2
  build_program "-DHALFPLANE_RTL_EXTRA=$extra"
}
