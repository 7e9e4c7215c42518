#include "sim/interrupt.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <csignal>
#include <ctime>

namespace halfplane {
namespace {

constexpr int kStatus = 130;            // 128 + SIGINT, as in shells
constexpr long long kSameSignal = 100;  // milliseconds

/// Effect of the next signal.
enum class Answer : int { end, ask, asked };

// The only data that the handler touches.
std::atomic<Answer> answer = Answer::end;
std::atomic<long long> asked_at = 0;  // milliseconds
std::atomic<bool> has_half_written = false;
std::array<char, PATH_MAX> half_written{};
static_assert(std::atomic<Answer>::is_always_lock_free && std::atomic<long long>::is_always_lock_free &&
              std::atomic<bool>::is_always_lock_free);

long long milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<long long>(now.tv_sec) * 1000 + now.tv_nsec / 1'000'000;
}

// Only functions that POSIX allows here.
void on_signal(int) {
  auto expected = Answer::ask;
  if (answer.compare_exchange_strong(expected, Answer::asked)) {
    asked_at = milliseconds();
    return;
  }
  if (expected == Answer::asked && milliseconds() - asked_at < kSameSignal) return;
  if (expected == Answer::end) {
    constexpr char kLine[] = "halfplane: interrupted before the work began, so nothing was written\n";
    (void)!write(STDERR_FILENO, kLine, sizeof kLine - 1);
  }
  if (has_half_written) unlink(half_written.data());
  _exit(kStatus);
}

}  // namespace

// Also for a script's background job, which starts with SIGINT ignored: a SIGINT sent to it is intended.
void catch_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) sigaddset(&action.sa_mask, signal);
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

void stop_in_order() {
  auto expected = Answer::end;
  answer.compare_exchange_strong(expected, Answer::ask);
}

bool is_interrupted() noexcept { return answer == Answer::asked; }

void stop_if_interrupted() {
  if (is_interrupted()) throw Interrupted{};
}

HalfWrittenFile::HalfWrittenFile(const std::string& path) {
  has_half_written = false;
  if (path.size() >= half_written.size()) return;
  path.copy(half_written.data(), path.size());
  half_written[path.size()] = '\0';
  has_half_written = true;
}

HalfWrittenFile::~HalfWrittenFile() { has_half_written = false; }

}  // namespace halfplane
