// Committed files made from a table of the model, for readers who do not build.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "halfplane_paths.hpp"

namespace halfplane::test {

/// Compares a file of the repository with `made`, which makes the expected text from its text. With HALFPLANE_UPDATE in
/// the environment the file is rewritten instead.
inline void expect_committed(const std::string& path, const std::function<std::string(const std::string&)>& made) {
  const std::string file = std::string(HALFPLANE_SOURCE_DIR) + "/" + path;
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}}, expected = made(text);
  if (text == expected) return;
  if (std::getenv("HALFPLANE_UPDATE") != nullptr) {
    std::ofstream(file, std::ios::binary) << expected;
    return;
  }
  const auto differs = std::ranges::mismatch(text, expected).in1;
  ADD_FAILURE() << path << ":" << std::count(text.begin(), differs, '\n') + 1
                << " is not what its table yields; HALFPLANE_UPDATE=1 ./dev test -R Committed rewrites it";
}

}  // namespace halfplane::test
