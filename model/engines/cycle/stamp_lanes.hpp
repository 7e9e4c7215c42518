// Stamps of 2x2 pixels in four lanes, from the edges to the stored colours, where the depth test is the only operation
// on fragments. Bits and counters are those of fine_raster, interpolate and FragmentPath, whose arithmetic this is modulo
// 2^32.
#pragma once

#include <cstring>

#include "../../stages/depth_test.hpp"
#include "../../stages/fine_raster.hpp"
#include "../../stages/framebuffer.hpp"

namespace halfplane {

class StampLanes {
 public:
  StampLanes(const Config& config, const Widths& widths) : config_(config), widths_(widths) {
    const int channels = config.color_format == ColorFormat::rgba8888 ? 4 : 3;
    fits_ = widths.has_samples == 0 && widths.stamps.size == kSize && widths.affine_planes > channels &&
            !has_texture_planes(config) && !packs_at_write(config);
    has_alpha_ = channels == 4;
    for (std::size_t p = 0; p < kPlanes; ++p) {
      const CodePlace& place = widths.code_place[p];
      codes_[p] = {place.shift, Lanes{} + place.offset, Lanes{} + place.mask};
      fits_ = fits_ && (std::uint64_t{place.mask} << place.shift) >> 32 == 0;  // in the lower 32 bits
    }
  }

  /// Whether a primitive is drawn here. `tests_alpha`: by the colour registers.
  [[nodiscard]] bool draws(const PrimitiveState& state, bool tests_alpha) const {
    return fits_ && !tests_alpha && !state.tests_stencil;
  }

  /// The tiles that follow are of this primitive.
  void begin(const ContextPacket& context, const EdgeContext& edges) {
    state_ = context.state;
    for (std::size_t e = 0; e < 3; ++e)
      edges_[e] = Steps(static_cast<std::uint32_t>(edges.step_x[e]), static_cast<std::uint32_t>(edges.step_y[e]));
    for (std::size_t p = 0; p < kPlanes; ++p)
      planes_[p] = Steps(static_cast<std::uint32_t>(context.step_x[p]), static_cast<std::uint32_t>(context.step_y[p]));
  }

  /// Of the primitive.
  [[nodiscard]] const PrimitiveState& state() const { return state_; }

  /// Draws a tile: visit(stamp, covered, passed) for each stamp with a covered sample, row by row, with a bit for each
  /// sample. Returns the end of the visit.
  template <class Visit>
  RetirePacket draw(const TilePacket& tile, Framebuffer& frame, CounterPacket& counters, Visit&& visit) {
    const StampGrid& stamps = widths_.stamps;
    const PixelBounds box = to_bounds(tile.box);
    const int half_tile = 1 << (widths_.tile_shift - 1);
    const DepthOutcomes passes(state_.depth_test);
    int full = 0;
    Lanes covered{}, passed{}, largest{};  // the first two: counts
    for (int y = box.top & -kSize; y <= box.bottom; y += kSize) {
      const unsigned rows = (y >= box.top ? 3U : 0U) | (y + 1 <= box.bottom ? 12U : 0U);
      int x = box.left & -kSize;
      std::array<Lanes, 3> edge;
      for (std::size_t e = 0; e < 3; ++e) edge[e] = edges_[e].at(static_cast<std::uint32_t>(tile.edge_value[e]), x, y);
      std::size_t at =
          frame.at((tile.key.tile_x << widths_.tile_shift) + x, (tile.key.tile_y << widths_.tile_shift) + y);
      for (; x <= box.right; x += kSize, at += kSize) {
        const unsigned in_box = rows & ((x >= box.left ? 5U : 0U) | (x + 1 <= box.right ? 10U : 0U));
        unsigned mask = in_box;
        if (!tile.is_inside) {
          mask &= ~bits_of(lane_mask<Lanes>(reinterpret_cast<SignedLanes>(edge[0] | edge[1] | edge[2]) < 0));
          for (std::size_t e = 0; e < 3; ++e) edge[e] += edges_[e].stamp_x;
        }
        if (mask == 0) continue;
        const Lanes& drawn = kLanesOf[mask];
        const auto code = [&](std::size_t p) {
          const Code& place = codes_[p];
          const Lanes value = planes_[p].at(static_cast<std::uint32_t>(tile.anchor[p]), x - half_tile, y - half_tile);
          return ((value >> place.shift) - place.offset) & place.mask;
        };
        const Lanes depth = code(kDepthPlane), stored = load(frame.depth, at, frame.stride);
        const Lanes pass = passes(depth, stored) & drawn;
        const unsigned bits = bits_of(pass);
        if (bits != 0) {
          if (state_.depth_write) store(write_where(pass, depth, stored), frame.depth, at, frame.stride);
          if (state_.color_write) {
            const Channels<Lanes> channels{code(kColorPlane), code(kColorPlane + 1), code(kColorPlane + 2),
                                           has_alpha_ ? code(kColorPlane + 3) : Lanes{}};
            const Lanes color = pack_color<Lanes>(config_.color_format, channels);
            store(write_where(pass, color, load(frame.color, at, frame.stride)), frame.color, at, frame.stride);
          }
          if (bits == 15) {
            ++full;
            largest = halfplane::largest(largest, depth);
          }
        }
        covered -= drawn;  // 1 more where the mask is set
        passed -= pass;
        visit(stamps.stamp_at(x, y), mask, bits);
      }
    }
    if (is_counted(tile.kind)) {
      counters.covered += sum(covered);
      counters.depth_passed += sum(passed);
      if (state_.writes()) counters.written += sum(passed);
    }
    RetirePacket retired;
    retired.key = tile.key;
    set_hiz_update(retired, state_, full == stamps.stamps(), sum(passed) != 0,
                   std::max({largest[0], largest[1], largest[2], largest[3]}), config_, widths_);
    return retired;
  }

 private:
  static constexpr int kSize = 2, kPlanes = 5;  ///< pixels along a stamp; depth and the colours
  /// A lane for each pixel of a stamp, row by row.
  using Lanes __attribute__((vector_size(16))) = std::uint32_t;
  using SignedLanes __attribute__((vector_size(16))) = std::int32_t;
  using Rows __attribute__((vector_size(16))) = std::uint64_t;

  /// A value that is linear over the pixels of a tile.
  struct Steps {
    std::uint32_t x = 0, y = 0;  ///< per pixel
    Lanes stamp_x{};             ///< from a stamp to the next
    Lanes in_stamp{};            ///< from the first pixel of a stamp to each
    Steps() = default;
    Steps(std::uint32_t x_, std::uint32_t y_)
        : x(x_), y(y_), stamp_x(Lanes{} + kSize * x_), in_stamp{0, x_, y_, x_ + y_} {}
    /// At the pixels of the stamp that lies i and j pixels from a pixel with value `from`.
    [[nodiscard]] Lanes at(std::uint32_t from, int i, int j) const {
      return (Lanes{} + (from + static_cast<std::uint32_t>(i) * x + static_cast<std::uint32_t>(j) * y)) + in_stamp;
    }
  };

  [[nodiscard]] static std::uint32_t sum(const Lanes& v) { return v[0] + v[1] + v[2] + v[3]; }
  /// The place of a code in its plane (CodePlace).
  struct Code {
    int shift = 0;
    Lanes offset{}, mask{};
  };

  /// A bit for each lane whose mask is set.
  [[nodiscard]] static unsigned bits_of(const Lanes& mask) {
#ifdef __SSE__
    using Floats __attribute__((vector_size(16))) = float;
    return static_cast<unsigned>(__builtin_ia32_movmskps(reinterpret_cast<Floats>(mask)));
#else
    const auto rows = reinterpret_cast<Rows>(mask & Lanes{1, 2, 4, 8});
    const std::uint64_t both = rows[0] | rows[1];
    return static_cast<unsigned>(both | both >> 32);
#endif
  }
  /// The inverse.
  static constexpr std::array<Lanes, 16> kLanesOf = [] {
    std::array<Lanes, 16> lanes{};
    for (unsigned bits = 0; bits < 16; ++bits) {
      const auto lane = [bits](unsigned n) { return (bits >> n & 1) != 0 ? ~std::uint32_t{0} : 0; };
      lanes[bits] = Lanes{lane(0), lane(1), lane(2), lane(3)};
    }
    return lanes;
  }();

  [[nodiscard]] static Lanes load(const Framebuffer::Image& image, std::size_t at, int stride) {
    std::array<std::uint64_t, kSize> rows;
    std::memcpy(&rows[0], &image[at], sizeof rows[0]);
    std::memcpy(&rows[1], &image[at + static_cast<std::size_t>(stride)], sizeof rows[1]);
    return reinterpret_cast<Lanes>(Rows{rows[0], rows[1]});
  }
  static void store(const Lanes& values, Framebuffer::Image& image, std::size_t at, int stride) {
    const auto rows = reinterpret_cast<Rows>(values);
    const std::array<std::uint64_t, kSize> row{rows[0], rows[1]};
    std::memcpy(&image[at], &row[0], sizeof row[0]);
    std::memcpy(&image[at + static_cast<std::size_t>(stride)], &row[1], sizeof row[1]);
  }

  Config config_;
  Widths widths_;
  bool fits_ = false, has_alpha_ = false;
  PrimitiveState state_;
  std::array<Steps, 3> edges_;
  std::array<Steps, kPlanes> planes_;
  std::array<Code, kPlanes> codes_;
};

}  // namespace halfplane
