// Stamp images: the framebuffer as the stages downstream of interpolate see it, a stamp at a time. Whether a stamp is
// on the chip or in memory makes no difference to bits, only to time in the caches.
#pragma once

#include <array>
#include <span>

#include "../../stages/depth_test.hpp"
#include "../../stages/framebuffer.hpp"

namespace halfplane {

class StampImages {
 public:
  /// `frames`: one for each sample of a pixel. Both must outlive this.
  StampImages(std::span<Framebuffer> frames, const Widths& widths)
      : frame_(frames[0]), widths_(widths), stamps_(widths.stamps), word_(widths) {
    for (std::size_t s = 0; s < static_cast<std::size_t>(widths.samples); ++s) {
      Framebuffer& frame = frames[s & (frames.size() - 1)];
      const PixelOffset place = stamps_.pixel_of(static_cast<int>(s));
      const int offset = place.y * frame.stride + place.x;
      sample_[s] = {frame.depth.data() + offset, frame.color.data() + offset, frame.stencil.data() + offset};
    }
  }

  /// Moves on to a stamp.
  void enter(const StampAddress& at) {
    const PixelOffset in_tile = stamps_.origin_of(at.stamp);
    first_ = {(at.tile_x << widths_.tile_shift) + in_tile.x, (at.tile_y << widths_.tile_shift) + in_tile.y};
    index_ = frame_.at(first_.x, first_.y);
  }

  /// The pixel of a sample, in the target.
  [[nodiscard]] PixelOffset pixel(std::size_t s) const {
    const PixelOffset in_stamp = stamps_.pixel_of(static_cast<int>(s));
    return {first_.x + in_stamp.x, first_.y + in_stamp.y};
  }

  /// The words of `samples` as in the depth RAM, and their colours; other samples are undefined.
  [[nodiscard]] std::span<const std::uint32_t> words(SampleMask samples) {
    samples.for_each([this](std::size_t s) { code_[s] = sample_[s].depth[index_]; });
    if (word_.has_stencil())
      samples.for_each([this](std::size_t s) { code_[s] = word_.pack(code_[s], sample_[s].stencil[index_]); });
    return code_;
  }
  [[nodiscard]] std::span<const std::uint32_t> colors(SampleMask samples) {
    samples.for_each([&](std::size_t s) { code_[s] = color(s); });
    return code_;
  }

  void write(const WritePacket& packet) const {
    packet.write_depth.for_each([&](std::size_t s) { sample_[s].depth[index_] = word_.depth(packet.depth[s]); });
    if (word_.has_stencil())
      packet.write_depth.for_each([&](std::size_t s) { sample_[s].stencil[index_] = word_.stencil(packet.depth[s]); });
    packet.write_color.for_each([&](std::size_t s) { sample_[s].color[index_] = packet.color[s]; });
  }

  /// The pixels of the stamp whose samples are stored with one colour.
  [[nodiscard]] SampleMask even_pixels() const {
    SampleMask even;
    for (int pixel = 0; pixel < widths_.pixels; ++pixel) {
      const auto first = static_cast<std::size_t>(pixel * widths_.pixel_samples);
      bool is_even = true;
      for (std::size_t s = first; s < first + static_cast<std::size_t>(widths_.pixel_samples); ++s)
        is_even = is_even && color(s) == color(first);
      even.set(pixel, is_even);
    }
    return even;
  }

 private:
  /// A sample of the stamp at the first pixel, in its images.
  struct Sample {
    std::uint32_t *depth, *color;
    std::uint8_t* stencil;
  };
  [[nodiscard]] std::uint32_t color(std::size_t s) const { return sample_[s].color[index_]; }

  const Framebuffer& frame_;
  const Widths& widths_;
  StampGrid stamps_;
  DepthWord word_;
  PixelOffset first_;      ///< first pixel of the stamp, in the target
  std::size_t index_ = 0;  ///< its index in the images
  std::array<Sample, kMaxSamples> sample_;
  std::array<std::uint32_t, kMaxSamples> code_;
};

}  // namespace halfplane
