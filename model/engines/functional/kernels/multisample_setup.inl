// Increments of sixteen small or medium triangles from the centre of a pixel to its samples, a triangle a lane:
// multisample.hpp.
#pragma once

#include "leaf.inl"
#include "small_batch.inl"
#include "small_setup.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

// The steps of a plane per pixel, in a tile's precision, and from them the increment to a sample:
// sample_plane_offset(), modulo a tile's wrap window. A step that wraps keeps as many bits as the increment still has
// without its fraction.

/// In 32 bits, if planes fit.
struct PixelStepsI {
  I16 x, y;

  HALFPLANE_INLINE PixelStepsI(const Gradients<I16>& steps, const LaneFormat& format)
      : x(rounded(steps.x, format.step_drop)), y(rounded(steps.y, format.step_drop)) {}
  HALFPLANE_INLINE I16 gain(const SampleOffset& o, int s) const {
    return shift_right_logical(x * o.x + y * o.y + (1 << (s - 1)), s);
  }

 private:
  HALFPLANE_INLINE static I16 rounded(const I16& step, int drop) {
    return shift_right_logical(step + (1 << (drop - 1)), drop);
  }
};

/// Split, like the gradients, at a pixel's fraction of `s` bits.
struct PixelStepsSplit {
  I16 x, y;              ///< upper part
  I16 x_lower, y_lower;  ///< lower part, rounded

  HALFPLANE_INLINE PixelStepsSplit(const Gradients<SplitLanes>& steps, const LaneFormat& format)
      : x(steps.x.upper),
        y(steps.y.upper),
        x_lower(rounded(steps.x.lower, format.step_drop)),
        y_lower(rounded(steps.y.lower, format.step_drop)) {}
  HALFPLANE_INLINE I16 gain(const SampleOffset& o, int s) const {
    return x * o.x + y * o.y + ((x_lower * o.x + y_lower * o.y + (1 << (s - 1))) >> s);
  }

 private:
  HALFPLANE_INLINE static I16 rounded(const I16& lower, int drop) { return (lower + (1 << (drop - 1))) >> drop; }
};

/// In 64 bits.
struct PixelStepsL {
  L16 x, y;

  HALFPLANE_INLINE PixelStepsL(const Gradients<L16>& steps, const LaneFormat& format)
      : x(rounded(steps.x, format.step_drop)), y(rounded(steps.y, format.step_drop)) {}
  HALFPLANE_INLINE I16 gain(const SampleOffset& o, int s) const {
    return convert<std::int32_t>((x * o.x + y * o.y + (std::int64_t{1} << (s - 1))) >> s);
  }

 private:
  HALFPLANE_INLINE static L16 rounded(const L16& step, int drop) {
    return drop <= 0 ? step << -drop : (step + (std::int64_t{1} << (drop - 1))) >> drop;
  }
};

HALFPLANE_INLINE PixelStepsI pixel_steps(const Gradients<I16>& steps, const LaneFormat& format) {
  return {steps, format};
}
HALFPLANE_INLINE PixelStepsSplit pixel_steps(const Gradients<SplitLanes>& steps, const LaneFormat& format) {
  return {steps, format};
}
HALFPLANE_INLINE PixelStepsL pixel_steps(const Gradients<L16>& steps, const LaneFormat& format) {
  return {steps, format};
}

/// A batch at each sample; set_up_small() fills it.
struct SmallSamples {
  const Widths& widths;
  std::size_t count;                                                        ///< of a pixel
  alignas(64) std::array<SmallBatch::LaneArray<3>, kMaxPixelSamples> edge;  ///< as SmallBatch::edge, at each sample
  alignas(64) std::array<SmallBatch::Lane, kMaxPixelSamples> depth;         ///< increments, in a lane
  alignas(64) std::array<SmallBatch::FourChannels, kMaxPixelSamples> color;
  alignas(64) std::array<SmallBatch::LaneArray<4>, kMaxPixelSamples> channel;  ///< increments of each channel

  HALFPLANE_INLINE explicit SmallSamples(const Widths& of)
      : widths(of), count(static_cast<std::size_t>(of.pixel_samples)) {}

  /// Edge e, with the dropped bits of its value: sample_edge_offset().
  HALFPLANE_INLINE void move_edge(std::size_t e, const I16& exact, const I16& dx, const I16& dy, bool is_short) {
    for (std::size_t k = 0; k < count; ++k) {
      const SampleOffset& o = widths.sample_offset[k];
      const I16 value = (exact - dy * o.x + dx * o.y) >> widths.grid_bits;
      (is_short ? doubled(value) : value).store(edge[k][e].data());
    }
  }
  template <class Steps>
  HALFPLANE_INLINE void move_depth(const Steps& steps, const LaneFormat& format) {
    const auto of_pixel = pixel_steps(steps, format);
    for (std::size_t k = 0; k < count; ++k)
      (of_pixel.gain(widths.sample_offset[k], widths.grid_bits) << format.up).store(depth[k].data());
  }
  template <class Steps>
  HALFPLANE_INLINE void move_channel(std::size_t c, const Steps& steps, const LaneFormat& format) {
    const auto of_pixel = pixel_steps(steps, format);
    for (std::size_t k = 0; k < count; ++k)
      (of_pixel.gain(widths.sample_offset[k], widths.grid_bits) << format.up).store(channel[k][c].data());
  }
  /// A channel that is constant over each triangle.
  HALFPLANE_INLINE void keep_channel(std::size_t c) {
    for (std::size_t k = 0; k < count; ++k) I16(0).store(channel[k][c].data());
  }
  /// To be called after the last channel.
  HALFPLANE_INLINE void join_channels() {
    for (std::size_t k = 0; k < count; ++k) {
      const auto pair = [&](std::size_t c) HALFPLANE_LAMBDA {
        return pairs(I16::load(channel[k][c].data()), I16::load(channel[k][c + 1].data()));
      };
      store_interleaved(pair(0), pair(2), color[k].data());
    }
  }
};

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
