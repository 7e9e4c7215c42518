#include "sim/study/stress/run.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "model/engines/scalar.hpp"
#include "sim/interrupt.hpp"
#include "sim/study/stress/check.hpp"
#include "sim/study/stress/grid.hpp"

namespace halfplane::stress {
namespace {

constexpr double kBiasBound = 0.05;           // LSB
constexpr double kBiasStandardError = 0.002;  // LSB: a mean with a larger error is not judged

std::vector<const Case*> chosen(const std::vector<std::string>& names) {
  std::vector<const Case*> list;
  for (const Case& c : cases())
    if (names.empty() || std::find(names.begin(), names.end(), c.name) != names.end()) list.push_back(&c);
  for (const std::string& name : names)
    if (std::none_of(list.begin(), list.end(), [&name](const Case* c) { return c->name == name; }))
      throw InputError("--case: no case '" + name + "'; `halfplane stress --list` shows them all");
  return list;
}

/// A different sequence for each seed, case and unit.
std::uint64_t unit_seed(std::uint64_t seed, std::string_view name, std::uint64_t unit) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return halfplane::Random(seed ^ halfplane::Random(hash ^ halfplane::Random(unit).next()).next()).next();
}

/// Data shared by all threads, and the work of each.
class Driver {
 public:
  explicit Driver(const RunOptions& options)
      : options_(options), cases_(chosen(options.names)), engine_(options.engine ? options.engine : Engine(draw)) {}

  std::vector<CaseResult> run() {
    const auto threads = static_cast<std::size_t>(std::max(1, options_.threads));
    std::vector<std::vector<Tally>> tallies(threads, std::vector<Tally>(cases_.size()));
    std::vector<std::thread> helpers;
    for (std::size_t t = 1; t < threads; ++t) helpers.emplace_back([this, &tallies, t] { work(tallies[t], false); });
    work(tallies[0], true);
    for (std::thread& helper : helpers) helper.join();
    std::vector<CaseResult> results;
    for (std::size_t c = 0; c < cases_.size(); ++c) {
      results.push_back({cases_[c], std::move(tallies[0][c])});
      for (std::size_t t = 1; t < threads; ++t) results.back().tally.merge(std::move(tallies[t][c]));
      judge(results.back());
    }
    return results;
  }

 private:
  /// 0...1, and 1 when no further unit is started.
  [[nodiscard]] double fraction(std::uint64_t task) const {
    const auto all = static_cast<double>((options_.unit ? 1 : quick_rounds()) * cases_.size());
    if (options_.seconds <= 0 || options_.unit) return static_cast<double>(task) / all;
    if (task < cases_.size()) return 0;  // one unit of each case, for any time limit
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count() / options_.seconds;
  }

  void work(std::vector<Tally>& tallies, bool reports) {
    try {
      work_until_stopped(tallies, reports);
    } catch (const Interrupted&) {  // checks made by then count
    }
  }

  /// Throws Interrupted inside a long unit.
  void work_until_stopped(std::vector<Tally>& tallies, bool reports) {
    double done = 0;
    const auto poll = [this, &done, reports] {
      if (is_stopped_ || (reports && !goes_on(done))) throw Interrupted{};
    };
    const Engine engine = [this, &poll](const Scene& scene, const Config& config, const RenderOptions& options) {
      poll();
      RenderOptions polling = options;
      polling.progress = [&poll](double) { poll(); };
      return engine_(scene, config, polling);
    };
    for (;;) {
      const std::uint64_t task = next_task_++;
      done = fraction(task);
      if (done >= 1) return;
      poll();
      const std::size_t c = static_cast<std::size_t>(task % cases_.size());
      const std::uint64_t round = task / cases_.size(), every = static_cast<std::uint64_t>(cases_[c]->every);
      if (options_.unit)
        run_unit(*cases_[c], *options_.unit, engine, poll, tallies[c]);
      else if (round % every == 0)
        run_unit(*cases_[c], round / every, engine, poll, tallies[c]);
    }
  }

  /// Whether the progress callback lets the run continue; if not, no further unit starts.
  bool goes_on(double done) {
    if (!options_.progress) return true;
    try {
      options_.progress(done, checks_);
    } catch (const Interrupted&) {
      is_stopped_ = true;
    }
    return !is_stopped_;
  }

  void run_unit(const Case& c, std::uint64_t number, const Engine& engine, const std::function<void()>& poll,
                Tally& tally) {
    // The grid twice, and then new combinations.
    const std::uint64_t grid_size = grid().size();
    const bool is_preset = c.prefers_presets && number % 2 == 0;
    const std::uint64_t step = c.prefers_presets ? number / 2 : number;
    const std::uint64_t place = is_preset                 ? step % preset_names().size()
                                : number < quick_rounds() ? step % grid_size
                                                          : step;
    const Config config = options_.config ? *options_.config : config_of(place);
    if (!c.own_configs) tally.configs.insert(options_.config ? 0 : place);
    ++tally.units;
    const std::uint64_t before = tally.checks;
    Unit unit(config, number, unit_seed(options_.seed, c.name, number), engine, tally);
    unit.poll = poll;
    try {
      c.run(unit);
    } catch (const std::exception& error) {
      unit.require(false, "exception", {}, error.what());
    }
    checks_ += tally.checks - before;
  }

  /// The engine for a rule: all but the default rule need the scalar engine.
  [[nodiscard]] Engine engine_of(FillRule rule) const {
    if (rule == FillRule::top_left) return engine_;
    return [rule](const Scene& scene, const Config& config, RenderOptions options) {
      options.rules.fill_rule = rule;
      return render_scalar(scene, config, options);
    };
  }

  void judge(CaseResult& result) const {
    Tally& tally = result.tally;
    for (const auto& [name, sums] : tally.bias) {
      if (sums.standard_error() > kBiasStandardError) continue;
      ++tally.bias_judged;
      const Place place{0, tally.bias_config.at(name), {}};
      tally.keep_worst("bias", {std::abs(sums.mean()), kBiasBound, "LSB", place, std::nullopt});
      if (std::abs(sums.mean()) < kBiasBound) continue;
      ++tally.failures;
      tally.keep_first({"bias", "mean error " + std::to_string(sums.mean()) + " LSB", place});
    }
    if (const auto depth = tally.worst.find("depth"); depth != tally.worst.end() && depth->second.value > 0) {
      Worst& worst = depth->second;
      if (!worst.place.scene.states.empty())
        worst.measured = measured_depth_error(worst.place.scene, worst.place.config, engine_of(worst.place.rule));
      if (worst.measured && !(std::abs(worst.value - *worst.measured) <= 0.01 * *worst.measured)) {
        ++tally.failures;
        tally.keep_first({"self-report",
                          "the worst error is reported as " + std::to_string(worst.value) + " LSB and measured as " +
                              std::to_string(*worst.measured),
                          worst.place});
      }
    }
    if (tally.checks == 0 && !is_stopped_) {
      ++tally.failures;
      tally.keep_first({"empty", "nothing was compared: it needs more units, so more --seconds", {}});
    }
  }

  const RunOptions& options_;
  const std::vector<const Case*> cases_;
  const Engine engine_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<std::uint64_t> next_task_{0}, checks_{0};
  std::atomic<bool> is_stopped_ = false;
};

}  // namespace

std::uint64_t quick_rounds() { return 2 * grid().size(); }

std::vector<CaseResult> run_cases(const RunOptions& options) { return Driver(options).run(); }

}  // namespace halfplane::stress
