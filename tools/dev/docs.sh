# shellcheck shell=bash
# Part of ./dev: docs.

docs() {
  ensure docs
  insist docs
  mkdir -p build/docs
  step 'doxygen' doxygen docs/Doxyfile
  step 'mkdocs' tools/docs_site.py
  say 'build/docs/site/index.html; with its search: python3 -m http.server --directory build/docs/site'
}
