// Progress of long work: fraction done, rate and remaining time; and its end by a signal.
#pragma once

#include <chrono>
#include <cstdint>
#include <iosfwd>
#include <string>

#include "sim/cli/options.hpp"

namespace halfplane {

/// The progress of one piece of work, on stderr: on a terminal a line that is redrawn, once the work takes longer than
/// two seconds; elsewhere, in a log, a line every ten seconds, or at the interval of HALFPLANE_PROGRESS. Nothing with
/// --quiet. From construction on, a signal asks the program to stop, and these calls report that.
class Progress {
 public:
  /// `unit`: the unit of the counts, as "checks"; empty: no counts.
  Progress(const CommonOptions& options, std::string what, std::string unit = "");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows the fraction done, 0...1, NaN if the total is unknown. False: a signal asks to stop.
  [[nodiscard]] bool goes_on(double fraction, std::uint64_t count = 0);
  /// The same, but throws Interrupted.
  void operator()(double fraction, std::uint64_t count = 0);

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] std::string line(double fraction, std::uint64_t count, double seconds) const;

  std::string what_, unit_;
  Clock::time_point start_, next_;
  Clock::duration every_;
  bool is_enabled_, is_terminal_, is_shown_ = false;
};

/// Marks the result of interrupted work: `"partial": true`. Other results have no such key.
void mark_partial(Json& result);

/// Prints its last line for people.
void print_partial(std::ostream& out);
/// The exit status: `status`, unless a signal interrupted the work, as the last line then says.
[[nodiscard]] int ended(std::ostream& out, bool is_partial, int status);

}  // namespace halfplane
