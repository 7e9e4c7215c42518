#include "sim/study/depth/measure.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "model/engines/functional.hpp"
#include "model/golden/exact.hpp"
#include "model/host/primitives.hpp"
#include "model/scene.hpp"
#include "model/stages/interpolate.hpp"
#include "model/stages/triangle_setup.hpp"
#include "sim/interrupt.hpp"
#include "sim/scene/depth_mapping.hpp"
#include "sim/study/compare/coverage.hpp"
#include "sim/study/depth/error_bound.hpp"

namespace halfplane {

namespace {

/// 1/w over the screen, from the triangle's unsnapped clip coordinates, uncut: 1/w = a x + b y + c, pixels, y down. If
/// w is the eye depth, as in every perspective projection, this is 1 / eye depth.
struct EyePlane {
  double a = 0, b = 0, c = 0;  ///< all 0: a triangle seen edge-on, or not a filled triangle

  [[nodiscard]] bool is_empty() const { return a == 0 && b == 0 && c == 0; }
  /// At the centre of a pixel.
  [[nodiscard]] double eye_depth(int x, int y) const { return 1 / (a * (x + 0.5) + b * (y + 0.5) + c); }
};

using Wide = long double;  // slivers cancel digits of the determinant

EyePlane plane_of(const Viewport& vp, const Vertex& v0, const Vertex& v1, const Vertex& v2) {
  // Each vertex at (X, Y) = (x w, y w) in pixels times w solves a X + b Y + c W = 1.
  Wide m[3][3];
  const Vertex* const vertices[3] = {&v0, &v1, &v2};
  for (int i = 0; i < 3; ++i) {
    const Vertex& v = *vertices[i];
    m[i][0] = vp.x * static_cast<Wide>(v.w) + (static_cast<Wide>(v.x) + v.w) / 2 * vp.width;
    m[i][1] = vp.y * static_cast<Wide>(v.w) + (static_cast<Wide>(v.w) - v.y) / 2 * vp.height;
    m[i][2] = v.w;
  }
  Wide cofactor[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int r = (i + 1) % 3, s = (i + 2) % 3, p = (j + 1) % 3, q = (j + 2) % 3;
      cofactor[i][j] = m[r][p] * m[s][q] - m[r][q] * m[s][p];
    }
  const Wide determinant = m[0][0] * cofactor[0][0] + m[0][1] * cofactor[0][1] + m[0][2] * cofactor[0][2];
  if (determinant == 0) return {};
  Wide sum[3];
  for (int j = 0; j < 3; ++j) sum[j] = (cofactor[0][j] + cofactor[1][j] + cofactor[2][j]) / determinant;
  return {static_cast<double>(sum[0]), static_cast<double>(sum[1]), static_cast<double>(sum[2])};
}

/// By number of the input primitive over the whole scene, as in Rendering::ids. Throws InputError for a scene whose
/// filled triangles are not all in clip space, or that changes depth by depth_range or polygon_offset: its eye depth is
/// unknown; and for a scene that clears depth between its draws or has several frames.
std::vector<EyePlane> eye_planes(const Scene& scene) {
  std::vector<EyePlane> planes;
  bool has_ended = false;
  for (const Command& command : scene.commands) {
    const auto* clear = std::get_if<Clear>(&command);
    if (!planes.empty() && (std::holds_alternative<EndFrame>(command) || (clear != nullptr && clear->depth)))
      has_ended = true;
    const auto* draw = std::get_if<Draw>(&command);
    if (draw == nullptr) continue;
    if (has_ended)
      throw InputError(place_of_draw(scene.name, draw->line) +
                       ": depth is measured on one frame with one clear of depth before it; leave the rest out");
    const State& state = scene.states[draw->state];
    if (drawn_as(state, draw->topology) != PrimitiveType::triangle) {
      planes.resize(planes.size() + primitive_count(scene, *draw));
      continue;
    }
    if (state.space != Space::clip || state.depth_range != std::array{0.0, 1.0} ||
        state.polygon_offset != std::array{0.0, 0.0})
      throw InputError(place_of_draw(scene.name, draw->line) +
                       ": depth is measured on clip-space triangles without depth_range and polygon_offset, whose eye "
                       "depth is their w; leave the state out");
    const Viewport viewport = effective_viewport(state, scene.width, scene.height);
    for_each_triangle(scene, *draw, state.provoking, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      planes.push_back(plane_of(viewport, scene.vertices[a], scene.vertices[b], scene.vertices[c]));
    });
  }
  return planes;
}

/// One sample of one triangle.
struct Fragment {
  std::uint32_t pixel, code;
  double eye_depth;  ///< exact
};

/// Errors of one decade of eye depth during collection.
struct DecadeSet {
  ErrorSet error;
  MomentSet snap, interpolation, storage;
  double bound = 0, worst_share = 0;
};

class Measurer {
 public:
  Measurer(const Scene& scene, const DepthVariant& variant, const MeasureOptions& options)
      : scene_(mapped(scene, variant)),
        variant_(variant),
        config_(variant.config),
        options_(options),
        widths_(derive_widths(config_)),
        encode_(config_, variant.planes),
        bound_(variant),
        planes_(eye_planes(scene_)),
        plane_top_(std::ldexp(1.0, config_.depth_bits) - 1),
        pixels_(static_cast<std::size_t>(scene_.width) * static_cast<std::size_t>(scene_.height)) {}

  DepthMeasurement run() {
    CoverageLog log(config_.tile_size);
    RenderOptions render;
    render.want_ids = true;
    render.progress = [this](double fraction) { report(0.2 * fraction); };
    render.coverage_tap = [&log](std::uint32_t triangle, int tile_x, int tile_y, const TileMask& mask, int) {
      log.add(triangle, tile_x, tile_y, mask);
    };
    rendering_ = render_functional(scene_, config_, render);
    log.sort();
    if (options_.wants_maps) {
      result_.error.assign(pixels_, std::numeric_limits<float>::quiet_NaN());
      result_.fights.assign(pixels_, 0);
    }
    result_.triangles = rendering_.triangles.size();
    fragments_.reserve(rendering_.counters.covered);
    walk(log);
    rendering_ = {};
    put_in_order();
    finish();
    result_.is_whole = true;
    return std::move(result_);
  }

 private:
  static Scene mapped(Scene scene, const DepthVariant& variant) {
    scene.planes = variant.planes;
    return in_depth_mapping(std::move(scene), variant.mapping);
  }

  void report(double fraction) const {
    if (options_.progress) options_.progress(fraction);
  }

  void walk(const CoverageLog& log) {
    const auto& visits = log.visits();
    TriangleSetup setup;
    std::uint32_t triangle = ~0U;
    bool is_flat = false;
    DepthBudget budget;
    for (std::size_t i = 0; i < visits.size(); ++i) {
      const CoverageLog::Visit& visit = visits[i];
      const Triangle& t = rendering_.triangles[visit.triangle];
      const EyePlane& plane = planes_[t.primitive];
      if (visit.triangle != triangle) {
        triangle = visit.triangle;
        setup = setup_triangle(t, config_, widths_);
        is_flat = t.v[0].depth() == t.v[1].depth() && t.v[1].depth() == t.v[2].depth();
        budget = bound_.budget(std::abs(bound_.scale().t_per_inverse_z()) * (std::abs(plane.a) + std::abs(plane.b)),
                               is_flat);
      }
      if (i % 256 == 0) report(0.2 + 0.6 * static_cast<double>(i) / static_cast<double>(visits.size()));
      if (plane.is_empty()) continue;
      for (int row = 0; row < config_.tile_size; ++row)
        for (int column = 0; column < config_.tile_size; ++column)
          if (log.test(visit, column, row))
            sample(visit.triangle, t, setup, plane, budget, (visit.tile_x << widths_.tile_shift) + column,
                   (visit.tile_y << widths_.tile_shift) + row);
    }
  }

  void sample(std::uint32_t index, const Triangle& t, const TriangleSetup& setup, const EyePlane& plane,
              const DepthBudget& budget, int x, int y) {
    const PlaneSample depth = plane_at(setup, kDepthPlane, widths_, x, y);
    const std::uint32_t code = encode_(depth.code);
    const double u = plane.eye_depth(x, y);
    if (!(u > 0) || std::isinf(u)) {  // covered by the snapped triangle only: there the true one is behind the eye
      ++result_.beyond;
      return;
    }
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(scene_.width) + static_cast<std::size_t>(x);
    fragments_.push_back({static_cast<std::uint32_t>(pixel), code, u});
    const bool is_visible = rendering_.visible[pixel] == static_cast<std::int32_t>(index);
    if (is_visible && rendering_.frame.depth[rendering_.frame.at(x, y)] != code &&
        scene_.states[std::get<Draw>(scene_.commands[t.draw]).state].depth_write)
      ++result_.stage_mismatches;
    if (options_.wants_errors) errors(t, depth, code, u, budget, x, y, is_visible ? &pixel : nullptr);
  }

  void errors(const Triangle& t, const PlaneSample& depth, std::uint32_t code, double u, const DepthBudget& budget,
              int x, int y, const std::size_t* visible) {
    const DepthScale& scale = bound_.scale();
    const exact::Rational plane = exact::depth_at(t, x, y, widths_.grid_bits);
    const double s = scale.z_of_t(
        static_cast<double>(static_cast<long double>(plane.numerator) / static_cast<long double>(plane.denominator)) /
        plane_top_);
    const double h =
        scale.z_of_t(std::ldexp(static_cast<double>(depth.unrounded), -config_.local_guard_bits) / plane_top_);
    const double d = scale.z_of_d(static_cast<double>(encode_.window_value(code)));
    if (!(s > 0 && h > 0 && d > 0) || std::isinf(s + h + d)) {
      ++result_.beyond;
      return;
    }
    snap_.add(s - u);
    interpolation_.add(h - s);
    storage_.add(d - h);
    total_.add(d - u);
    DecadeSet& decade = decades_[static_cast<int>(std::floor(std::log10(u)))];
    const double bound = bound_.error(u, budget);
    decade.error.add(d - u);
    decade.snap.add(s - u);
    decade.interpolation.add(h - s);
    decade.storage.add(d - h);
    decade.bound = std::max(decade.bound, bound);
    decade.worst_share = std::max(decade.worst_share, std::abs(d - u) / bound);
    if (visible != nullptr && !result_.error.empty()) result_.error[*visible] = static_cast<float>(d - u);
  }

  /// Sorts the fragments by pixel and exact depth, and compares each pair of a pixel.
  void put_in_order() {
    std::vector<std::uint32_t> first(pixels_ + 1, 0);
    for (const Fragment& f : fragments_) ++first[f.pixel + 1];
    for (std::size_t p = 0; p < pixels_; ++p) first[p + 1] += first[p];
    std::vector<Fragment> sorted(fragments_.size());
    std::vector<std::uint32_t> next = first;
    for (const Fragment& f : fragments_) sorted[next[f.pixel]++] = f;
    result_.fragments = fragments_.size();
    fragments_ = {};  // large scenes: 16 bytes a fragment, twice
    result_.eye_min = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < pixels_; ++p) {
      const std::span<Fragment> here(sorted.data() + first[p], first[p + 1] - first[p]);
      std::sort(here.begin(), here.end(),
                [](const Fragment& a, const Fragment& b) { return a.eye_depth < b.eye_depth; });
      if (!here.empty()) {
        result_.eye_min = std::min(result_.eye_min, here.front().eye_depth);
        result_.eye_max = std::max(result_.eye_max, here.back().eye_depth);
      }
      pairs(p, here);
    }
    if (sorted.empty()) result_.eye_min = 0;
  }

  void pairs(std::size_t pixel, std::span<const Fragment> here) {
    // A pixel with very many layers is compared within a neighbourhood, or time would grow with their square.
    constexpr std::size_t kNeighbours = 64;
    const bool is_turned = is_reversed(variant_.mapping);
    DepthOrder& order = result_.order;
    bool has_tie = false, has_inversion = false, has_pair = false;
    for (std::size_t i = 0; i < here.size(); ++i)
      for (std::size_t j = i + 1; j < std::min(here.size(), i + 1 + kNeighbours); ++j) {
        const Fragment &nearer = here[i], &farther = here[j];
        if (farther.eye_depth - nearer.eye_depth <= 1e-12 * farther.eye_depth) continue;
        has_pair = true;
        ++order.pairs;
        const bool is_tie = nearer.code == farther.code;
        const bool is_inverted = !is_tie && (nearer.code > farther.code) != is_turned;
        if (!is_tie && !is_inverted) continue;
        ++(is_tie ? order.ties : order.inversions);
        (is_tie ? has_tie : has_inversion) = true;
        if (order.nearest_fight == 0 || nearer.eye_depth < order.nearest_fight) order.nearest_fight = nearer.eye_depth;
      }
    order.fighting_pixels += has_tie || has_inversion ? 1 : 0;
    if (!result_.fights.empty())
      result_.fights[pixel] = static_cast<std::uint8_t>(has_inversion ? 3 : has_tie ? 2 : has_pair ? 1 : 0);
  }

  void finish() {
    result_.total = total_.stats();
    result_.snap = snap_.stats();
    result_.interpolation = interpolation_.stats();
    result_.storage = storage_.stats();
    for (const auto& [power, set] : decades_) {
      const DepthDecade decade{
          std::pow(10.0, power),     std::pow(10.0, power + 1), set.error.stats(), set.snap.stats(),
          set.interpolation.stats(), set.storage.stats(),       set.bound,         set.worst_share};
      result_.worst_share = std::max(result_.worst_share, set.worst_share);
      result_.decades.push_back(decade);
    }
  }

  const Scene scene_;
  const DepthVariant& variant_;
  const Config& config_;
  const MeasureOptions& options_;
  const Widths widths_;
  const DepthEncode encode_;
  const DepthBound bound_;
  const std::vector<EyePlane> planes_;
  const double plane_top_;
  const std::size_t pixels_;
  Rendering rendering_;
  std::vector<Fragment> fragments_;
  MomentSet snap_, interpolation_, storage_;
  ErrorSet total_;
  std::map<int, DecadeSet> decades_;  ///< by power of ten
  DepthMeasurement result_;
};

}  // namespace

DepthMeasurement measure_depth(const Scene& scene, const DepthVariant& variant, const MeasureOptions& options) {
  return Measurer(scene, variant, options).run();
}

std::vector<DepthMeasurement> measure_depths(const Scene& scene, std::span<const DepthVariant> variants,
                                             const MeasureOptions& options, int threads) {
  std::vector<DepthMeasurement> results(variants.size());
  std::vector<double> fractions(variants.size(), 0);
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < variants.size(); i = next++) {
      MeasureOptions own = options;
      own.progress = [&, i](double fraction) {
        const std::lock_guard lock(mutex);
        fractions[i] = fraction;
        double sum = 0;
        for (const double f : fractions) sum += f;
        if (options.progress) options.progress(sum / static_cast<double>(variants.size()));
      };
      try {
        results[i] = measure_depth(scene, variants[i], own);
        own.progress(1);
      } catch (const Interrupted&) {
        next = variants.size();
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
        next = variants.size();
      }
    }
  };
  std::vector<std::jthread> workers;
  for (std::size_t i = 1; i < std::min(static_cast<std::size_t>(threads), variants.size()); ++i)
    workers.emplace_back(work);
  work();
  workers.clear();  // joins
  if (failure) std::rethrow_exception(failure);
  return results;
}

}  // namespace halfplane
