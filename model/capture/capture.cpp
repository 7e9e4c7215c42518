#include "capture.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "../config.hpp"
#include "capture_lines.hpp"
#include "capture_states.hpp"
#include "capture_text.hpp"
#include "capture_textures.hpp"

namespace halfplane {
namespace {

/// Builds the scene, one line at a time.
class CaptureReader {
 public:
  CaptureReader(std::string_view text, std::string_view file_name, std::size_t head)
      : text_(text, file_name, head), textures_(file_name) {
    scene_.name = file_name;
  }

  Scene read() {
    read_header();
    while (text_.next_line()) {
      read_line(text_.word());
      text_.expect_end();
    }
    textures_.expect_complete(text_);
    return std::move(scene_);
  }

 private:
  void read_header();
  void read_line(std::string_view word);
  void read_rare_line(std::string_view word);
  void read_target();
  void read_planes();
  void read_clear();
  void read_state();
  void read_object();
  void read_vertex();
  void read_attribute();
  void grow_vertices();
  void read_draw(const CaptureDraw& draw);

  std::uint32_t state_number();
  std::array<double, 4> read_color();

  CaptureText text_;
  TextureReader textures_;
  Scene scene_;
  State state_;                // state of the next draw
  bool state_changed_ = true;  // since the last call of state_number()
  std::uint32_t state_number_ = 0;
  std::uint32_t object_ = 0;
  std::size_t target_line_ = 0;  // 0: not given yet
  /// By hash, so that a file with a new state for each triangle is still read in linear time.
  std::unordered_map<State, std::uint32_t, StateHash> state_numbers_;
  std::unordered_map<std::string, std::uint32_t> object_numbers_{{"", 0}};
};

void CaptureReader::read_header() {
  if (!text_.next_line()) {
    constexpr std::string_view mend = "; a capture begins with the line 'halfplane 1'";
    throw InputError(scene_.name + ":1: the file is empty" + std::string(mend));
  }
  const std::string_view word = text_.word();
  if (word == "halfplane") {
    const std::string_view version = text_.word();
    if (version.empty()) text_.fail("'halfplane' without a version; write 'halfplane 1'");
    if (version != "1")
      text_.fail("version " + quoted_word(version) +
                 " of the format is not known here; this program reads 'halfplane 1'");
  } else {
    text_.fail("this is no capture, it begins with " + quoted_word(word) + "; the first line must be 'halfplane 1'");
  }
  text_.expect_end();
  text_.refuse_nul();
}

void CaptureReader::read_line(std::string_view word) {
  if (word == "texels") return textures_.read_texels(text_, scene_.textures);
  if (word == "palette") return textures_.read_palette(text_);
  textures_.expect_complete(text_);
  if (word == "v") return read_vertex();
  for (const CaptureDraw& draw : kCaptureDraws)
    if (word == draw.word) return read_draw(draw);
  if (word == "state") return read_state();
  read_rare_line(word);
}

void CaptureReader::read_rare_line(std::string_view word) {
  if (word == "a") return read_attribute();
  if (word == "object") return read_object();
  if (word == "clear") return read_clear();
  if (word == "target") return read_target();
  if (word == "texture") return textures_.read_texture(text_, scene_.textures);
  if (word == "space") {
    read_state_value(text_, capture_space(), scene_.textures, state_);
    state_changed_ = true;
  } else if (word == "frame") {
    scene_.commands.emplace_back(EndFrame{});
  } else if (word == "planes") {
    read_planes();
  } else if (word == "halfplane") {
    text_.fail("a second 'halfplane' line; a file holds one capture: remove the line, or split the file");
  } else {
    text_.fail(quoted_word(word) +
               " begins no line of a capture; write one of target, clear, space, state, v, a, t, ts, tf, " +
               "l, ls, ll, p, object, texture, palette, texels, planes, frame, or # before a comment");
  }
}

void CaptureReader::read_target() {
  if (target_line_ != 0)
    text_.fail("a second target, the first is on line " + std::to_string(target_line_) + "; remove one of them");
  target_line_ = text_.line();
  scene_.width = text_.integer("the target's width", 1, kLargestSide);
  scene_.height = text_.integer("the target's height", 1, kLargestSide);
}

void CaptureReader::read_planes() {
  if (scene_.planes) text_.fail("a second planes line, and a capture has one pair of planes; remove one of them");
  constexpr double largest = std::numeric_limits<double>::max();
  const double near = text_.number("the near plane", 0, largest);
  const double far =
      text_.take("inf") ? std::numeric_limits<double>::infinity() : text_.number("the far plane", 0, largest);
  if (!(near > 0 && near < far)) text_.fail("planes must be 0 < near < far; far may be inf");
  scene_.planes = {near, far};
}

std::array<double, 4> CaptureReader::read_color() {
  std::array<double, 4> color{};
  for (double& component : color) component = text_.number("a colour component", 0, 255);
  return color;
}

void CaptureReader::read_clear() {
  Clear clear;
  while (text_.has_word()) {
    const std::string_view what = text_.word();
    if ((what == "color" && clear.color) || (what == "depth" && clear.depth) || (what == "stencil" && clear.stencil))
      text_.fail("a second " + quoted_word(what) + " on one clear line; remove one of them");
    if (what == "color") {
      clear.color = read_color();
    } else if (what == "depth") {
      clear.depth = text_.number("the clear depth", 0, 1);
    } else if (what == "stencil") {
      clear.stencil = static_cast<std::uint8_t>(text_.integer("the clear stencil", 0, 255));
    } else {
      text_.fail(quoted_word(what) + " cannot be cleared; write clear color r g b a depth z stencil s, or one of them");
    }
  }
  if (!clear.color && !clear.depth && !clear.stencil)
    text_.fail("clear without anything to clear; write clear color r g b a depth z stencil s, or one of them");
  clear.state = state_number();
  scene_.commands.emplace_back(clear);
}

void CaptureReader::read_state() {
  const std::string_view name = text_.word();
  const auto settings = capture_states();
  const auto setting = std::find_if(settings.begin(), settings.end(), [&](const auto& s) { return s.name == name; });
  if (setting != settings.end()) {
    read_state_value(text_, *setting, scene_.textures, state_);
    state_changed_ = true;
    return;
  }
  std::string known;
  for (const DrawState& s : settings) known.append(known.empty() ? "" : ", ").append(s.name);
  text_.fail((name.empty() ? "state without a name" : "state " + quoted_word(name) + " is not known") +
             "; write one of " + known);
}

/// The index of state_ in Scene::states; a state used by an earlier draw keeps its index.
std::uint32_t CaptureReader::state_number() {
  if (state_changed_) {
    state_changed_ = false;
    const auto next = static_cast<std::uint32_t>(scene_.states.size());
    const auto [place, is_new] = state_numbers_.try_emplace(state_, next);
    if (is_new) scene_.states.push_back(state_);
    state_number_ = place->second;
  }
  return state_number_;
}

void CaptureReader::read_object() {
  const std::string_view raw = text_.rest();
  std::string name;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const auto byte = static_cast<unsigned char>(raw[i]);
    if ((byte < 0x20 && byte != '\t') || byte == 0x7f)
      text_.fail("the object's name " + quoted_word(raw) + " holds a control byte; write it as % and two hex digits");
    if (raw[i] != '%') {
      name += raw[i];
      continue;
    }
    const int high = i + 2 < raw.size() ? hex_digit(raw[i + 1]) : -1;
    const int low = i + 2 < raw.size() ? hex_digit(raw[i + 2]) : -1;
    if (high < 0 || low < 0)
      text_.fail("the object's name " + quoted_word(raw) + " holds a % without two hex digits; write %25 for a % sign");
    name += static_cast<char>(high * 16 + low);
    i += 2;
  }
  const auto next = static_cast<std::uint32_t>(scene_.objects.size());
  const auto [place, is_new] = object_numbers_.try_emplace(name, next);
  if (is_new) scene_.objects.push_back(std::move(name));
  object_ = place->second;
}

/// Lists the forms of a vertex: "3 (x y z), 4 (and w), 8 (and r g b a) or 10 (and u v)".
std::string vertex_forms() {
  std::string text;
  for (const VertexPart& part : kVertexParts) {
    if (!text.empty()) text += part.end == kVertexParts.back().end ? " or " : ", ";
    text += std::to_string(part.end) + (text.empty() ? " (" : " (and ") + std::string(part.names) + ")";
  }
  return text;
}

void CaptureReader::read_vertex() {
  VertexNumbers numbers = numbers_of(Vertex{});
  const std::size_t count = text_.numbers(numbers);
  if (text_.has_word() || std::ranges::find(kVertexParts, count, &VertexPart::end) == kVertexParts.end())
    text_.fail(std::string("a vertex of ") + (text_.has_word() ? "more than " : "") + std::to_string(count) +
               " numbers; write " + vertex_forms());
  // No index can follow the last line, and a truncated number would be read as a shorter one.
  if (!text_.is_terminated())
    text_.fail("the file ends inside this vertex: it may be cut off; add the rest, or end the line");
  if (const VertexPart* const part = part_out_of_bounds(numbers); part != nullptr)
    text_.fail(std::string(part->what) + " outside " + range_of(*part) + "; write " + std::string(part->names) +
               " in " + range_of(*part));
  if (scene_.vertices.size() == scene_.vertices.capacity()) grow_vertices();
  scene_.vertices.push_back(vertex_of(numbers));
}

/// Reads one more attribute of the vertex above.
void CaptureReader::read_attribute() {
  const std::string_view name = text_.word();
  if (name != "normal")
    text_.fail((name.empty() ? "an attribute without a name" : quoted_word(name) + " is no attribute of a vertex") +
               "; write a normal x y z");
  if (scene_.vertices.empty()) text_.fail("a normal without a vertex; write it below the 'v' line of its vertex");
  if (scene_.normals.size() == scene_.vertices.size())
    text_.fail("a second normal of vertex " + std::to_string(scene_.vertices.size() - 1) + "; remove one of them");
  scene_.normals.resize(scene_.vertices.size());
  for (double& component : scene_.normals.back())
    component = text_.number("a component of a normal", -kLargestNormal, kLargestNormal);
}

/// Reserves room for the number of vertices extrapolated from the text so far: touching fresh memory, which doubling
/// does twice, takes as long as reading the numbers. Bounded by the text's size, since a vertex takes at least 8 bytes
/// of it.
void CaptureReader::grow_vertices() {
  constexpr std::size_t enough_to_tell = 1024;  // vertices
  const std::size_t count = scene_.vertices.size();
  const double share = static_cast<double>(text_.size()) / static_cast<double>(text_.bytes_read());
  const double expected = static_cast<double>(count) * share * 1.02;  // 2 %: lines get longer as numbers do, or shorter
  const std::size_t doubled = std::max<std::size_t>(2 * count, enough_to_tell);
  scene_.vertices.reserve(count < enough_to_tell ? doubled : std::max(doubled, static_cast<std::size_t>(expected)));
}

/// One line of indices. A strip, a fan or a loop is one line; consecutive lists are joined.
void CaptureReader::read_draw(const CaptureDraw& draw) {
  const bool is_list = draw.is_list;
  const std::size_t least = draw.least;
  const std::string primitive(draw.primitive);
  const std::size_t first = scene_.indices.size();
  std::size_t run = 0;  // indices since the last restart
  bool has_restart = false;
  const auto end_run = [&] {
    if (is_list ? run % least == 0 && run > 0 : run >= least) return;
    text_.fail(std::string(draw.word) + (has_restart ? " with a run of " : " with ") + std::to_string(run) +
               (run == 1 ? " index" : " indices") + "; write " +
               (is_list ? std::to_string(least) + " for each " + primitive
                        : "at least " + std::to_string(least) + ", all on one line"));
  };
  do {
    if (text_.take("restart")) {
      if (is_list) text_.fail("restart in a list; leave it out, " + primitive + "s of a list share nothing");
      has_restart = true;
      end_run();
      run = 0;
      scene_.indices.push_back(kRestart);
    } else {
      scene_.indices.push_back(text_.index(scene_.vertices.size()));
      ++run;
    }
  } while (text_.has_word());
  end_run();
  const std::size_t count = scene_.indices.size() - first;
  const std::uint32_t state = state_number();
  if (is_list && !scene_.commands.empty()) {
    auto* last = std::get_if<Draw>(&scene_.commands.back());
    if (last != nullptr && last->topology == draw.topology && last->state == state && last->object == object_) {
      last->count += count;
      return;
    }
  }
  const auto line = std::min<std::size_t>(text_.line(), std::numeric_limits<std::uint32_t>::max());
  scene_.commands.emplace_back(Draw{.state = state,
                                    .object = object_,
                                    .topology = draw.topology,
                                    .first = first,
                                    .count = count,
                                    .line = static_cast<std::uint32_t>(line)});
}

/// The text of a file. Its memory is not initialised before the read, unlike a std::string's.
struct FileText {
  std::unique_ptr<char[]> bytes;
  std::size_t size = 0;
};

/// Reads to the end, a file in one piece; the size of a pipe is unknown.
FileText read_all(const std::string& path) {
  const auto refuse = [&path](const std::string& why) {
    throw InputError(path + ": " + why + "; give the path of a capture");
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) refuse("there is no such file");
  if (std::filesystem::is_directory(status)) refuse("this is a folder");
  if (std::filesystem::is_character_file(status)) refuse("this is a device");  // some devices never end
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse("the file cannot be opened (" + std::generic_category().message(errno) + ")");

  const auto known_size = std::filesystem::is_regular_file(status) ? std::filesystem::file_size(path, error) : 0;
  // One byte more than the file has: the first read then reaches its end.
  std::size_t room = std::max<std::size_t>(error ? 0 : known_size, 1u << 16) + 1;
  FileText text{std::make_unique_for_overwrite<char[]>(room)};
  for (;;) {
    file.read(text.bytes.get() + text.size, static_cast<std::streamsize>(room - text.size));
    text.size += static_cast<std::size_t>(file.gcount());
    if (!file) break;
    auto larger = std::make_unique_for_overwrite<char[]>(room * 2);
    std::copy_n(text.bytes.get(), text.size, larger.get());
    text.bytes = std::move(larger);
    room *= 2;
  }
  if (file.bad()) refuse("reading stopped (" + std::generic_category().message(errno) + ")");
  return text;
}

}  // namespace

Scene read_capture(std::string_view text, std::string_view file_name) { return read_capture_lines(text, file_name, 0); }

Scene read_capture_lines(std::string_view text, std::string_view file_name, std::size_t head) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";  // some editors begin UTF-8 files with it
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  return CaptureReader(text, file_name, head).read();
}

Scene read_capture_file(const std::string& path) {
  const FileText text = read_all(path);
  return read_capture({text.bytes.get(), text.size}, path);
}

}  // namespace halfplane
