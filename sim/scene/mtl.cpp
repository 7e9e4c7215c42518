#include "sim/scene/mtl.hpp"

#include <algorithm>

#include "sim/scene/mesh.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {
namespace {

// A number of 0...1 as 0...255; files of some exporters overshoot a little.
double channel(TextCursor& cursor, std::string_view what) {
  return std::clamp(cursor.number(what, kLargestCoordinate), 0.0, 1.0) * 255;
}

// Behind Ka, Kd, Ks or Ke: 0...255.
std::optional<std::array<double, 3>> read_color(TextCursor& cursor, std::string_view key) {
  TextCursor ahead = cursor;
  const std::string_view word = ahead.next_word();
  if (word == "spectral" || word == "xyz") return {};  // measured spectra: legal, rare, and no colour of ours
  const std::string of = " of " + std::string(key);
  std::array<double, 3> color{};
  color.fill(channel(cursor, "red" + of));
  if (!cursor.more()) return color;
  color[1] = channel(cursor, "green" + of);
  color[2] = channel(cursor, "blue" + of);
  return color;
}

/// Ka, Kd, Ks, Ke: true if it was one.
bool read_colors(TextCursor& cursor, std::string_view key, MtlMaterial& material) {
  if (key != "Ka" && key != "Kd" && key != "Ks" && key != "Ke") return false;
  const auto color = read_color(cursor, key);
  if (!color) return true;
  if (key == "Kd") std::ranges::copy(*color, material.rgba.begin());
  std::array<double, 3> part = *color;
  for (double& c : part) c /= 255;
  if (key == "Ka") material.surface.ambient = part;
  if (key == "Ks") material.surface.specular = part;
  if (key == "Ke") material.surface.emission = part;
  return true;
}

bool is_next_number(TextCursor cursor) { return parse_number(cursor.next_word()).has_value(); }

// Behind -s, -o or -t: one to three numbers, of u, v and (unused) w.
void read_pair(TextCursor& cursor, std::string_view option, std::array<double, 2>& pair) {
  pair[0] = cursor.number("u of " + std::string(option), kLargestCoordinate);
  if (is_next_number(cursor)) pair[1] = cursor.number("v", kLargestCoordinate);
  if (is_next_number(cursor)) (void)cursor.next_word();
}

// Options, each a word and what follows it; then the file's name, which may hold blanks.
MtlTexture read_map(TextCursor& cursor, std::string_view folder) {
  MtlTexture map;
  map.place = cursor.file() + ":" + std::to_string(cursor.line());
  std::array<double, 2> unused{};
  for (TextCursor ahead = cursor; ahead.more(); ahead = cursor) {
    const std::string_view option = ahead.next_word();
    if (!option.starts_with('-')) break;
    cursor = ahead;
    if (option == "-s" || option == "-o" || option == "-t") {
      read_pair(cursor, option, option == "-s" ? map.scale : option == "-o" ? map.offset : unused);
      continue;
    }
    const std::string_view value = cursor.next_word();
    if (option == "-mm") (void)cursor.next_word();  // base and gain; all others have one word
    if (option == "-clamp") map.wrap = value == "on" ? TextureWrap::clamp : TextureWrap::repeat;
  }
  std::string name(cursor.rest_of_line());
  if (name.empty()) cursor.fail("map_Kd without a file", "write map_Kd FILE, or delete the line");
  map.file = name.front() == '/' ? name : std::string(folder) + name;
  std::ranges::replace(map.file, '\\', '/');  // written on Windows
  return map;
}

}  // namespace

void parse_mtl(std::string_view text, const std::string& file, MaterialTable& materials) {
  TextCursor cursor(text, printable(file));
  const std::string_view folder = std::string_view(file).substr(0, file.find_last_of("/\\") + 1);
  constexpr std::array<double, 4> kDefault{204, 204, 204, 255};  // a newmtl without Kd
  constexpr std::array<std::string_view, 9> kKeys{"Ka", "Kd", "Ks", "Ke", "Ns", "illum", "d", "Tr", "map_Kd"};
  MtlMaterial* current = nullptr;
  bool has_color = false;
  while (cursor.next_line()) {
    const std::string_view key = cursor.next_word();
    if (key == "newmtl") {
      const std::string name(cursor.rest_of_line());
      if (name.empty()) cursor.fail("newmtl without a name", "write newmtl NAME");
      current = &(materials[name] = {.rgba = kDefault});
      has_color = false;
    } else if (std::ranges::find(kKeys, key) != kKeys.end()) {
      if (current == nullptr) cursor.fail(in_quotes(key) + " before any newmtl", "start the material with newmtl NAME");
      has_color = has_color || key == "Kd";
      if (read_colors(cursor, key, *current)) continue;
      if (key == "Ns") {
        current->surface.shininess = std::clamp(cursor.number("exponent Ns", kLargestCoordinate), 0.0, kMostShininess);
        continue;
      }
      if (key == "illum") {
        current->has_highlight = cursor.number("illum", kLargestCoordinate) >= 2;
        continue;
      }
      if (key == "map_Kd") {
        current->texture = read_map(cursor, folder);
        if (!has_color) std::fill_n(current->rgba.begin(), 3, 255.0);  // as it is
        continue;
      }
      TextCursor ahead = cursor;
      if (ahead.next_word() == "-halo") cursor = ahead;
      const double value = channel(cursor, key == "d" ? "opacity d" : "transparency Tr");
      current->rgba[3] = key == "d" ? value : 255 - value;
    }
  }
}

}  // namespace halfplane
