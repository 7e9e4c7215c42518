// halfplane_draw_words: a file of command words, little endian, as a picture.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "draw.hpp"
#include "model/stages/color_ops.hpp"

namespace halfplane::driver {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError("cannot read '" + path + "'");
  return {std::istreambuf_iterator<char>(file), {}};
}

void run(const std::vector<std::string>& words) {
  if (words.size() != 3 && words.size() != 4)
    throw InputError("give CONFIG FILE.words FILE.ppm, and the bytes of textures in a file if there are any");
  const Config config = labelled(words[0]);
  const std::vector<std::uint8_t> bytes = bytes_of(words[1]);
  if (bytes.empty() || bytes.size() % 4 != 0)
    throw InputError("'" + words[1] + "' has " + std::to_string(bytes.size()) +
                     " bytes; give a file of words of 4 bytes, at least one");
  std::vector<std::uint32_t> stream(bytes.size() / 4);
  for (std::size_t i = 0; i < 4 * stream.size(); ++i) stream[i / 4] |= std::uint32_t{bytes[i]} << (8 * (i % 4));
  const Framebuffer frame = draw(stream, config, words.size() == 4 ? bytes_of(words[3]) : std::vector<std::uint8_t>());
  std::string picture = "P6\n" + std::to_string(frame.width) + " " + std::to_string(frame.height) + "\n255\n";
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const auto rgba = widen_color<std::uint32_t>(config.color_format, frame.color[frame.at(x, y)]);
      for (std::size_t c = 0; c < 3; ++c) picture += static_cast<char>(rgba[c]);
    }
  std::ofstream file(words[2], std::ios::binary);
  if (!(file << picture).flush()) throw InputError("cannot write '" + words[2] + "'");
}

}  // namespace
}  // namespace halfplane::driver

int main(int argc, char** argv) {
  try {
    halfplane::driver::run({argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "halfplane_draw_words: %s\n", error.what());
    return 2;
  }
}
