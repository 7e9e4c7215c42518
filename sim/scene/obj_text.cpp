#include "sim/scene/obj_text.hpp"

#include <algorithm>

#include "model/as_number.hpp"
#include "model/config.hpp"
#include "sim/scene/mesh.hpp"
#include "sim/scene/text_cursor.hpp"

namespace halfplane {

namespace {

// A number of 0...1 as 0...255; some exporters overshoot slightly.
double channel(TextCursor& cursor, std::string_view what) {
  return std::clamp(cursor.number(what, kLargestCoordinate), 0.0, 1.0) * 255;
}

// After Ka, Kd, Ks or Ke: 0...255.
std::optional<std::array<double, 3>> read_color(TextCursor& cursor, std::string_view key) {
  TextCursor ahead = cursor;
  const std::string_view word = ahead.next_word();
  if (word == "spectral" || word == "xyz") return {};  // measured spectra: legal, rare, and not converted to a colour
  const std::string of = " of " + std::string(key);
  std::array<double, 3> color{};
  color.fill(channel(cursor, "red" + of));
  if (!cursor.more()) return color;
  color[1] = channel(cursor, "green" + of);
  color[2] = channel(cursor, "blue" + of);
  return color;
}

/// Reads Ka, Kd, Ks, Ke: true if it was one of them.
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

// After -s, -o or -t: one to three numbers, for u, v and (unused) w.
void read_pair(TextCursor& cursor, std::string_view option, std::array<double, 2>& pair) {
  pair[0] = cursor.number("u of " + std::string(option), kLargestCoordinate);
  if (is_next_number(cursor)) pair[1] = cursor.number("v", kLargestCoordinate);
  if (is_next_number(cursor)) (void)cursor.next_word();
}

// Options, each a word and its arguments; then the file's name, which may contain blanks.
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
  std::ranges::replace(map.file, '\\', '/');  // for paths written on Windows
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
      if (!has_color_) std::fill_n(current_->rgba.begin(), 3, 255.0);  // unchanged
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

  // Exporters that write `Tr 1` for an opaque material also write `d 1`.
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
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& file, const MaterialSource& source,
            std::vector<std::string>& warnings)
      : cursor_(text, file), source_(source), warnings_(warnings) {
    out_.file = file;
  }

  ObjText run() {
    while (cursor_.next_line()) read_line(cursor_.next_word());
    return std::move(out_);
  }

 private:
  void read_line(std::string_view key) {
    if (key == "v") {
      read_position();
    } else if (key == "f" || key == "fo") {  // fo: the old spelling
      read_face();
    } else if (key == "vn") {
      forgive("vn", "it is taken as missing", [&] {
        out_.normals.emplace_back();
        const double x = coordinate("x of vn"), y = coordinate("y of vn");
        out_.normals.back() = {x, y, coordinate("z of vn")};
      });
    } else if (key == "vt") {
      forgive("vt", "it is taken as 0 0", [&] {
        out_.uvs.emplace_back();
        const double u = coordinate("u of vt");
        out_.uvs.back() = {u, cursor_.more() ? coordinate("v of vt") : 0.0};
      });
    } else if (key == "o" || key == "g") {
      face_.object = number_of(cursor_.name(), out_.object_names, objects_);
    } else if (key == "usemtl") {
      face_.material = number_of(cursor_.name(), out_.material_names, materials_);
    } else if (key == "mtllib") {
      forgive("mtllib", "the line is passed over", [&] { read_libraries(); });
    } else if (key == "s") {
      forgive("s", "the line is passed over", [&] { read_smoothing(); });
    } else if (key == "l" || key == "p") {
      read_line_element(key == "p");
    }
  }

  // For lines that positions do not depend on: a warning for each kind, and the reader continues.
  template <class Read>
  void forgive(std::string_view kind, std::string_view how, Read read) {
    try {
      read();
    } catch (const InputError& error) {
      warnings_.once(std::string(kind), std::string(error.what()) + "; " + std::string(how));
    }
  }

  double coordinate(std::string_view what) { return cursor_.number(what, kLargestCoordinate); }

  // v x y z, with a weight (unused), a colour, or a colour and an alpha after it.
  void read_position() {
    const double x = coordinate("x of v"), y = coordinate("y of v"), z = coordinate("z of v");
    out_.positions.push_back({x, y, z});
    forgive("colour", "the vertex has no colour", [&] { read_vertex_color(); });
  }

  void read_vertex_color() {
    std::array<double, 4> extra{-1, -1, -1, -1};
    std::size_t count = 0;
    while (cursor_.more()) {
      if (count == 4) cursor_.fail("v with more than 7 numbers", "write v x y z or v x y z r g b");
      extra[count++] = coordinate("a number after x y z");
    }
    if (count == 2) cursor_.fail("v with 5 numbers", "write v x y z or v x y z r g b");
    if (count < 3) return;
    for (std::size_t i = 0; i < count; ++i) {
      if (extra[i] < 0 || extra[i] > 255)
        cursor_.fail("a colour of " + std::to_string(extra[i]) + " is out of range", "use 0 to 1, or 0 to 255");
    }
    out_.colors.resize(out_.positions.size() - 1, {-1, -1, -1, -1});
    out_.colors.push_back(extra);
  }

  void read_face() {
    face_.first = out_.corners.size();
    while (cursor_.more()) {
      const std::string_view word = cursor_.next_word();
      out_.corners.push_back(read_corner(word));
    }
    face_.count = out_.corners.size() - face_.first;
    face_.line = cursor_.line();
    if (face_.count >= 3) return out_.faces.push_back(face_);
    out_.corners.resize(face_.first);
    warnings_.once("corners", at_line() + "a face of " + std::to_string(face_.count) + " corners is left out");
  }

  void read_line_element(bool is_points) {
    const std::size_t first = out_.corners.size();
    while (cursor_.more()) {
      const std::string_view word = cursor_.next_word();
      out_.corners.push_back(read_corner(word));
    }
    const std::size_t count = out_.corners.size() - first;
    if (count >= (is_points ? 1u : 2u))
      return out_.lines.push_back({first, count, cursor_.line(), face_.material, face_.object, is_points});
    out_.corners.resize(first);
    warnings_.once("ends",
                   at_line() + (is_points ? "a p without points" : "a line of fewer than two points") + " is left out");
  }

  [[nodiscard]] std::string at_line() const { return out_.file + ":" + std::to_string(cursor_.line()) + ": "; }

  // a, a/b, a//c or a/b/c; a trailing slash is accepted.
  ObjCorner read_corner(std::string_view word) {
    const std::array<std::size_t, 3> counts{out_.positions.size(), out_.uvs.size(), out_.normals.size()};
    std::array<std::int64_t, 3> index{kNoIndex, kNoIndex, kNoIndex};
    std::string_view left = word;
    for (std::size_t part = 0; part < 3; ++part) {
      const std::size_t slash = left.find('/');
      const std::string_view field = left.substr(0, slash);
      if (part == 0) {
        index[part] = read_index(field, word, counts[part]);
      } else if (!field.empty()) {
        forgive(part == 1 ? "vt index" : "vn index", "it is taken as missing",
                [&] { index[part] = read_index(field, word, counts[part]); });
      }
      if (slash == std::string_view::npos) return {index[0], index[1], index[2]};
      left.remove_prefix(slash + 1);
    }
    cursor_.fail("a corner " + in_quotes(word) + " of more than three parts", "write v, v/vt, v//vn or v/vt/vn");
  }

  std::int64_t read_index(std::string_view field, std::string_view word, std::size_t count) const {
    const auto number = as_number<std::int64_t>(field);
    if (!number)
      cursor_.fail("a corner " + in_quotes(word) + " is not made of whole numbers", "write v, v/vt, v//vn or v/vt/vn");
    const std::int64_t value = *number;
    if (value > 0) return value - 1;
    if (value == 0) cursor_.fail("index 0 in " + in_quotes(word), "OBJ counts from 1; -1 is the last one so far");
    if (value < -static_cast<std::int64_t>(count)) {
      cursor_.fail("index " + std::to_string(value) + " in " + in_quotes(word) + " counts back beyond the first of " +
                       std::to_string(count),
                   "lower the count or move the line down");
    }
    return static_cast<std::int64_t>(count) + value;
  }

  void read_smoothing() {
    const std::string_view word = cursor_.next_word();
    if (word == "off") {
      face_.smoothing = 0;
      return;
    }
    const auto group = as_number<std::uint32_t>(word == "on" ? "1" : word);
    if (!group) cursor_.fail("smoothing group " + in_quotes(word), "write s off or s NUMBER");
    face_.smoothing = *group;
  }

  // A name may contain blanks, or the line may contain several names: the whole line is tried first.
  void read_libraries() {
    const std::string all = cursor_.name();
    if (all.empty()) cursor_.fail("mtllib without a name", "write mtllib FILE, or delete the line");
    if (load_library(all)) return;
    if (const std::string name = without_comment(all); !name.empty() && load_library(name)) return;
    TextCursor names(all, out_.file);
    if (!names.next_line()) return;
    bool several = false;
    for (std::string_view name = names.next_word(); !name.empty(); name = names.next_word()) {
      const bool whole = name.size() == all.size();
      several = several || !whole;
      if (!whole && load_library(std::string(name))) continue;
      warnings_.once("library " + std::string(name), at_line() + "no material library " + in_quotes(name) +
                                                         " beside the file; default colours are used");
    }
  }

  // Each library is read once, however often it is named: this bounds the work of a small file.
  bool load_library(const std::string& name) {
    if (const auto known = libraries_.find(name); known != libraries_.end()) return known->second;
    const std::optional<std::string> text = source_(name);
    libraries_.emplace(name, text.has_value());
    if (text) parse_mtl(*text, name, out_.materials, warnings_);
    return text.has_value();
  }

  static std::uint32_t number_of(std::string name, std::vector<std::string>& names,
                                 std::unordered_map<std::string, std::uint32_t>& numbers) {
    const auto [place, added] = numbers.emplace(std::move(name), static_cast<std::uint32_t>(names.size()));
    if (added) names.push_back(place->first);
    return place->second;
  }

  TextCursor cursor_;
  const MaterialSource& source_;
  Warnings warnings_;
  ObjText out_;
  ObjFace face_{.smoothing = 1};  // inherited by the next face
  std::unordered_map<std::string, std::uint32_t> objects_{{"", 0}}, materials_{{"", 0}};
  std::unordered_map<std::string, bool> libraries_;  // name -> whether it was found
};

}  // namespace

ObjText parse_obj_text(std::string_view text, const std::string& file, const MaterialSource& materials,
                       std::vector<std::string>& warnings) {
  return ObjReader(text, file, materials, warnings).run();
}

}  // namespace halfplane
