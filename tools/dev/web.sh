# shellcheck shell=bash disable=SC2154
# Part of ./dev: web.

# web [--test]: the page with the program as WebAssembly, in build/web/site, and its archive. --test: against the native program.
web() {
  [[ $* == '' || $* == --test ]] || { say "./dev web: --test, not '$*'"; exit 2; }
  ensure web
  insist web
  export NODE_PATH=/usr/share/nodejs # Debian's packages for Node.js, where that is not Debian's
  step 'configure' emcmake cmake -S web -B build/web/build -G Ninja
  step 'build the module' cmake --build build/web/build --parallel "$(jobs)" --target halfplane_site
  step 'packages of npm' web_packages
  step 'the page' web_site
  du -sh build/web/site >&2
  [[ ${1:-} == --test ]] || return 0
  ensure "${everyday[@]}" browser
  insist build sim browser
  build_program
  step 'the module against the program' node --test tests/web/engine_test.mjs
  step 'the page in Chromium' node tests/web/views_test.mjs build/web/site build/halfplane
}

# The chart library of the page and the driver of the browser for its tests, at the versions of web/package-lock.json.
web_packages() {
  ! cmp -s web/package-lock.json build/web/package-lock.json || return 0
  cp web/package.json build/web
  (cd build/web && cp ../../web/package-lock.json new-lock.json && mv new-lock.json package-lock.json && npm ci --ignore-scripts) ||
    { rm -f build/web/package-lock.json; return 3; }
}

# At most 5 MB, so that it loads at once.
web_site() {
  cp -r web/site/. build/web/site
  mkdir -p build/web/site/vendor
  cp build/web/node_modules/uplot/dist/uPlot.{esm.js,min.css} build/web/site/vendor
  local bytes
  bytes=$(du -sb build/web/site | cut -f1)
  ((bytes <= 5000000)) || { say "build/web/site has $bytes bytes, more than 5 MB"; return 1; }
  tar -C build/web -czf build/web/halfplane-web.tar.gz site
}
