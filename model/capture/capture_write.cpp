#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <span>

#include "../host/primitive_assembly.hpp"
#include "capture.hpp"
#include "capture_states.hpp"
#include "capture_text.hpp"
#include "capture_textures.hpp"

namespace halfplane {
namespace {

/// Equal in every bit: 0 and -0 differ.
bool same_bits(std::span<const double> a, std::span<const double> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

/// Number of numbers needed on a `v` line: up to the last part that differs from the defaults.
std::size_t numbers_needed(const VertexNumbers& numbers) {
  constexpr VertexNumbers defaults = numbers_of(Vertex{});
  std::size_t needed = 0, begin = 0;
  for (const VertexPart& part : kVertexParts) {
    const auto of_part = [&](const VertexNumbers& all) { return std::span(all).subspan(begin, part.end - begin); };
    if (begin == 0 || !same_bits(of_part(numbers), of_part(defaults))) needed = part.end;
    begin = part.end;
  }
  return needed;
}

/// An object's name as one word or several on a line: characters that the line cannot hold are written as % and two hex
/// digits.
std::string escaped(std::string_view name) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto byte = static_cast<unsigned char>(name[i]);
    const bool is_edge_blank = byte == ' ' && (i == 0 || i + 1 == name.size());
    if (byte >= 0x20 && byte != 0x7f && byte != '%' && byte != '#' && !is_edge_blank) {
      result += name[i];
    } else {
      result += '%';
      result += digits[byte >> 4];
      result += digits[byte & 15];
    }
  }
  return result;
}

/// Writes commands in order and tracks the reader's state.
class CaptureWriter {
 public:
  CaptureWriter(const Scene& scene, std::ostream& out) : scene_(scene), out_(out) {}

  void write() {
    buffer_ += "halfplane 1\ntarget " + std::to_string(scene_.width) + ' ' + std::to_string(scene_.height) + '\n';
    if (scene_.planes) {
      buffer_ += "planes ";
      append_number(buffer_, (*scene_.planes)[0]);
      buffer_ += ' ';
      if (std::isinf((*scene_.planes)[1]))
        buffer_ += "inf";
      else
        append_number(buffer_, (*scene_.planes)[1]);
      buffer_ += '\n';
    }
    for (const Texture& texture : scene_.textures) {
      write_texture(texture, buffer_);
      flush_if_full();
    }
    for (std::size_t i = 0; i < scene_.vertices.size(); ++i) {
      write_vertex(scene_.vertices[i]);
      if (const std::array<double, 3> normal = scene_.normal(i); normal != std::array<double, 3>{})
        write_normal(normal);
    }
    for (const Command& command : scene_.commands) {
      if (const auto* clear = std::get_if<Clear>(&command)) write_clear(*clear);
      if (const auto* draw = std::get_if<Draw>(&command)) write_draw(*draw);
      if (std::holds_alternative<EndFrame>(command)) buffer_ += "frame\n";
      flush_if_full();
    }
    introduce_objects(scene_.objects.size());
    flush();
  }

 private:
  void write_vertex(const Vertex& vertex);
  void write_normal(const std::array<double, 3>& normal);
  void write_clear(const Clear& clear);
  void write_draw(const Draw& draw);
  void write_state(const State& wanted);
  void write_object(std::size_t object);
  void introduce_objects(std::size_t end);

  void flush() {
    out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
  }
  void flush_if_full() {
    if (buffer_.size() > (1u << 16)) flush();
  }

  const Scene& scene_;
  std::ostream& out_;
  std::string buffer_;
  State state_;                    // the reader's state at this point
  bool space_is_named_ = false;    // `space` is written once even if it is the default, for human readers
  std::size_t object_ = 0;         // the reader's current object
  std::size_t objects_named_ = 1;  // objects below this one have their numbers; 0 needs no line
};

void CaptureWriter::write_vertex(const Vertex& vertex) {
  const VertexNumbers numbers = numbers_of(vertex);
  buffer_ += 'v';
  for (const double number : std::span(numbers).first(numbers_needed(numbers))) {
    buffer_ += ' ';
    append_number(buffer_, number);
  }
  buffer_ += '\n';
  flush_if_full();
}

void CaptureWriter::write_normal(const std::array<double, 3>& normal) {
  buffer_ += "a normal";
  for (const double component : normal) {
    buffer_ += ' ';
    append_number(buffer_, component);
  }
  buffer_ += '\n';
}

void CaptureWriter::write_state(const State& wanted) {
  const auto write = [&](const DrawState& row) {
    buffer_ += row.name;
    write_state_value(wanted, row, scene_.textures, buffer_);
    buffer_ += '\n';
  };
  if (!space_is_named_ || !capture_space().is_same(state_, wanted)) write(capture_space());
  space_is_named_ = true;
  if (!(state_ == wanted))
    for (const DrawState& row : capture_states()) {
      if (row.is_same(state_, wanted)) continue;
      buffer_ += "state ";
      write(row);
    }
  state_ = wanted;
}

void CaptureWriter::write_clear(const Clear& clear) {
  if (!clear.color && !clear.depth && !clear.stencil) return;  // clears nothing, and needs no line
  write_state(scene_.states[clear.state]);
  buffer_ += "clear";
  const auto write = [this](const char* what, std::span<const double> numbers) {
    buffer_ += what;
    for (const double number : numbers) {
      buffer_ += ' ';
      append_number(buffer_, number);
    }
  };
  if (clear.color) write(" color", *clear.color);
  if (clear.depth) write(" depth", std::span(&*clear.depth, 1));
  if (clear.stencil) buffer_ += " stencil " + std::to_string(*clear.stencil);
  buffer_ += '\n';
}

void CaptureWriter::write_object(std::size_t object) {
  buffer_ += "object";
  if (!scene_.objects[object].empty()) buffer_ += ' ' + escaped(scene_.objects[object]);
  buffer_ += '\n';
  object_ = object;
}

/// The reader numbers objects as they appear: writes the names before `end` that have not appeared yet, in order.
void CaptureWriter::introduce_objects(std::size_t end) {
  for (; objects_named_ < end; ++objects_named_) write_object(objects_named_);
}

/// Writes the drawn part: indices that make no primitive are left out.
void CaptureWriter::write_draw(const Draw& draw) {
  const auto format = *std::ranges::find(kCaptureDraws, draw.topology, &CaptureDraw::topology);
  const auto drawn = [&format](std::size_t run) {
    return format.is_list ? run - run % format.least : run < format.least ? 0 : run;
  };
  std::size_t total = 0;
  for_each_run(scene_, draw, [&](std::span<const std::uint32_t> run) { total += drawn(run.size()); });
  if (total == 0) return;
  introduce_objects(draw.object);
  if (draw.object != object_) {
    write_object(draw.object);
    objects_named_ = std::max<std::size_t>(objects_named_, draw.object + std::size_t{1});
  }
  write_state(scene_.states[draw.state]);
  bool is_first = true;
  for_each_run(scene_, draw, [&](std::span<const std::uint32_t> run) {
    for (std::size_t i = 0; i < drawn(run.size()); ++i) {
      if (format.is_list ? i % format.least == 0 : is_first) buffer_ += format.word;
      if (!format.is_list && i == 0 && !is_first) buffer_ += " restart";
      is_first = false;
      buffer_ += ' ';
      buffer_ += std::to_string(run[i]);
      if (format.is_list && i % format.least == format.least - 1) buffer_ += '\n';
      flush_if_full();
    }
  });
  if (!format.is_list) buffer_ += '\n';
}

bool same_command(const Scene& a, const Command& command_a, const Scene& b, const Command& command_b) {
  if (command_a.index() != command_b.index()) return false;
  if (const auto* clear_a = std::get_if<Clear>(&command_a)) {
    const auto& clear_b = std::get<Clear>(command_b);
    return clear_a->state == clear_b.state && clear_a->stencil == clear_b.stencil &&
           clear_a->color.has_value() == clear_b.color.has_value() &&
           (!clear_a->color || same_bits(*clear_a->color, *clear_b.color)) &&
           clear_a->depth.has_value() == clear_b.depth.has_value() &&
           (!clear_a->depth || same_bits(std::span(&*clear_a->depth, 1), std::span(&*clear_b.depth, 1)));
  }
  if (const auto* draw_a = std::get_if<Draw>(&command_a)) {
    const auto& draw_b = std::get<Draw>(command_b);
    if (draw_a->state != draw_b.state || draw_a->object != draw_b.object || draw_a->topology != draw_b.topology)
      return false;
    const auto indices_a = std::span(a.indices).subspan(draw_a->first, draw_a->count);
    const auto indices_b = std::span(b.indices).subspan(draw_b.first, draw_b.count);
    return std::equal(indices_a.begin(), indices_a.end(), indices_b.begin(), indices_b.end());
  }
  return true;  // EndFrame
}

}  // namespace

void write_capture(const Scene& scene, std::ostream& out) {
  validate(scene);
  CaptureWriter(scene, out).write();
}

bool same_scene(const Scene& a, const Scene& b) {
  for (std::size_t i = 0; i < std::max(a.normals.size(), b.normals.size()); ++i)
    if (a.normal(i) != b.normal(i)) return false;
  return a.width == b.width && a.height == b.height && a.planes == b.planes && a.states == b.states &&
         a.textures == b.textures && a.objects == b.objects &&
         std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                    [](const Vertex& v, const Vertex& w) { return same_bits(numbers_of(v), numbers_of(w)); }) &&
         std::equal(a.commands.begin(), a.commands.end(), b.commands.begin(), b.commands.end(),
                    [&](const Command& c, const Command& d) { return same_command(a, c, b, d); });
}

}  // namespace halfplane
