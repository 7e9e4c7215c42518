#include "sim/study/bench/rows.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "model/engines/functional.hpp"
#include "sim/interrupt.hpp"
#include "sim/study/bench/engines.hpp"
#include "sim/study/compare/compare.hpp"

namespace halfplane {
namespace {

std::string reason_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const std::exception& e) {
    return e.what();
  }
}

/// Omitted engines, with reasons.
class LeftOut {
 public:
  void add(const std::string& engine, const BenchCase& at, const std::exception_ptr& error) {
    if (!first_) first_ = error;
    entries_.emplace_back(engine, engine + " on " + at.scene_name + ", " + label(at.config) + ": " + reason_of(error));
  }
  [[nodiscard]] const std::exception_ptr& first() const { return first_; }

  void tell(const BenchPlan& plan) const {
    for (const auto& [engine, line] : entries_)
      if (plan.left_out) plan.left_out(engine, line);
  }

 private:
  std::vector<std::pair<std::string, std::string>> entries_;  // engine, line
  std::exception_ptr first_;
};

BenchErrors errors_of(const Comparison& c, const Config& config) {
  BenchErrors errors;
  if (c.depth_lsb.count > 0) {
    const double range = std::ldexp(1.0, config.depth_bits) - 1;
    errors.depth_lsb_max = c.depth_lsb.max;
    errors.depth_lsb_rms = c.depth_lsb.rms;
    errors.depth_range_max = c.depth_lsb.max / range;
    errors.depth_range_rms = c.depth_lsb.rms / range;
  }
  if (c.color_lsb.count > 0) {
    errors.color_lsb_max = c.color_lsb.max;
    errors.color_lsb_rms = c.color_lsb.rms;
  }
  if (c.depth_eye) {
    errors.depth_eye_max = c.depth_eye->max;
    errors.depth_eye_rms = c.depth_eye->rms;
  }
  errors.coverage_mismatches = c.oracle.mismatches;
  errors.coverage_missing = c.coverage.missing;
  errors.coverage_extra = c.coverage.extra;
  return errors;
}

/// The first case of each scene is llvmpipe's.
bool is_first_of_scene(std::span<const BenchCase> cases, std::size_t index) {
  return std::none_of(cases.begin(), cases.begin() + static_cast<std::ptrdiff_t>(index),
                      [&](const BenchCase& other) { return other.scene_name == cases[index].scene_name; });
}

/// Adds the rows of one case and the frames that measure them.
void add_case(std::span<const BenchCase> cases, std::size_t index, const BenchPlan& plan,
              const std::function<void(double)>& progress, LeftOut& left_out, std::vector<BenchRow>& rows,
              std::vector<Frame>& frames) {
  const BenchCase& at = cases[index];
  BenchFacts facts;
  try {
    facts = find_facts(*at.scene, at.config, plan.wants_errors, progress);
  } catch (const InputError&) {
    for (const std::string& engine : plan.engines) left_out.add(engine, at, std::current_exception());
    return;
  }
  for (const std::string& engine : plan.engines) {
    if (engine == "llvmpipe" && !is_first_of_scene(cases, index)) continue;
    for (std::size_t t = 0; t < (has_threads(engine) ? plan.threads.size() : 1); ++t) {
      const int threads = has_threads(engine) ? plan.threads[t] : 1;
      try {
        frames.push_back(make_frame(engine, at.scene, at.config, threads, plan.poll));
        rows.push_back({engine, threads, index, {}, facts});
        // Bit-exact engines share one comparison; the golden is its reference, and llvmpipe is not compared.
        if (!is_bit_exact(engine)) rows.back().facts.errors.reset();
      } catch (const InputError&) {
        left_out.add(engine, at, std::current_exception());
      } catch (const std::runtime_error&) {  // missing in this build
        if (engine == "llvmpipe") throw;
        left_out.add(engine, at, std::current_exception());
      }
    }
  }
}

}  // namespace

double BenchRow::mtri_s() const { return static_cast<double>(facts.counters.primitives_in) / 1e6 / times.median(); }
double BenchRow::mpix_s() const { return static_cast<double>(facts.counters.covered) / 1e6 / times.median(); }
double BenchRow::cycles_per_s() const { return static_cast<double>(times.cycles) / times.median(); }

BenchFacts find_facts(const Scene& scene, const Config& config, bool wants_errors,
                      const std::function<void(double)>& progress) {
  BenchFacts facts;
  Rendering rendering;
  if (wants_errors) {
    CompareOptions options;
    options.skip = skip_none();
    options.progress = progress;
    Comparison comparison = compare(scene, config, options);
    facts.errors = errors_of(comparison, config);
    rendering = std::move(comparison.rendering);
  } else {
    RenderOptions options;
    options.skip = skip_none();
    options.progress = progress;
    options.want_count = true;
    rendering = render_functional(scene, config, options);
  }
  facts.counters = rendering.counters;
  const auto covered =
      rendering.count.size() - static_cast<std::size_t>(std::count(rendering.count.begin(), rendering.count.end(), 0U));
  if (!rendering.count.empty())
    facts.coverage = static_cast<double>(covered) / static_cast<double>(rendering.count.size());
  return facts;
}

std::vector<BenchRow> measure_rows(std::span<const BenchCase> cases, const BenchPlan& plan) {
  std::vector<BenchRow> rows;
  std::vector<Frame> frames;
  LeftOut left_out;
  constexpr double kFactsShare = 0.3;  // fraction of the progress before the frames
  try {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const auto progress = [&, i](double fraction) {
        if (plan.progress)
          plan.progress(kFactsShare * (static_cast<double>(i) + fraction) / static_cast<double>(cases.size()));
      };
      progress(0);
      add_case(cases, i, plan, progress, left_out, rows, frames);
    }
  } catch (const Interrupted&) {  // nothing is measured yet
    return {};
  }
  const auto times = measure_in_turns(frames, plan.repeat, [&](double fraction) {
    if (plan.progress) plan.progress(kFactsShare + (1 - kFactsShare) * fraction);
  });
  std::vector<BenchRow> measured;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].times = times[i];
    if (times[i].refusal)
      left_out.add(rows[i].engine, cases[rows[i].case_index], times[i].refusal);
    else if (!times[i].seconds.empty())  // true if the study was ended early
      measured.push_back(std::move(rows[i]));
  }
  if (measured.empty() && left_out.first()) std::rethrow_exception(left_out.first());
  left_out.tell(plan);
  return measured;
}

}  // namespace halfplane
