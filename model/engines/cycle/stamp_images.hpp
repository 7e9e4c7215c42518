// Stamp images: the framebuffer as the stages downstream of interpolate see it, a stamp at a time. Whether a stamp is
// on the chip or in memory makes no difference to bits, only to time in the caches.
#pragma once

#include <array>
#include <span>

#include "../../stages/depth_test.hpp"
#include "../../stages/framebuffer.hpp"
#include "../../stages/pixel_colors.hpp"

namespace halfplane {

class StampImages {
 public:
  /// `frames`: one for each sample of a pixel. Both must outlive this.
  StampImages(std::span<Framebuffer> frames, const Widths& widths)
      : frames_(frames), widths_(widths), stamps_(widths.stamps) {
    for (int pixel = 0; pixel < stamps_.pixels(); ++pixel) {
      const PixelOffset place = stamps_.place_of(pixel);
      offset_[static_cast<std::size_t>(pixel)] = place.y * frames_[0].stride + place.x;
    }
  }

  /// Moves on to a stamp.
  void enter(const StampAddress& at) {
    const PixelOffset in_tile = stamps_.origin_of(at.stamp);
    first_ = {(at.tile_x << widths_.tile_shift) + in_tile.x, (at.tile_y << widths_.tile_shift) + in_tile.y};
    index_ = frames_[0].at(first_.x, first_.y);
  }

  /// The pixel of a sample, in the target.
  [[nodiscard]] PixelOffset pixel(std::size_t s) const {
    const PixelOffset in_stamp = stamps_.pixel_of(static_cast<int>(s));
    return {first_.x + in_stamp.x, first_.y + in_stamp.y};
  }

  /// The words of `samples` as in the depth RAM, and their colours; other samples are undefined.
  [[nodiscard]] std::span<const std::uint32_t> words(SampleMask samples) {
    samples.for_each([&](std::size_t s) {
      const auto& [frame, at] = stored(s);
      code_[s] = depth_word(frame.depth[at], frame.stencil[at], widths_);
    });
    return code_;
  }
  [[nodiscard]] std::span<const std::uint32_t> colors(SampleMask samples) {
    samples.for_each([&](std::size_t s) { code_[s] = color(s); });
    return code_;
  }

  void write(const WritePacket& packet) const {
    packet.write_depth.for_each([&](std::size_t s) {
      const auto& [frame, at] = stored(s);
      frame.depth[at] = depth_of(packet.depth[s], widths_);
      frame.stencil[at] = stencil_of(packet.depth[s], widths_);
    });
    packet.write_color.for_each([&](std::size_t s) {
      const auto& [frame, at] = stored(s);
      frame.color[at] = packet.color[s];
    });
  }

  /// Whether in each pixel of the stamp all samples are in `mask` and stored equally, or none is.
  [[nodiscard]] bool has_one_color(SampleMask mask) const {
    return halfplane::has_one_color(mask, widths_, [&](std::size_t s) { return color(s); });
  }

 private:
  struct Stored {
    Framebuffer& frame;
    std::size_t at;
  };
  [[nodiscard]] Stored stored(std::size_t s) const {
    const auto pixel = static_cast<std::size_t>(stamps_.pixel_number(static_cast<int>(s)));
    return {frames_[s & (frames_.size() - 1)], index_ + static_cast<std::size_t>(offset_[pixel])};
  }
  [[nodiscard]] std::uint32_t color(std::size_t s) const {
    const auto& [frame, at] = stored(s);
    return frame.color[at];
  }

  std::span<Framebuffer> frames_;
  const Widths& widths_;
  StampGrid stamps_;
  PixelOffset first_;                    ///< first pixel of the stamp, in the target
  std::size_t index_ = 0;                ///< its index in the images
  std::array<int, kMaxSamples> offset_;  ///< from there to each pixel of a stamp
  std::array<std::uint32_t, kMaxSamples> code_;
};

}  // namespace halfplane
