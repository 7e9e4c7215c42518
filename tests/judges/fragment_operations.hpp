// Operations on fragments: 16 points, each alone on its pixel, meet what was drawn before them.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "judge.hpp"

namespace halfplane::judges {

inline constexpr int kPoints = 16;
inline constexpr std::array<std::string_view, 8> kFunctions{"never",   "less",   "lequal",   "equal",
                                                            "greater", "gequal", "notequal", "always"};
/// ES 2.0, 4.1.4 and 4.1.5.
inline bool compares(std::size_t function, int a, int b) {
  const bool results[] = {false, a<b, a <= b, a == b, a> b, a >= b, a != b, true};
  return results[function];
}

using Rgba = std::array<int, 4>;
/// Colours with zeros, ones and values between, different at every point.
inline Rgba source(int n) { return {n * 17, 255 - n * 13, (n * 53) % 256, n % 3 == 0 ? 255 : (n * 37) % 256}; }
inline Rgba destination(int n) { return {(n * 71) % 256, n % 4 == 0 ? 0 : 255 - n * 9, n * 16, 255 - (n * 29) % 256}; }

inline std::string fragment_head() {
  return "halfplane 1\ntarget 16 1\nspace window\nclear color 0 0 0 0 depth 1 stencil 0\n";
}
/// One point a pixel: depth and colour by number.
template <class Depth, class Color>
std::string points(Depth&& depth, Color&& color, int first) {
  std::string result;
  for (int n = 0; n < kPoints; ++n) {
    const Rgba c = color(n);
    result += text("v %d.5 0.5 %.10g 1 %d %d %d %d\n", n, depth(n), c[0], c[1], c[2], c[3]);
  }
  for (int n = 0; n < kPoints; ++n) result += text("p %d\n", first + n);
  return result;
}
inline double near_depth(int) { return .25; }

// ---- blending: ES 2.0, 4.1.6; min and max of ES 3.0
inline constexpr std::array<std::string_view, 15> kFactors{"zero",
                                                           "one",
                                                           "src_color",
                                                           "one_minus_src_color",
                                                           "dst_color",
                                                           "one_minus_dst_color",
                                                           "src_alpha",
                                                           "one_minus_src_alpha",
                                                           "dst_alpha",
                                                           "one_minus_dst_alpha",
                                                           "constant_color",
                                                           "one_minus_constant_color",
                                                           "constant_alpha",
                                                           "one_minus_constant_alpha",
                                                           "src_alpha_saturate"};
inline constexpr std::array<std::string_view, 5> kEquations{"add", "subtract", "reverse_subtract", "min", "max"};
inline constexpr std::array<double, 4> kConstant{64 / 255., 200 / 255., 16 / 255., 100 / 255.};

inline double factor(std::size_t which, std::size_t c, const std::array<double, 4>& s, const std::array<double, 4>& d) {
  const double values[] = {0,
                           1,
                           s[c],
                           1 - s[c],
                           d[c],
                           1 - d[c],
                           s[3],
                           1 - s[3],
                           d[3],
                           1 - d[3],
                           kConstant[c],
                           1 - kConstant[c],
                           kConstant[3],
                           1 - kConstant[3],
                           c == 3 ? 1 : std::min(s[3], 1 - d[3])};
  return values[which];
}
inline double blended(std::size_t equation, double s, double d, double fs, double fd) {
  const double values[] = {s * fs + d * fd, s * fs - d * fd, d * fd - s * fs, std::min(s, d), std::max(s, d)};
  return std::clamp(values[equation], 0., 1.);
}
inline std::string blend_capture(std::size_t src, std::size_t dst, std::size_t equation) {
  const auto word = [](std::string_view w) { return std::string(w); };
  return fragment_head() + "state depth_test always\n" + points(near_depth, destination, 0) + "state blend " +
         word(kFactors[src]) + " " + word(kFactors[dst]) + "\nstate blend_equation " + word(kEquations[equation]) +
         "\nstate blend_color 64 200 16 100\n" + points(near_depth, source, kPoints);
}
inline Case blend_case(std::size_t src, std::size_t dst, std::size_t equation) {
  const bool has_factors = equation < 3;
  return {"blend/" + std::string(kEquations[equation]) + "/" + std::string(kFactors[src]) + "/" +
              std::string(kFactors[dst]),
          blend_capture(src, dst, equation),
          [=](const Framebuffer& frame, const Config& config) -> std::string {
            for (int n = 0; n < kPoints; ++n) {
              const Channels top = channels(0, config);
              std::array<double, 4> s, d, wanted;
              for (std::size_t c = 0; c < 4; ++c) {
                s[c] = source(n)[c] / 255.;
                d[c] = std::round(destination(n)[c] / 255. * top.top[c]) / top.top[c];  // as it was stored
              }
              if (config.color_format == ColorFormat::rgb565) d[3] = 1;  // no stored alpha
              for (std::size_t c = 0; c < 4; ++c)
                wanted[c] = blended(equation, s[c], d[c], factor(src, c, s, d), factor(dst, c, s, d));
              if (config.color_format == ColorFormat::rgb565) wanted[3] = 1;
              const std::uint32_t color = frame.color[frame.at(n, 0)];
              if (!is_near(color, wanted, 1.0, config)) return at(n, 0, color_text(color, wanted, config));
            }
            return "";
          },
          !has_factors                ? blend_capture(src, dst, 7 - equation)
          : equation == 2 && dst == 0 ? blend_capture(std::max<std::size_t>(src, 1), dst, 0)  // 0 with any factor
                                      : blend_capture((src + 1) % 14, dst, equation)};
}

// ---- depth: ES 2.0, 4.1.5
inline double stored_depth(int n) { return (4 + n / 4 * 3) / 16.; }
inline double tested_depth(int n) { return (3 + n % 4 * 4) / 16. + (n % 4 == n / 4 ? 1 / 16. * (1 - n % 4) : 0); }
inline std::string depth_capture(std::size_t function, bool writes) {
  return fragment_head() + "state depth_test always\n" + points(stored_depth, destination, 0) + "state depth_test " +
         std::string(kFunctions[function]) + (writes ? "\n" : "\nstate depth_write off\n") +
         points(tested_depth, source, kPoints);
}
inline long depth_code(double z, const Config& config) {
  return static_cast<long>(std::floor(z * static_cast<double>((1L << config.depth_bits) - 1) + .5));
}
inline Case depth_case(std::size_t function, bool writes) {
  return {"depth/" + std::string(kFunctions[function]) + (writes ? "" : "/masked"), depth_capture(function, writes),
          [=](const Framebuffer& frame, const Config& config) -> std::string {
            for (int n = 0; n < kPoints; ++n) {
              const long before = depth_code(stored_depth(n), config), now = depth_code(tested_depth(n), config);
              const bool passes = compares(function, static_cast<int>(now), static_cast<int>(before));
              const Rgba& c = passes ? source(n) : destination(n);
              std::array<double, 4> wanted{c[0] / 255., c[1] / 255., c[2] / 255., c[3] / 255.};
              if (config.color_format == ColorFormat::rgb565) wanted[3] = 1;
              if (!is_near(frame.color[frame.at(n, 0)], wanted, .51, config))
                return at(n, 0, color_text(frame.color[frame.at(n, 0)], wanted, config));
              const long depth = frame.depth[frame.at(n, 0)];
              if (depth != (passes && writes ? now : before)) return at(n, 0, text("depth %ld", depth));
            }
            return "";
          },
          depth_capture((function + 1) % 8, writes)};
}

// ---- stencil: ES 2.0, 4.1.4
inline constexpr std::array<std::string_view, 8> kOps{"keep", "zero",   "replace",   "incr",
                                                      "decr", "invert", "incr_wrap", "decr_wrap"};
struct StencilCase {
  std::size_t function = 7;
  std::array<std::size_t, 3> ops{};  ///< sfail, zfail, zpass
  int reference = 0, read = 255, write = 255;
};
inline int stencil_before(int n) {
  return std::array{0, 1, 2, 127, 128, 254, 255, 60}[static_cast<std::size_t>(n % 8)];
}
inline std::string stencil_capture(const StencilCase& s) {
  std::string capture = fragment_head() + "state depth_test always\nstate color_write off\n";
  for (int n = 0; n < kPoints; ++n)  // depth .5, and what lies in the stencil
    capture +=
        text("state stencil always %d 255 255 replace replace replace\nv %d.5 .5 .5\np %d\n", stencil_before(n), n, n);
  capture += text("state stencil %s %d %d %d %s %s %s\nstate depth_test less\nstate depth_write off\n",
                  std::string(kFunctions[s.function]).c_str(), s.reference, s.read, s.write,
                  std::string(kOps[s.ops[0]]).c_str(), std::string(kOps[s.ops[1]]).c_str(),
                  std::string(kOps[s.ops[2]]).c_str());
  return capture + points([](int n) { return n < 8 ? .25 : .75; }, source, kPoints);  // the second half fails in depth
}
inline int stencil_after(std::size_t op, int stored, const StencilCase& s) {
  const int results[] = {stored,
                         0,
                         s.reference,
                         std::min(stored + 1, 255),
                         std::max(stored - 1, 0),
                         255 - stored,
                         (stored + 1) % 256,
                         (stored + 255) % 256};
  return (results[op] & s.write) | (stored & ~s.write);
}
inline Case stencil_case(const StencilCase& s, const StencilCase& wrong) {
  return {text("stencil/%s_%d_%d_%d/%s/%s/%s", std::string(kFunctions[s.function]).c_str(), s.reference, s.read,
               s.write, std::string(kOps[s.ops[0]]).c_str(), std::string(kOps[s.ops[1]]).c_str(),
               std::string(kOps[s.ops[2]]).c_str()),
          stencil_capture(s),
          [s](const Framebuffer& frame, const Config&) -> std::string {
            for (int n = 0; n < kPoints; ++n) {
              const int before = stencil_before(n);
              const bool passes = compares(s.function, s.reference & s.read, before & s.read);
              const int wanted = stencil_after(s.ops[!passes ? 0 : n < 8 ? 2 : 1], before, s);
              if (const int got = frame.stencil[frame.at(n, 0)]; got != wanted)
                return at(n, 0, text("stencil %d, not %d", got, wanted));
            }
            return "";
          },
          stencil_capture(wrong)};
}

// ---- alpha test (ES 1.1, 4.1.4), colour mask (ES 2.0, 4.2.2), scissor (ES 2.0, 4.1.2): one point or none
inline Case selection_case(const std::string& name, const std::string& state, const std::string& wrong,
                           std::function<std::array<bool, 4>(int)> is_written) {
  const auto capture = [](const std::string& line) {
    return fragment_head() + "state depth_test always\n" + points(near_depth, destination, 0) + "state " + line + "\n" +
           points(near_depth, source, kPoints);
  };
  return {name, capture(state),
          [is_written](const Framebuffer& frame, const Config& config) -> std::string {
            for (int n = 0; n < kPoints; ++n) {
              std::array<double, 4> wanted;
              for (std::size_t c = 0; c < 4; ++c) wanted[c] = (is_written(n)[c] ? source(n) : destination(n))[c] / 255.;
              if (config.color_format == ColorFormat::rgb565) wanted[3] = 1;
              if (!is_near(frame.color[frame.at(n, 0)], wanted, .51, config))
                return at(n, 0, color_text(frame.color[frame.at(n, 0)], wanted, config));
            }
            return "";
          },
          wrong.empty() ? "" : capture(wrong)};
}

inline constexpr std::array<std::size_t, 8> kComplement{7, 5, 4, 6, 2, 1, 3, 0};  ///< passes where the function fails

inline std::vector<Case> fragment_operations() {
  std::vector<Case> cases;
  for (std::size_t equation = 0; equation < kEquations.size(); ++equation)
    for (std::size_t src = 0; src < kFactors.size(); ++src)
      for (std::size_t dst = 0; dst < (equation < 3 ? kFactors.size() : 1); ++dst)
        cases.push_back(blend_case(src, dst, equation));
  for (std::size_t function = 0; function < 8; ++function)
    for (const bool writes : {true, false}) cases.push_back(depth_case(function, writes));
  for (std::size_t function = 0; function < 8; ++function)
    for (std::size_t op = 1; op < 8; ++op)
      for (std::size_t outcome = 0; outcome < 3; ++outcome)
        for (const auto& [read, write] : {std::array{255, 255}, std::array{254, 255}, std::array{255, 0x3c}}) {
          StencilCase s{function, {}, 127, read, write};
          s.ops[outcome] = op;
          StencilCase wrong = s;
          wrong.ops = {op, op, op};
          wrong.ops[outcome] = 0;  // at the other outcomes
          cases.push_back(stencil_case(s, wrong));
        }
  for (std::size_t function = 0; function < 8; ++function)
    for (const int reference : {0, 1, 111, 127, 255}) {
      const auto line = [&](std::size_t f) {
        return "alpha_test " + std::string(kFunctions[f]) + text(" %d", reference);
      };
      cases.push_back(selection_case(line(function), line(function), line(kComplement[function]), [=](int n) {
        const bool is = compares(function, source(n)[3], reference);
        return std::array{is, is, is, is};
      }));
    }
  for (unsigned mask = 0; mask < 16; ++mask) {
    const auto line = [](unsigned m) {
      std::string words = "color_mask";
      for (unsigned c = 0; c < 4; ++c) words += (m >> c & 1) != 0 ? " on" : " off";
      return words;
    };
    cases.push_back(selection_case(line(mask), line(mask), line(mask ^ 5), [mask](int) {
      return std::array{(mask & 1) != 0, (mask & 2) != 0, (mask & 4) != 0, (mask & 8) != 0};
    }));
  }
  for (int left = -1; left < 17; left += 3)
    for (const int width : {0, 1, 7, 16}) {
      const auto line = [width](int x) { return text("scissor %d 0 %d 1", x, width); };
      cases.push_back(
          selection_case(line(left), line(left), width == 7 && left > 0 && left < 9 ? line(left + 1) : "", [=](int n) {
            const bool is = n >= left && n < left + width;
            return std::array{is, is, is, is};
          }));
    }
  return cases;
}

}  // namespace halfplane::judges
