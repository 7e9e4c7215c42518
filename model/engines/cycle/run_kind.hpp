// The runs that a timing is compiled for. Half of the model's time is in times, and asking each stamp for what a plain run
// never has is a part of it.
#pragma once

namespace halfplane {

/// Any run.
struct AnyRun {
  static constexpr bool is_plain = false;
};

/// A run that nothing stalls or watches, of a framebuffer of blocks without texture unit, blending and compress.unit.
struct PlainRun {
  static constexpr bool is_plain = true;
};

}  // namespace halfplane
