#include "compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <utility>

#include "eye_depth.hpp"
#include "line_coverage.hpp"
#include "line_pixels.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/exact.hpp"
#include "model/stages/depth_encode.hpp"
#include "model/stages/plane_rules.hpp"
#include "model/stages/rop.hpp"
#include "model/stages/triangle_setup.hpp"
#include "model/stages/viewport.hpp"

namespace halfplane {
namespace {

constexpr double kGrid = 1 << exact::kGridBits;  // a power of two: scaling by it is exact

double to_lsb(std::int64_t error) { return static_cast<double>(error) / kGrid; }

/// A real value in LSB on the grid of 2^-20 LSB.
std::int64_t on_grid(double lsb) { return static_cast<std::int64_t>(std::floor(lsb * kGrid + 0.5)); }

/// The four values of one quantity at one pixel, on the grid.
struct Values {
  std::int64_t u = 0, s = 0, h = 0, d = 0;
};

struct PartSets {
  PartSet snap, interpolation, storage, total;

  void add(const Values& v) {
    snap.add(v.s - v.u);
    interpolation.add(v.h - v.s);
    storage.add(v.d - v.h);
    total.add(v.d - v.u);
  }
  [[nodiscard]] ErrorParts stats() const {
    return {snap.stats(), interpolation.stats(), storage.stats(), total.stats()};
  }
};

/// Pixel numbers grouped by the triangle they show, so that each triangle is set up once.
struct PixelGroups {
  std::vector<std::size_t> first;     // of triangle i in `pixels`; one entry more than triangles
  std::vector<std::uint32_t> pixels;  // a target has at most 2^28

  PixelGroups(const std::vector<std::int32_t>& visible, std::size_t triangle_count) : first(triangle_count + 1) {
    for (const std::int32_t t : visible)
      if (t >= 0) ++first[static_cast<std::size_t>(t) + 1];
    for (std::size_t i = 0; i < triangle_count; ++i) first[i + 1] += first[i];
    pixels.resize(first.back());
    std::vector<std::size_t> next = first;
    for (std::size_t p = 0; p < visible.size(); ++p)
      if (visible[p] >= 0) pixels[next[static_cast<std::size_t>(visible[p])]++] = static_cast<std::uint32_t>(p);
  }
};

/// Walks over the pixels that the model owns and gathers every attribute error.
class AttributeComparison {
 public:
  AttributeComparison(const Scene& scene, const Config& config, const StudyRules& rules, Comparison& result)
      : scene_(scene),
        config_(config),
        rules_(rules),
        widths_(derive_widths(config)),
        result_(result),
        depth_max_(std::ldexp(1.0, config.depth_bits) - 1),
        depth_encode_(config, scene.planes),
        eye_mappings_(fit_eye_mappings(result.golden.outlines, scene.commands.size())) {}

  void run() {
    const PixelGroups groups(result_.rendering.visible, result_.rendering.triangles.size());
    for (std::size_t i = 0; i + 1 < groups.first.size(); ++i) {
      if (groups.first[i] == groups.first[i + 1]) continue;
      ++result_.visible_triangles;
      const Triangle& triangle = result_.rendering.triangles[i];
      const TriangleSetup setup = setup_of(triangle);
      for (std::size_t k = groups.first[i]; k < groups.first[i + 1]; ++k)
        pixel(triangle_pixel(triangle, setup, groups.pixels[k]));
    }
    const std::uint64_t unexplained =
        for_each_line_pixel(scene_, config_, result_.rendering, [this](const OwnedPixel& p) { pixel(p); });
    result_.stage_mismatches += unexplained;
    result_.depth_lsb = depth_.stats();
    result_.color_lsb = color_.stats();
    if (const ErrorStats eye = eye_.stats(); eye.count > 0) result_.depth_eye = eye;
    result_.parts = depth_parts_.stats();
    result_.color_parts = color_parts_.stats();
    result_.affine = affine_.stats();
    result_.datapath = datapath_.stats();
    result_.line_datapath = line_datapath_.stats();
    result_.color_datapath = color_datapath_.stats();
    result_.datapath_bias = datapath_bias_.stats();
    result_.color_datapath_bias = color_datapath_bias_.stats();
  }

 private:
  [[nodiscard]] const State& state_of(const Triangle& triangle) const {
    return scene_.states[std::get<Draw>(scene_.commands[triangle.draw]).state];
  }

  /// As the engine has it: a saturated plane depends on where its box begins.
  [[nodiscard]] TriangleSetup setup_of(const Triangle& triangle) const {
    TriangleSetup setup =
        setup_triangle(triangle, config_, widths_, raster_rect(state_of(triangle), scene_.width, scene_.height));
    if (rules_ == StudyRules{}) return setup;
    const auto area = signed_area(triangle.v[0], triangle.v[1], triangle.v[2]);
    set_planes(setup, canonical(triangle.v, area), rules_, config_, widths_);
    return setup;
  }

  [[nodiscard]] OwnedPixel triangle_pixel(const Triangle& triangle, const TriangleSetup& setup, std::size_t p) const {
    const auto width = static_cast<std::size_t>(result_.golden.width);
    const int x = static_cast<int>(p % width), y = static_cast<int>(p / width);
    const State& state = state_of(triangle);
    const Interpolated stages = interpolate_by_rules(setup, rules_, widths_, x, y);
    OwnedPixel pixel{p, triangle.primitive, triangle.draw, false, {}, {}, stages.depth_code, stages.color_code};
    if (state.depth_write)
      pixel.depth = {exact::depth_at(triangle, x, y, widths_.grid_bits),
                     {stages.depth, int128{1} << config_.local_guard_bits}};
    if (!state.color_write) return pixel;
    for (int channel = 0; channel < golden::channel_count(config_.color_format); ++channel) {
      const auto c = static_cast<std::size_t>(channel);
      pixel.color[c] = {exact::color_at(triangle, x, y, widths_.grid_bits, channel),
                        {stages.color[c], int128{1} << config_.local_guard_bits}};
    }
    return pixel;
  }

  void pixel(const OwnedPixel& pixel) {
    const State& state = scene_.states[std::get<Draw>(scene_.commands[pixel.draw]).state];
    // The same primitive, not merely some primitive: otherwise U - D would be the distance of two surfaces.
    const bool same_visible = result_.golden.ids[pixel.p] == static_cast<std::int32_t>(pixel.primitive);
    const auto width = static_cast<std::size_t>(result_.golden.width);
    const std::size_t at =
        result_.rendering.frame.at(static_cast<int>(pixel.p % width), static_cast<int>(pixel.p / width));
    result_.compared_pixels += same_visible ? 1 : 0;
    if (state.depth_write) depth(pixel, result_.rendering.frame.depth[at], same_visible);
    if (state.color_write) color(pixel, state, result_.rendering.frame.color[at], same_visible);
  }

  void depth(const OwnedPixel& pixel, std::uint32_t stored, bool same_visible) {
    Values v;
    v.s = exact::on_grid(pixel.depth.exact);
    v.h = exact::on_grid(pixel.depth.hardware);
    v.d = depth_encode_.is_identity() ? std::int64_t{stored} << exact::kGridBits
                                      : on_grid(static_cast<double>(depth_encode_.plane_value(stored)) * depth_max_);
    result_.stage_mismatches += stored != depth_encode_(pixel.depth_code) ? 1 : 0;
    // Of a format that is not the plane's, storage is a step after the datapath.
    const std::int64_t datapath = depth_encode_.is_identity() ? v.d : v.h;
    if (pixel.is_line) {
      line_datapath_.add(to_lsb(datapath - v.s));
    } else {
      datapath_.add(to_lsb(datapath - v.s));
      datapath_bias_.add(to_lsb(v.h - v.s));
    }
    if (!same_visible) return;
    const double u = result_.golden.depth[pixel.p];
    v.u = on_grid(u);
    depth_parts_.add(v);
    depth_.add(to_lsb(v.d - v.u));
    result_.depth_error_lsb[pixel.p] = static_cast<float>(to_lsb(v.d - v.u));
    if (const auto& mapping = eye_mappings_[pixel.draw]) {
      const auto of_d = mapping->eye_depth(to_lsb(v.d) / depth_max_), of_u = mapping->eye_depth(u / depth_max_);
      if (of_d && of_u)
        eye_.add(*of_d - *of_u);
      else
        ++result_.beyond_eye;
    }
  }

  void color(const OwnedPixel& pixel, const State& state, std::uint32_t stored, bool same_visible) {
    const auto max = golden::channel_max(config_.color_format);
    result_.stage_mismatches += stored != pack_color(config_.color_format, pixel.color_code) ? 1 : 0;
    double worst = 0;
    for (int channel = 0; channel < golden::channel_count(config_.color_format); ++channel) {
      const auto c = static_cast<std::size_t>(channel);
      Values v;
      v.s = exact::on_grid(pixel.color[c].exact, max[c], 255);
      v.h = exact::on_grid(pixel.color[c].hardware, max[c], 255);
      v.d = std::int64_t{golden::stored_channel(stored, config_.color_format, channel)} << exact::kGridBits;
      color_datapath_.add(to_lsb(v.d - v.s));
      color_datapath_bias_.add(to_lsb(v.h - v.s));
      if (!same_visible) continue;
      v.u = on_grid(result_.golden.affine[pixel.p][c] * max[c] / 255);
      const std::int64_t perspective = on_grid(result_.golden.perspective[pixel.p][c] * max[c] / 255);
      color_parts_.add(v);
      affine_.add(v.u - perspective);
      const double error = to_lsb(v.d - (state.color_interp == ColorInterp::affine ? v.u : perspective));
      color_.add(error);
      if (std::abs(error) > std::abs(worst)) worst = error;
    }
    if (same_visible) result_.color_error_lsb[pixel.p] = static_cast<float>(worst);
  }

  const Scene& scene_;
  const Config& config_;
  const StudyRules& rules_;
  const Widths widths_;
  Comparison& result_;
  double depth_max_;  // 2^B - 1
  DepthEncode depth_encode_;
  std::vector<std::optional<EyeMapping>> eye_mappings_;
  ErrorSet depth_, color_, eye_;
  MomentSet datapath_, line_datapath_, color_datapath_, datapath_bias_, color_datapath_bias_;
  PartSets depth_parts_, color_parts_;
  PartSet affine_;
};

CoverageClass classify(std::uint32_t golden_count, std::uint32_t model_count, bool same_visible) {
  if (golden_count > model_count) return CoverageClass::missing;
  if (golden_count < model_count) return CoverageClass::extra;
  if (!same_visible) return CoverageClass::other;
  return golden_count == 0 ? CoverageClass::none : CoverageClass::both;
}

std::uint64_t different_pixels(const Scene& scene, const Rendering& a, const Rendering& b) {
  std::uint64_t different = 0;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t at = a.frame.at(x, y), bt = b.frame.at(x, y);
      different += a.frame.depth[at] != b.frame.depth[bt] || a.frame.color[at] != b.frame.color[bt] ? 1 : 0;
    }
  return different;
}

std::string line(const char* format, double value, double bound) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), format, value, bound);
  return text.data();
}

}  // namespace

Comparison compare(const Scene& scene, const Config& config, const CompareOptions& options) {
  Comparison result;
  CoverageLog log(config.tile_size);
  RenderOptions render_options;
  render_options.skip = options.skip;
  render_options.rules = options.rules;
  render_options.want_count = render_options.want_ids = render_options.want_triangles = true;
  render_options.coverage_tap = [&log](std::uint32_t triangle, int tile_x, int tile_y, const TileMask& mask) {
    log.add(triangle, tile_x, tile_y, mask);
  };
  PixelLog pixel_log;
  render_options.pixel_tap = [&pixel_log](std::uint32_t primitive, int x, int y) { pixel_log.add(primitive, x, y); };
  golden::Options golden_options;
  golden_options.precision = options.precision;
  golden_options.want_outlines = true;
  if (options.progress) {
    render_options.progress = [&options](double fraction) { options.progress(0.5 * fraction); };
    golden_options.progress = [&options](double fraction) { options.progress(0.5 + 0.5 * fraction); };
  }
  const bool is_default = options.rules == StudyRules{};
  const Engine engine = options.engine ? options.engine : is_default ? render_functional : render_scalar;
  result.rendering = engine(scene, config, render_options);
  result.golden = golden::render(scene, config, golden_options);
  // With taps the functional engine draws by the stages: what it draws without them must be the same.
  if (is_default && !options.engine) {
    RenderOptions plain;
    plain.skip = options.skip;
    result.stage_mismatches += different_pixels(scene, result.rendering, engine(scene, config, plain));
  }

  log.sort();
  result.oracle = check_coverage(scene, config, result.rendering.triangles, log, options.rules.fill_rule);
  pixel_log.sort();
  check_line_coverage(scene, config, result.rendering, pixel_log, result.oracle);
  result.coverage = compare_counts(scene, result.rendering.count, result.golden, config.subpixel_bits);
  const std::size_t pixels = result.rendering.count.size();
  result.coverage_class.resize(pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    result.coverage_class[p] =
        classify(result.golden.count[p], result.rendering.count[p], result.golden.ids[p] == result.rendering.ids[p]);
    result.other_visible += result.coverage_class[p] == CoverageClass::other ? 1 : 0;
  }
  result.depth_error_lsb.assign(pixels, std::numeric_limits<float>::quiet_NaN());
  result.color_error_lsb = result.depth_error_lsb;
  AttributeComparison(scene, config, options.rules, result).run();
  return result;
}

std::vector<std::string> broken_bounds(const Comparison& c, const Config& config) {
  std::vector<std::string> broken;
  const auto require = [&broken](bool holds, const char* format, double value, double bound) {
    if (!holds) broken.push_back(line(format, value, bound));
  };
  if (c.rendering.counters.covered == 0) broken.push_back("nothing was compared: no primitive covers a sample");
  const double depth_bound = depth_error_bound(config);
  // The mean is a property of many triangles: one alone has the error of its own reciprocal, up to 1/16 LSB.
  const bool has_population = c.visible_triangles >= 100;

  require(c.oracle.mismatches == 0, "coverage: %.0f samples differ from the exact oracle (bound %.0f)",
          static_cast<double>(c.oracle.mismatches), 0);
  require(c.stage_mismatches == 0, "engine: %.0f stored values differ from what the stages compute (bound %.0f)",
          static_cast<double>(c.stage_mismatches), 0);
  require(c.datapath.max <= depth_bound,
          "depth: %.3f LSB from the exact plane through the snapped vertices (bound %.2f)", c.datapath.max,
          depth_bound);
  require(c.line_datapath.max <= line_depth_error_bound(config),
          "depth of lines: %.3f LSB from the exact value between the snapped ends (bound %.2f)", c.line_datapath.max,
          line_depth_error_bound(config));
  require(!has_population || std::abs(c.datapath_bias.mean) < 0.05,
          "depth: mean error %.4f LSB before rounding (bound %.2f)", c.datapath_bias.mean, 0.05);
  require(c.color_datapath.max <= 1, "colour: %.3f LSB from the exact plane through the snapped vertices (bound %.0f)",
          c.color_datapath.max, 1);
  return broken;
}

}  // namespace halfplane
