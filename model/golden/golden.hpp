// The float golden model: the scene without snap, quantization or fixed-point arithmetic (image U).
//
// Deliberately independent code: it shares scene, configuration and framebuffer type with the model, but no stage. The
// docs call the pixel values "real"; here they are binary64, contraction off.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "../config.hpp"
#include "../counters.hpp"
#include "../scene.hpp"
#include "../stages/framebuffer.hpp"
#include "../study/rules.hpp"
#include "fragment_buffer.hpp"

namespace halfplane::golden {

/// binary64 is the reference. binary32 shows the effect of a GPU's single precision: it cannot judge a 24-bit depth.
enum class Precision { binary64, binary32 };

/// The place of a golden triangle, line or point, after clipping: for distances to edges and for eye-space depth.
struct Outline {
  std::size_t corners = 3;         ///< 3: triangle, 2: line from [0] to [1], 1: point
  std::uint32_t primitive = 0;     ///< input primitive, over the whole scene
  std::uint32_t draw = 0;          ///< index into Scene::commands
  std::array<double, 3> x{}, y{};  ///< pixels, y down
  std::array<double, 3> z{};       ///< window depth, 0...1, without polygon offset
  std::array<double, 3> inverse_w{};
};

/// Stored values, width * height entries each, rows from the top.
struct Samples {
  std::vector<std::int32_t> ids;             ///< input primitive that owns the stored colour or depth, -1 none
  std::vector<double> depth;                 ///< window z * (2^B - 1), not rounded: LSB of the interpolated depth
  std::vector<std::array<double, 4>> color;  ///< 0...255, not rounded
};

/// All per-pixel vectors have width * height entries, rows from the top. With several samples per pixel: the mean of
/// their colours; depth and owner of sample 0.
struct Image : Samples {
  int width = 0, height = 0;
  std::vector<std::uint32_t> count;  ///< covered samples before the depth test
  std::vector<Samples> samples;      ///< of each sample of a pixel; empty with one sample per pixel
  Framebuffer frame;                 ///< the same, rounded to the stored formats
  Counters counters;                 ///< primitives, covered, samples_tested, depth_passed, written
  std::vector<Outline> outlines;     ///< primitives that were not culled, if requested
};

/// A fragment at the entry of the operations, and its fate. Depths in LSB of the interpolated depth, not rounded.
struct TappedFragment {
  std::uint32_t primitive = 0, draw = 0;  ///< as in Outline
  std::size_t outline = 0;                ///< its index in Image::outlines; with want_outlines
  int x = 0, y = 0;                       ///< pixels
  int sample = 0;                         ///< in its pixel: each covered sample is a fragment of its own
  double depth = 0, stored_depth = 0;     ///< its own depth, and the stored one before it
  std::array<double, 4> color{};          ///< 0...255, with its texture
  Fate fate;
};

struct Options {
  Precision precision = Precision::binary64;
  Clipping clipping = Clipping::polygon;
  std::optional<ColorInterp> color_interp;                  ///< instead of the states' values
  std::optional<TextureInterp> texture_interp;              ///< likewise
  bool want_outlines = false;                               ///< not for triangles drawn without clipping
  std::optional<Rect> only;                                 ///< draws touch only these pixels; clears touch all
  std::function<void(const TappedFragment&)> fragment_tap;  ///< in program order; may be empty
  std::function<void(double fraction)> progress;  ///< 0...1, called once per 64 primitives or so; may be empty
};

/// Renders every command in program order. Throws InputError for a target larger than the configuration's: each pixel
/// takes 70 bytes here.
[[nodiscard]] Image render(const Scene& scene, const Config& config, const Options& options);
[[nodiscard]] Image render(const Scene& scene, const Config& config, Precision precision = Precision::binary64);

/// The largest code of a channel in the stored format: 31, 63, 31, 255 or 255 each. rgb565 stores no alpha.
[[nodiscard]] std::array<int, 4> channel_max(ColorFormat format);
[[nodiscard]] int channel_count(ColorFormat format);

/// One channel of a stored colour code.
[[nodiscard]] int stored_channel(std::uint32_t color, ColorFormat format, int channel);

/// A colour, 0 to 255, rounded to the nearest of the stored format: relates Image::frame to Samples::color.
[[nodiscard]] std::uint32_t rounded_color(const std::array<double, 4>& rgba, ColorFormat format);

}  // namespace halfplane::golden
