#include "sim/scene/depth_collision.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unordered_map>
#include <vector>

#include "model/host/viewport.hpp"

namespace halfplane {
namespace {

constexpr double kLeastRatio = 1.05;
constexpr double kBinsBetween = 2;  // enough to tell two distances apart, wherever they lie in their bins
constexpr int kMostBits = 32;

bool is_in_view(const Vertex& v, ClipZ clip_z) {
  const double least_z = clip_z == ClipZ::zero_one ? 0 : -v.w;
  return v.w > 0 && std::abs(v.x) <= v.w && std::abs(v.y) <= v.w && v.z >= least_z && v.z <= v.w;
}

bool orders_by_depth(const State& state) {
  return state.space == Space::clip && state.depth_test != DepthFunc::always && state.depth_write;
}

/// To two digits.
double rounded_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::ceil(value / unit) * unit;
}

struct Distances {
  double nearest = HUGE_VAL, farthest = 0;
};

}  // namespace

std::optional<DepthCollision> depth_collision(const Scene& scene, const Config& config) {
  if (config.depth_mapping != DepthMapping::projection || config.depth_format != DepthFormat()) return {};
  // Places w and w r can only have one code if w > near (1 - 1/r) (2^B - 1): most scenes end before that.
  if (const double least = (1 - 1 / kLeastRatio) * (std::ldexp(1.0, config.depth_bits) - 1);
      scene.planes && (*scene.planes)[1] < least * (*scene.planes)[0])
    return {};
  std::unordered_map<std::uint32_t, Distances> of_code;
  std::vector<std::uint32_t> seen_in(scene.vertices.size(), ~0U);  // the state of its last test
  for (const Command& command : scene.commands) {
    const Draw* const draw = std::get_if<Draw>(&command);
    if (draw == nullptr || draw->outside != 0 || !orders_by_depth(scene.states[draw->state])) continue;
    const State& state = scene.states[draw->state];
    for (std::size_t i = draw->first; i < draw->first + draw->count; ++i) {
      const std::uint32_t index = scene.indices[i];
      if (index == kRestart || seen_in[index] == draw->state) continue;
      seen_in[index] = draw->state;
      const Vertex& v = scene.vertices[index];
      if (!is_in_view(v, state.clip_z)) continue;
      Distances& at = of_code[snap_depth(to_window(v, state, {0, 0, 1, 1}).z, config.depth_bits)];
      at.nearest = std::min(at.nearest, v.w);
      at.farthest = std::max(at.farthest, v.w);
    }
  }
  DepthCollision worst;
  double ratio = kLeastRatio;
  for (const auto& [code, at] : of_code)
    if (at.farthest / at.nearest >= ratio) {
      ratio = at.farthest / at.nearest;
      worst = {at.nearest, at.farthest, config.depth_bits, {}, {}, {}};
    }
  if (worst.bits == 0) return {};
  if (!scene.planes) return worst;
  // A bin of depth d is d^2 / (near 2^B) long, and far beyond the near plane.
  const double near = (*scene.planes)[0];
  const double bins = kBinsBetween * worst.farther * worst.farther / (worst.farther - worst.nearer);
  worst.near = near;
  const double bits = std::ceil(std::log2(bins / near));
  if (bits <= kMostBits) worst.enough_bits = static_cast<int>(bits);
  const double near_enough = rounded_up(std::ldexp(bins, -config.depth_bits));
  if (near_enough < worst.nearer) worst.near_enough = near_enough;
  return worst;
}

std::string text(const DepthCollision& c) {
  char words[160];
  std::snprintf(words, sizeof words,
                "distances %.4g and %.4g have one depth code of %d bits: the order of drawing decides which is seen",
                c.nearer, c.farther, c.bits);
  std::string line = words;
  std::string way;
  if (c.enough_bits) way = "depth.bits=" + std::to_string(*c.enough_bits);
  if (c.near_enough) {
    std::snprintf(words, sizeof words, "%sa near plane at %.2g (now %.3g)", way.empty() ? "" : " or ", *c.near_enough,
                  c.near.value_or(0));
    way += words;
  }
  if (!way.empty()) line += "; " + way + " tells them apart";
  return line + "; halfplane depth --scene says how often";
}

}  // namespace halfplane
