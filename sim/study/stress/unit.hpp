// A unit of stress: one random input of one case in one configuration, and the record of its checks and results.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "model/widths.hpp"
#include "sim/scene/random.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane::stress {

/// SplitMix64 with the functions that generators need. Draw at most one number in the arguments of a call.
class Random : public halfplane::Random {
 public:
  using halfplane::Random::Random;
  double unit() { return uniform(0, 1); }
  double between(double low, double high) { return uniform(low, high); }
  /// In [0, count).
  int index(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }
  /// In [low, high].
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(next() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool coin() { return (next() >> 63) != 0; }
};

/// The place of a unit, to find it again.
struct Place {
  std::uint64_t unit = 0;
  Config config;
  Scene scene;                         ///< may be empty: not every check draws a scene
  FillRule rule = FillRule::top_left;  ///< used for drawing
};

/// The worst of one property so far.
struct Worst {
  double value = 0;
  double bound = 0;
  std::string unit;  ///< "LSB", "samples", ...
  Place place;
  std::optional<double> measured;  ///< by the independent checker, if it supports the property

  /// Nearness to its bound; a bound of 0 is broken by any value.
  [[nodiscard]] double ratio() const { return bound > 0 ? value / bound : value; }
};

/// A requirement that did not hold.
struct Failure {
  std::string property, what;
  Place place;
};

/// Sums from which a mean and its standard error follow. The fragments of one triangle share its errors, so triangles are
/// the sampled clusters. Errors are integers of 2^-20 LSB: the sums do not depend on their order.
struct BiasSums {
  std::uint64_t triangles = 0, fragments = 0;
  int128 sum = 0, sum_squares = 0, sum_products = 0, count_squares = 0;  ///< of s, s^2, s n, n^2 over the triangles

  void add_triangle(std::int64_t error_sum, std::int64_t count);
  void add(const BiasSums& other);
  [[nodiscard]] double mean() const;            ///< LSB
  [[nodiscard]] double standard_error() const;  ///< LSB; of the ratio estimator
};

/// Results of one case; sums and maxima, so that the parts of several threads merge into the same total.
struct Tally {
  std::uint64_t units = 0, triangles = 0, failures = 0;
  std::uint64_t samples = 0;        ///< triangle-sample checks: samples and fragments compared with the exact oracle
  std::uint64_t checks = 0;         ///< these, and all other comparisons: pixels of two images, yes-or-no properties
  std::set<std::uint64_t> configs;  ///< numbers of the configurations visited
  std::map<std::string, Worst, std::less<>> worst;
  std::map<std::string, double, std::less<>> preset_depth;  ///< the worst "depth" in each unchanged preset, LSB
  std::map<std::string, BiasSums, std::less<>> bias;        ///< by the label of the configuration
  std::map<std::string, Config, std::less<>> bias_config;
  std::uint64_t bias_judged = 0;  ///< configurations whose mean is exact enough to be judged
  std::optional<Failure> first;   ///< the failure of the lowest unit

  void keep_worst(const std::string& property, Worst candidate);
  void keep_first(Failure failure);
  void merge(Tally&& other);
};

/// Input and record of a case.
class Unit {
 public:
  Unit(const Config& config_, std::uint64_t number_, std::uint64_t seed, const Engine& engine_, Tally& tally)
      : config(config_),
        widths(derive_widths(config_)),
        number(number_),
        random(seed),
        engine(engine_),
        tally_(tally) {}

  /// The same unit in another configuration, which must outlive it.
  Unit(const Unit& other, const Config& config_) : Unit(config_, other.number, 0, other.engine, other.tally_) {}

  const Config& config;
  const Widths widths;
  const std::uint64_t number;
  Random random;
  const Engine& engine;        ///< draws the scenes; a test puts a faulty one here
  std::function<void()> poll;  ///< for long work without the engine: throws when the run was ended; may be empty

  void count_triangles(std::uint64_t n) { tally_.triangles += n; }
  /// Samples whose coverage, or fragments whose depth and colour, were compared with the exact oracle.
  void count_samples(std::uint64_t n) {
    tally_.samples += n;
    tally_.checks += n;
  }
  /// Other comparisons.
  void count_checks(std::uint64_t n) { tally_.checks += n; }
  /// A configuration other than `config` used by the unit.
  void count_config(std::uint64_t id) { tally_.configs.insert(id); }
  /// A yes-or-no property: counts as one check. `scene` is saved when it fails. Returns `holds`.
  bool require(bool holds, std::string_view property, const Scene& scene, std::string_view what);
  /// A measured figure against its bound; the worst of all units is kept with its scene.
  void measure(std::string_view property, std::string_view unit, double value, double bound, const Scene& scene,
               FillRule rule = FillRule::top_left);
  /// One triangle's errors for the mean of this configuration.
  void add_bias(std::int64_t error_sum, std::int64_t count);

  /// A target of at most this size that the configuration supports.
  [[nodiscard]] int width(int wanted) const { return std::min({wanted, config.target_width, inside_band()}); }
  [[nodiscard]] int height(int wanted) const { return std::min({wanted, config.target_height, inside_band()}); }
  /// Units of the grid on which window coordinates lie, per pixel: 2^S.
  [[nodiscard]] int pixel() const { return 1 << config.subpixel_bits; }

 private:
  /// Room for vertices outside the target on every side.
  [[nodiscard]] int inside_band() const { return config.guard_band - 8; }

  Tally& tally_;
};

}  // namespace halfplane::stress
