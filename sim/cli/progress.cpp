#include "sim/cli/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

namespace halfplane {
namespace {

constexpr double kFirstRedrawn = 2, kRedrawn = 0.1, kLogged = 10;  // seconds

/// Seconds between lines of a log.
double log_interval() {
  const char* text = std::getenv("HALFPLANE_PROGRESS");
  const double seconds = text == nullptr ? 0 : std::atof(text);
  return seconds > 0 && seconds < 1e6 ? seconds : kLogged;
}

/// 1234567 as "1.2 M".
std::string rounded(double value) {
  for (const auto& [factor, letter] : {std::pair{1e9, " G"}, {1e6, " M"}, {1e3, " k"}})
    if (value >= factor) return fixed(value / factor, value < 10 * factor ? 1 : 0) + letter;
  return fixed(value, value < 10 ? 1 : 0);
}

/// 95 as "1:35".
std::string minutes(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
  const auto two = [](std::uint64_t value) { return (value < 10 ? "0" : "") + std::to_string(value); };
  const std::uint64_t hours = whole / 3600, rest = whole / 60 % 60;
  return (hours > 0 ? std::to_string(hours) + ":" + two(rest) : std::to_string(rest)) + ":" + two(whole % 60);
}

}  // namespace

Progress::Progress(const CommonOptions& options, std::string what, std::string unit)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      start_(Clock::now()),
      is_enabled_(!options.quiet),
      is_terminal_(isatty(STDERR_FILENO) != 0) {
  const auto duration = [](double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  };
  every_ = duration(is_terminal_ ? kRedrawn : log_interval());
  next_ = start_ + (is_terminal_ ? duration(kFirstRedrawn) : every_);
  stop_in_order();
}

Progress::~Progress() {
  if (is_shown_ && is_terminal_) std::cerr << "\r\033[K" << std::flush;
}

bool Progress::goes_on(double fraction, std::uint64_t count) {
  if (is_interrupted()) return false;
  if (!is_enabled_) return true;
  const auto now = Clock::now();
  if (now < next_) return true;
  next_ = now + every_;
  is_shown_ = true;
  const std::string text = line(fraction, count, std::chrono::duration<double>(now - start_).count());
  std::cerr << (is_terminal_ ? "\r" + text + "\033[K" : text + "\n") << std::flush;
  return true;
}

void Progress::operator()(double fraction, std::uint64_t count) {
  if (!goes_on(fraction, count)) throw Interrupted{};
}

std::string Progress::line(double fraction, std::uint64_t count, double seconds) const {
  std::string text = what_;
  if (!std::isnan(fraction))
    text += " " + std::to_string(static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0))) + " %";
  if (!unit_.empty() && count > 0)
    text += ", " + rounded(static_cast<double>(count) / seconds) + " " + unit_ + " a second";
  constexpr double kGuess = 0.005;  // fraction done below which no estimate is shown
  if (fraction >= kGuess) text += ", " + minutes(seconds * std::max(0.0, 1 / fraction - 1)) + " left";
  return text;
}

void mark_partial(Json& result) { result["partial"] = true; }

int ended(std::ostream& out, bool is_partial, int status) {
  if (is_partial) print_partial(out);
  return is_partial ? int{exit_interrupted} : status;
}

void print_partial(std::ostream& out) { out << "interrupted: this result is partial, as far as the work came\n"; }

}  // namespace halfplane
