# shellcheck shell=bash
# Part of ./dev: docs.

docs() {
  ensure docs
  insist docs
  mkdir -p build/docs
  step 'doxygen' doxygen docs/Doxyfile
  say 'build/docs/html/index.html'
}
