// The packets of a stage's ports, one list for each.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "model/vectors/stages.hpp"

namespace halfplane::vectors {

/// Packets of one size, as packed words.
class PacketList {
 public:
  explicit PacketList(std::size_t words = 1) : per_(words) {}
  /// `undefined`: bits without a value, x or z in a simulator; empty: all have one.
  void push(std::span<const std::uint32_t> words, std::vector<std::uint32_t> undefined = {}) {
    if (!undefined.empty()) undefined_[size()] = std::move(undefined);
    words_.insert(words_.end(), words.begin(), words.end());
  }
  [[nodiscard]] std::span<const std::uint32_t> undefined(std::size_t n) const {
    const auto found = undefined_.find(n);
    return found == undefined_.end() ? std::span<const std::uint32_t>() : std::span(found->second);
  }
  [[nodiscard]] std::size_t size() const { return words_.size() / per_; }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t n) const {
    return std::span(words_).subspan(n * per_, per_);
  }
  /// For tests that inject a fault.
  [[nodiscard]] std::span<std::uint32_t> at(std::size_t n) { return std::span(words_).subspan(n * per_, per_); }

 private:
  std::size_t per_;
  std::vector<std::uint32_t> words_;
  std::map<std::size_t, std::vector<std::uint32_t>> undefined_;
};

/// In the order of the stage's ports.
struct StagePackets {
  std::vector<PacketList> in, out;

  StagePackets() = default;
  StagePackets(const JudgedStage& stage, const Widths& widths) {
    for (const Port& port : stage.in) in.emplace_back(packet_words(port.like, widths));
    for (const Port& port : stage.out) out.emplace_back(packet_words(port.like, widths));
  }
};

}  // namespace halfplane::vectors
