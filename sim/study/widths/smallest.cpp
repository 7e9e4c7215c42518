#include "sim/study/widths/smallest.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "model/packets/packet_words.hpp"
#include "model/stages/surface.hpp"
#include "model/widths.hpp"
#include "sim/interrupt.hpp"
#include "sim/study/compare/compare.hpp"
#include "sim/study/depth/fewest_bits.hpp"

namespace halfplane {
namespace {

/// A searched setting. The guard band counts by its logarithm, so that each step is one bit.
struct Axis {
  std::string_view key;
  int Config::*member;
  bool is_logarithm = false;
};
constexpr std::array kAxes{Axis{"depth.bits", &Config::depth_bits},
                           Axis{"plane.local_guard_bits", &Config::local_guard_bits},
                           Axis{"reciprocal.extra_bits", &Config::reciprocal_extra_bits},
                           Axis{"subpixel.bits", &Config::subpixel_bits},
                           Axis{"guard.band", &Config::guard_band, true},
                           Axis{"perspective.bits", &Config::perspective_bits},
                           Axis{"perspective.mantissa_bits", &Config::perspective_mantissa_bits}};
using Point = std::array<int, kAxes.size()>;

std::string refusal(const Config& config) {
  try {
    validate(config);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string broken_line(const char* what, double value, const char* unit, double bound) {
  char text[160];
  std::snprintf(text, sizeof text, "%s: %.4g%s (bound %.4g)", what, value, unit, bound);
  return text;
}

class Search {
 public:
  Search(const std::vector<Scene>& scenes, const Config& start, const ErrorBounds& bounds,
         const std::function<void(int)>& progress)
      : scenes_(scenes),
        start_(start),
        bounds_(bounds),
        progress_(progress),
        has_over_w_(is_any_state(scenes, has_surface)),
        has_colors_over_w_(
            is_any_state(scenes, [](const State& state) { return state.color_interp == ColorInterp::perspective; })) {
    if (bounds.texture && !is_any_state(scenes, [](const State& state) { return state.texture.has_value(); }))
      throw InputError("--texture-error: no scene has a texture; leave it out, or add a scene that has one");
    for (const Scene& scene : scenes)
      if (bounds.fights && !scene.planes)
        throw InputError("--fight-rate: the near and far plane of " + scene.name +
                         " are not known, so no eye depths are; leave it out, or give scenes seen in perspective");
    for (std::size_t a = 0; a < kAxes.size(); ++a) {
      const int value = value_of(start_, a);
      low_[a] = high_[a] = value;
      if (is_fixed(a)) continue;
      low_[a] = setting_range(a).first;
      high_[a] = kAxes[a].is_logarithm ? value : setting_range(a).second;
    }
    // The widest legal configuration: reductions are made where the bits help least.
    for (const std::size_t a : {2U, 1U, 3U, 0U})
      while (!refusal(at(high_)).empty() && high_[a] > value_of(start_, a)) --high_[a];
  }

  Smallest run() {
    Smallest result;
    try {
      result.widest = trial(high_);
      if (result.widest.holds()) {
        raise_lower_ends();
        const Point found = cheapest();
        result.found = trial(found);
        for (std::size_t i = 0; i < scenes_.size(); ++i)
          result.found->scenes[i].fights = fights(scenes_[i], result.found->config);
        for (std::size_t a = 0; a < kAxes.size(); ++a)
          if (!is_over_w(a) || !is_fixed(a)) result.one_less.push_back(one_less(found, a));
      }
    } catch (const Interrupted&) {
      if (!result.found) result.found = cheapest_so_far();
    }
    result.trials = static_cast<int>(trials_.size());
    return result;
  }

 private:
  template <class Has>
  [[nodiscard]] static bool is_any_state(const std::vector<Scene>& scenes, Has&& has) {
    return std::ranges::any_of(scenes, [&has](const Scene& scene) { return std::ranges::any_of(scene.states, has); });
  }

  [[nodiscard]] static bool is_over_w(std::size_t a) {
    return kAxes[a].member == &Config::perspective_bits || kAxes[a].member == &Config::perspective_mantissa_bits;
  }

  [[nodiscard]] long cost(const Config& config) const { return hardware_bits(config, has_over_w_).total(); }

  /// None before the widest was measured.
  [[nodiscard]] std::optional<TriedConfig> cheapest_so_far() const {
    const TriedConfig* best = nullptr;
    for (const auto& [point, trial] : trials_)
      if (trial.holds() && (best == nullptr || cost(trial.config) < cost(best->config))) best = &trial;
    return best == nullptr ? std::nullopt : std::optional(*best);
  }

  void report() const {
    if (progress_) progress_(static_cast<int>(trials_.size()));
  }

  [[nodiscard]] bool is_fixed(std::size_t a) const {
    if (kAxes[a].member == &Config::subpixel_bits) return !bounds_.coverage;
    if (kAxes[a].member == &Config::depth_bits) return !bounds_.depth && !bounds_.fights;
    if (is_over_w(a)) return !bounds_.texture && !(bounds_.color && has_colors_over_w_);
    if (kAxes[a].is_logarithm) return false;
    return !bounds_.depth && !bounds_.color && !bounds_.fights;
  }

  static int value_of(const Config& config, std::size_t a) {
    const int value = config.*kAxes[a].member;
    return kAxes[a].is_logarithm ? floor_log2(static_cast<uint128>(value)) : value;
  }

  static std::pair<int, int> setting_range(std::size_t a) {
    const auto all = settings();
    const auto setting = std::find_if(all.begin(), all.end(), [a](const Setting& s) { return s.key == kAxes[a].key; });
    if (!kAxes[a].is_logarithm) return {setting->min, setting->max};
    return {floor_log2(static_cast<uint128>(setting->min)), floor_log2(static_cast<uint128>(setting->max))};
  }

  [[nodiscard]] Config at(const Point& point) const {
    Config config = start_;
    for (std::size_t a = 0; a < kAxes.size(); ++a)
      config.*kAxes[a].member = kAxes[a].is_logarithm ? 1 << point[a] : point[a];
    return config;
  }

  /// The fraction of the overlapping pairs that fights, if there are any and their eye depths are known.
  [[nodiscard]] std::optional<double> fights(const Scene& scene, const Config& config) const {
    if (!scene.planes) return std::nullopt;
    MeasureOptions options;
    options.wants_errors = false;
    options.progress = [this](double) { report(); };
    const DepthOrder order = measure_depth(scene, stored_plane(config, *scene.planes), options).order;
    return order.pairs == 0 ? std::nullopt : std::optional(order.rate());
  }

  /// Measures one scene. Returns the broken bound.
  [[nodiscard]] std::string measure(const Scene& scene, const Config& config, SceneErrors& errors) const {
    CompareOptions options;
    options.progress = [this](double) { report(); };
    const Comparison c = compare(scene, config, options);
    errors.depth = std::max(c.datapath.max, c.line_datapath.max) / (std::ldexp(1.0, config.depth_bits) - 1);
    errors.color = std::max(c.color_datapath.max, c.color_over_w.max);
    errors.texture = c.texture ? c.texture->coordinate.max : 0;
    errors.coverage = c.coverage.missing + c.coverage.extra;
    if (bounds_.depth && errors.depth > *bounds_.depth)
      return broken_line("depth", errors.depth, " of the range", *bounds_.depth);
    if (bounds_.coverage && errors.coverage > *bounds_.coverage)
      return broken_line("coverage", static_cast<double>(errors.coverage), " pixels missing or extra",
                         static_cast<double>(*bounds_.coverage));
    if (bounds_.color && errors.color > *bounds_.color)
      return broken_line("colour", errors.color, " LSB", *bounds_.color);
    if (bounds_.texture && errors.texture > *bounds_.texture)
      return broken_line("texture coordinate", errors.texture, " texels", *bounds_.texture);
    if (bounds_.fights) errors.fights = fights(scene, config);
    if (errors.fights && *errors.fights >= *bounds_.fights)
      return broken_line("fights", 100 * *errors.fights, " % of the overlapping pairs", 100 * *bounds_.fights);
    return "";
  }

  const TriedConfig& trial(const Point& point) {
    const auto known = trials_.find(point);
    if (known != trials_.end()) return known->second;
    TriedConfig trial{at(point), {}, ""};
    trial.broken = refusal(trial.config);
    for (const Scene& scene : scenes_) {
      if (!trial.holds()) break;
      try {
        trial.scenes.emplace_back();
        trial.broken = measure(scene, trial.config, trial.scenes.back());
        if (!trial.holds() && scenes_.size() > 1) trial.broken = scene.name + ": " + trial.broken;
      } catch (const InputError& error) {  // a vertex in window space outside a smaller guard band
        if (point == high_) throw;
        trial.scenes.pop_back();
        trial.broken = error.what();
      }
    }
    const TriedConfig& kept = trials_.emplace(point, std::move(trial)).first->second;
    report();
    return kept;
  }

  /// Below these no other setting helps: each is the minimum that works with all others at their maximum.
  void raise_lower_ends() {
    for (std::size_t a = 0; a < kAxes.size(); ++a) {
      int fails = low_[a] - 1, holds = high_[a];
      while (holds - fails > 1) {
        Point point = high_;
        point[a] = (fails + holds) / 2;
        (trial(point).holds() ? holds : fails) = point[a];
      }
      low_[a] = holds;
    }
  }

  /// The cheapest point that keeps the bounds, in order of cost.
  Point cheapest() {
    std::vector<std::pair<long, Point>> points;
    Point point = low_;
    for (bool is_more = true; is_more;) {
      if (refusal(at(point)).empty()) points.emplace_back(cost(at(point)), point);
      is_more = false;
      for (std::size_t a = 0; a < kAxes.size() && !is_more; ++a) {  // counts through all combinations
        is_more = point[a] < high_[a];
        point[a] = is_more ? point[a] + 1 : low_[a];
      }
    }
    std::sort(points.begin(), points.end());
    std::vector<Point> failed;
    for (const auto& [cost, candidate] : points) {
      const bool is_below = std::any_of(failed.begin(), failed.end(), [&p = candidate](const Point& f) {
        for (std::size_t a = 0; a < kAxes.size(); ++a)
          if (p[a] > f[a]) return false;
        return true;
      });
      if (is_below) continue;
      if (trial(candidate).holds()) return candidate;
      failed.push_back(candidate);
    }
    return high_;  // which keeps the bounds
  }

  OneLess one_less(const Point& found, std::size_t a) {
    OneLess less{kAxes[a].key, at(found).*kAxes[a].member, is_fixed(a), ""};
    if (less.is_fixed) return less;
    Point point = found;
    --point[a];
    if (point[a] < setting_range(a).first)
      less.broken = "the least that the setting takes";
    else
      less.broken = trial(point).broken;
    return less;
  }

  const std::vector<Scene>& scenes_;
  const Config& start_;
  const ErrorBounds& bounds_;
  const std::function<void(int)>& progress_;
  const bool has_over_w_, has_colors_over_w_;
  Point low_{}, high_{};
  std::map<Point, TriedConfig> trials_;
};

}  // namespace

HardwareBits hardware_bits(const Config& config, bool has_over_w) {
  const Widths w = derive_widths(config);
  HardwareBits bits;
  bits.packets = packet_bits<PrimitivePacket>(w) + packet_bits<TrianglePacket>(w) + packet_bits<SetupPacket>(w) +
                 packet_bits<TilePacket>(w) + packet_bits<StampPacket>(w) + packet_bits<FragmentPacket>(w) +
                 packet_bits<WritePacket>(w);
  if (config.line_units != 0) bits.packets += packet_bits<LineSetup>(w) + packet_bits<LinePixel>(w);
  bits.context = config.context_slots * (packet_bits<ContextPacket>(w) + packet_bits<EdgeContext>(w));
  bits.products = 2 * (w.edge_product.bits + widest(w, &AttributeWidths::numerator).bits +
                       widest(w, &AttributeWidths::product).bits);
  bits.tiles = long{config.cache_lines} * w.blocks.stamps() * w.samples *
               (w.stored_depth.bits + w.stored_color.bits + config.stencil_bits);
  if (has_over_w) {
    const PerspectiveFormat format = perspective_format(config);
    constexpr long kValues = 3, kCoordinates = 2;  // of a plane: anchor and two steps
    const long planes = q_plane_bits(format, w) + kCoordinates * p_plane_bits(format.coordinate, w) +
                        w.color_planes * p_plane_bits(format.color, w);
    const long divisions = kCoordinates * (format.mantissa_bits + format.coordinate.narrow_bits + 1) +
                           w.color_planes * (format.mantissa_bits + format.color.narrow_bits + 1L);
    bits.over_w = config.context_slots * kValues * planes + divisions;
  }
  return bits;
}

SceneErrors TriedConfig::worst() const {
  SceneErrors worst;
  for (const SceneErrors& scene : scenes) {
    worst.depth = std::max(worst.depth, scene.depth);
    worst.color = std::max(worst.color, scene.color);
    worst.texture = std::max(worst.texture, scene.texture);
    worst.coverage = std::max(worst.coverage, scene.coverage);
    if (scene.fights) worst.fights = std::max(worst.fights.value_or(0), *scene.fights);
  }
  return worst;
}

Smallest find_smallest(const std::vector<Scene>& scenes, const Config& start, const ErrorBounds& bounds,
                       const std::function<void(int trials)>& progress) {
  validate(start);
  return Search(scenes, start, bounds, progress).run();
}

}  // namespace halfplane
