// Per-primitive cycle listing: when each primitive crossed each boundary first and last, a line of CSV each,
// about 150 bytes, held in memory until finish().
#pragma once

#include <array>
#include <string>

#include "model/engines/cycle/cycle_model.hpp"

namespace halfplane {

class PrimitiveSpans final : public TransferSink {
 public:
  PrimitiveSpans();
  void transfer(Arrow boundary, Cycle cycle) override;
  void primitive(const HostPrimitive& primitive) override;
  /// The whole listing, header first. Call it once, after the run.
  [[nodiscard]] const std::string& finish();

 private:
  struct Span {
    Cycle first = 0, last = 0;
    std::uint64_t items = 0;
  };
  void write();

  std::string text_, head_;  ///< head_: of the line at work
  bool has_primitive_ = false;
  std::uint64_t number_ = 0;
  std::array<Span, kArrows> span_{};
};

/// "triangle", "rectangle", "fast_clear", "flush", "point", "line".
[[nodiscard]] std::string_view kind_name(PrimitiveKind kind);

}  // namespace halfplane
