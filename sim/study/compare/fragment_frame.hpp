// The result of a tap's fragments in a target by the golden's own operations: for each pixel, the fragment it shows.
//
// The tests store a fragment unchanged or not at all, so that the exact and the unrounded values of a pixel are those
// of its visible fragment and can be computed on demand. They compare stored codes, as real numbers. Colours of several
// fragments are layers (layers.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "layers.hpp"
#include "model/engines/render.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/golden/fragment_buffer.hpp"
#include "model/stages/depth_encode.hpp"

namespace halfplane {

class FragmentFrame {
 public:
  /// `sample`: number of the target's sample in a pixel.
  FragmentFrame(const Scene& scene, const Config& config, int sample = 0);

  /// The next fragment in program order; fragments of other samples are ignored.
  void add(const TappedFragment& fragment);
  /// To be called after the last fragment.
  void finish() { clear_until(scene_.commands.size()); }

  /// By pixel, y * width + x: the primitive that owns it, -1 none; and the fragment it shows, where it is owned.
  [[nodiscard]] const std::vector<std::int32_t>& owners() const { return pixels_.owners(); }
  [[nodiscard]] const LayeredColors& layers() const { return layers_; }
  [[nodiscard]] const TappedFragment& shown(std::size_t pixel) const { return shown_[pixel]; }

 private:
  struct Nothing {};

  void clear_until(std::size_t command);
  [[nodiscard]] bool is_equal(const TappedFragment& a, const TappedFragment& b, const State& state) const;

  const Scene& scene_;
  const Config& config_;
  int sample_;
  DepthEncode depth_encode_;
  golden::FragmentBuffer<double, Nothing> pixels_;  // stored depth codes
  LayeredColors layers_;
  std::vector<TappedFragment> shown_;
  std::size_t next_command_ = 0;
};

/// The numbers of owned pixels, in the order in which errors are summed: by triangle, then by primitive of the lines,
/// then by primitive of the points.
struct OwnedPixels {
  std::vector<std::uint32_t> pixels;  // a target has at most 2^28
  std::uint64_t triangles = 0;        // visible triangles

  explicit OwnedPixels(const FragmentFrame& frame);
};

}  // namespace halfplane
