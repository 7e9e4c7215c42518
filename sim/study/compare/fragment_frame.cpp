#include "fragment_frame.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "model/golden/viewport.hpp"
#include "model/host/primitives.hpp"
#include "model/stages/fragment_ops.hpp"

namespace halfplane {
namespace {

std::size_t pixels_of(const Scene& scene) {
  return static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height);
}

std::size_t pixel_of(const Scene& scene, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.width) + static_cast<std::size_t>(x);
}

std::array<std::uint8_t, 4> color_of(const TappedFragment& fragment) {
  if (fragment.surface) return fragment.surface->color;
  std::array<std::uint8_t, 4> code;
  for (std::size_t c = 0; c < 4; ++c) code[c] = static_cast<std::uint8_t>(fragment.plane[kColorPlane + c].code);
  return code;
}

std::uint32_t alpha_of(const TappedFragment& fragment) { return color_of(fragment)[3]; }

bool shows_back(const TappedFragment& fragment, const State& state, Topology topology) {
  if (!state.stencil || fragment.triangle == nullptr || draws_rectangles(state, topology)) return false;
  const auto& v = fragment.triangle->v;
  return halfplane::shows_back(signed_area(v[0], v[1], v[2]), state.front);
}

}  // namespace

FragmentFrame::FragmentFrame(const Scene& scene, const Config& config, int sample)
    : scene_(scene),
      config_(config),
      sample_(sample),
      depth_encode_(config, scene.planes),
      pixels_(pixels_of(scene), depth_encode_.of_window(1.0), {}, config.color_format == ColorFormat::rgba8888),
      layers_(pixels_of(scene), config.color_format),
      shown_(pixels_of(scene)) {}

void FragmentFrame::add(const TappedFragment& fragment) {
  if (fragment.sample != sample_) return;
  clear_until(fragment.draw);
  const bool is_in_target =
      fragment.x >= 0 && fragment.x < scene_.width && fragment.y >= 0 && fragment.y < scene_.height;
  if (!is_in_target) return;  // the judge of coverage has counted it
  const Draw& draw = std::get<Draw>(scene_.commands[fragment.draw]);
  const State& state = scene_.states[draw.state];
  const std::size_t p = pixel_of(scene_, fragment.x, fragment.y);
  const auto owner = static_cast<std::int32_t>(fragment.primitive);
  const bool has_samples = config_.msaa_samples > 1;
  if (has_samples && state.sample_mask && (*state.sample_mask >> sample_ & 1U) == 0) return;
  const double alpha = alpha_of(fragment);
  const bool is_drawn_by_alpha = !has_samples || !state.alpha_to_coverage ||
                                 sample_ < static_cast<int>(std::floor(alpha / 255 * config_.msaa_samples + 0.5));
  const golden::Tested<double> tested{static_cast<double>(depth_encode_(fragment.plane[kDepthPlane].code)), alpha,
                                      shows_back(fragment, state, draw.topology), is_drawn_by_alpha};
  const golden::Fate fate = pixels_.apply(p, state, tested, {}, owner);
  // Where several lines or points of one primitive store the same value, the last one counts.
  const bool is_another = !fate.written && fragment.kind != PrimitiveKind::triangle && pixels_.owners()[p] == owner &&
                          is_equal(fragment, shown_[p], state);
  if (fate.written || is_another) shown_[p] = fragment;
  if (fate.written && writes_color(state, config_.color_format)) layers_.write(p, state, color_of(fragment));
}

/// Whether two fragments leave the same in the target.
bool FragmentFrame::is_equal(const TappedFragment& a, const TappedFragment& b, const State& state) const {
  if (fragment_state(state, config_.color_format).depth_write && a.plane[kDepthPlane].code != b.plane[kDepthPlane].code)
    return false;
  return !state.color_write ||
         pack_color(config_.color_format, color_of(a)) == pack_color(config_.color_format, color_of(b));
}

void FragmentFrame::clear_until(std::size_t command) {
  for (; next_command_ < command; ++next_command_) {
    const auto* clear = std::get_if<Clear>(&scene_.commands[next_command_]);
    if (clear == nullptr) continue;
    const golden::PixelRange range = golden::clear_region(scene_, scene_.states[clear->state]);
    for (int y = range.begin_y; y < range.end_y; ++y)
      for (int x = range.begin_x; x < range.end_x; ++x) {
        const std::size_t p = pixel_of(scene_, x, y);
        if (clear->depth) pixels_.clear_depth(p, depth_encode_.of_window(*clear->depth));
        if (clear->color) layers_.clear(p, *clear->color);
        if (clear->stencil) pixels_.clear_stencil(p, *clear->stencil);
        pixels_.disown(p);
      }
  }
}

OwnedPixels::OwnedPixels(const FragmentFrame& frame) {
  for (std::size_t p = 0; p < frame.owners().size(); ++p)
    if (frame.owners()[p] >= 0) pixels.push_back(static_cast<std::uint32_t>(p));
  const auto key = [&frame](std::uint32_t p) {
    const TappedFragment& f = frame.shown(p);
    const bool is_triangle = f.kind == PrimitiveKind::triangle;
    const int rank = is_triangle ? 0 : f.kind == PrimitiveKind::line ? 1 : 2;
    return std::pair(rank, is_triangle ? f.item : f.primitive);
  };
  std::stable_sort(pixels.begin(), pixels.end(), [&key](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::optional<std::uint32_t> before;
  for (const std::uint32_t p : pixels) {
    const TappedFragment& f = frame.shown(p);
    if (f.kind != PrimitiveKind::triangle) break;
    triangles += f.item != before ? 1 : 0;
    before = f.item;
  }
}

}  // namespace halfplane
