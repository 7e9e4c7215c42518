// The memory on the RTL's memory port: the data, and the times of a MemoryTiming.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "model/engines/hardware.hpp"
#include "model/host/texture_memory.hpp"
#include "model/packets/packet_words.hpp"
#include "model/timing/memory.hpp"

namespace halfplane {

// A queue of packets as packed 32-bit words (model/packets/packet_words.hpp), without an allocation a packet.

static_assert(std::endian::native == std::endian::little, "Verilated ports are compared as bytes, lowest first");

/// A first-in first-out ring of packets of one size. It grows; it never shrinks.
class PacketQueue {
 public:
  explicit PacketQueue(std::size_t words = 1) : words_(words) {}

  [[nodiscard]] bool empty() const { return head_ == tail_; }
  [[nodiscard]] std::size_t size() const { return tail_ - head_; }
  [[nodiscard]] std::size_t words() const { return words_; }

  /// Room for one more packet, to be filled by the caller; valid until the next push. `tag` is returned with it.
  std::uint32_t* push(std::uint32_t tag) {
    if (size() == capacity_) grow();
    std::uint32_t* slot = at(tail_++);
    slot[words_] = tag;
    return slot;
  }
  [[nodiscard]] const std::uint32_t* front(std::size_t ahead = 0) const { return at(head_ + ahead); }
  [[nodiscard]] std::uint32_t* front(std::size_t ahead = 0) { return at(head_ + ahead); }
  [[nodiscard]] std::uint32_t front_tag() const { return front()[words_]; }
  void pop() { ++head_; }

 private:
  [[nodiscard]] const std::uint32_t* at(std::size_t n) const {
    return ring_.data() + (n & (capacity_ - 1)) * (words_ + 1);
  }
  [[nodiscard]] std::uint32_t* at(std::size_t n) { return ring_.data() + (n & (capacity_ - 1)) * (words_ + 1); }
  void grow() {
    std::vector<std::uint32_t> ring((2 * capacity_) * (words_ + 1));
    for (std::size_t n = head_; n != tail_; ++n)
      std::copy_n(at(n), words_ + 1, ring.data() + (n & (2 * capacity_ - 1)) * (words_ + 1));
    ring_.swap(ring);
    capacity_ *= 2;
  }

  std::size_t words_, capacity_ = 64;  // capacity in packets, a power of two
  std::size_t head_ = 0, tail_ = 0;
  std::vector<std::uint32_t> ring_ = std::vector<std::uint32_t>(capacity_ * (words_ + 1));
};

/// The first of the answers if it is due in this cycle; a tag is the cycle in which it is due, modulo 2^32.
[[nodiscard]] inline const std::uint32_t* due_of(const PacketQueue& answers, std::uint64_t cycle) {
  if (answers.empty()) return nullptr;
  const std::uint32_t late = static_cast<std::uint32_t>(cycle) - answers.front_tag();
  return late < 1U << 31 ? answers.front() : nullptr;
}

class MemoryModel {
 public:
  MemoryModel(const Config& config, const Widths& widths, const MemorySettings& settings, const MemoryLayout& layout)
      : widths_(widths),
        tiles_(config, layout),
        timing_(make_memory(settings, config)),
        answers_(words_of(packet_bits<MemoryAnswer>(widths))) {}

  /// Whether a beat can be taken in this cycle.
  [[nodiscard]] bool is_ready(std::uint64_t cycle) const { return left_ != 0 || timing_->room() <= cycle; }

  /// A faulty design may access invalid addresses: such data are dropped. Or cut a burst: it is never answered.
  void accept(const std::uint32_t* words, std::uint64_t cycle) {
    const auto beat = unpack_words<MemoryBeat>(words, widths_);
    const bool is_inside = tiles_.has(beat);
    if (beat.is_first) {
      left_ = beat.length;
      burst_ = {beat.is_write, beat.address, beat.length};
    }
    if (!beat.is_write) {
      left_ = 0;
      const BurstAnswer due = timing_->accept(burst_, cycle);
      MemoryBeat next = beat;
      for (int n = 0; n < beat.length; ++n, next.address += static_cast<std::uint32_t>(widths_.port_bytes)) {
        MemoryAnswer answer;
        if (tiles_.has(next)) tiles_.read(next.address, answer.data);
        push(answer, due.at(n));
      }
      return;
    }
    if (is_inside) tiles_.write(beat);
    if (left_ == 0) return;
    if (--left_ == 0) push({true, {}}, timing_->accept(burst_, cycle).at(0));
  }

  void show(int width, int height) { timing_->show(width, height); }
  /// The answer that is due in this cycle, or null.
  [[nodiscard]] const std::uint32_t* due(std::uint64_t cycle) const { return due_of(answers_, cycle); }
  void pop() { answers_.pop(); }
  [[nodiscard]] bool is_idle() const { return answers_.empty() && left_ == 0; }
  /// State after a long rest: drops bursts in flight, keeps the content.
  void rest(std::unique_ptr<MemoryTiming> timing) {
    timing_ = std::move(timing);
    while (!answers_.empty()) answers_.pop();
    left_ = 0;
  }
  [[nodiscard]] const TileMemory& tiles() const { return tiles_; }
  [[nodiscard]] TileMemory& tiles() { return tiles_; }

 private:
  void push(const MemoryAnswer& answer, Cycle due) {
    pack_words(answer, widths_, answers_.push(static_cast<std::uint32_t>(due)));
  }

  const Widths& widths_;
  TileMemory tiles_;
  std::unique_ptr<MemoryTiming> timing_;
  PacketQueue answers_;
  MemoryBurst burst_;  ///< the burst being written
  int left_ = 0;       ///< beats of it
};

/// The same for textures, on the texture unit's port: reads only.
class TextureModel {
 public:
  TextureModel(const Config& config, const Widths& widths, std::unique_ptr<MemoryTiming> timing)
      : config_(config),
        widths_(widths),
        timing_(std::move(timing)),
        answers_(words_of(packet_bits<TexelBeat>(widths))) {}

  /// From now on it holds the scene's.
  void hold(const Scene& scene) { texels_ = TextureMemory(scene, config_); }
  [[nodiscard]] bool is_ready(std::uint64_t cycle) const { return timing_->room() <= cycle; }
  void accept(const std::uint32_t* words, std::uint64_t cycle) {
    const auto request = unpack_words<TextureRequest>(words, widths_);
    const BurstAnswer due = timing_->accept({false, request.address, request.beats}, cycle);
    const auto bytes = static_cast<std::size_t>(widths_.texture_port_bytes);
    for (std::uint32_t n = 0; n < request.beats; ++n) {
      TexelBeat beat;
      texels_.read(request.address + n * static_cast<std::uint32_t>(bytes), std::span(beat.data).first(bytes));
      pack_words(beat, widths_, answers_.push(static_cast<std::uint32_t>(due.at(static_cast<int>(n)))));
    }
  }
  /// The same as in MemoryModel.
  [[nodiscard]] const std::uint32_t* due(std::uint64_t cycle) const { return due_of(answers_, cycle); }
  void pop() { answers_.pop(); }
  [[nodiscard]] bool is_idle() const { return answers_.empty(); }
  void rest(std::unique_ptr<MemoryTiming> timing) {
    timing_ = std::move(timing);
    while (!answers_.empty()) answers_.pop();
  }

 private:
  const Config& config_;
  const Widths& widths_;
  std::unique_ptr<MemoryTiming> timing_;
  TextureMemory texels_;
  PacketQueue answers_;
};

}  // namespace halfplane
