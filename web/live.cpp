// The door for pictures that move: a scene stays open and is drawn by the functional engine, call by call. engine.mjs calls it.
#include <algorithm>
#include <cstdint>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "model/engines/functional.hpp"
#include "sim/cli/options.hpp"
#include "sim/show/image/framebuffer_files.hpp"

namespace {

using namespace halfplane;

/// A scene, its options and the engine that keeps its memory from frame to frame.
struct Live {
  std::string line;  ///< the arguments, which are compared
  CommonOptions options;
  Config config;
  MovingScene source;
  FunctionalEngine engine;

  Live(std::string of, CommonOptions with)
      : line(std::move(of)),
        options(std::move(with)),
        config(drawing_config(options)),
        source(open_scene(options, config)),
        engine(config) {}
};

std::optional<Live> live;
std::vector<std::uint32_t> pixels;  // bytes R, G, B, A
std::string message;

/// As color_picture(), for pictures that move. Of rgb565 the colours of all codes are one picture, made once.
void take_pixels(const Framebuffer& frame, ColorFormat format) {
  constexpr std::uint32_t kOpaque = 0xff000000;
  static const std::vector<std::uint32_t> of_rgb565 = [] {
    Framebuffer codes(256, 256, 8);
    for (std::uint32_t code = 0; code < 65536; ++code) codes.color[code] = code;
    const Picture colors = color_picture(codes, ColorFormat::rgb565);
    std::vector<std::uint32_t> table;
    for (std::size_t i = 0; i < colors.rgb.size(); i += 3)
      table.push_back(kOpaque |
                      static_cast<std::uint32_t>(colors.rgb[i + 2] << 16 | colors.rgb[i + 1] << 8 | colors.rgb[i]));
    return table;
  }();
  pixels.clear();
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const std::uint32_t code = frame.color[frame.at(x, y)];
      pixels.push_back(format == ColorFormat::rgb565 ? of_rgb565[code] : code | kOpaque);
    }
}

/// Arguments in lines, as of `halfplane render`: the scene and the common options.
void open_live(const char* lines) {
  if (live && live->line == lines) return;
  std::vector<std::string> words;
  std::istringstream in(lines);
  for (std::string word; std::getline(in, word);) words.push_back(word);
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  CLI::App app;
  CommonOptions options;
  add_scene_options(app, options);
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what());
  }
  live.reset();
  live.emplace(lines, std::move(options));
}

}  // namespace

extern "C" {

/// Draws one frame: `turn`, part of the camera's orbit; `time`, seconds of the animation, below 0 none. Returns
/// width << 16 | height, or -1, when live_message() says why.
int live_frame(const char* lines, double turn, double time) {
  try {
    open_live(lines);
    Moment moment;
    moment.turn = turn;
    if (time >= 0) moment.time = time;
    const Scene scene = prepared(live->source.at(moment), live->options, live->config);
    RenderOptions render;
    render.resolved_only = true;
    const Rendering& drawn = live->engine.render(scene, render);
    take_pixels(drawn.frame, live->config.color_format);
    return drawn.frame.width << 16 | drawn.frame.height;
  } catch (const std::exception& error) {
    live.reset();
    message = error.what();
    return -1;
  }
}

/// Files of the scene may be other ones now.
void live_close() { live.reset(); }

const void* live_pixels() { return pixels.data(); }
const char* live_message() { return message.c_str(); }
}
