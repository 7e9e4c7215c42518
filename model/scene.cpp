#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "config.hpp"
#include "draw_states.hpp"
#include "known_textures.hpp"
#include "vertex_bounds.hpp"

namespace halfplane {
namespace {

constexpr std::size_t kMostPrimitives = std::numeric_limits<std::int32_t>::max();  // ids are signed

/// Place in a message: the scene, and the item in it.
class Place {
 public:
  explicit Place(const Scene& scene) : scene_(scene) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError((scene_.name.empty() ? "scene" : scene_.name) + ": " + what);
  }
  [[noreturn]] void fail_at(std::size_t command, const Draw& draw, const std::string& what) const {
    if (draw.line != 0) throw InputError(place_of_draw(scene_.name, draw.line) + ": " + what);
    fail("draw " + std::to_string(command) + ": " + what);
  }

 private:
  const Scene& scene_;
};

bool is_between(double value, double low, double high) { return value >= low && value <= high; }  // false for NaN

bool is_color(const std::array<double, 4>& rgba) {
  return std::ranges::all_of(rgba, [](double c) { return is_between(c, 0, 255); });
}

void check_vertices(const Scene& scene, const Place& place) {
  if (scene.vertices.size() >= kRestart) place.fail("more vertices than indices can name; give fewer than 4294967295");
  VertexNumbers low, high;
  std::size_t number = 0;
  for (const VertexPart& part : kVertexParts)
    for (; number < part.end; ++number) low[number] = part.low, high[number] = part.high;
  if (are_within(scene.vertices, low, high)) return;
  for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
    const VertexPart* const part = part_out_of_bounds(numbers_of(scene.vertices[i]));
    if (part == nullptr) continue;
    const bool is_bounded = part->high < std::numeric_limits<double>::max();
    place.fail("vertex " + std::to_string(i) + " has " + std::string(part->what) +
               (is_bounded ? " outside " + range_of(*part) : " that is no finite number"));
  }
}

void check_normals(const Scene& scene, const Place& place) {
  if (scene.normals.size() > scene.vertices.size()) place.fail("more normals than vertices");
  for (std::size_t i = 0; i < scene.normals.size(); ++i)
    for (const double c : scene.normals[i])
      if (!is_between(c, -kLargestNormal, kLargestNormal))
        place.fail("normal " + std::to_string(i) + " has a component beyond 1e12");
}

/// A texture is in the form of make_texture(), and its name is a word of a capture.
void check_texture(const Scene& scene, std::size_t index, const Place& place) {
  const Texture& texture = scene.textures[index];
  const auto fail = [&](const std::string& what) { place.fail("texture " + std::to_string(index) + ": " + what); };
  const auto is_plain = [](char c) { return c > ' ' && c != '#' && c != 127; };
  if (texture.name.empty() || texture.name == "off" || !std::ranges::all_of(texture.name, is_plain))
    fail("a name that is no word of a capture");
  for (std::size_t i = 0; i < index; ++i)
    if (scene.textures[i].name == texture.name) fail("the name " + texture.name + " of texture " + std::to_string(i));
  if (texture.level.empty()) fail("no texels");
  int width = texture.width(), height = texture.height();
  if (!is_between(width, 1, kLargestTexture) || !is_between(height, 1, kLargestTexture)) fail("sides outside 1...4096");
  for (const TextureLevel& level : texture.level) {
    const std::size_t texels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const bool has_palette = palette_size(texture.format) != 0;
    const std::uint64_t codes = has_palette ? texture.palette.size() : std::uint64_t{1} << texel_bits(texture.format);
    if (level.width != width || level.height != height || level.code.size() != texels)
      fail("a level of another size than half of the one before");
    std::uint32_t all = 0;  // their bits together: without an early end, in lanes
    for (const std::uint32_t code : level.code) all |= code;
    const auto is_beyond = [codes](std::uint64_t code) { return code >= codes; };
    if (is_beyond(all) && (!has_palette || std::ranges::any_of(level.code, is_beyond)))
      fail("a code that the format or its palette does not have");
    width = std::max(1, width / 2);
    height = std::max(1, height / 2);
  }
  if (texture.mips == Mips::levels && !texture.is_complete()) fail("levels of its own that end before 1x1");
}

/// Every member is in the range of its row of the table.
void check_state(const Scene& scene, std::size_t index, const Place& place) {
  for (const DrawState& row : draw_states()) {
    const StateValue value = row.value(scene.states[index]);
    const auto fail = [&](const std::string& what) {
      place.fail("state " + std::to_string(index) + ": " + std::string(row.name) + " " + what);
    };
    if (value.word < row.words.size()) continue;
    if (value.word > row.words.size() || row.numbers.empty()) fail("has a value that is none of its enumerators");
    for (std::size_t i = 0; i < row.numbers.size(); ++i) {
      const StateNumber& number = row.numbers[i];
      const double n = value.numbers[i];
      if (number.is_texture && n >= static_cast<double>(scene.textures.size()))
        fail("of " + std::to_string(static_cast<long>(n)) + ", but there are " + std::to_string(scene.textures.size()) +
             " textures");
      if (!is_between(n, number.low, number.high) || (number.is_positive && n == 0))
        fail("of " + std::to_string(n) + " is outside " + std::to_string(number.low) + "..." +
             std::to_string(number.high));
    }
  }
}

void check_clear(const Scene& scene, std::size_t command, const Clear& clear, const Place& place) {
  const auto fail = [&](const std::string& what) { place.fail("clear " + std::to_string(command) + ": " + what); };
  if (clear.state >= scene.states.size())
    fail("state " + std::to_string(clear.state) + " of " + std::to_string(scene.states.size()));
  if (clear.color && !is_color(*clear.color)) fail("a colour component outside 0...255");
  if (clear.depth && !is_between(*clear.depth, 0, 1)) fail("a depth outside 0...1");
}

void check_draw(const Scene& scene, std::size_t command, const Draw& draw, const Place& place) {
  const auto fail = [&](const std::string& what) { place.fail_at(command, draw, what); };
  const auto of = [](std::size_t number, std::size_t size) {
    return std::to_string(number) + " of " + std::to_string(size);
  };
  if (draw.state >= scene.states.size()) fail("state " + of(draw.state, scene.states.size()));
  if (draw.object >= scene.objects.size()) fail("object " + of(draw.object, scene.objects.size()));
  if (static_cast<unsigned>(draw.topology) > static_cast<unsigned>(Topology::points)) fail("an unknown topology");
  const std::size_t indices = scene.indices.size();
  if (draw.first > indices || draw.count > indices - draw.first)
    fail("indices " + std::to_string(draw.first) + " and " + std::to_string(draw.count) + " more, but there are " +
         std::to_string(indices));
  const auto named = std::span(scene.indices).subspan(draw.first, draw.count);
  std::uint32_t largest = 0;  // without an early end, so that the compiler takes indices in lanes
  for (const std::uint32_t index : named) largest = std::max(largest, index == kRestart ? 0 : index);
  if (largest < scene.vertices.size() || named.empty()) return;
  for (const std::uint32_t index : named)
    if (index >= scene.vertices.size() && index != kRestart)
      fail("index " + std::to_string(index) + ", but there are " + std::to_string(scene.vertices.size()) + " vertices");
}

}  // namespace

std::string range_of(const VertexPart& part) {
  return std::to_string(std::lround(part.low)) + "..." + std::to_string(std::lround(part.high));
}

std::string place_of_draw(std::string_view file, std::uint32_t line) {
  std::string place(file);
  if (line != 0) place += ": draw from line " + std::to_string(line);
  return place;
}

void validate(const Scene& scene) { validate(scene, 0); }

void validate(const Scene& scene, std::size_t known_textures) {
  const Place place(scene);
  if (!is_between(scene.width, 1, kLargestSide) || !is_between(scene.height, 1, kLargestSide))
    place.fail("a target of " + std::to_string(scene.width) + "x" + std::to_string(scene.height) +
               "; give 1x1 to 16384x16384 pixels");
  if (scene.planes) {
    const auto [near, far] = *scene.planes;
    if (!(near > 0 && near < far) || std::isinf(near)) place.fail("planes must be 0 < near < far; far may be infinite");
  }
  check_vertices(scene, place);
  check_normals(scene, place);
  for (std::size_t i = known_textures; i < scene.textures.size(); ++i) check_texture(scene, i, place);
  for (std::size_t i = 0; i < scene.states.size(); ++i) check_state(scene, i, place);
  std::size_t primitives = 0;  // an upper bound: an index makes at most one
  for (std::size_t i = 0; i < scene.commands.size(); ++i) {
    if (const auto* clear = std::get_if<Clear>(&scene.commands[i])) check_clear(scene, i, *clear, place);
    const auto* draw = std::get_if<Draw>(&scene.commands[i]);
    if (draw == nullptr) continue;
    check_draw(scene, i, *draw, place);
    primitives += draw->count;
    if (primitives > kMostPrimitives)
      place.fail_at(i, *draw, "more than 2147483647 indices up to here; split the frame");
  }
}

}  // namespace halfplane
