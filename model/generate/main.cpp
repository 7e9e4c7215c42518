// Writes the files that the RTL is built from and that follow from a configuration: built from few sources, so that a
// build that verilates has them early.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include "../config.hpp"
#include "c_header.hpp"
#include "dpi_package.hpp"
#include "raster_pkg.hpp"
#include "raster_taps.hpp"

namespace halfplane {
namespace {

constexpr const char* kUsage = "give package LABEL FILE, c LABEL FILE, dpi LABEL FILE, or taps FILE";

std::string generated(std::span<const char* const> words) {
  const std::string what = words.empty() ? "" : words[0];
  if (what == "package" && words.size() == 3) return raster_pkg(labelled(words[1]));
  if (what == "c" && words.size() == 3) return c_header(labelled(words[1]));
  if (what == "dpi" && words.size() == 3) return vectors::dpi_package(labelled(words[1]));
  if (what == "taps" && words.size() == 2) return raster_taps();
  throw InputError(kUsage);
}

/// Does not touch a file with the same text: files made from it need not be made again.
void write(const char* path, const std::string& text) {
  std::ifstream before(path, std::ios::binary);
  if (before && std::string(std::istreambuf_iterator<char>(before), {}) == text) return;
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  if (!(file << text).flush()) throw InputError("cannot write '" + std::string(path) + "': " + std::strerror(errno));
}

}  // namespace
}  // namespace halfplane

int main(int argc, char** argv) {
  const std::span words(argv + 1, static_cast<std::size_t>(argc - 1));
  try {
    const std::string text = halfplane::generated(words);
    halfplane::write(words.back(), text);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "halfplane_generate: %s\n", error.what());
    return 2;
  }
}
