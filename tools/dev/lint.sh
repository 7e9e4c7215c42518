# shellcheck shell=bash
# Part of ./dev: lint and format.

sources() { find capi examples gl model sim tests tools web -name '*.[ch]pp' -o -name '*.inl' | sort; }

# Files that differ from the last commit; all of them where git cannot tell.
changed_sources() {
  if [[ ${1:-} == --all ]] || ! git rev-parse -q --verify HEAD >/dev/null 2>&1; then
    sources
  else
    comm -12 <(sources) <({ git diff --name-only HEAD && git ls-files --others --exclude-standard; } | sort)
  fi
}

# Switches that clang-format 14 does not know, because more than the words themselves stands in the comment.
format_switches() { ! sources | xargs grep -nE '// clang-format (on|off).+'; }

# Each module with the widths of `embedded`, or with a texture unit if it is about one; the whole design with those of every
# design of model/designs.toml.
lint_rtl() {
  local file package status=0
  for file in rtl_ref/stages/*.sv rtl_ref/lib/*.sv; do
    package=rtl_ref/raster_pkg.sv
    case $file in */texture_stage.sv | */state_token.sv) package=build/release/rtl_ref/packages/blended/raster_pkg.sv ;; esac
    verilate_lint "$package" "$file" || status=1
  done
  for package in build/release/rtl_ref/packages/*/raster_pkg.sv; do
    verilate_lint "$package" rtl_ref/raster_top.sv || status=1
    verilate_lint "$package" rtl_ref/cosim/raster_cosim.sv || status=1
  done
  return $status
}

verilate_lint() {
  verilator_bin --lint-only -Wall -Irtl_ref -Irtl_ref/lib -Irtl_ref/stages --top-module "$(basename "$2" .sv)" rtl_ref/lint.vlt \
    "$1" "$2"
}

# The same by slang, which is as strict as the compilers of FPGA vendors, and every file by Verible.
slang_rtl() {
  local package tops status=0
  for package in build/release/rtl_ref/packages/*/raster_pkg.sv; do
    tops=(--top raster_cosim --top halfplane_core)
    [[ $package != */full/* ]] || tops=(--top raster_cosim)  # the core refuses it
    build/python/bin/python tools/slang.py -Irtl_ref "${tops[@]}" "$package" rtl_ref/lib/*.sv \
      rtl_ref/stages/*.sv rtl_ref/raster_top.sv rtl_ref/primitive_stream_checker.sv rtl_ref/cosim/raster_cosim.sv \
      core/*.sv || status=1
  done
  return $status
}

verible_rtl() {
  build/python/bin/verible-verilog-lint --rules_config rtl_ref/verible.rules build/release/rtl_ref/packages/*/*.sv \
    rtl_ref/*.sv rtl_ref/*/*.sv core/*.sv tests/rtl_units/*.sv
}

# Each file of the functional engine's kernels by itself: so a tool can read it, and the order of #include does not matter.
kernels_alone() {
  local folder=model/engines/functional status=0 kernel
  local compile=("${CXX:-g++}" -std=c++20 -I. -Wall -Werror -Wno-psabi -Wno-unused)
  "${compile[@]}" -w -x c++-header "$folder/kernel_headers.hpp" -o build/lint/kernel_headers.hpp.gch || return
  for kernel in "$folder"/kernels/*.inl; do
    "${compile[@]}" -include build/lint/kernel_headers.hpp -fsyntax-only -x c++ - <<<"#include \"$kernel\"" || status=1
  done
  return $status
}

lint() {
  ensure "${everyday[@]}" lint
  insist build sim test rtl lint
  local changed
  local kernels='^model/engines/functional/(kernel_headers\.hpp|kernels/.*)'
  mapfile -t changed < <(changed_sources "$@" | grep -E "^(gl|model|sim|tests)/.*\.cpp\$|$kernels")
  mkdir -p build/lint
  step 'shellcheck' shellcheck --external-sources --check-sourced dev .ci/run tools/mesa/run
  step "clang-format's switches" format_switches
  step 'clang-format' xargs -a <(sources) clang-format --dry-run -Werror
  [[ ! ${changed[*]} =~ model/engines/functional/kernel ]] || step 'kernels, each by itself' kernels_alone
  step 'configure' configure release
  step 'generate the packages' build release halfplane_packages
  step 'verilator --lint-only' lint_rtl
  step 'packages of PyPI' python_packages
  step 'slang' slang_rtl
  step 'verible-verilog-lint' verible_rtl
  ((${#changed[@]} > 0)) || return 0
  # Every file by itself, Verilated headers from the build, no options that only GCC knows.
  step 'configure for clang-tidy' cmake --preset release -B build/lint -DHALFPLANE_UNITY=OFF
  sed -Ei 's/ (--param=[^ ]*|-mmem(cpy|set)-strategy=[^ ]*|-Wno-(restrict|maybe-uninitialized))//g;
           s!build/lint/rtl_ref/V!build/release/rtl_ref/V!g' build/lint/compile_commands.json
  step "clang-tidy: ${#changed[@]} files" xargs -a <(printf '%s\n' "${changed[@]}") -n 1 -P "$(jobs)" \
    clang-tidy --quiet -p build/lint --warnings-as-errors='*'
}

format() {
  ensure lint
  insist lint
  xargs -a <(sources) clang-format -i
}
