#include "sim/scene/mtl.hpp"

#include <algorithm>

#include "model/config.hpp"
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
MtlTexture read_map(TextCursor& cursor, std::string_view key, std::string_view folder) {
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
  const std::string name = cursor.name();
  if (name.empty()) cursor.fail(std::string(key) + " without a file", "give it one, or delete the line");
  map.file = name.front() == '/' ? name : std::string(folder) + name;
  std::ranges::replace(map.file, '\\', '/');  // written on Windows
  return map;
}

class MtlReader {
 public:
  MtlReader(std::string_view text, const std::string& file, MaterialTable& materials, Warnings& warnings)
      : cursor_(text, printable(file)),
        folder_(std::string_view(file).substr(0, file.find_last_of("/\\") + 1)),
        materials_(materials),
        warnings_(warnings) {}

  void run() {
    while (cursor_.next_line()) {
      const std::string_view key = cursor_.next_word();
      try {
        read_line(key);
      } catch (const InputError& error) {
        warnings_.once("mtl " + std::string(key), std::string(error.what()) + "; the line is passed over");
      }
    }
  }

 private:
  void read_line(std::string_view key) {
    constexpr std::array<std::string_view, 10> kKeys{"Ka",    "Kd", "Ks", "Ke",     "Ns",
                                                     "illum", "d",  "Tr", "map_Kd", "map_d"};
    if (key == "newmtl") return begin(cursor_.name());
    if (std::ranges::find(kKeys, key) == kKeys.end()) return;
    if (current_ == nullptr) cursor_.fail(in_quotes(key) + " before any newmtl", "start the material with newmtl NAME");
    has_color_ = has_color_ || key == "Kd";
    if (read_colors(cursor_, key, *current_)) return;
    if (key == "Ns") {
      current_->surface.shininess = std::clamp(cursor_.number("exponent Ns", kLargestCoordinate), 0.0, kMostShininess);
    } else if (key == "illum") {
      current_->has_highlight = cursor_.number("illum", kLargestCoordinate) >= 2;
    } else if (key == "map_Kd") {
      current_->texture = read_map(cursor_, key, folder_);
      if (!has_color_) std::fill_n(current_->rgba.begin(), 3, 255.0);  // as it is
    } else if (key == "map_d") {
      current_->opacity_map = read_map(cursor_, key, folder_);
    } else {
      read_opacity(key == "d");
    }
  }

  void begin(const std::string& name) {
    constexpr std::array<double, 4> kDefault{204, 204, 204, 255};  // a newmtl without Kd
    current_ = name.empty() ? &unnamed_ : &materials_[name];
    *current_ = {.rgba = kDefault};
    has_color_ = false;
    if (name.empty()) cursor_.fail("newmtl without a name", "write newmtl NAME");
  }

  // Exporters that mean an opaque material by `Tr 1` write `d 1` beside it.
  void read_opacity(bool is_opacity) {
    TextCursor ahead = cursor_;
    if (ahead.next_word() == "-halo") cursor_ = ahead;
    const double value = channel(cursor_, is_opacity ? "opacity d" : "transparency Tr");
    if (is_opacity || !current_->has_opacity) current_->rgba[3] = is_opacity ? value : 255 - value;
    current_->has_opacity = current_->has_opacity || is_opacity;
  }

  TextCursor cursor_;
  std::string_view folder_;
  MaterialTable& materials_;
  Warnings& warnings_;
  MtlMaterial* current_ = nullptr;
  MtlMaterial unnamed_;
  bool has_color_ = false;
};

}  // namespace

void parse_mtl(std::string_view text, const std::string& file, MaterialTable& materials, Warnings& warnings) {
  MtlReader(text, file, materials, warnings).run();
}

}  // namespace halfplane
