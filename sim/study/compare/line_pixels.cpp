#include "line_pixels.hpp"

#include <algorithm>
#include <map>
#include <span>

#include "model/golden/exact_line.hpp"
#include "model/golden/golden.hpp"
#include "model/golden/viewport.hpp"
#include "model/stages/line_raster.hpp"
#include "model/stages/point_raster.hpp"
#include "model/stages/rop.hpp"

namespace halfplane {
namespace {

constexpr std::int32_t kOwnedByLine = -2;  // in Rendering::visible

/// One pixel of one line or point of the primitive at work.
struct Candidate {
  std::size_t item = 0;  ///< index into Rendering::lines or points
  int x = 0, y = 0;
  LineState registers;  ///< of a line
  LinePixel codes;
};

class LinePixels {
 public:
  LinePixels(const Scene& scene, const Config& config, const Rendering& rendering,
             const std::function<void(const OwnedPixel&)>& visit)
      : scene_(scene), config_(config), widths_(derive_widths(config)), rendering_(rendering), visit_(visit) {}

  std::uint64_t run() {
    const auto& lines = rendering_.lines;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      add_line(i);
      if (i + 1 == lines.size() || lines[i + 1].primitive != lines[i].primitive) finish_lines();
    }
    const auto& points = rendering_.points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      add_point(i);
      if (i + 1 == points.size() || points[i + 1].primitive != points[i].primitive) finish_points();
    }
    const auto owned =
        static_cast<std::uint64_t>(std::count(rendering_.visible.begin(), rendering_.visible.end(), kOwnedByLine));
    return owned - visited_;
  }

 private:
  [[nodiscard]] const State& state_of(std::uint32_t command) const {
    return scene_.states[std::get<Draw>(scene_.commands[command]).state];
  }

  [[nodiscard]] PixelBounds region_of(std::uint32_t command) const {
    const golden::PixelRange range = golden::draw_region(scene_, state_of(command));
    return {range.begin_x, range.begin_y, range.end_x - 1, range.end_y - 1};
  }

  /// Is what the pixel holds what the candidate would have written?
  [[nodiscard]] bool is_stored(const Candidate& c, const State& state) const {
    const std::size_t at = rendering_.frame.at(c.x, c.y);
    const bool same_depth = !state.depth_write || rendering_.frame.depth[at] == c.codes.depth;
    return same_depth && (!state.color_write ||
                          rendering_.frame.color[at] == pack_color(config_.color_format, channels(c.codes.color)));
  }

  static std::array<std::uint8_t, 4> channels(std::uint32_t color) {
    std::array<std::uint8_t, 4> code;
    for (std::size_t c = 0; c < 4; ++c) code[c] = static_cast<std::uint8_t>(color >> 8 * c);
    return code;
  }

  /// Keeps it if its primitive owns the pixel: the first, and then any later one that is stored there.
  void add(const Candidate& c, std::uint32_t primitive, std::uint32_t command) {
    const std::size_t p =
        static_cast<std::size_t>(c.y) * static_cast<std::size_t>(scene_.width) + static_cast<std::size_t>(c.x);
    if (rendering_.visible[p] != kOwnedByLine || rendering_.ids[p] != static_cast<std::int32_t>(primitive)) return;
    const auto [place, is_new] = owned_.try_emplace(p, c);
    if (!is_new && is_stored(c, state_of(command))) place->second = c;
  }

  void add_line(std::size_t i) {
    const DrawnLine& line = rendering_.lines[i];
    const auto setup = setup_line(line.start, line.end, state_of(line.draw).line_rule, line.drops_last,
                                  region_of(line.draw), config_, widths_);
    if (!setup) return;
    for (LineState state = first_state(*setup);; state = next_state(state, *setup, widths_)) {
      add({i, state.x, state.y, state, pixel_of(state, *setup, widths_)}, line.primitive, line.draw);
      if (state.remaining == 0) return;
    }
  }

  void add_point(std::size_t i) {
    const DrawnPoint& point = rendering_.points[i];
    const PixelBounds box = point_bounds(point.at, point.size, region_of(point.draw), widths_.grid_bits);
    LinePixel codes;
    codes.depth = point.at.z;
    codes.color = packet_color(point.at.rgba, widths_);
    for (int y = box.top; y <= box.bottom; ++y)
      for (int x = box.left; x <= box.right; ++x) add({i, x, y, {}, codes}, point.primitive, point.draw);
  }

  [[nodiscard]] int stored_channels() const { return golden::channel_count(config_.color_format); }

  /// A register along a line, without the half LSB that it carries.
  [[nodiscard]] exact::Rational before_rounding(std::uint64_t value) const {
    const int128 unit = int128{1} << widths_.line_guard_bits;
    return {static_cast<int128>(value) - unit / 2, unit};
  }

  void finish_lines() {
    for (const auto& [p, c] : owned_) {
      const DrawnLine& drawn = rendering_.lines[c.item];
      const State& state = state_of(drawn.draw);
      const exact::Line line{drawn.start, drawn.end, state.line_rule, drawn.drops_last, widths_.grid_bits};
      const bool is_start = c.registers.is_before_start != 0;  // shows the start's codes as they are
      OwnedPixel pixel{p, drawn.primitive, drawn.draw, true, {}, {}, c.codes.depth, channels(c.codes.color)};
      const auto hardware = [&](std::uint64_t value, std::uint32_t code) {
        return is_start ? exact::Rational{code, 1} : before_rounding(value);
      };
      pixel.depth = {exact::depth_at(line, c.x, c.y), hardware(c.registers.depth, c.codes.depth)};
      for (int channel = 0; channel < stored_channels(); ++channel) {
        const auto k = static_cast<std::size_t>(channel);
        pixel.color[k] = {exact::color_at(line, c.x, c.y, channel),
                          hardware(c.registers.color[k], pixel.color_code[k])};
      }
      visit_(pixel);
    }
    finish();
  }

  void finish_points() {
    for (const auto& [p, c] : owned_) {
      const DrawnPoint& drawn = rendering_.points[c.item];
      OwnedPixel pixel{p, drawn.primitive, drawn.draw, true, {}, {}, c.codes.depth, channels(c.codes.color)};
      pixel.depth = {{drawn.at.z, 1}, {drawn.at.z, 1}};
      for (std::size_t k = 0; k < static_cast<std::size_t>(stored_channels()); ++k)
        pixel.color[k] = {{drawn.at.rgba[k], 1}, {drawn.at.rgba[k], 1}};
      visit_(pixel);
    }
    finish();
  }

  void finish() {
    visited_ += owned_.size();
    owned_.clear();
  }

  const Scene& scene_;
  const Config& config_;
  const Widths widths_;
  const Rendering& rendering_;
  const std::function<void(const OwnedPixel&)>& visit_;
  std::map<std::size_t, Candidate> owned_;  // by pixel: of the primitive at work
  std::uint64_t visited_ = 0;
};

}  // namespace

std::uint64_t for_each_line_pixel(const Scene& scene, const Config& config, const Rendering& rendering,
                                  const std::function<void(const OwnedPixel&)>& visit) {
  return LinePixels(scene, config, rendering, visit).run();
}

}  // namespace halfplane
