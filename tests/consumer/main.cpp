// A stranger's first program: only the library, no other package. Draws two triangles that share an edge and checks that
// every pixel is drawn once; with an argument, also shows the picture in the terminal.
#include <cstdint>
#include <cstdio>
#include <string>

#include <halfplane/config.hpp>
#include <halfplane/engines/functional.hpp>
#include <halfplane/scene.hpp>

namespace {

constexpr int width = 64, height = 40;  // pixels; two rows share one line of text

/// A square of two triangles with a colour at each corner, in window space.
halfplane::Scene square() {
  halfplane::Scene scene;
  scene.width = width;
  scene.height = height;
  scene.states.emplace_back().space = halfplane::Space::window;
  scene.vertices = {{12, 2, 0.5, 1, {255, 64, 64, 255}},
                    {52, 2, 0.5, 1, {64, 255, 64, 255}},
                    {52, 38, 0.5, 1, {64, 64, 255, 255}},
                    {12, 38, 0.5, 1, {255, 255, 64, 255}}};
  scene.indices = {0, 1, 2, 0, 2, 3};
  scene.commands.emplace_back(halfplane::Clear{.color = {{24, 24, 32, 255}}, .depth = 1.0});
  scene.commands.emplace_back(halfplane::Draw{.count = scene.indices.size()});
  return scene;
}

/// Two pixels, one above the other, in one character cell: the upper half block in two 24-bit colours.
std::string cell(std::uint32_t upper, std::uint32_t lower) {
  const auto rgb = [](std::uint32_t c) {  // rgba8888: R in the lowest byte
    return std::to_string(c & 255) + ';' + std::to_string(c >> 8 & 255) + ';' + std::to_string(c >> 16 & 255);
  };
  return "\033[38;2;" + rgb(upper) + ";48;2;" + rgb(lower) + "m\u2580";
}

void show(const halfplane::Framebuffer& frame) {
  for (int y = 0; y < height; y += 2) {
    std::string line;
    for (int x = 0; x < width; ++x) line += cell(frame.color[frame.at(x, y)], frame.color[frame.at(x, y + 1)]);
    std::printf("%s\033[0m\n", line.c_str());
  }
}

}  // namespace

int main(int argc, char**) {
  halfplane::RenderOptions options;
  options.want_count = true;
  const auto result = halfplane::render_functional(square(), halfplane::preset("full"), options);

  if (argc > 1) show(result.frame);

  // 40 x 36 pixel centres lie in the square; the diagonal between the triangles must not count twice.
  int wrong = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool inside = x >= 12 && x < 52 && y >= 2 && y < 38;
      wrong += result.count[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] != (inside ? 1U : 0U);
    }
  }
  std::printf("%llu samples covered, %d pixels not drawn exactly once\n",
              static_cast<unsigned long long>(result.counters.covered), wrong);
  return wrong == 0 ? 0 : 1;
}
