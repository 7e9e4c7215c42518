// A context that draws textures over a whole window, read back as bytes.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "gl/core/commands.hpp"
#include "model/config.hpp"

namespace halfplane::gl {

using Bytes = std::array<GLubyte, 4>;

/// Window coordinates are those of clip space, -1...1.
struct TexturedWindow {
  static constexpr int kSide = 64;

  explicit TexturedWindow(const std::string& config = "full stencil.bits=8", OnMissing on_missing = OnMissing::warn)
      : drawable(options(config, on_missing), kSide, kSide) {
    context.drawable = context.read_drawable = &drawable;
    context.state.viewport.width = context.state.viewport.height = kSide;
    ++context.revision;
  }
  static Options options(const std::string& config, OnMissing on_missing) {
    Options options;
    options.config = labelled(config);
    options.on_missing = on_missing;
    return options;
  }
  static std::shared_ptr<const Image> image(int width, int height, const std::vector<Bytes>& pixels, int depth = 1) {
    auto image = std::make_shared<Image>(Image{width, height, depth, GL_RGBA, {}});
    for (const Bytes& p : pixels)
      image->pixel.push_back({static_cast<float>(p[0]) / 255, static_cast<float>(p[1]) / 255,
                              static_cast<float>(p[2]) / 255, static_cast<float>(p[3]) / 255});
    return image;
  }
  static std::shared_ptr<const Image> filled(int width, int height, const Bytes& pixel, int depth = 1) {
    return image(width, height, std::vector<Bytes>(static_cast<std::size_t>(width * height * depth), pixel), depth);
  }
  void upload(int level, GLint format, const std::shared_ptr<const Image>& pixels, GLenum target = GL_TEXTURE_2D,
              int dimensions = 2) {
    ++context.revision;
    tex_image(context, dimensions, target, level, format, pixels->width, pixels->height, pixels->depth, 0, pixels);
  }
  void parameter(GLenum pname, double value, GLenum target = GL_TEXTURE_2D) {
    ++context.revision;
    tex_parameter(context, target, pname, {{value}, true, false});
  }
  void environment(GLenum pname, double value) {
    ++context.revision;
    tex_env(context, GL_TEXTURE_ENV, pname, {{value}, true, false});
  }
  void env_color(const Vec4& color) { tex_env(context, GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, {color, false, true}); }
  void filter(GLenum both, GLenum target = GL_TEXTURE_2D) {
    parameter(GL_TEXTURE_MIN_FILTER, both, target);
    parameter(GL_TEXTURE_MAG_FILTER, both, target);
  }
  void nearest(GLenum target = GL_TEXTURE_2D) { filter(GL_NEAREST, target); }
  /// Turns a texture of its own on in a unit, which is active from now on.
  void use_unit(GLenum unit, GLenum target = GL_TEXTURE_2D) {
    active_texture(context, unit);
    if (target == GL_TEXTURE_2D) bind_texture(context, target, unit - GL_TEXTURE0 + 1);
    enable(context, target, true);
    nearest(target);
  }
  /// The whole window, with texture coordinates `low` at the bottom left and `high` at the top right.
  void draw(const Vec4& c, const std::array<double, 2>& low, const std::array<double, 2>& high) {
    ++context.revision;
    gl::color(context, c[0], c[1], c[2], c[3]);
    begin(context, GL_QUADS);
    for (const auto& [x, y] : {std::array{0, 0}, std::array{1, 0}, std::array{1, 1}, std::array{0, 1}}) {
      tex_coord(context, GL_TEXTURE0, x == 0 ? low[0] : high[0], y == 0 ? low[1] : high[1], 0, 1);
      vertex(context, 2 * x - 1, 2 * y - 1, 0, 1);
    }
    gl::end(context);
  }
  /// The same from 0 to `end`.
  void draw(const Vec4& c, double end = 1) { draw(c, {0, 0}, {end, end}); }
  Bytes color(int x, int y) {
    Bytes read{};
    read_pixels(context, x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, read.data());
    return read;
  }
  /// Pixels with some red.
  int drawn_pixels() {
    int count = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) count += color(x, y)[0] != 0 ? 1 : 0;
    return count;
  }
  GLenum error() { return get_error(context); }
  double level_parameter(GLenum target, int level, GLenum pname) {
    return get_tex_level_parameter(context, target, level, pname).value.at(0);
  }

  Drawable drawable;
  Context context;
};

inline constexpr Bytes kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kBlue{0, 0, 255, 255}, kGrey{128, 128, 128, 255};

/// Of a channel, within the rounding of a stored colour and one more step.
inline void expect_near(const Bytes& drawn, const Vec4& color) {
  for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(drawn[c], color[c] * 255, 1.01) << "channel " << c;
}

}  // namespace halfplane::gl
