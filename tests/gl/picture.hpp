// A context that draws into a picture of 64x64 pixels without a window.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "gl/core/commands.hpp"
#include "gl/core/context.hpp"
#include "model/config.hpp"

namespace halfplane::gl {

/// Window coordinates follow glOrtho(0, 64, 0, 64, ...): a unit is a pixel, y up.
struct Picture {
  static constexpr int kSide = 64;

  explicit Picture(const std::string& config = "full stencil.bits=8 texture.unit=trilinear perspective.colors=1",
                   OnMissing on_missing = OnMissing::warn)
      : options(options_of(config, on_missing)), drawable(options, kSide, kSide) {
    context.drawable = context.read_drawable = &drawable;
    viewport(context, 0, 0, kSide, kSide);
    pixels();
  }

  /// Vertices are given in pixels.
  void pixels() {
    matrix_mode(context, GL_PROJECTION);
    load_identity(context);
    ortho(context, 0, kSide, 0, kSide, -1, 1);
    matrix_mode(context, GL_MODELVIEW);
    changed();
  }
  /// A command was called here that entry points would have counted.
  void changed() { ++context.revision; }

  /// R, G, B, A of the pixel, from the bottom left.
  [[nodiscard]] std::array<int, 4> pixel(int x, int y) {
    const Framebuffer& picture = drawable.frame.picture();
    const std::uint32_t code = picture.color[picture.at(x, kSide - 1 - y)];
    std::array<int, 4> rgba{};
    for (std::size_t c = 0; c < 4; ++c) rgba[c] = static_cast<int>(code >> (8 * c) & 255);
    return rgba;
  }
  [[nodiscard]] std::array<int, 3> rgb(int x, int y) {
    const auto [r, g, b, a] = pixel(x, y);
    return {r, g, b};
  }
  [[nodiscard]] bool is_drawn(int x, int y) { return rgb(x, y) != std::array{0, 0, 0}; }
  [[nodiscard]] std::uint32_t depth(int x, int y) {
    const Framebuffer& picture = drawable.frame.picture();
    return picture.depth[picture.at(x, kSide - 1 - y)];
  }
  [[nodiscard]] int stencil(int x, int y) {
    const Framebuffer& picture = drawable.frame.picture();
    return picture.stencil[picture.at(x, kSide - 1 - y)];
  }
  /// Pixels that are not black.
  [[nodiscard]] int drawn_pixels() {
    int count = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) count += is_drawn(x, y) ? 1 : 0;
    return count;
  }
  /// "#.#" of a row, from x = first on.
  [[nodiscard]] std::string row(int y, int first, int count) {
    std::string text;
    for (int x = first; x < first + count; ++x) text += is_drawn(x, y) ? '#' : '.';
    return text;
  }

  void black() {
    changed();
    clear_color(context, 0, 0, 0, 0);
    clear(context, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  }
  /// Between glBegin and glEnd, in the current attributes.
  void draw(GLenum mode, std::initializer_list<std::array<double, 2>> places) {
    changed();
    begin(context, mode);
    for (const auto& [x, y] : places) vertex(context, x, y, 0, 1);
    end(context);
  }
  GLenum error() {
    const GLenum code = context.error;
    context.error = GL_NO_ERROR;
    return code;
  }

  [[nodiscard]] static Options options_of(const std::string& config, OnMissing on_missing) {
    Options options;
    options.config = labelled(config);
    options.on_missing = on_missing;
    return options;
  }

  Options options;
  Drawable drawable;
  Context context;
};

}  // namespace halfplane::gl
