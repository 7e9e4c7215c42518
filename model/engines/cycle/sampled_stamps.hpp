// Sampled stamps: what a triangle covers in a tile where pixels have several samples, and what becomes of it, stamp by stamp as
// the stages have it. A pixel with one sample has the rows of TileKernel instead.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "../../stages/coarse_raster.hpp"
#include "../../stages/depth_test.hpp"
#include "../../stages/fine_raster.hpp"
#include "../../stages/framebuffer.hpp"
#include "../../stages/interpolate.hpp"
#include "../../stages/pixel_colors.hpp"
#include "../../stages/rop.hpp"

namespace halfplane {

class SampledStamps {
 public:
  /// Of a primitive, which rides as `packet`.
  SampledStamps(const TriangleSetup& setup, const SetupPacket& packet, const Widths& widths)
      : widths_(widths),
        setup_(to_setup_packet(setup, widths)),
        edges_(make_edge_context(setup_)),
        stamp_(static_cast<std::size_t>(widths.stamps.stamps())) {
    setup_.kind = packet.kind;
    setup_.state = packet.state;
    setup_.coordinates = packet.coordinates;
    context_ = make_context(setup_, widths);
  }

  /// Goes on to a tile. cover(stamp): of each that is not empty.
  template <class Cover>
  void enter(int tile_x, int tile_y, Cover&& cover) {
    fine_raster(make_tile_packet(setup_, tile_x, tile_y, 0, false, widths_), edges_, widths_,
                [&](const StampPacket& stamp) {
                  stamp_[stamp.stamp] = stamp;
                  if (stamp.mask.any()) cover(stamp.stamp);
                });
  }

  /// A stamp of the tile that is not empty, with its attributes.
  [[nodiscard]] FragmentPacket fragment(int stamp) const {
    return interpolate(stamp_[static_cast<std::size_t>(stamp)], context_, widths_);
  }

 private:
  const Widths& widths_;
  SetupPacket setup_;
  EdgeContext edges_;
  ContextPacket context_;
  std::vector<StampPacket> stamp_;  ///< of the tile at work, by number
};

/// The framebuffers of the samples, as the stages behind interpolate use them.
struct SampledTarget {
  std::span<Framebuffer> frames;  ///< of each sample of a pixel
  const Config& config;
  const Widths& widths;

  /// The pixel of a fragment's sample.
  [[nodiscard]] PixelOffset pixel(const FragmentPacket& fragment, std::size_t s) const {
    return pixel({fragment.key.tile_x, fragment.key.tile_y, fragment.stamp}, s);
  }
  [[nodiscard]] PixelOffset pixel(const StampAddress& at, std::size_t s) const {
    const PixelOffset origin = widths.stamps.origin_of(at.stamp),
                      in_stamp = widths.stamps.pixel_of(static_cast<int>(s));
    return {(at.tile_x << widths.tile_shift) + origin.x + in_stamp.x,
            (at.tile_y << widths.tile_shift) + origin.y + in_stamp.y};
  }

  /// Whether of each pixel of a stamp all samples in `mask` are there, and stored alike, or none is.
  [[nodiscard]] bool has_one_color(const StampAddress& at, SampleMask mask) const {
    return halfplane::has_one_color(mask, widths, [&](std::size_t s) {
      const PixelOffset place = pixel(at, s);
      const Framebuffer& frame = frames[s % static_cast<std::size_t>(widths.pixel_samples)];
      return frame.color[frame.at(place.x, place.y)];
    });
  }

  /// depth_test, and rop behind it.
  [[nodiscard]] WritePacket test(const FragmentPacket& fragment, const StencilState& stencil) const {
    std::array<std::uint32_t, kMaxSamples> stored{};
    fragment.mask.for_each([&](std::size_t s) {
      const auto& [frame, at] = stored_at(fragment, s);
      stored[s] = depth_word(frame.depth[at], frame.stencil[at], widths);
    });
    return rop(fragment, depth_test(fragment, stored, stencil, widths), config, widths);
  }

  /// What is written, with the operations on colours.
  void store(const FragmentPacket& fragment, const WritePacket& written, const ColorOps& ops) const {
    written.write_depth.for_each([&](std::size_t s) {
      const auto& [frame, at] = stored_at(fragment, s);
      frame.depth[at] = depth_of(written.depth[s], widths);
      frame.stencil[at] = stencil_of(written.depth[s], widths);
    });
    written.write_color.for_each([&](std::size_t s) {
      const auto& [frame, at] = stored_at(fragment, s);
      const PixelOffset place = pixel(fragment, s);
      frame.color[at] =
          store_color<std::uint32_t>(ops, config.color_format, color_channels(fragment_code(fragment, s, widths)),
                                     frame.color[at], dither_threshold(place.x, place.y));
    });
  }

 private:
  struct Stored {
    Framebuffer& frame;
    std::size_t at;
  };
  [[nodiscard]] Stored stored_at(const FragmentPacket& fragment, std::size_t s) const {
    Framebuffer& frame = frames[s % static_cast<std::size_t>(widths.pixel_samples)];
    const PixelOffset place = pixel(fragment, s);
    return {frame, frame.at(place.x, place.y)};
  }
};

}  // namespace halfplane
