// The primitives of a frame, sorted by bin (frame.order bins).
//
// A bin is an aligned rectangle of pixels whose blocks have a cache line each: nothing leaves the chip while it is
// drawn. In: primitives in program order. Out: bin by bin, the primitives that touch it, in program order, each cut to
// the bin. A pixel lies in one bin, so its fragments keep their order, and the picture is that of program order.
//
// The whole frame must be here before the first primitive is sent: memory is primitives, and 4 bytes for each of their
// bins.
//
// A bin with the same draws as in the frame before holds the same picture, and is skipped (BinContents): its signature
// covers everything that its pixels depend on, in order. Signatures of 128 bits (signature.hpp) are equal by chance
// once in 2^128 comparisons.
#pragma once

#include <optional>
#include <vector>

#include "../config.hpp"
#include "../signature.hpp"
#include "host_primitive.hpp"
#include "line_setup.hpp"

namespace halfplane {

/// Input of line_setup to begin a line again in each bin.
struct WholeLine {
  SnappedVertex start, end;
  LineRule rule = LineRule::diamond;
  bool drops_last = false;
  PixelBounds limit;  ///< the scissor, inside the target
};

/// The content of a target in memory that was drawn in bins.
struct BinContents {
  int width = 0, height = 0;   ///< of the target, pixels
  std::vector<Signature> bin;  ///< row by row; empty: unknown
  void forget() { bin.clear(); }
};

/// Whether successive frames are compared bin by bin: only if no bin has depths to be kept.
[[nodiscard]] inline bool compares_bins(const Config& config) {
  return config.frame_order == FrameOrder::bins && config.frame_store == FrameStore::color;
}

class FrameBins {
 public:
  /// For a target of width x height pixels. `compares`: compares bins with the previous frame's, on hardware with
  /// these clears.
  FrameBins(const Widths& widths, int width, int height, std::optional<FrameClears> compares = {});

  /// Whether bins consist of whole tiles, as required for a clear of one bin.
  [[nodiscard]] static bool has_whole_tiles(const Widths& widths);

  /// Nothing has been added since the last primitive was sent.
  [[nodiscard]] bool is_empty() const { return items_.empty(); }

  /// A triangle with the right facing, a point, or a rectangle. Returns whether it may cover a sample.
  bool add(const HostPrimitive& primitive);

  /// A line with a pixel inside its limit; `primitive` without its setup.
  void add(const HostPrimitive& primitive, const WholeLine& line);

  /// The frame is complete. `drops_depth`: the final depths are never read. With `held`: bins whose content equals
  /// their draws over `clears` are skipped, where that pays off; on return it is the content of memory after this
  /// frame.
  void close(bool drops_depth, BinContents* held = nullptr, const Signature& clears = {});

  /// After close(): the boxes of the bins that must be cleared, one by one; none: all of the target at once.
  [[nodiscard]] const std::optional<std::vector<PixelBounds>>& cleared() const { return cleared_; }
  /// Whether next() will return a primitive.
  [[nodiscard]] bool has_next() const;

  /// After close(): the next primitive; none after the last, and then a new frame may be added.
  [[nodiscard]] std::optional<HostPrimitive> next();

  [[nodiscard]] std::uint64_t bins() const { return bins_; }    ///< not empty, of all frames closed so far
  [[nodiscard]] std::uint64_t pairs() const { return pairs_; }  ///< triangles, lines and points in them
  /// Bins that are not empty and were skipped.
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }

 private:
  static constexpr std::uint32_t kNoLine = ~0U;
  struct Item {
    PrimitivePacket packet;
    std::uint32_t primitive = 0, command = 0;
    std::uint32_t line = kNoLine;  ///< index into lines_
    UnitWords units{};
    Signature signature{};  ///< where bins are compared
  };

  [[nodiscard]] PixelBounds box_of(std::size_t bin) const;
  template <class Touches>
  bool add_to_bins(const PixelBounds& box, Touches&& touches);
  [[nodiscard]] HostPrimitive part(const Item& item, const PixelBounds& bin) const;
  [[nodiscard]] Signature signature_of(const HostPrimitive& primitive, const WholeLine* line);
  void leave_out_equal(BinContents& held, const Signature& clears);
  [[nodiscard]] std::uint64_t least_cycles(std::size_t bin) const;

  Widths widths_;
  int target_width_, target_height_;
  std::optional<FrameClears> compares_;
  int width_, height_;  ///< of a bin, pixels
  std::size_t columns_;
  std::vector<Item> items_;
  std::vector<WholeLine> lines_;
  std::vector<std::vector<std::uint32_t>> bin_;  ///< row by row: indices into items_
  bool is_closed_ = false;
  std::size_t bin_next_ = 0, item_next_ = 0;  ///< the next bin and item
  std::uint64_t bins_ = 0, pairs_ = 0, left_out_ = 0;
  std::optional<std::vector<PixelBounds>> cleared_;
  UnitSignatures units_;
};

}  // namespace halfplane
