// Texture lookups: a square of 16 x 16 pixels shows a rectangle of texture coordinates, its colours are the texels'.
#pragma once

#include <algorithm>
#include <cmath>

#include "judge.hpp"

namespace halfplane::judges {

inline constexpr std::array<std::string_view, 3> kWraps{"repeat", "clamp", "mirror"};
inline constexpr std::array<std::string_view, 6> kMinFilters{"nearest",
                                                             "linear",
                                                             "nearest_mipmap_nearest",
                                                             "linear_mipmap_nearest",
                                                             "nearest_mipmap_linear",
                                                             "linear_mipmap_linear"};

struct TextureCase {
  int width = 8, height = 8;
  std::size_t wrap_s = 0, wrap_t = 0;
  std::size_t min = 0, mag = 0;  ///< mag: nearest, linear
  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
};
/// Levels have a colour each in the captures of levels, and texels of their own otherwise.
inline bool has_levels(const TextureCase& t) { return t.min > 1; }
inline int texel(const TextureCase& t, int level, int x, int y, std::size_t c) {
  if (has_levels(t) && level > 0) return c == 3 ? 255 : (40 + 50 * level + 60 * static_cast<int>(c)) % 256;
  return c == 3 ? 255 : (x * 37 + y * 91 + static_cast<int>(c) * 50) % 256;
}

inline std::string texture_capture(const TextureCase& t) {
  std::string capture = "halfplane 1\ntarget 16 16\n" + text("texture t inline rgba8888 %d %d%s\n", t.width, t.height,
                                                             has_levels(t) ? " mips levels" : "");
  for (int level = 0, w = t.width, h = t.height;; ++level, w = std::max(1, w / 2), h = std::max(1, h / 2)) {
    for (int y = 0; y < h; ++y) {
      capture += "texels";
      for (int x = 0; x < w; ++x) {
        capture += " ";
        for (std::size_t c = 0; c < 4; ++c) capture += text("%02x", texel(t, level, x, y, c));
      }
      capture += "\n";
    }
    if (!has_levels(t) || (w == 1 && h == 1)) break;
  }
  const auto word = [](std::string_view w) { return std::string(w); };
  capture +=
      "space window\nclear color 0 0 0 255 depth 1\nstate texture t\nstate texture_combine replace\nstate "
      "texture_wrap " +
      word(kWraps[t.wrap_s]) + " " + word(kWraps[t.wrap_t]) + "\nstate texture_min " + word(kMinFilters[t.min]) +
      "\nstate texture_mag " + (t.mag == 0 ? "nearest" : "linear") + "\n";
  for (const auto& [x, y] : {std::array{0, 0}, std::array{1, 0}, std::array{1, 1}, std::array{0, 1}})
    capture +=
        text("v %d %d .5 1 255 255 255 255 %.17g %.17g\n", 16 * x, 16 * y, x == 0 ? t.u0 : t.u1, y == 0 ? t.v0 : t.v1);
  return capture + "t 0 1 2\nt 0 2 3\n";
}

/// ES 2.0, 3.7.6 and 3.7.7: the texel of a coordinate. `mirror` is its MIRRORED_REPEAT, `clamp` its CLAMP_TO_EDGE.
inline int wrapped(std::size_t wrap, int i, int size) {
  const auto modulo = [](int a, int n) { return (a % n + n) % n; };
  if (wrap == 0) return modulo(i, size);
  if (wrap == 1) return std::clamp(i, 0, size - 1);
  const int m = modulo(i, 2 * size);
  return m < size ? m : 2 * size - 1 - m;
}

/// A lookup in one level, with the range of values of each channel that the precision of coordinates allows.
struct Range {
  std::array<double, 4> low, high;
};
inline Range lookup(const TextureCase& t, int level, bool is_linear, double s, double v) {
  constexpr double kPrecision = 1. / 64;  // texels
  const int w = std::max(1, t.width >> level), h = std::max(1, t.height >> level);
  const double x = s * w, y = v * h;
  Range range{{1e9, 1e9, 1e9, 1e9}, {-1, -1, -1, -1}};
  const auto add = [&range](std::size_t c, double value) {
    range.low[c] = std::min(range.low[c], value);
    range.high[c] = std::max(range.high[c], value);
  };
  const auto at = [&](int i, int j, std::size_t c) {
    return double(texel(t, level, wrapped(t.wrap_s, i, w), wrapped(t.wrap_t, j, h), c));
  };
  for (std::size_t c = 0; c < 4; ++c) {
    if (!is_linear) {
      for (const double dx : {-kPrecision, kPrecision})
        for (const double dy : {-kPrecision, kPrecision})
          add(c, at(int(std::floor(x + dx)), int(std::floor(y + dy)), c));
      continue;
    }
    const int i = int(std::floor(x - .5)), j = int(std::floor(y - .5));
    const double a = x - .5 - i, b = y - .5 - j;
    add(c, (1 - a) * (1 - b) * at(i, j, c) + a * (1 - b) * at(i + 1, j, c) + (1 - a) * b * at(i, j + 1, c) +
               a * b * at(i + 1, j + 1, c));
  }
  return range;
}

/// ES 2.0, 3.7.7 to 3.7.9: filters by the scale, which is the same along x and y and at every pixel.
inline Range filtered(const TextureCase& t, double s, double v) {
  const double rho = std::max(std::abs(t.u1 - t.u0) * t.width, std::abs(t.v1 - t.v0) * t.height) / 16;
  const double lambda = std::log2(rho), c = t.mag == 1 && (t.min == 2 || t.min == 4) ? .5 : 0;
  const int top = int(std::floor(std::log2(std::max(t.width, t.height))));
  if (lambda <= c) return lookup(t, 0, t.mag == 1, s, v);
  const bool is_linear = t.min % 2 == 1;
  if (t.min < 2) return lookup(t, 0, is_linear, s, v);
  if (t.min < 4) return lookup(t, lambda <= .5 ? 0 : std::min(top, int(std::ceil(lambda + .5)) - 1), is_linear, s, v);
  const int lower = std::min(top, int(std::floor(lambda))), upper = std::min(top, lower + 1);
  const double f = lambda - std::floor(lambda);
  const Range a = lookup(t, lower, is_linear, s, v), b = lookup(t, upper, is_linear, s, v);
  Range range;
  for (std::size_t n = 0; n < 4; ++n) {
    range.low[n] = (1 - f) * a.low[n] + f * b.low[n];
    range.high[n] = (1 - f) * a.high[n] + f * b.high[n];
  }
  return range;
}

inline Case texture_case(const TextureCase& t, const TextureCase& wrong, bool has_wrong) {
  return {text("texture/%dx%d/%s_%s/%s/%s/%g_to_%g_%g_to_%g", t.width, t.height, std::string(kWraps[t.wrap_s]).c_str(),
               std::string(kWraps[t.wrap_t]).c_str(), std::string(kMinFilters[t.min]).c_str(),
               t.mag == 0 ? "nearest" : "linear", t.u0, t.u1, t.v0, t.v1),
          texture_capture(t),
          [t](const Framebuffer& frame, const Config& config) -> std::string {
            for (int y = 0; y < 16; ++y)
              for (int x = 0; x < 16; ++x) {
                const Range range =
                    filtered(t, t.u0 + (t.u1 - t.u0) * (x + .5) / 16, t.v0 + (t.v1 - t.v0) * (y + .5) / 16);
                const Channels got = channels(frame.color[frame.at(x, y)], config);
                const double slack = t.min > 3 ? 4 : 2;  // codes of 8 bits
                for (std::size_t c = 0; c < 3; ++c) {
                  const double code = got.code[c] * 255. / got.top[c], step = 255. / got.top[c] - 1;
                  if (code < range.low[c] - slack - step || code > range.high[c] + slack + step)
                    return at(x, y,
                              text("channel %d is %.1f, not %.1f to %.1f", int(c), code, range.low[c], range.high[c]));
                }
              }
            return "";
          },
          has_wrong ? texture_capture(wrong) : ""};
}

inline std::vector<Case> textures() {
  std::vector<Case> cases;
  constexpr std::array<std::array<double, 4>, 4> kRectangles{
      {{0, 1, 0, 1}, {-1.3, 2.1, -.7, 1.9}, {.3, .55, .2, .45}, {1.25, -1.25, 2.5, .1}}};
  for (const auto& [width, height] : {std::array{8, 8}, std::array{4, 16}, std::array{1, 2}, std::array{32, 32}})
    for (std::size_t s = 0; s < 3; ++s)
      for (std::size_t v = 0; v < 3; ++v)
        for (std::size_t filter = 0; filter < 2; ++filter)
          for (const auto& r : kRectangles) {
            const TextureCase t{width, height, s, v, filter, filter, r[0], r[1], r[2], r[3]};
            TextureCase wrong = t;  // the other filter
            wrong.min = wrong.mag = 1 - filter;
            cases.push_back(texture_case(t, wrong, width > 2 && (width < 32 || r[0] == .3)));
          }
  for (std::size_t min = 2; min < 6; ++min)
    for (const std::size_t mag : {0U, 1U})
      for (const double texels : {.4, .8, 1.2, 1.7, 2.0, 2.6, 3.3, 4.0, 5.1, 8.0, 11., 40.}) {
        TextureCase t{32, 32, 0, 0, min, mag};
        t.u1 = t.v1 = texels * 16 / 32;
        TextureCase wrong = t;  // one level in place of two, or two in place of one
        wrong.min = 2 + min % 4;
        const double lambda = std::log2(texels);
        const bool is_between = lambda > .6 && lambda < 5 && std::abs(lambda - std::round(lambda)) > .1;
        cases.push_back(texture_case(t, wrong, is_between));
      }
  return cases;
}

}  // namespace halfplane::judges
