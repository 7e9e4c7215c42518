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

}  // namespace

void parse_mtl(std::string_view text, const std::string& file, MaterialTable& materials) {
  constexpr std::array<double, 4> kDefault{204, 204, 204, 255};  // a newmtl without Kd
  TextCursor cursor(text, file);
  std::array<double, 4>* current = nullptr;
  while (cursor.next_line()) {
    const std::string_view key = cursor.next_word();
    if (key == "newmtl") {
      const std::string name(cursor.rest_of_line());
      if (name.empty()) cursor.fail("newmtl without a name", "write newmtl NAME");
      current = &(materials[name] = kDefault);
    } else if (key == "Kd" || key == "d" || key == "Tr") {
      if (current == nullptr) cursor.fail(in_quotes(key) + " before any newmtl", "start the material with newmtl NAME");
      if (key == "Kd") {
        read_diffuse(cursor, *current);
        continue;
      }
      TextCursor ahead = cursor;
      if (ahead.next_word() == "-halo") cursor = ahead;
      const double value = channel(cursor, key == "d" ? "opacity d" : "transparency Tr");
      (*current)[3] = key == "d" ? value : 255 - value;
    }
  }
}

}  // namespace halfplane
