#include "sim/scene/obj_text.hpp"

#include <charconv>
#include <unordered_set>

#include "sim/scene/text_cursor.hpp"

namespace halfplane {
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
      const double x = coordinate("x of vn"), y = coordinate("y of vn");
      out_.normals.push_back({x, y, coordinate("z of vn")});
    } else if (key == "vt") {
      const double u = coordinate("u of vt");
      out_.uvs.push_back({u, cursor_.more() ? coordinate("v of vt") : 0.0});
    } else if (key == "o" || key == "g") {
      face_.object = number_of(std::string(cursor_.rest_of_line()), out_.object_names, objects_);
    } else if (key == "usemtl") {
      face_.material = number_of(std::string(cursor_.rest_of_line()), out_.material_names, materials_);
    } else if (key == "mtllib") {
      read_libraries();
    } else if (key == "s") {
      read_smoothing();
    } else if ((key == "l" || key == "p") && !warned_of_lines_) {
      warned_of_lines_ = true;
      warnings_.push_back(out_.file + ":" + std::to_string(cursor_.line()) +
                          ": lines and points of an OBJ are left out; only its faces are drawn");
    }
  }

  double coordinate(std::string_view what) { return cursor_.number(what, kLargestCoordinate); }

  // v x y z, with a weight (unused), a colour, or a colour and an alpha after it.
  void read_position() {
    const double x = coordinate("x of v"), y = coordinate("y of v"), z = coordinate("z of v");
    out_.positions.push_back({x, y, z});
    std::array<double, 4> extra{};
    std::size_t count = 0;
    while (cursor_.more()) {
      if (count == 4) cursor_.fail("v with more than 7 numbers", "write v x y z or v x y z r g b");
      extra[count++] = coordinate("a number after x y z");
    }
    if (count == 2) cursor_.fail("v with 5 numbers", "write v x y z or v x y z r g b");
    const bool colored = count >= 3;
    if (!colored && out_.colors.empty()) return;
    constexpr std::array<double, 4> kUncolored{-1, -1, -1, -1};  // turned white when the range is known
    out_.colors.resize(out_.positions.size() - 1, kUncolored);
    if (count == 3) extra[3] = -1;
    out_.colors.push_back(colored ? extra : kUncolored);
    if (!colored) return;
    for (std::size_t i = 0; i < count; ++i) {
      if (extra[i] < 0 || extra[i] > 255) {
        cursor_.fail("a colour of " + std::to_string(extra[i]) + " is out of range", "use 0 to 1, or 0 to 255");
      }
    }
  }

  void read_face() {
    face_.first = out_.corners.size();
    while (cursor_.more()) {
      const std::string_view word = cursor_.next_word();
      out_.corners.push_back(read_corner(word));
    }
    face_.count = out_.corners.size() - face_.first;
    face_.line = cursor_.line();
    if (face_.count < 3) {
      cursor_.fail("a face of " + std::to_string(face_.count) + " corners", "give it 3 or more, or delete the line");
    }
    out_.faces.push_back(face_);
  }

  // a, a/b, a//c or a/b/c; a trailing slash is forgiven.
  ObjCorner read_corner(std::string_view word) {
    const std::array<std::size_t, 3> counts{out_.positions.size(), out_.uvs.size(), out_.normals.size()};
    std::array<std::int64_t, 3> index{kNoIndex, kNoIndex, kNoIndex};
    std::string_view left = word;
    for (std::size_t part = 0; part < 3; ++part) {
      const std::size_t slash = left.find('/');
      const std::string_view field = left.substr(0, slash);
      if (!field.empty() || part == 0) index[part] = read_index(field, word, counts[part]);
      if (slash == std::string_view::npos) return {index[0], index[1], index[2]};
      left.remove_prefix(slash + 1);
    }
    cursor_.fail("a corner " + in_quotes(word) + " of more than three parts", "write v, v/vt, v//vn or v/vt/vn");
  }

  std::int64_t read_index(std::string_view field, std::string_view word, std::size_t count) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size()) {
      cursor_.fail("a corner " + in_quotes(word) + " is not made of whole numbers", "write v, v/vt, v//vn or v/vt/vn");
    }
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
    const std::string_view digits = word == "on" ? "1" : word;
    std::uint32_t group = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), group);
    if (error != std::errc() || end != digits.data() + digits.size()) {
      cursor_.fail("smoothing group " + in_quotes(word), "write s off or s NUMBER");
    }
    face_.smoothing = group;
  }

  // A name may hold blanks, or the line may hold several names: the whole line is tried first.
  void read_libraries() {
    const std::string all(cursor_.rest_of_line());
    if (all.empty()) cursor_.fail("mtllib without a name", "write mtllib FILE, or delete the line");
    if (load_library(all)) return;
    TextCursor names(all, out_.file);
    if (!names.next_line()) return;
    bool several = false;
    for (std::string_view name = names.next_word(); !name.empty(); name = names.next_word()) {
      const bool whole = name.size() == all.size();
      several = several || !whole;
      if (!whole && load_library(std::string(name))) continue;
      if (!warned_libraries_.insert(std::string(name)).second) continue;
      warnings_.push_back(out_.file + ":" + std::to_string(cursor_.line()) + ": no material library " +
                          in_quotes(name) + " beside the file; default colours are used");
    }
  }

  // Each library is read once, however often it is named: a small file cannot ask for much work.
  bool load_library(const std::string& name) {
    if (const auto known = libraries_.find(name); known != libraries_.end()) return known->second;
    const std::optional<std::string> text = source_(name);
    libraries_.emplace(name, text.has_value());
    if (text) parse_mtl(*text, name, out_.materials);
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
  std::vector<std::string>& warnings_;
  ObjText out_;
  ObjFace face_{.smoothing = 1};  // what the next face inherits
  std::unordered_map<std::string, std::uint32_t> objects_{{"", 0}}, materials_{{"", 0}};
  std::unordered_map<std::string, bool> libraries_;  // name -> whether it was found
  std::unordered_set<std::string> warned_libraries_;
  bool warned_of_lines_ = false;
};

}  // namespace

ObjText parse_obj_text(std::string_view text, const std::string& file, const MaterialSource& materials,
                       std::vector<std::string>& warnings) {
  return ObjReader(text, file, materials, warnings).run();
}

}  // namespace halfplane
