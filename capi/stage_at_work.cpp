#include "stage_at_work.hpp"

#include <unistd.h>

#include <algorithm>

namespace halfplane::capi {
namespace {

std::vector<StageAtWork::PortInfo> described(const std::vector<vectors::Port>& ports, const Widths& widths) {
  std::vector<StageAtWork::PortInfo> all;
  for (const vectors::Port& port : ports) {
    const auto elements = vectors::fields_of(port.like, widths);
    all.push_back(
        {std::string(port.name), vectors::bits_of(port.like, widths), elements, vectors::highest_first(elements)});
  }
  return all;
}

std::size_t words_of(const StageAtWork::PortInfo& port) { return static_cast<std::size_t>((port.bits + 31) / 32); }

Config validated(const Config& config) {
  validate(config);
  return config;
}

}  // namespace

StageAtWork::StageAtWork(const Config& config, std::string_view name)
    : config_(validated(config)),
      widths_(derive_widths(config_)),
      stage_(vectors::judged_stage(name)),
      in_ports_(described(stage_.in, widths_)),
      out_ports_(described(stage_.out, widths_)),
      in_(in_ports_.size()),
      out_(out_ports_.size()),
      process_(getpid()) {
  vectors::require_stage(stage_, config_);
  if (!stage_.can_run())
    throw InputError("stage " + std::string(name) + " cannot be run by itself: " + std::string(stage_.why_not));
  thread_ = std::thread([this] { run(); });
  go_on();
  if (!error_) return;
  thread_.join();
  std::rethrow_exception(error_);
}

StageAtWork::~StageAtWork() {
  if (process_ != getpid()) {
    thread_.detach();
    return;
  }
  is_ending_ = true;
  if (!has_ended_) go_on();
  thread_.join();
}

void StageAtWork::run() {
  stage_turn_.acquire();
  try {
    run_stage(stage_, *this, config_, widths_);
  } catch (...) {
    error_ = std::current_exception();
  }
  has_ended_ = true;
  caller_turn_.release();
}

/// Lets the stage run until it wants a packet that is not there.
void StageAtWork::go_on() {
  stage_turn_.release();
  caller_turn_.acquire();
}

std::span<const std::uint32_t> StageAtWork::take(std::size_t port) {
  while (in_[port].empty()) {
    if (is_ending_) return {};
    waits_for_ = port;
    caller_turn_.release();
    stage_turn_.acquire();
  }
  taken_ = std::move(in_[port].front());
  in_[port].pop_front();
  return taken_;
}

void StageAtWork::send(std::size_t port, std::span<const std::uint32_t> words) {
  out_[port].emplace_back(words.begin(), words.end());
}

void StageAtWork::put(std::size_t port, const std::uint32_t* words) {
  const PortInfo& info = in_ports_.at(port);
  if (error_) std::rethrow_exception(error_);
  require_own_process();
  Packet packet(words, words + words_of(info));
  if (info.bits % 32 != 0) packet.back() &= ~0U >> (32 - info.bits % 32);
  const auto values = vectors::values_of(stage_.in[port].like, widths_, packet);
  if (const std::string fault = vectors::place_fault(info.elements, values, config_, widths_); !fault.empty())
    throw InputError(fault);
  in_[port].push_back(std::move(packet));
  if (!has_ended_ && port == waits_for_) go_on();
  if (error_) std::rethrow_exception(error_);
}

/// A child of fork() has the stage and not its thread.
void StageAtWork::require_own_process() const {
  if (process_ != getpid()) throw InputError("this stage belongs to the process that made it");
}

bool StageAtWork::get(std::size_t port, std::uint32_t* words) {
  auto& packets = out_.at(port);
  if (packets.empty()) return false;
  std::ranges::copy(packets.front(), words);
  packets.pop_front();
  return true;
}

}  // namespace halfplane::capi
