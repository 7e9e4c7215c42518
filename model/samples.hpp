// The samples of a stamp: their number and numbering, and masks of them.
//
// A stamp is a square of pixels. Its samples are numbered pixel by pixel, row by row, and samples of a pixel are
// consecutive. A pixel has one sample, at its centre, or several (sample_pattern.hpp).
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace halfplane {

/// The largest number of samples of a stamp: the bits of a mask.
inline constexpr std::size_t kMaxSamples = 64;

/// A set of samples of one stamp: bit n is sample n.
class SampleMask {
 public:
  constexpr SampleMask() = default;
  constexpr explicit SampleMask(std::uint64_t bits) : bits_(bits) {}
  /// Sample n alone.
  [[nodiscard]] static constexpr SampleMask only(int n) { return SampleMask(std::uint64_t{1} << n); }

  /// The first n, at least one.
  [[nodiscard]] static constexpr SampleMask all(int n) { return SampleMask(~std::uint64_t{0} >> (64 - n)); }

  [[nodiscard]] constexpr std::uint64_t bits() const { return bits_; }
  [[nodiscard]] constexpr bool any() const { return bits_ != 0; }
  [[nodiscard]] constexpr bool has(std::size_t n) const { return (bits_ >> n & 1) != 0; }
  [[nodiscard]] constexpr int count() const { return std::popcount(bits_); }
  /// Numbers of the lowest and the highest sample. Precondition: any().
  [[nodiscard]] constexpr int first() const { return std::countr_zero(bits_); }
  [[nodiscard]] constexpr int last() const { return 63 - std::countl_zero(bits_); }
  constexpr void set(int n, bool value = true) { bits_ |= std::uint64_t{value} << n; }

  /// Calls visit(number) for each sample, lowest first.
  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    for (std::uint64_t left = bits_; left != 0; left &= left - 1)
      visit(static_cast<std::size_t>(std::countr_zero(left)));
  }

  constexpr bool operator==(const SampleMask&) const = default;
  [[nodiscard]] friend constexpr SampleMask operator&(SampleMask a, SampleMask b) {
    return SampleMask(a.bits_ & b.bits_);
  }
  [[nodiscard]] friend constexpr SampleMask operator|(SampleMask a, SampleMask b) {
    return SampleMask(a.bits_ | b.bits_);
  }

 private:
  std::uint64_t bits_ = 0;
};

/// A place: offset in pixels from the first pixel of a stamp or of a tile.
struct PixelOffset {
  int x = 0, y = 0;
};

/// The stamps of a tile and the samples of a stamp. All three are powers of two, so that a place needs shifts, not
/// divisions.
struct StampGrid {
  int size = 1;            ///< pixels along the side of a stamp
  int stamps_per_row = 1;  ///< stamps along the side of a tile
  int per_pixel = 1;       ///< samples of a pixel

  constexpr StampGrid() = default;
  constexpr StampGrid(int size_, int stamps_per_row_, int per_pixel_)
      : size(size_),
        stamps_per_row(stamps_per_row_),
        per_pixel(per_pixel_),
        size_log2_(log2(size)),
        stamps_per_row_log2_(log2(stamps_per_row)),
        per_pixel_log2_(log2(per_pixel)) {}

  [[nodiscard]] constexpr int stamps() const { return stamps_per_row * stamps_per_row; }
  [[nodiscard]] constexpr int pixels() const { return size * size; }
  [[nodiscard]] constexpr int samples() const { return pixels() * per_pixel; }
  /// The place of a pixel, by number, in its stamp; the pixel of a sample.
  [[nodiscard]] constexpr PixelOffset place_of(int pixel) const { return {pixel & (size - 1), pixel >> size_log2_}; }
  [[nodiscard]] constexpr int pixel_number(int sample) const { return sample >> per_pixel_log2_; }
  [[nodiscard]] constexpr PixelOffset pixel_of(int sample) const { return place_of(pixel_number(sample)); }
  /// The first sample of a pixel of the stamp.
  [[nodiscard]] constexpr int sample_at(int x, int y) const { return (y * size + x) * per_pixel; }
  /// All samples of a pixel of the stamp.
  [[nodiscard]] constexpr SampleMask samples_at(int x, int y) const {
    return SampleMask(SampleMask::all(per_pixel).bits() << sample_at(x, y));
  }
  /// The samples of pixel `pixel` that are in `mask`, sample 0 of the pixel the lowest bit.
  [[nodiscard]] constexpr unsigned of_pixel(SampleMask mask, int pixel) const {
    return static_cast<unsigned>(mask.bits() >> pixel * per_pixel & SampleMask::all(per_pixel).bits());
  }
  /// The same samples in every pixel: the lowest bits of `of_pixel`.
  [[nodiscard]] constexpr SampleMask in_every_pixel(unsigned of_pixel) const {
    const std::uint64_t samples = of_pixel & SampleMask::all(per_pixel).bits();
    std::uint64_t bits = 0;
    for (int pixel = 0; pixel < pixels(); ++pixel) bits |= samples << pixel * per_pixel;
    return SampleMask(bits);
  }
  /// The pixels with a sample in `mask`.
  [[nodiscard]] constexpr SampleMask pixels_of(SampleMask mask) const {
    if (per_pixel == 1) return mask;
    SampleMask result;
    for (int pixel = 0; pixel < pixels(); ++pixel) result.set(pixel, of_pixel(mask, pixel) != 0);
    return result;
  }
  /// All samples of these pixels.
  [[nodiscard]] constexpr SampleMask samples_of(SampleMask of_pixels) const {
    if (per_pixel == 1) return of_pixels;
    std::uint64_t bits = 0;
    for (int pixel = 0; pixel < pixels(); ++pixel)
      if (of_pixels.has(static_cast<std::size_t>(pixel)))
        bits |= SampleMask::all(per_pixel).bits() << pixel * per_pixel;
    return SampleMask(bits);
  }
  /// The first pixel of a stamp, in its tile.
  [[nodiscard]] constexpr PixelOffset origin_of(int stamp) const {
    return {column_of(stamp) << size_log2_, row_of(stamp) << size_log2_};
  }
  /// Its column and row in the tile, in stamps.
  [[nodiscard]] constexpr int column_of(int stamp) const { return stamp & (stamps_per_row - 1); }
  [[nodiscard]] constexpr int row_of(int stamp) const { return stamp >> stamps_per_row_log2_; }
  [[nodiscard]] constexpr int stamp_number(int column, int row) const { return (row << stamps_per_row_log2_) + column; }
  /// The stamp that holds a pixel of the tile.
  [[nodiscard]] constexpr int stamp_at(int x, int y) const { return stamp_number(x >> size_log2_, y >> size_log2_); }

 private:
  [[nodiscard]] static constexpr int log2(int power) { return std::countr_zero(static_cast<unsigned>(power)); }

  int size_log2_ = 0, stamps_per_row_log2_ = 0, per_pixel_log2_ = 0;
};

}  // namespace halfplane
