// The stencil in lanes: test and update of a triangle's pixels in a tile, from stencil_ops.hpp, with the depth and the alpha
// test between them. The 64 stored values of a tile are lanes of 16 bits, in the order of its pixels.
#pragma once

#include "bin.inl"
#include "fragments.inl"
#include "operations.inl"
#include "tile_memory.inl"
#include "values.inl"

namespace halfplane::functional::HALFPLANE_ISA_NAME {
namespace {

/// Stencil values of a tile of the target.
struct TileStencil {
  std::uint8_t* first;
  std::ptrdiff_t stride;

  HALFPLANE_INLINE TileStencil(const Bin& bin, int tile)
      : first(bin.job.target.stencil.data() + in_target(bin, tile)), stride(bin.job.target.stride) {}

  HALFPLANE_INLINE S64 load() const {
    std::array<std::uint8_t, kTilePixels> bytes;
    for (std::size_t row = 0; row < kTilePixels / kBlockSize; ++row)
      std::memcpy(bytes.data() + kBlockSize * row, first + place_of_row(row), kBlockSize);
    alignas(64) std::array<std::int16_t, kTilePixels> codes;
    for (std::size_t i = 0; i < kTilePixels; ++i) codes[i] = bytes[i];
    return S64::load(codes.data());
  }
  HALFPLANE_INLINE void store(const S64& values) const {
    alignas(64) std::array<std::int16_t, kTilePixels> codes;
    values.store(codes.data());
    std::array<std::uint8_t, kTilePixels> bytes;
    for (std::size_t i = 0; i < kTilePixels; ++i) bytes[i] = static_cast<std::uint8_t>(codes[i]);
    for (std::size_t row = 0; row < kTilePixels / kBlockSize; ++row)
      std::memcpy(first + place_of_row(row), bytes.data() + kBlockSize * row, kBlockSize);
  }

 private:
  /// Of a block's row of four pixels, block after block.
  HALFPLANE_INLINE std::ptrdiff_t place_of_row(std::size_t row) const {
    const auto block = static_cast<std::ptrdiff_t>(row / kBlockSize),
               line = static_cast<std::ptrdiff_t>(row % kBlockSize);
    return (block / 2 * kBlockSize + line) * stride + block % 2 * kBlockSize;
  }
};

/// The stored values after an operation: apply_stencil().
HALFPLANE_INLINE S64 after_operation(StencilOp op, const Stencil& s, const S64& stored) {
  const auto result = [&]() HALFPLANE_LAMBDA {
    switch (op) {
      case StencilOp::keep: return stored;
      case StencilOp::zero: return S64(0);
      case StencilOp::replace: return S64(s.reference);
      case StencilOp::incr: return min(stored + 1, S64(255));
      case StencilOp::decr: return max(stored - 1, S64(0));
      case StencilOp::invert: return 255 - stored;
      case StencilOp::incr_wrap: return (stored + 1) & 255;
      case StencilOp::decr_wrap: return (stored - 1) & 255;
    }
    return stored;
  }();
  const std::int16_t mask = s.write_mask;
  return (result & mask) | (stored & static_cast<std::int16_t>(~mask));
}

/// The pixels of a tile whose depths pass the test.
HALFPLANE_INLINE std::uint64_t nearer_pixels(Bin& bin, const BinTriangle& t, int tile) {
  if (bin.ops->state.depth_test == DepthFunc::always) return ~std::uint64_t{0};
  need_depth(bin, tile);
  const BlockRamp<I16> plane = depth_ramp(bin, t, depth_anchor(bin, t, tile % kBinTiles, tile / kBinTiles));
  const auto first = static_cast<std::size_t>(first_of(tile));
  std::uint64_t nearer = 0;
  for_each_block([&](auto block) HALFPLANE_LAMBDA {
    const I16 passes = OpaqueFragments<false>::passes(bin.state, block_depths(bin, t, plane, block),
                                                      load_depths(bin, first + block * kBlockPixels));
    nearer |= std::uint64_t{bits_of(passes)} << (kBlockPixels * block);
  });
  return nearer;
}

/// Draws the `covered` pixels of a triangle in a tile; returns those that pass the stencil and the depth test. A pixel that
/// the alpha test drops changes nothing: apply_fragment().
HALFPLANE_NOINLINE std::uint64_t draw_tile_by_stencil(Bin& bin, const BinTriangle& t, int tile, std::uint64_t covered) {
  const FragmentOps& ops = *bin.ops;
  const Stencil& side = (*ops.stencil)[bin.is_back ? 1 : 0];
  const TileStencil memory(bin, tile);
  const S64 stored = memory.load();
  const SliceState of_stencil{FragmentState{side.func, false, false}};
  const std::int16_t read_mask = side.read_mask;
  const std::uint64_t matches = bits_of(OpaqueFragments<false>::passes(
                          of_stencil, S64(static_cast<std::int16_t>(side.reference & read_mask)), stored & read_mask)),
                      nearer = nearer_pixels(bin, t, tile), passed = covered & matches & nearer;
  const bool writes_values = writes_stencil(side), tests_alpha = ops.alpha.func != DepthFunc::always;
  std::uint64_t kept = writes_values ? covered : passed;
  const std::uint64_t shown = tests_alpha ? kept : ops.state.color_write ? passed : 0;
  if (shown != 0) {
    const TileColors colors(bin, t, tile, shown);
    if (tests_alpha) kept = test_alpha(bin, kept, colors);
    if (ops.state.color_write && (passed & kept) != 0) {
      need_color(bin, tile);
      store_colors(bin, bin.memory.color.data() + first_of(tile), passed & kept, colors);
    }
  }
  count_killed(bin, static_cast<unsigned>(std::popcount(passed & ~kept)));
  if (ops.state.depth_write) write_depths(bin, t, tile, passed & kept);
  if (!writes_values) return passed;
  S64 now = stored;
  const auto operate = [&](StencilOp op, std::uint64_t pixels) HALFPLANE_LAMBDA {
    if (op != StencilOp::keep && pixels != 0) now = select(lanes_of(pixels), after_operation(op, side, stored), now);
  };
  operate(side.stencil_fails, kept & ~matches);
  operate(side.depth_fails, kept & matches & ~nearer);
  operate(side.passes, kept & passed);
  memory.store(now);
  return passed;
}

/// Whether a fragment that fails the depth test changes nothing, on either side of a draw's triangles.
inline bool keeps_where_hidden(const StencilSides& sides) {
  return std::ranges::all_of(sides, [](const Stencil& s) {
    return s.write_mask == 0 || (s.stencil_fails == StencilOp::keep && s.depth_fails == StencilOp::keep);
  });
}

/// Whether a triangle shows its back, where the stencil has two sides. The rotation of vertices in records keeps the
/// sign of the area.
inline bool shows_back(const Bin& bin, const Slice& slice, const Record& record) {
  if (!bin.ops->stencil || record.kind() != RecordKind::triangle) return false;
  const VertexRow &a = slice.vertices[record.v[0]], &b = slice.vertices[record.v[1]], &c = slice.vertices[record.v[2]];
  const std::int64_t area = signed_area({a.x, a.y, {}}, {b.x, b.y, {}}, {c.x, c.y, {}});
  return halfplane::shows_back(area, slice.context->state.front);
}

}  // namespace
}  // namespace halfplane::functional::HALFPLANE_ISA_NAME
