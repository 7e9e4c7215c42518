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

void read_diffuse(TextCursor& cursor, std::array<double, 4>& rgba) {
  TextCursor ahead = cursor;
  const std::string_view word = ahead.next_word();
  if (word == "spectral" || word == "xyz") return;  // measured spectra: legal, rare, and no colour of ours
  rgba[0] = channel(cursor, "red of Kd");
  rgba[1] = rgba[2] = rgba[0];
  if (!cursor.more()) return;
  rgba[1] = channel(cursor, "green of Kd");
  rgba[2] = channel(cursor, "blue of Kd");
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
  MtlMaterial* current = nullptr;
  bool has_color = false;
  while (cursor.next_line()) {
    const std::string_view key = cursor.next_word();
    if (key == "newmtl") {
      const std::string name(cursor.rest_of_line());
      if (name.empty()) cursor.fail("newmtl without a name", "write newmtl NAME");
      current = &(materials[name] = {kDefault, {}});
      has_color = false;
    } else if (key == "Kd" || key == "d" || key == "Tr" || key == "map_Kd") {
      if (current == nullptr) cursor.fail(in_quotes(key) + " before any newmtl", "start the material with newmtl NAME");
      if (key == "Kd") {
        read_diffuse(cursor, current->rgba);
        has_color = true;
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
