// Judges: small scenes with results that follow from the OpenGL ES specifications alone, for any engine.
//
// Written from the text of OpenGL ES 2.0.25 (3.3 points, 3.4.1 lines, 3.5.1 polygons, 3.7 textures, 4.1 fragment
// operations), of ES 1.1.12 (4.1.4 alpha test) and of ES 3.0 (4.1.7, min and max), as tables; nothing is shared with the
// model or the golden. A case has a capture, a verdict on its picture, and a capture with a deliberate fault that the
// verdict must reject. Where the specification leaves a choice and this project promises one, the verdict takes that one:
// docs/testing.md lists these.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "model/config.hpp"
#include "model/engines/render.hpp"

namespace halfplane::judges {

struct Case {
  std::string name;
  std::string capture;
  /// Empty: as specified. Otherwise the first pixel that is not, with both values.
  std::function<std::string(const Framebuffer&, const Config&)> verdict;
  std::string wrong;  ///< a capture whose picture the verdict rejects; empty: the fault changes nothing here
};

/// Channels of a stored colour as codes of its format, and the largest code of each.
struct Channels {
  std::array<int, 4> code, top;
};
inline Channels channels(std::uint32_t color, const Config& config) {
  const auto part = [color](int low, int bits) { return static_cast<int>(color >> low & ((1U << bits) - 1)); };
  if (config.color_format == ColorFormat::rgba8888)
    return {{part(0, 8), part(8, 8), part(16, 8), part(24, 8)}, {255, 255, 255, 255}};
  return {{part(11, 5), part(5, 6), part(0, 5), 1}, {31, 63, 31, 1}};
}

/// Whether a stored colour is within `codes` codes of `wanted`, channels from 0 to 1.
inline bool is_near(std::uint32_t color, const std::array<double, 4>& wanted, double codes, const Config& config) {
  const Channels stored = channels(color, config);
  for (std::size_t c = 0; c < 4; ++c) {
    const double off = stored.code[c] - wanted[c] * stored.top[c];
    if (off > codes || off < -codes) return false;
  }
  return true;
}

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

inline std::string at(int x, int y, const std::string& what) { return text("pixel %d %d: ", x, y) + what; }

inline std::string color_text(std::uint32_t color, const std::array<double, 4>& wanted, const Config& config) {
  const Channels stored = channels(color, config);
  std::string result;
  for (std::size_t c = 0; c < 4; ++c) result += text("%d not %.2f, ", stored.code[c], wanted[c] * stored.top[c]);
  return result;
}

}  // namespace halfplane::judges
