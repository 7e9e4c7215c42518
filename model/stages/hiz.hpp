// HiZ: a bound on the depths of each tile, by which coarse_raster drops tiles that cannot pass the depth test.
//
// In: the tile visits and the fast clears, in program order. Out: whether a tile of a primitive can be skipped. The
// bound of a tile is {h, all ones}, h the stored top hiz.bits of a depth code: no depth in the tile is above the bound.
//
// Visit n sees the updates of all visits up to n - lag and of no later one, so that the visible updates follow from
// program order alone and no visit waits for one that has just begun. The visits between can only have lowered depths,
// which keeps a bound valid; if one of them may have raised a depth, by its state, no tile is hidden. A fast
// clear of depth sets all bounds, and updates of earlier visits are dropped.
//
// Lines belong to no tile visit, so no retirement could raise a bound after them. A line whose depth test can raise a
// depth (greater, gequal, notequal, always) invalidates all bounds as it passes coarse_raster: later triangles are not
// tested, until a fast clear of depth sets all bounds again. Program order alone, one flip-flop and no wait; the other
// tests only lower depths, which keeps bounds valid.
#pragma once

#include <algorithm>
#include <vector>

#include "../packets/packets.hpp"
#include "fragment_ops.hpp"

namespace halfplane {

/// The bounds of all tiles. Before the first clear they are all ones: no tile is skipped.
class Hiz {
 public:
  /// A primitive of at most `untested_tiles` tiles in x and in y is never tested.
  explicit Hiz(const Config& config, const Widths& widths, int untested_tiles = kHizUntestedTiles)
      : untested_tiles_(untested_tiles),
        bits_(config.hiz_bits),
        low_bits_(config.depth_bits - hiz_code_bits(config)),
        lag_(config.hiz_lag),
        tiles_x_(static_cast<std::size_t>(widths.tiles_x)),
        code_(tiles_x_ * static_cast<std::size_t>(widths.tiles_y),
              static_cast<std::uint32_t>(widths.hiz_code.range.hi)),
        unseen_(static_cast<std::size_t>(lag_)),
        quiet_(lag_ - 1) {}

  /// Whether the primitive may be tested at all. Not if a failing sample changes the stencil; nor if it has at most 2 x
  /// 2 tiles: reading the bound would cost more than it saves.
  [[nodiscard]] bool is_eligible(const SetupPacket& setup, const Widths& widths) const {
    const auto tiles = [&widths](int first, int last) {
      return (last >> widths.tile_shift) - (first >> widths.tile_shift) + 1;
    };
    const DepthFunc func = setup.state.depth_test;
    const PixelBox& box = setup.box;
    return bits_ > 0 && holds_ && setup.kind == PrimitiveKind::triangle && !setup.state.marks_failed &&
           (tiles(box.left, box.right) > untested_tiles_ || tiles(box.top, box.bottom) > untested_tiles_) &&
           (func == DepthFunc::less || func == DepthFunc::lequal || func == DepthFunc::equal);
  }

  /// Whether no sample of an eligible primitive can pass in this tile.
  [[nodiscard]] bool rejects(const SetupPacket& setup, int tile_x, int tile_y) const {
    if (quiet_ < lag_ - 1) return false;
    const std::uint64_t nearest = setup.range.low[kDepthPlane], farthest = bound(tile_x, tile_y);
    return setup.state.depth_test == DepthFunc::less ? nearest >= farthest : nearest > farthest;
  }

  void begin_visit(const PrimitiveState& state) {
    quiet_ = state.depth_write && can_raise_depth(state.depth_test) ? 0 : std::min(quiet_ + 1, lag_ - 1);
  }

  /// The visit has retired: the next visit sees the update of the visit `lag` visits before it.
  void retire(const RetirePacket& retired) {
    unseen_[newest_] = retired;
    if (++newest_ == unseen_.size()) newest_ = 0;
    RetirePacket& seen = unseen_[newest_];
    if (seen.update != HizUpdate::none) code_[index(seen.key.tile_x, seen.key.tile_y)] = seen.hiz_code;
    seen = {};
  }

  /// A line follows; its pixels are not visible here.
  void pass_line(const SetupPacket& line) {
    if (line.state.depth_write && can_raise_depth(line.state.depth_test)) holds_ = false;
  }

  /// Tiles (0, 0) to (last_x, last_y), the whole target, now hold the clear depth.
  void clear(int last_x, int last_y, std::uint32_t depth) {
    holds_ = true;
    quiet_ = lag_ - 1;
    std::ranges::fill(unseen_, RetirePacket{});
    if (bits_ == 0) return;
    for (int y = 0; y <= last_y; ++y)
      for (int x = 0; x <= last_x; ++x) code_[index(x, y)] = depth >> low_bits_;
  }

  /// No depth code of the tile is above this.
  [[nodiscard]] std::uint64_t bound(int tile_x, int tile_y) const {
    return ((std::uint64_t{code_[index(tile_x, tile_y)]} + 1) << low_bits_) - 1;
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * tiles_x_ + static_cast<std::size_t>(x);
  }
  bool holds_ = true;  ///< no line can have raised a depth since the last fast clear
  int untested_tiles_;
  int bits_, low_bits_;  ///< bits stored, and dropped, of a depth code
  int lag_;              ///< visits
  std::size_t tiles_x_;
  std::vector<std::uint32_t> code_;
  std::vector<RetirePacket> unseen_;  ///< ring: of the last visits
  std::size_t newest_ = 0;            ///< place of the next visit, and of the oldest
  int quiet_;                         ///< visits since one that may raise a depth, lag - 1 at most
};

}  // namespace halfplane
