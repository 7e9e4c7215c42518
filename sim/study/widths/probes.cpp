#include "sim/study/widths/probes.hpp"

#include <algorithm>
#include <cmath>

#include "sim/study/vertices.hpp"

namespace halfplane {
namespace {

std::uint32_t depth_max_of(const Config& config) {
  return static_cast<std::uint32_t>((std::uint64_t{1} << config.depth_bits) - 1);
}

}  // namespace

ProbeMaker::ProbeMaker(const Config& config, std::uint64_t seed)
    : random_(seed),
      grid_bits_(std::max(config.subpixel_bits, 1)),
      low_(-(config.guard_band << grid_bits_)),
      high_((config.guard_band << grid_bits_) - 1),
      odd_mask_(config.subpixel_bits == 0 ? ~1 : ~0),
      depth_max_(depth_max_of(config)),
      widths_(derive_widths(config)) {}

std::int32_t ProbeMaker::legal(std::int64_t subpixels) const {
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(subpixels, low_, high_)) & odd_mask_;
}

std::int32_t ProbeMaker::coordinate() {
  const std::int64_t span = std::int64_t{high_} - low_ + 1;
  const auto anywhere = static_cast<std::int64_t>(random_.next() % static_cast<std::uint64_t>(span)) + low_;
  switch (below(6)) {
    case 0: return legal(low_ + below(4));
    case 1: return legal(high_ - below(4));
    case 2: return legal((anywhere >> grid_bits_ << grid_bits_) + (std::int64_t{1} << (grid_bits_ - 1)));  // a centre
    case 3: return legal(std::abs(anywhere) >> below(grid_bits_ + 8));  // near the target's first corner
    default: return legal(anywhere);
  }
}

std::uint32_t ProbeMaker::depth() {
  switch (below(4)) {
    case 0: return 0;
    case 1: return depth_max_;
    default: return static_cast<std::uint32_t>(random_.next()) & depth_max_;
  }
}

Probe ProbeMaker::random() {
  Probe probe;
  probe.is_line = below(3) == 0;
  probe.rule = below(2) == 0 ? LineRule::diamond : LineRule::midpoint;
  for (SnappedVertex& v : probe.v) {
    v.x = coordinate();
    v.y = coordinate();
    v.depth() = depth();
    set_colors(v, widths_, [this] { return below(3) == 0 ? 255 * below(2) : below(256); });
  }
  if (below(3) != 0) return probe;
  // A sliver, or a small triangle: the third vertex close to the first, or to the line through the others.
  const double t = below(2) == 0 ? 0 : random_.uniform(0, 1);
  const auto near = [&](std::int32_t a, std::int32_t b) {
    return legal(a + static_cast<std::int64_t>(t * (static_cast<double>(b) - a)) + below(7) - 3);
  };
  probe.v[2].x = near(probe.v[0].x, probe.v[1].x);
  probe.v[2].y = near(probe.v[0].y, probe.v[1].y);
  if (t == 0) std::swap(probe.v[1], probe.v[2]);  // for a line, the ends are close together
  return probe;
}

Probe ProbeMaker::changed(Probe probe) {
  for (int changes = 1 + below(3); changes > 0; --changes) {
    SnappedVertex& v = probe.v[static_cast<std::size_t>(below(probe.is_line ? 2 : 3))];
    const SnappedVertex& other = probe.v[static_cast<std::size_t>(below(probe.is_line ? 2 : 3))];
    const int what = below(6);
    if (what < 4) {
      std::int32_t& c = what % 2 == 0 ? v.x : v.y;
      switch (below(4)) {
        case 0: c = coordinate(); break;
        case 1: c = what % 2 == 0 ? other.x : other.y; break;
        default: c = legal(c + (below(2) == 0 ? 1 : -1) * (std::int64_t{1} << below(grid_bits_ + 12))); break;
      }
    } else if (what == 4) {
      v.depth() = depth();
    } else {
      const int channel = below(4);
      const auto code = static_cast<std::uint32_t>(below(2) == 0 ? 255 * below(2) : below(256));
      if (channel < widths_.color_planes) v.code[kColorPlane + static_cast<std::size_t>(channel)] = code;
    }
  }
  return probe;
}

std::vector<Probe> extreme_probes(const Config& config) {
  const int s = std::max(config.subpixel_bits, 1), step = config.subpixel_bits == 0 ? 2 : 1;
  const std::int32_t low = -(config.guard_band << s), high = (config.guard_band << s) - step, middle = 1 << (s - 1);
  const std::uint32_t top = depth_max_of(config);
  const Widths widths = derive_widths(config);
  const auto vertex = [&widths](std::int32_t x, std::int32_t y, std::uint32_t z) {
    SnappedVertex v{x, y, {z}};
    for (std::size_t p = kColorPlane; p < static_cast<std::size_t>(widths.affine_planes); ++p)
      v.code[p] = z == 0 ? 0 : static_cast<std::uint32_t>(widths.of_plane(p).code.range.hi);
    return v;
  };
  std::vector<Probe> probes;
  const std::array<std::int32_t, 3> places{low, middle, high};
  const auto place = [&](int n, std::uint32_t z) {
    return vertex(places[static_cast<std::size_t>(n % 3)], places[static_cast<std::size_t>(n / 3)], z);
  };
  for (int a = 0; a < 9; ++a)
    for (int b = 0; b < 9; ++b) {
      for (const std::uint32_t z : {0U, top})
        for (const LineRule rule : {LineRule::diamond, LineRule::midpoint})
          probes.push_back({true, rule, {place(a, z), place(b, top - z), SnappedVertex{}}});
      for (int c = a + 1; c < 9 && b != a; ++c)
        if (c != b)
          for (const unsigned depths : {1U, 3U})
            probes.push_back(
                {false, LineRule::diamond, {place(a, depths % 2 * top), place(b, depths / 2 * top), place(c, 0)}});
    }
  // Twice the area is one square step: (0, L) and (step, step) span step^2.
  for (const std::uint32_t z : {0U, top})
    for (const bool is_tall : {false, true}) {
      const auto turned = [&](std::int32_t x, std::int32_t y, std::uint32_t depth) {
        return is_tall ? vertex(x, y, depth) : vertex(y, x, depth);
      };
      probes.push_back({false,
                        LineRule::diamond,
                        {turned(middle, low, z), turned(middle + step, high, z), turned(middle, low + step, top - z)}});
      probes.push_back({true, LineRule::diamond, {turned(0, 0, z), turned(step, 0, top - z), {}}});
    }
  return probes;
}

Scene probe_scene(const Probe& probe, const Config& config) {
  Scene scene;
  scene.name = "probe";
  scene.width = config.target_width;
  scene.height = config.target_height;
  State state;
  state.space = Space::window;
  state.depth_test = DepthFunc::always;
  state.line_rule = probe.rule;
  state.line_last = probe.is_line && probe.rule != LineRule::diamond ? std::optional(true) : std::nullopt;
  scene.states.push_back(state);
  const std::size_t count = probe.is_line ? 2 : 3;
  for (std::size_t i = 0; i < count; ++i) {
    const SnappedVertex& snapped = probe.v[i];
    Vertex v;
    v.x = std::ldexp(snapped.x, -std::max(config.subpixel_bits, 1));
    v.y = std::ldexp(snapped.y, -std::max(config.subpixel_bits, 1));
    v.z = snapped.depth() / static_cast<double>(depth_max_of(config));
    v.rgba = colors_of(snapped);
    scene.indices.push_back(static_cast<std::uint32_t>(i));
    scene.vertices.push_back(v);
  }
  scene.commands.push_back(Draw{0, 0, probe.is_line ? Topology::lines : Topology::triangles, 0, count, 0});
  return scene;
}

}  // namespace halfplane
