#include "sim/study/widths/study.hpp"

#include <algorithm>
#include <cmath>

#include "sim/interrupt.hpp"
#include "sim/study/compare/surface_oracle.hpp"

namespace halfplane {

std::optional<double> proven_w_ratio(double extent, double error, const PerspectiveFormat& format,
                                     const OverWFormat& attribute, int tile_size) {
  const auto holds = [&](double log_ratio) {
    return over_w_bound(extent, std::exp2(log_ratio), format, attribute, tile_size) <= error;
  };
  if (!holds(0)) return std::nullopt;
  double low = 0, high = format.q_bits;  // at 2^N no bits of Q are left
  while (high - low > 1e-9) {
    const double middle = (low + high) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return std::exp2(low);
}
namespace {

/// The primitives that reached the ends of one width.
struct Witnesses {
  Seen seen;
  Probe at_lo, at_hi;
  std::uint64_t first_overflow = 0, overflows = 0;  // of the random probes, with one bit less
};

/// Tries probes and remembers the best for each end.
class Study {
 public:
  Study(const Config& config, const WidthStudyOptions& options)
      : options_(options),
        maker_(config, options.seed),
        observer_(config),
        all_(observer_.widths().all()),
        witnesses_(all_.size()) {}

  WidthStudy run() {
    try {
      try_all();
    } catch (const Interrupted&) {  // values seen so far are kept
    }
    return result();
  }

 private:
  void try_all() {
    for (std::uint64_t i = 1; i <= options_.samples; ++i) {
      attempt(maker_.random(), i);
      if (i % 1024 == 0) report(0.4 * static_cast<double>(i) / static_cast<double>(options_.samples));
    }
    for (const Probe& probe : extreme_probes(observer_.config())) attempt(probe);
    for (std::size_t place = 0; place < all_.size(); ++place) {
      report(0.4 + 0.6 * static_cast<double>(place) / static_cast<double>(all_.size()));
      if (!observer_.is_observed(place)) continue;
      for (const bool upwards : {false, true}) {
        if (is_attained(place, upwards)) continue;
        climb(place, upwards, upwards ? witnesses_[place].at_hi : witnesses_[place].at_lo);
        climb(place, upwards, fresh_start(place));
      }
    }
  }

  void report(double fraction) const {
    if (options_.progress) options_.progress(fraction, probes_);
  }

  [[nodiscard]] Interval range(std::size_t place) const {
    return value_range(*all_[place], observer_.widths(), observer_.config());
  }

  [[nodiscard]] bool is_attained(std::size_t place, bool upwards) const {
    const Seen& seen = witnesses_[place].seen;
    return seen.count != 0 && (upwards ? seen.hi >= range(place).hi : seen.lo <= range(place).lo);
  }

  /// Whether it overflows with one bit less.
  [[nodiscard]] bool overflows(std::size_t place, const Seen& seen) const {
    const Width& width = *all_[place];
    return bits_needed({seen.lo, seen.hi}, width.is_signed, width.is_modular) >= width.bits;
  }

  /// `number`: of a random probe, from 1. Leaves this probe's values in the observer.
  void attempt(const Probe& probe, std::uint64_t number = 0) {
    observer_.clear();
    observer_.observe(probe);
    ++probes_;
    const auto seen = observer_.seen();
    for (std::size_t place = 0; place < seen.size(); ++place) {
      if (seen[place].count == 0) continue;
      Witnesses& best = witnesses_[place];
      if (best.seen.count == 0 || seen[place].lo < best.seen.lo) best.at_lo = probe;
      if (best.seen.count == 0 || seen[place].hi > best.seen.hi) best.at_hi = probe;
      best.seen.add(seen[place].lo);
      best.seen.add(seen[place].hi);
      if (number == 0 || !overflows(place, seen[place])) continue;
      if (best.overflows++ == 0) best.first_overflow = number;
    }
  }

  /// A random probe that uses the width.
  [[nodiscard]] Probe fresh_start(std::size_t place) {
    Probe probe;
    for (int i = 0; i < 100; ++i) {
      attempt(probe = maker_.random());
      if (observer_.seen()[place].count != 0) break;
    }
    return probe;
  }

  void climb(std::size_t place, bool upwards, Probe probe) {
    const auto height = [&]() -> std::optional<int128> {
      const Seen& seen = observer_.seen()[place];
      if (seen.count == 0) return std::nullopt;
      return upwards ? seen.hi : -seen.lo;
    };
    attempt(probe);
    auto best = height();
    for (int step = 0; step < options_.climb_steps / 2 && !is_attained(place, upwards); ++step) {
      const Probe next = maker_.changed(probe);
      attempt(next);
      const auto reached = height();
      if (!reached || (best && *reached < *best)) continue;  // equal steps are accepted: they lead along ridges
      best = reached;
      probe = next;
    }
  }

  [[nodiscard]] WidthStudy result() const {
    WidthStudy study;
    study.probes = probes_;
    for (std::size_t place = 0; place < all_.size(); ++place) {
      const Width& width = *all_[place];
      const Witnesses& best = witnesses_[place];
      WidthRow row{width, observer_.is_observed(place), range(place), best.seen, width.bits, std::nullopt};
      if (best.seen.count != 0)
        row.needed_bits = bits_needed({best.seen.lo, best.seen.hi}, width.is_signed, width.is_modular);
      if (best.seen.count != 0 && overflows(place, best.seen)) {
        const int128 limit = int128{1} << (width.bits - (width.is_signed ? 2 : 1));
        const bool is_high = width.is_modular || best.seen.hi >= limit;
        row.overflows = Overflow{is_high ? best.at_hi : best.at_lo, is_high ? best.seen.hi : best.seen.lo,
                                 best.first_overflow, best.overflows};
      }
      study.rows.push_back(std::move(row));
    }
    return study;
  }

  const WidthStudyOptions& options_;
  ProbeMaker maker_;
  WidthObserver observer_;
  std::vector<const Width*> all_;
  std::vector<Witnesses> witnesses_;
  std::uint64_t probes_ = 0;
};

}  // namespace

double WidthRow::used() const {
  if (seen.count == 0) return 0;
  const auto share = [](int128 value, int128 end) {
    return end == 0 ? 0.0 : std::max(0.0, static_cast<double>(value) / static_cast<double>(end));
  };
  return std::max(share(seen.lo, range.lo), share(seen.hi, range.hi));
}

int bits_needed(const Interval& values, bool is_signed, bool is_modular) {
  if (is_modular) return std::max(1, ceil_log2(static_cast<uint128>(values.hi - values.lo + 1)));
  const auto bits = [](int128 value) {
    const auto magnitude = static_cast<uint128>(value < 0 ? ~value : value);
    return magnitude == 0 ? 0 : floor_log2(magnitude) + 1;
  };
  return std::max(1, std::max(bits(values.lo), bits(values.hi)) + (is_signed ? 1 : 0));
}

std::vector<std::size_t> WidthStudy::overflow_order() const {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].overflows) order.push_back(i);
  const auto key = [this](std::size_t i) {
    const Overflow& overflow = *rows[i].overflows;
    return std::pair(overflow.random_probes == 0, std::pair(overflow.first_probe, ~overflow.random_probes));
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
}

WidthStudy study_widths(const Config& config, const WidthStudyOptions& options) {
  validate(config);
  return Study(config, options).run();
}

}  // namespace halfplane
