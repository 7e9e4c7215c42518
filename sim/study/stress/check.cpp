#include "sim/study/stress/check.hpp"

#include <gmpxx.h>
#include <algorithm>

#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/golden/exact.hpp"

namespace halfplane::stress {

namespace {

/// |code - exact * scale_numerator / scale_denominator|.
double code_distance(std::uint32_t code, const exact::Rational& exact, int scale_numerator = 1,
                     int scale_denominator = 1) {
  const int128 denominator = exact.denominator * scale_denominator;
  const int128 distance = denominator * static_cast<std::int64_t>(code) - exact.numerator * scale_numerator;
  return static_cast<double>(distance < 0 ? -distance : distance) / static_cast<double>(denominator);
}

constexpr std::uint64_t kUnitsPerFragmentCheck = 8;  // the scalar engine is slow

}  // namespace

Rendering draw(const Scene& scene, const Config& config, const RenderOptions& options) {
  return options.fragment_tap ? render_scalar(scene, config, options) : render_functional(scene, config, options);
}

bool is_drawn_by_hardware(const Scene& scene, const Config& config) {
  try {
    validate(config);
    check_hardware_scene(scene, config);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

RenderOptions render_options() {
  RenderOptions options;
  options.want_count = options.want_ids = options.want_triangles = true;
  return options;
}

AttributeErrors attribute_errors(const Scene& scene, const Config& config, const Rendering& rendering) {
  AttributeErrors errors;
  const int grid_bits = derive_widths(config).grid_bits;
  const auto color_max = golden::channel_max(config.color_format);
  const auto planes = judged_planes(config);
  std::int32_t known = -1;
  std::optional<exact::TriangleOracle> oracle;
  std::size_t p = 0;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x, ++p) {
      const std::int32_t visible = rendering.visible[p];
      if (visible < 0) continue;
      const Triangle& triangle = rendering.triangles[static_cast<std::size_t>(visible)];
      if (visible != known) oracle.emplace(triangle, grid_bits);
      known = visible;
      const std::size_t at = rendering.frame.at(x, y);
      const exact::PlaneWeights weights = oracle->weights_at(x, y);
      ++errors.fragments;
      for (std::size_t i = 0; i < planes.size(); ++i) {
        const exact::Rational exact = weights.plane(plane_codes(triangle, i));
        if (planes[i].is_depth) {
          errors.depth = std::max(errors.depth, code_distance(rendering.frame.depth[at], exact));
          continue;
        }
        if (!planes[i].is_color) continue;  // it is not stored
        const int code =
            golden::stored_channel(rendering.frame.color[at], config.color_format, static_cast<int>(i - kColorPlane));
        errors.color = std::max(
            errors.color, code_distance(static_cast<std::uint32_t>(code), exact, color_max[i - kColorPlane], 255));
      }
    }
  return errors;
}

/// Judges every fragment of the scene before the operations. Adds no figure: it passes or fails.
static void check_fragments(Unit& unit, const Scene& scene, const Engine& engine, FillRule rule) {
  FragmentJudge judge(scene, unit.config, rule);
  RenderOptions options;
  options.rules.fill_rule = rule;
  options.fragment_tap = [&judge](const TappedFragment& fragment) { judge.add(fragment); };
  const auto broken = broken_fragment_bounds(judge.finish(engine(scene, unit.config, options)), unit.config);
  if (!broken.empty()) unit.require(false, "fragments", scene, broken.front());
}

Rendering check_scene(Unit& unit, const Scene& scene, FillRule rule) {
  std::vector<CoverageLog> logs = coverage_logs(unit.config);
  RenderOptions options = render_options();
  options.rules.fill_rule = rule;
  options.coverage_tap = [&logs](std::uint32_t triangle, int tile_x, int tile_y, const TileMask& mask, int sample) {
    logs[static_cast<std::size_t>(sample)].add(triangle, tile_x, tile_y, mask);
  };
  // Only the scalar engine has the study rules.
  const Engine engine = rule == FillRule::top_left ? unit.engine : Engine(render_scalar);
  Rendering rendering = engine(scene, unit.config, options);
  if (unit.number % kUnitsPerFragmentCheck == 0) check_fragments(unit, scene, engine, rule);
  // With taps the functional engine draws by the stages.
  if (rule == FillRule::top_left) expect_same_image(unit, scene, rendering, unit.engine(scene, unit.config, {}));
  for (CoverageLog& log : logs) log.sort();
  const OracleResult oracle = check_coverage(scene, unit.config, rendering.triangles, logs, rule);
  unit.count_triangles(rendering.triangles.size());
  unit.count_samples(oracle.samples);
  unit.measure("coverage", "samples", static_cast<double>(oracle.mismatches), 0, scene);
  const AttributeErrors errors = attribute_errors(scene, unit.config, rendering);
  unit.count_samples(errors.fragments);
  unit.measure("depth", "LSB", errors.depth, depth_error_bound(unit.config), scene, rule);
  unit.measure("color", "LSB", errors.color, 1, scene);
  return rendering;
}

bool polygon_covers(std::span<const Point> polygon, int x, int y, int subpixel_bits) {
  // Twice the grid, so that centres lie on it at S = 0 too.
  const std::int64_t pixel = std::int64_t{2} << subpixel_bits;
  const std::int64_t px = x * pixel + pixel / 2, py = y * pixel + pixel / 2;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const std::int64_t dx = b.x - a.x, dy = b.y - a.y;
    const std::int64_t e = dx * (py - 2 * a.y) - dy * (px - 2 * a.x);
    const bool owns = dy < 0 || (dy == 0 && dx > 0);
    if (e < 0 || (e == 0 && !owns)) return false;
  }
  return true;
}

void expect_once(Unit& unit, const Scene& scene, const Rendering& rendering, std::span<const Point> polygon) {
  expect_count(unit, scene, rendering,
               [&](int x, int y) { return polygon_covers(polygon, x, y, unit.config.subpixel_bits) ? 1 : 0; });
}

void expect_same_image(Unit& unit, const Scene& scene, const Rendering& a, const Rendering& b) {
  std::uint64_t wrong = a.frame.samples.size() == b.frame.samples.size() ? 0 : 1;
  for (std::size_t k = 0; k < a.frame.samples.size() && k < b.frame.samples.size(); ++k) {
    const Framebuffer &of_a = a.frame.samples[k], &of_b = b.frame.samples[k];
    wrong += of_a.depth != of_b.depth || of_a.color != of_b.color || of_a.stencil != of_b.stencil ? 1 : 0;
  }
  std::size_t p = 0;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x, ++p) {
      const std::size_t at = a.frame.at(x, y), bt = b.frame.at(x, y);
      const bool same_count = a.count.empty() || b.count.empty() || a.count[p] == b.count[p];
      wrong += a.frame.depth[at] != b.frame.depth[bt] || a.frame.color[at] != b.frame.color[bt] || !same_count ? 1 : 0;
    }
  unit.count_checks(p);
  unit.measure("image", "pixels", static_cast<double>(wrong), 0, scene);
}

namespace {

/// floor(value * scale + 1/2).
mpz_class snapped(double value, const mpz_class& scale) {
  const mpq_class moved = mpq_class(value) * mpq_class(scale) + mpq_class(1, 2);
  mpz_class floor;
  mpz_fdiv_q(floor.get_mpz_t(), moved.get_num_mpz_t(), moved.get_den_mpz_t());
  return floor;
}

/// z = (d - a x - b y) / c, coordinates in subpixels, depth in codes.
struct ExactPlane {
  mpz_class a, b, c, d;
};

ExactPlane plane_through(const Scene& scene, std::size_t first_index, const Config& config) {
  const mpz_class pixel = mpz_class(1) << static_cast<mp_bitcnt_t>(config.subpixel_bits);
  const mpz_class codes = (mpz_class(1) << static_cast<mp_bitcnt_t>(config.depth_bits)) - 1;
  std::array<std::array<mpz_class, 3>, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vertex& v = scene.vertices[scene.indices[first_index + i]];
    p[i] = {snapped(v.x, pixel), snapped(v.y, pixel), snapped(v.z, codes)};
  }
  const auto difference = [&p](std::size_t i, std::size_t k) { return mpz_class(p[i][k] - p[0][k]); };
  ExactPlane plane;  // the cross product of two edges
  plane.a = difference(1, 1) * difference(2, 2) - difference(1, 2) * difference(2, 1);
  plane.b = difference(1, 2) * difference(2, 0) - difference(1, 0) * difference(2, 2);
  plane.c = difference(1, 0) * difference(2, 1) - difference(1, 1) * difference(2, 0);
  plane.d = plane.a * p[0][0] + plane.b * p[0][1] + plane.c * p[0][2];
  return plane;
}

bool can_judge(const Scene& scene, const Config& config) {
  if (config.depth_format != DepthFormat{} || config.depth_mapping != DepthMapping::projection) return false;
  for (const Command& command : scene.commands) {
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    const State& s = scene.states[draw->state];
    if (draw->topology != Topology::triangles || s.space != Space::window || s.polygon_mode != PolygonMode::fill ||
        s.polygon_offset != std::array{0.0, 0.0} || s.pixel_center != PixelCenter::half ||
        s.origin != Origin::top_left || !s.depth_write)
      return false;
  }
  return true;
}

}  // namespace

std::optional<double> measured_depth_error(const Scene& scene, const Config& config, const Engine& engine) {
  if (!can_judge(scene, config)) return std::nullopt;
  std::vector<std::size_t> first_index;  // of each primitive
  for (const Command& command : scene.commands)
    if (const auto* draw = std::get_if<Draw>(&command))
      for (std::size_t i = 0; i + 2 < draw->count; i += 3) first_index.push_back(draw->first + i);
  RenderOptions options;
  options.want_ids = true;
  const Rendering rendering = engine(scene, config, options);
  const mpz_class doubled_pixel = mpz_class(2) << static_cast<mp_bitcnt_t>(config.subpixel_bits);
  mpq_class worst = 0;
  std::int32_t known = -1;
  ExactPlane plane;
  std::size_t p = 0;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x, ++p) {
      const std::int32_t id = rendering.ids[p];
      if (id < 0) continue;
      if (id != known) plane = plane_through(scene, first_index[static_cast<std::size_t>(id)], config);
      known = id;
      const mpz_class px = doubled_pixel * x + doubled_pixel / 2, py = doubled_pixel * y + doubled_pixel / 2;  // halves
      const mpz_class stored(static_cast<unsigned long>(rendering.frame.depth[rendering.frame.at(x, y)]));
      mpq_class error(stored * 2 * plane.c - (2 * plane.d - plane.a * px - plane.b * py), 2 * plane.c);
      error.canonicalize();
      worst = std::max(worst, mpq_class(abs(error)));
    }
  return worst.get_d();
}

}  // namespace halfplane::stress
