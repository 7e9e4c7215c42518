// Stamps of 2x2 pixels in four lanes, from the edges to the stored colours, where the depth test is the only operation
// on fragments. Bits and counters are those of fine_raster, interpolate and FragmentPath, whose arithmetic this is modulo
// 2^32.
#pragma once

#include <cstring>
#include <type_traits>

#include "../../stages/coarse_raster.hpp"
#include "../../stages/depth_test.hpp"
#include "../../stages/fine_raster.hpp"
#include "../../stages/framebuffer.hpp"
#include "steps.hpp"

namespace halfplane {

class StampLanes {
 public:
  StampLanes(const Config& config, const Widths& widths) : config_(config), widths_(widths) {
    const int channels = config.color_format == ColorFormat::rgba8888 ? 4 : 3;
    fits_ = widths.has_samples == 0 && widths.stamps.size == kSize && widths.affine_planes > channels &&
            !has_texture_planes(config) && !packs_at_write(config);
    has_alpha_ = channels == 4;
    fits_ = fits_ && widths.code_place[kDepthPlane].mask >> 31 == 0;  // passes()
    for (std::size_t p = 0; p < kPlanes; ++p) {
      const CodePlace& place = widths.code_place[p];
      const AttributeWidths& attribute = widths.of_plane(p);
      const int drop = attribute.plane.bits - attribute.local.bits;
      codes_[p] = {place.shift, Lanes{} + place.mask, drop, drop - widths.grid_bits};
      if (p < kFirstPlanes) offsets_[p] = 0U - (place.offset << place.shift);
      fits_ = fits_ && (std::uint64_t{place.mask} << place.shift) >> 32 == 0;  // in the lower 32 bits
    }
  }

  /// Whether a primitive is drawn here. `tests_alpha`: by the colour registers.
  [[nodiscard]] bool draws(const PrimitiveState& state, bool tests_alpha) const {
    return fits_ && !tests_alpha && !state.tests_stencil;
  }

  /// The tiles that follow are of this primitive.
  void begin(const SetupPacket& setup) {
    state_ = setup.state;
    first_x_ = setup.box.left >> widths_.tile_shift;
    first_y_ = setup.box.top >> widths_.tile_shift;
    for (std::size_t e = 0; e < 3; ++e)
      edges_[e] = Steps(static_cast<std::uint32_t>(-setup.dy[e]), static_cast<std::uint32_t>(setup.dx[e]));
    const auto per_pixel = [&](std::int64_t step, std::size_t p) {  // ContextPacket
      return static_cast<std::uint32_t>(round_shift(step, codes_[p].step_drop));
    };
    Lanes x, y;
    for (std::size_t p = 0; p < kFirstPlanes; ++p) {
      const std::uint32_t step_x = per_pixel(setup.step_x[p], p), step_y = per_pixel(setup.step_y[p], p);
      in_stamp_[p] = Lanes{0, step_x, step_y, step_x + step_y};
      x[p] = step_x;
      y[p] = step_y;
    }
    if (has_alpha_)
      alpha_ = Steps(per_pixel(setup.step_x[kFirstPlanes], kFirstPlanes),
                     per_pixel(setup.step_y[kFirstPlanes], kFirstPlanes));
    stamp_x_ = x << 1;
    stamp_y_ = y << 1;
    to_corner_ = offsets_ - ((x + y) << (widths_.tile_shift - 1));
    const DepthOutcomes passes(state_.depth_test);
    greater_ = Lanes{} + passes.greater;
    less_ = greater_ ^ passes.less;
    equal_ = greater_ ^ passes.equal;
  }

  /// Draws a tile of the primitive. Its stamps go to `next`, and how many there are in each row of stamps in the box to
  /// `row`. Returns the end of the visit.
  [[gnu::always_inline]] RetirePacket draw(const SetupPacket& setup, const VisitedTile& tile, Framebuffer& frame,
                                           CounterPacket& counters, LaneStamp*& next, std::uint8_t*& row) {
    const StampGrid& stamps = widths_.stamps;
    const PixelBounds box = to_bounds(tile.box);
    const int left = box.left & -kSize, top = box.top & -kSize;
    const std::uint64_t columns_in_box = ((std::uint64_t{2} << (box.right - box.left)) - 1) << (box.left - left);
    std::array<Lanes, 3> row_edge{};
    for (std::size_t e = 0; e < 3 && !tile.is_inside; ++e)
      row_edge[e] = edges_[e].at(edge_at(tile.edges[e]), left, top);
    Lanes row_planes = to_corner_;  // a lane for each of the first planes, at the first pixel of a stamp
    for (std::size_t p = 0; p < kFirstPlanes; ++p) row_planes[p] += anchor(setup, tile, p);
    const std::uint32_t alpha_anchor = has_alpha_ ? anchor(setup, tile, kFirstPlanes) : 0;
    if ((left | top) != 0)
      row_planes +=
          stamp_x_ * static_cast<std::uint32_t>(left / kSize) + stamp_y_ * static_cast<std::uint32_t>(top / kSize);
    const auto row_stride = static_cast<std::size_t>(kSize * frame.stride);
    std::size_t row_at = frame.at((tile.x << widths_.tile_shift) + left, (tile.y << widths_.tile_shift) + top);
    int row_number = stamps.stamp_at(left, top);
    Lanes covered_of{}, passed_of{};  // by lane, negative
    int full = 0;
    Lanes largest{};
    for (int y = top; y <= box.bottom; y += kSize) {
      const LaneStamp* const first = next;
      const unsigned rows = (y >= box.top ? 3U : 0U) | (y + 1 <= box.bottom ? 12U : 0U);
      std::array<Lanes, 3> edge = row_edge;
      Lanes planes = row_planes;
      std::size_t at = row_at;
      int number = row_number;
      for (std::uint64_t columns = columns_in_box; columns != 0; columns >>= kSize) {
        unsigned mask = rows & static_cast<unsigned>(columns & 3) * 5;  // a column has bits 0 and 2, or 1 and 3
        if (!tile.is_inside) {
          mask &= ~bits_of(lane_mask<Lanes>(reinterpret_cast<SignedLanes>(edge[0] | edge[1] | edge[2]) < 0));
          for (std::size_t e = 0; e < 3; ++e) edge[e] += edges_[e].stamp_x;
        }
        if (mask != 0) {
          const auto code = [&](auto plane) {
            constexpr std::size_t p = decltype(plane)::value;
            const Code& place = codes_[p];
            const Lanes value = __builtin_shufflevector(planes, planes, p, p, p, p) + in_stamp_[p];
            return (value >> place.shift) & place.mask;
          };
          const Lanes depth = code(Plane<kDepthPlane>()), stored = load(frame.depth, at, frame.stride);
          const Lanes inside = kLanesOf[mask], pass = passes(depth, stored) & inside;
          const unsigned bits = bits_of(pass);
          if (bits != 0) {
            if (state_.depth_write) store(write_where(pass, depth, stored), frame.depth, at, frame.stride);
            if (state_.color_write) {
              const Channels<Lanes> channels{code(Plane<kColorPlane>()), code(Plane<kColorPlane + 1>()),
                                             code(Plane<kColorPlane + 2>()),
                                             has_alpha_ ? alpha(alpha_anchor, number) : Lanes{}};
              const Lanes color = pack(channels);
              store(write_where(pass, color, load(frame.color, at, frame.stride)), frame.color, at, frame.stride);
            }
            if (bits == 15) {
              ++full;
              largest = halfplane::largest(largest, depth);
            }
          }
          covered_of += inside;
          passed_of += pass;
          *next++ = {static_cast<std::uint16_t>(number), static_cast<std::uint8_t>(mask),
                     static_cast<std::uint8_t>(bits)};
        }
        planes += stamp_x_;
        at += kSize;
        ++number;
      }
      *row++ = static_cast<std::uint8_t>(next - first);
      for (std::size_t e = 0; e < 3; ++e) row_edge[e] += edges_[e].stamp_y;
      row_planes += stamp_y_;
      row_at += row_stride;
      row_number += stamps.stamps_per_row;
    }
    const std::uint32_t passed = minus_sum(passed_of);
    if (is_counted(setup.kind)) {
      counters.covered += minus_sum(covered_of);
      counters.depth_passed += passed;
      if (state_.writes()) counters.written += passed;
    }
    RetirePacket retired;
    retired.key = {setup.primitive_id, static_cast<std::uint16_t>(tile.x), static_cast<std::uint16_t>(tile.y)};
    const bool is_full = full == stamps.stamps();
    set_hiz_update(retired, state_, is_full, passed != 0,
                   is_full ? std::max({largest[0], largest[1], largest[2], largest[3]}) : 0, config_, widths_);
    return retired;
  }

 private:
  static constexpr int kSize = 2;  ///< pixels along a stamp
  /// Depth and the colours; and of these all but alpha, which step from stamp to stamp in one vector.
  static constexpr std::size_t kPlanes = 5, kFirstPlanes = 4;
  template <std::size_t p>
  using Plane = std::integral_constant<std::uint32_t, p>;
  /// A lane for each pixel of a stamp, row by row.
  using Lanes __attribute__((vector_size(16))) = std::uint32_t;
  using SignedLanes __attribute__((vector_size(16))) = std::int32_t;
  using Halves __attribute__((vector_size(16))) = std::uint16_t;
  using Rows __attribute__((vector_size(16))) = std::uint64_t;

  /// A value that is linear over the pixels of a tile.
  struct Steps {
    std::uint32_t x = 0, y = 0;  ///< per pixel
    Lanes stamp_x{}, stamp_y{};  ///< from a stamp to the next one to the right, and below
    Lanes in_stamp{};            ///< from the first pixel of a stamp to each
    Steps() = default;
    Steps(std::uint32_t x_, std::uint32_t y_)
        : x(x_), y(y_), stamp_x(Lanes{} + kSize * x_), stamp_y(Lanes{} + kSize * y_), in_stamp{0, x_, y_, x_ + y_} {}
    /// At the pixels of the stamp that lies i and j pixels from a pixel with value `from`.
    [[nodiscard]] Lanes at(std::uint32_t from, int i, int j) const {
      return (Lanes{} + (from + static_cast<std::uint32_t>(i) * x + static_cast<std::uint32_t>(j) * y)) + in_stamp;
    }
  };

  /// The place of a code in its plane (CodePlace); its offset is subtracted before the shift.
  struct Code {
    int shift = 0;
    Lanes mask{};
    int drop = 0, step_drop = 0;  ///< bits that the plane has below a local anchor, and its steps below those per pixel
  };

  [[nodiscard]] std::uint32_t edge_at(EdgeValue value) const {
    return static_cast<std::uint32_t>(widths_.edge_value.bits <= 32 ? value : saturate_tile_edge(value, widths_));
  }

  /// TilePacket::anchor, modulo 2^32; bits above those of a local plane are undefined.
  [[nodiscard]] std::uint32_t anchor(const SetupPacket& setup, const VisitedTile& tile, std::size_t p) const {
    const auto offset = [&](int tiles) {  // subpixels
      return static_cast<std::uint64_t>(std::int64_t{tiles}) << (widths_.tile_shift + widths_.grid_bits);
    };
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(setup.value[p]) +
                                       static_cast<std::uint64_t>(setup.step_x[p]) * offset(tile.x - first_x_) +
                                       static_cast<std::uint64_t>(setup.step_y[p]) * offset(tile.y - first_y_)) >>
                                      codes_[p].drop);
  }

  [[nodiscard]] Lanes alpha(std::uint32_t at_anchor, int stamp) const {
    constexpr std::size_t p = kFirstPlanes;
    const PixelOffset at = widths_.stamps.origin_of(stamp);
    const int half_tile = 1 << (widths_.tile_shift - 1);
    const std::uint32_t from = at_anchor - (widths_.code_place[p].offset << codes_[p].shift);
    return (alpha_.at(from, at.x - half_tile, at.y - half_tile) >> codes_[p].shift) & codes_[p].mask;
  }

  /// pack_color(). The sums of rgb565 have 16 bits, for which SSE2 has a multiplication.
  [[nodiscard]] Lanes pack(const Channels<Lanes>& c) const {
    if (config_.color_format != ColorFormat::rgb565) return pack_color<Lanes>(config_.color_format, c);
    const auto halves = [](const Lanes& lanes) { return reinterpret_cast<Halves>(lanes); };
    return reinterpret_cast<Lanes>(pack_rgb565<Halves>(halves(c[0]), halves(c[1]), halves(c[2])));
  }

  /// DepthOutcomes of depths below 2^31.
  [[nodiscard]] Lanes passes(const Lanes& depth, const Lanes& stored) const {
    const auto d = reinterpret_cast<SignedLanes>(depth), s = reinterpret_cast<SignedLanes>(stored);
    return greater_ ^ (reinterpret_cast<Lanes>(d < s) & less_) ^ (reinterpret_cast<Lanes>(d == s) & equal_);
  }

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
  [[nodiscard]] static std::uint32_t minus_sum(const Lanes& lanes) {
    return 0U - (lanes[0] + lanes[1] + lanes[2] + lanes[3]);
  }

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
  int first_x_ = 0, first_y_ = 0;       ///< the first tile
  Lanes greater_{}, less_{}, equal_{};  ///< DepthOutcomes: the first, and where the others differ from it
  std::array<Steps, 3> edges_;
  std::array<Lanes, kFirstPlanes> in_stamp_{};  ///< of a plane, from the first pixel of a stamp to each
  Steps alpha_;
  // A lane for each of the first planes: from a stamp to the next one to the right, and below; from the anchor of a tile
  // to its first pixel.
  Lanes stamp_x_{}, stamp_y_{}, to_corner_{};
  Lanes offsets_{};  ///< of their codes, negative
  std::array<Code, kPlanes> codes_;
};

}  // namespace halfplane
