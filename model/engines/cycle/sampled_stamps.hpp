// Sampled stamps: what a triangle covers in a tile where pixels have several samples, stamp by stamp as the stages have it. A
// pixel with one sample has the rows of TileKernel instead.
#pragma once

#include <vector>

#include "../../stages/coarse_raster.hpp"
#include "../../stages/fine_raster.hpp"
#include "../../stages/interpolate.hpp"

namespace halfplane {

class SampledStamps {
 public:
  /// Of a primitive, which rides with `kind` and `state`.
  SampledStamps(const TriangleSetup& setup, PrimitiveKind kind, const PrimitiveState& state, const Widths& widths)
      : widths_(widths),
        setup_(to_setup_packet(setup, widths)),
        edges_(make_edge_context(setup_)),
        stamp_(static_cast<std::size_t>(widths.stamps.stamps())) {
    setup_.kind = kind;
    setup_.state = state;
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

}  // namespace halfplane
