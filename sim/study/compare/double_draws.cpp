#include "double_draws.hpp"

#include <algorithm>
#include <optional>
#include <variant>
#include <vector>

#include "model/engines/commands.hpp"
#include "model/study/homogeneous_setup.hpp"
#include "model/study/traversal.hpp"

namespace halfplane {
namespace {

/// Draws per sample of the current mesh, under both rules.
class MeshCounts {
 public:
  MeshCounts(int width, int height)
      : width_(static_cast<std::size_t>(width)),
        by_rule_(width_ * static_cast<std::size_t>(height)),
        by_top_left_(by_rule_.size()) {}

  void add_by_rule(int x, int y) { ++by_rule_[at(x, y)]; }
  void add_by_top_left(int x, int y) { ++by_top_left_[at(x, y)]; }

  /// Later additions lie in `box`.
  void touch(const TriangleSetup& box) {
    if (touched_.is_empty()) touched_ = {box.left, box.top, box.right, box.bottom};
    touched_ = {std::min(touched_.left, box.left), std::min(touched_.top, box.top), std::max(touched_.right, box.right),
                std::max(touched_.bottom, box.bottom)};
  }

  /// Ends the mesh and adds its draws. The next one starts at 0.
  void finish(DrawsOfRule& sum) {
    for (int y = touched_.top; y <= touched_.bottom; ++y)
      for (int x = touched_.left; x <= touched_.right; ++x) {
        std::uint32_t &rule = by_rule_[at(x, y)], &top_left = by_top_left_[at(x, y)];
        const std::uint32_t due = std::max(1U, top_left);
        if (rule > due) sum.doubled += rule - due;
        if (rule == 0 && top_left > 0) ++sum.undrawn;
        rule = top_left = 0;
      }
    touched_ = {};
  }

 private:
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x);
  }

  std::size_t width_;
  std::vector<std::uint32_t> by_rule_, by_top_left_;
  PixelBounds touched_;
};

/// Whether draw number `next` belongs to another mesh than draw number `last`.
bool is_another_mesh(const Scene& scene, std::uint32_t last, std::uint32_t next) {
  for (std::uint32_t i = last; i <= next; ++i) {
    const auto* draw = std::get_if<Draw>(&scene.commands[i]);
    if (draw == nullptr || draw->object != std::get<Draw>(scene.commands[last]).object) return true;
  }
  return false;
}

}  // namespace

DrawsOfRule count_draws(const Scene& scene, const Config& config, const StudyRules& rules) {
  const FillRule rule = rules.fill_rule;
  const bool is_homogeneous = rules.clipping == Clipping::homogeneous;
  if (rule == FillRule::top_left && !is_homogeneous) return {};
  validate(config);
  const Widths widths = derive_widths(config);
  check_scene(scene, config);  // before the counts, which have its size
  MeshCounts counts(scene.width, scene.height);
  std::optional<std::uint32_t> last_draw;
  DrawsOfRule sum;
  const auto begin_draw = [&](const DrawContext& context) {
    if (last_draw && is_another_mesh(scene, *last_draw, context.command)) counts.finish(sum);
    last_draw = context.command;
  };
  (void)run_commands(
      scene, config, {},
      [&](const DrawContext& context, const Triangle& triangle, std::uint32_t, Rendering&) {
        begin_draw(context);
        TriangleSetup setup = setup_triangle(triangle, config, widths, context.rect);
        if (setup.is_empty()) return;
        counts.touch(setup);
        traverse_bbox(setup, widths, [&](int x, int y) { counts.add_by_top_left(x, y); });
        if (is_homogeneous && context.state.space == Space::clip) return;
        const auto area = signed_area(triangle.v[0], triangle.v[1], triangle.v[2]);
        set_fill_rule(setup, canonical(triangle.v, area), rule, widths);
        traverse_bbox(setup, widths, [&](int x, int y) { counts.add_by_rule(x, y); });
      },
      [&](const DrawContext& context, std::uint32_t&, Rendering&) {
        if (!is_homogeneous || context.state.space == Space::window) return false;
        begin_draw(context);
        const HomogeneousFrame frame{config, widths, context.state, context.viewport, context.rect};
        for_each_homogeneous(scene, context.draw, frame, [&](const HomogeneousSetup& setup) {
          if (setup.rejection != Rejection::none) return;
          counts.touch(setup.triangle);
          traverse_homogeneous(setup, [&](int x, int y) { counts.add_by_rule(x, y); });
        });
        return false;  // the clipped triangles are the reference
      });
  counts.finish(sum);
  return sum;
}

}  // namespace halfplane
