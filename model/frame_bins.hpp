// The primitives of a frame, sorted by bin (frame.order bins).
//
// A bin is an aligned rectangle of pixels whose blocks have a cache line each: nothing leaves the chip while it is drawn.
// In: primitives in program order. Out: bin by bin, those that touch it, in program order, each cut to the bin. A pixel lies
// in one bin, so everything that happens to it keeps its order, and the picture is that of program order.
//
// All of a frame must be here before the first primitive goes: memory is primitives, and 4 bytes for each of their bins.
#pragma once

#include <optional>
#include <vector>

#include "host_primitive.hpp"
#include "stages/line_setup.hpp"

namespace halfplane {

/// What line_setup needs to begin a line again in each bin.
struct WholeLine {
  SnappedVertex start, end;
  LineRule rule = LineRule::diamond;
  bool drops_last = false;
  PixelBounds limit;  ///< the scissor, inside the target
};

class FrameBins {
 public:
  /// Of a target of width x height pixels.
  FrameBins(const Widths& widths, int width, int height);

  /// Nothing has been added since the last primitive went.
  [[nodiscard]] bool is_empty() const { return items_.empty(); }

  /// A triangle that faces the right way, a point, or a rectangle. Returns whether it may cover a sample.
  bool add(const HostPrimitive& primitive);

  /// A line with a pixel inside its limit; `primitive` without its setup.
  void add(const HostPrimitive& primitive, const WholeLine& line);

  /// The frame is complete. `drops_depth`: nobody looks at the depths that it leaves behind.
  void close(bool drops_depth);

  /// Behind close(): the next primitive; none behind the last, and then a new frame may be added.
  [[nodiscard]] std::optional<HostPrimitive> next();

  [[nodiscard]] std::uint64_t bins() const { return bins_; }    ///< with something in them, of all frames closed so far
  [[nodiscard]] std::uint64_t pairs() const { return pairs_; }  ///< triangles, lines and points in them

 private:
  static constexpr std::uint32_t kNoLine = ~0U;
  struct Item {
    PrimitivePacket packet;
    std::uint32_t primitive = 0, command = 0;
    std::uint32_t line = kNoLine;  ///< index into lines_
    UnitWords units{};
  };

  [[nodiscard]] PixelBounds box_of(std::size_t bin) const;
  template <class Touches>
  bool add_to_bins(const PixelBounds& box, Touches&& touches);
  [[nodiscard]] HostPrimitive part(const Item& item, const PixelBounds& bin) const;

  Widths widths_;
  int width_, height_;  ///< of a bin, pixels
  std::size_t columns_;
  std::vector<Item> items_;
  std::vector<WholeLine> lines_;
  std::vector<std::vector<std::uint32_t>> bin_;  ///< row by row: indices into items_
  bool is_closed_ = false;
  std::size_t bin_next_ = 0, item_next_ = 0;  ///< what goes next
  std::uint64_t bins_ = 0, pairs_ = 0;
};

}  // namespace halfplane
