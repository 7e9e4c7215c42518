// The time of the units beside the texture unit: rtl_ref/stages/fog_unit.sv and light_unit.sv.
#pragma once

#include <algorithm>
#include <array>

#include "../../timing/stalls.hpp"

namespace halfplane {

/// Fog downstream of a texture unit, rtl_ref/stages/fog_unit.sv: three registers, each of which loads as soon as its
/// content moves on.
class FogTiming {
 public:
  /// A stamp on offer from `offered` on. Returns when it is on offer to the colour stage.
  Cycle take(Cycle offered) {
    Cycle at = offered;
    for (std::size_t n = 0; n < entered_.size(); ++n) {
      const Cycle free = n + 1 < entered_.size() ? entered_[n + 1] : left_;  // when the stamp before moves on
      at = std::max(at, free);
      entered_[n] = at++;
    }
    return at;
  }
  /// When it was taken.
  [[nodiscard]] Cycle taken() const { return entered_.front(); }
  /// The colour stage took it.
  void leave(Cycle w) { left_ = w; }

 private:
  std::array<Cycle, 3> entered_{};  ///< by the last stamp
  Cycle left_ = 0;
};

/// Light upstream of a texture unit, rtl_ref/stages/light_unit.sv: a queue, and a lane that takes a lit sample per
/// clock, or a stamp without any. For stamp m:
///
///   l(m) = max(x + 2, l(m-1) + 1), then a clock per sample; a token of the light waits for the last lit l + 10
///   leaves kClocks after the last one
class LightTiming {
 public:
  /// A stamp leaves the depth stage in `x`, with `lit` lit samples. Returns the cycle in which it would have left
  /// without a unit.
  Cycle take(Cycle x, int lit, bool sets) {
    last_ = std::max(x + kDoor, last_ + 1);
    if (sets) last_ = std::max(last_, looked_at_);
    if (lit > 0) {
      last_ += static_cast<Cycle>(lit) - 1;
      looked_at_ = last_ + kLooks;
    }
    return last_ + kClocks - 1;
  }

 private:
  static constexpr Cycle kDoor = 2;     ///< from the depth stage to the head of the queue
  static constexpr Cycle kClocks = 12;  ///< from there to the input of the texture unit
  static constexpr Cycle kLooks = 10;   ///< part of these, up to the last read of a register of the light
  Cycle last_ = 0;                      ///< when the last sample, or stamp without any, entered the lane
  Cycle looked_at_ = 0;                 ///< when the last sample has read all registers
};

}  // namespace halfplane
