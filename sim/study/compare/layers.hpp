// Layers: the errors of blending, masks and dithering, pixel by pixel. The same fragments, as codes, go through the
// golden's blending in real arithmetic; the stored colour less that is the error of the arithmetic alone, and a bound
// grows with it:
//
//   a plain write   1/2 LSB, dithered 1
//   a logic op.     the largest difference over all pairs of codes that the operands' bounds leave; where both codes
//                   are certain none
//   a blend         |d_m - d| f_d + (d + |d_m - d|) |delta f_d| + s |delta f_s|, then 1/2 of a 255th, then 1/2 LSB of rgb565
//
// d_m is the stored code at the blend's input: rgb565 is widened to 8 bits. A stored code was rounded from 8 bits, k,
// and returns within 4 (5 bits) or 2 (6 bits) of k, which is less than the stored half LSB and half of a 255th
// together. A factor has an error if it is made from the stored colour.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/config.hpp"
#include "model/golden/color.hpp"
#include "model/scene.hpp"

namespace halfplane {

/// The errors of the pixels under that many layers.
struct LayerRow {
  std::uint32_t layers = 0;  ///< colour writes that read the stored colour, since the last that did not
  std::uint64_t pixels = 0;
  double max = 0, rms = 0;   ///< LSB of the stored format, the worst channel of each pixel
  double bound = 0;          ///< the largest
  double part_of_bound = 0;  ///< the largest error as a fraction of its pixel's bound
};

/// Adds a row to the rows of other samples, in the order of their layers.
void add_row(std::vector<LayerRow>& rows, const LayerRow& row);

class LayeredColors {
 public:
  LayeredColors(std::size_t pixels, ColorFormat format);

  /// Writes a fragment's colour. `color`: its codes.
  void write(std::size_t pixel, const State& state, const std::array<std::uint8_t, 4>& color);
  void clear(std::size_t pixel, const std::array<double, 4>& color);

  /// Whether the pixel shows more than the code of one fragment.
  [[nodiscard]] bool is_layered(std::size_t pixel) const { return at_[pixel].is_layered; }

  /// Compares a stored colour with the pixel's.
  void judge(std::size_t pixel, std::uint32_t stored);
  /// Rows of the judged pixels, by number of layers.
  [[nodiscard]] std::vector<LayerRow> rows() const;

 private:
  struct Pixel {
    golden::RealColor real{0, 0, 0, 255};                    ///< 0...255
    std::array<float, 4> bound{};                            ///< LSB of the stored format
    std::array<bool, 4> is_certain{true, true, true, true};  ///< the code nearest to `real` must be the stored one
    std::uint32_t layers = 0;
    bool is_layered = false;
  };
  [[nodiscard]] double bound_of_blend(const Pixel& before, const State& state, const golden::RealColor& source,
                                      std::size_t channel) const;
  /// Sets a channel's bound, and whether its code is certain.
  void bound_logic_op(Pixel& at, const Pixel& before, const State& state, double source, std::size_t channel) const;

  ColorFormat format_;
  std::array<double, 4> most_;  ///< the largest code of each channel
  std::size_t channels_;
  std::vector<Pixel> at_;
  std::vector<LayerRow> rows_;  ///< by layers; rms is still a sum of squares
};

}  // namespace halfplane
