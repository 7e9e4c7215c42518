// Vertex arrays (OpenGL 1.5, 2.8).
#include <algorithm>
#include <cstring>
#include <limits>

#include "arrays.hpp"
#include "commands.hpp"
#include "list.hpp"
#include "matrix.hpp"
#include "primitive.hpp"
#include "shading.hpp"

namespace halfplane::gl {
namespace {

constexpr std::size_t kUnbounded = std::numeric_limits<std::size_t>::max();

/// Reads `count` numbers. Normalized: the largest integer is 1 (OpenGL 1.5, table 2.6).
using Read = void (*)(const std::byte* from, int count, double* to);

template <class Number, bool kNormalized>
void read(const std::byte* from, int count, double* to) {
  for (int i = 0; i < count; ++i, from += sizeof(Number)) {
    Number number;
    std::memcpy(&number, from, sizeof number);
    to[i] = static_cast<double>(number);
    if constexpr (kNormalized && std::is_integral_v<Number>) {
      constexpr auto kRange = static_cast<double>(std::numeric_limits<std::make_unsigned_t<Number>>::max());
      to[i] = std::is_signed_v<Number> ? (2 * to[i] + 1) / kRange : to[i] / kRange;
    }
  }
}

void read_fixed(const std::byte* from, int count, double* to) {
  read<GLint, false>(from, count, to);
  for (int i = 0; i < count; ++i) to[i] /= 65536;
}

struct NumberType {
  GLenum type;
  std::size_t bytes;
  Read plain, normalized;
};
template <class Number>
constexpr NumberType number_type(GLenum type) {
  return {type, sizeof(Number), read<Number, false>, read<Number, true>};
}
constexpr std::array kNumberTypes{number_type<GLbyte>(GL_BYTE),
                                  number_type<GLubyte>(GL_UNSIGNED_BYTE),
                                  number_type<GLshort>(GL_SHORT),
                                  number_type<GLushort>(GL_UNSIGNED_SHORT),
                                  number_type<GLint>(GL_INT),
                                  number_type<GLuint>(GL_UNSIGNED_INT),
                                  number_type<GLfloat>(GL_FLOAT),
                                  number_type<GLdouble>(GL_DOUBLE),
                                  NumberType{GL_FIXED, sizeof(GLint), read_fixed, read_fixed}};

const NumberType& number_type_of(GLenum type) {
  const auto found = std::ranges::find(kNumberTypes, type, &NumberType::type);
  return found == kNumberTypes.end() ? kNumberTypes.front() : *found;
}

/// Memory of the program or of a buffer.
struct Memory {
  std::shared_ptr<BufferObject> buffer;  ///< kept alive; null: the program's
  const std::byte* data = nullptr;       ///< null: none
  std::size_t bytes = 0;

  /// False: the buffer is mapped, and no one may read it.
  [[nodiscard]] bool is_readable() const { return buffer == nullptr || !buffer->mapped; }
  [[nodiscard]] const std::byte* at(std::size_t offset, std::size_t size) const {
    return offset <= bytes && size <= bytes - offset ? data + offset : nullptr;
  }
};

Memory memory_of(const Context& context, GLuint buffer_name, const void* pointer) {
  if (buffer_name == 0) return {nullptr, static_cast<const std::byte*>(pointer), pointer == nullptr ? 0 : kUnbounded};
  const auto buffer = context.shared->buffer(buffer_name);
  const auto offset = reinterpret_cast<std::size_t>(pointer);
  if (buffer == nullptr || offset > buffer->data.size()) return {};
  return {buffer, buffer->data.data() + offset, buffer->data.size() - offset};
}

/// An enabled array, ready to be read.
struct Stream {
  Memory memory;
  std::size_t stride = 0, element_bytes = 0;
  int size = 0;
  Read read = nullptr;

  /// Number of elements that lie in memory.
  [[nodiscard]] std::size_t elements() const {
    return read == nullptr || memory.bytes < element_bytes ? 0 : (memory.bytes - element_bytes) / stride + 1;
  }
  /// 0 0 0 1 for elements beyond the end of a buffer, as far as `to` has numbers.
  void get(std::uint32_t i, double* to, std::size_t numbers) const {
    const std::byte* const from = memory.at(i * stride, element_bytes);
    if (from != nullptr) return read(from, size, to);
    constexpr Vec4 kNone{0, 0, 0, 1};
    std::copy_n(kNone.begin(), numbers, to);
  }
};

/// All arrays of a draw.
struct Streams {
  std::array<Stream, kArrays> stream;
  bool is_readable = true;

  explicit Streams(const Context& context) {
    for (std::size_t i = 0; i < kArrays; ++i) {
      const ArrayPointer& array = context.client.array[i];
      if (!array.enabled) continue;
      const NumberType& type = number_type_of(array.type);
      const Memory memory = memory_of(context, array.buffer, array.pointer);
      const std::size_t bytes = type.bytes * static_cast<std::size_t>(array.size);
      stream[i] = {memory, array.stride == 0 ? bytes : static_cast<std::size_t>(array.stride), bytes, array.size,
                   array_kind(i).is_normalized ? type.normalized : type.plain};
      is_readable &= memory.is_readable();
    }
  }
  [[nodiscard]] const Stream& operator[](Array array) const { return stream[static_cast<std::size_t>(array)]; }

  /// Issues the attributes of an element as commands.
  void issue_attributes(Context& context, std::uint32_t i) const {
    const auto with = [&](Array array, auto&& command, std::size_t unit = 0) {
      const Stream& from = stream[static_cast<std::size_t>(array) + unit];
      if (from.read == nullptr) return;
      Vec4 value{0, 0, 0, 1};
      from.get(i, value.data(), value.size());
      command(value);
    };
    with(Array::edge_flag, [&](const Vec4& v) { issue<&gl::edge_flag>(context, static_cast<GLboolean>(v[0] != 0)); });
    for (std::size_t unit = 0; unit < kTextureUnits; ++unit) {
      const auto command = [&](const Vec4& v) {
        issue<&gl::tex_coord>(context, static_cast<GLenum>(GL_TEXTURE0 + unit), v[0], v[1], v[2], v[3]);
      };
      with(Array::tex_coord, command, unit);
    }
    with(Array::point_size, [&](const Vec4& v) {
      context.state.point.size = v[0];
      if (context.inside_begin()) context.input.set(Attribute::point_size, std::array{v[0]});
    });
    with(Array::fog_coord, [&](const Vec4& v) { issue<&gl::fog_coord>(context, v[0]); });
    with(Array::index, [&](const Vec4& v) { issue<&gl::index>(context, v[0]); });
    with(Array::secondary_color, [&](const Vec4& v) { issue<&gl::secondary_color>(context, v[0], v[1], v[2]); });
    with(Array::color, [&](const Vec4& v) { issue<&gl::color>(context, v[0], v[1], v[2], v[3]); });
    with(Array::normal, [&](const Vec4& v) { issue<&gl::normal>(context, v[0], v[1], v[2]); });
  }

  void issue_vertex(Context& context, std::uint32_t i) const {
    issue_attributes(context, i);
    if ((*this)[Array::vertex].read == nullptr) return;
    Vec4 position{0, 0, 0, 1};
    (*this)[Array::vertex].get(i, position.data(), position.size());
    const auto& [x, y, z, w] = position;
    issue<&gl::vertex>(context, x, y, z, w);
  }
};

/// Elements of the arrays as vertices, whose other attributes are the current ones.
class ElementReader {
 public:
  ElementReader(const Streams& streams, const State& state, InputVertices& vertices) : input_(vertices) {
    input_.begin(state);
    // An index has no column: it colours nothing.
    constexpr std::array<std::pair<Array, Attribute>, 8> kColumns{{{Array::vertex, Attribute::position},
                                                                   {Array::normal, Attribute::normal},
                                                                   {Array::color, Attribute::color},
                                                                   {Array::secondary_color, Attribute::secondary},
                                                                   {Array::edge_flag, Attribute::edge_flag},
                                                                   {Array::fog_coord, Attribute::fog_coord},
                                                                   {Array::point_size, Attribute::point_size},
                                                                   {Array::tex_coord, Attribute::tex_coord}}};
    for (const auto& [array, attribute] : kColumns)
      for (std::size_t unit = 0; unit < (array == Array::tex_coord ? kTextureUnits : 1); ++unit) {
        const Stream& stream = streams.stream[static_cast<std::size_t>(array) + unit];
        if (stream.read == nullptr) continue;
        const std::size_t which = static_cast<std::size_t>(attribute) + unit;
        const std::size_t numbers = kInputNumber[which + 1] - kInputNumber[which];
        if (attribute != Attribute::position) input_.vary(which);
        double* const to = input_.next(kInputNumber[which]);
        constexpr Vec4 kMissing{0, 0, 0, 1};  // of arrays with fewer numbers
        std::copy_n(kMissing.begin(), numbers, to);
        part_[parts_++] = {&stream, to, numbers};
      }
  }
  void add(std::uint32_t element) const {
    for (const Part& part : std::span(part_).first(parts_)) part.from->get(element, part.to, part.numbers);
    input_.add();
  }

 private:
  struct Part {
    const Stream* from;
    double* to;
    std::size_t numbers;
  };
  InputVertices& input_;
  std::array<Part, kAttributes> part_;
  std::size_t parts_ = 0;
};

/// A draw's errors; false: it has one. Within glBegin and glEnd a list takes it, and it is refused when it is played.
bool check_draw(Context& context, GLenum mode, GLsizei count) {
  const GLenum error = context.inside_begin() && context.compiling == nullptr ? GL_INVALID_OPERATION
                       : mode > last_mode(context)                            ? GL_INVALID_ENUM
                       : count < 0                                            ? GL_INVALID_VALUE
                                                                              : GL_NO_ERROR;
  if (error != GL_NO_ERROR) context.fail(error);
  return error == GL_NO_ERROR;
}

/// Checks the counts of several draws.
bool check_draws(Context& context, GLenum mode, const GLsizei* count, GLsizei draws) {
  return check_draw(context, mode, draws) &&
         std::all_of(count, count + draws, [&](GLsizei n) { return check_draw(context, mode, n); });
}

void play(Context& context, const std::shared_ptr<const DisplayList>& list) {
  const CurrentKept kept(context);
  list->play(context);
}

/// Reads elements first + indices[0], first + indices[1], ..., each once, and says at which place each one is. `are_distinct`:
/// they are so already. The places are valid until the next call.
std::span<const std::uint32_t> read_elements(const ElementReader& reader, const InputVertices& vertices,
                                             std::uint32_t first, std::span<const std::uint32_t> indices,
                                             bool are_distinct) {
  if (indices.empty()) return indices;
  constexpr auto kNowhere = std::numeric_limits<std::uint32_t>::max();
  const auto [low, high] = std::ranges::minmax(are_distinct ? indices.first(1) : indices);
  if (are_distinct || (high - low) / 8 > indices.size()) {  // of a sparse range index by index
    for (const std::uint32_t i : indices) reader.add(first + i);
    return counting(indices.size());
  }
  thread_local std::vector<std::uint32_t> place, placed;
  place.assign(std::size_t{high} - low + 1, kNowhere);
  placed.clear();
  for (const std::uint32_t i : indices) {
    std::uint32_t& at = place[i - low];
    if (at == kNowhere) {
      at = static_cast<std::uint32_t>(vertices.size());
      reader.add(first + i);
    }
    placed.push_back(at);
  }
  return placed;
}

/// Draws elements as read_elements() reads them; as a list of its own in one that is being compiled, so that it is refused as
/// a whole within glBegin and glEnd.
void draw(Context& context, const Streams& streams, GLenum mode, std::uint32_t first,
          std::span<const std::uint32_t> indices, bool are_distinct) {
  if (!streams.is_readable) return context.fail(GL_INVALID_OPERATION);
  if (streams[Array::vertex].elements() == 0) indices = {};
  const bool is_compiled = context.compiling != nullptr;
  if (indices.empty() && !is_compiled) return;
  InputVertices of_list;
  InputVertices& vertices = is_compiled ? of_list : context.input;
  const ElementReader reader(streams, context.state, vertices);
  const auto places = read_elements(reader, vertices, first, indices, are_distinct);
  if (is_compiled) {
    const auto list = std::make_shared<DisplayList>();
    list->add_vertices(mode, vertices, places);
    return issue<&play>(context, list);
  }
  update_shading(context);
  context.shaded.clear();
  draw_vertices(context, mode, vertices, vertices.values(), places);
}

/// glInterleavedArrays (OpenGL 1.5, table 2.5). Sizes of 0: the array is off. Offsets in bytes.
struct Interleaved {
  GLenum format;
  int texture_size, color_size;
  GLenum color_type;
  bool has_normal;
  int vertex_size, color_at, normal_at, vertex_at, stride;
};
constexpr int kFloat = sizeof(GLfloat);
constexpr GLenum kBytes = GL_UNSIGNED_BYTE;
constexpr std::array kInterleaved{
    Interleaved{GL_V2F, 0, 0, 0, false, 2, 0, 0, 0, 2 * kFloat},
    Interleaved{GL_V3F, 0, 0, 0, false, 3, 0, 0, 0, 3 * kFloat},
    Interleaved{GL_C4UB_V2F, 0, 4, kBytes, false, 2, 0, 0, 4, 4 + 2 * kFloat},
    Interleaved{GL_C4UB_V3F, 0, 4, kBytes, false, 3, 0, 0, 4, 4 + 3 * kFloat},
    Interleaved{GL_C3F_V3F, 0, 3, GL_FLOAT, false, 3, 0, 0, 3 * kFloat, 6 * kFloat},
    Interleaved{GL_N3F_V3F, 0, 0, 0, true, 3, 0, 0, 3 * kFloat, 6 * kFloat},
    Interleaved{GL_C4F_N3F_V3F, 0, 4, GL_FLOAT, true, 3, 0, 4 * kFloat, 7 * kFloat, 10 * kFloat},
    Interleaved{GL_T2F_V3F, 2, 0, 0, false, 3, 0, 0, 2 * kFloat, 5 * kFloat},
    Interleaved{GL_T4F_V4F, 4, 0, 0, false, 4, 0, 0, 4 * kFloat, 8 * kFloat},
    Interleaved{GL_T2F_C4UB_V3F, 2, 4, kBytes, false, 3, 2 * kFloat, 0, 2 * kFloat + 4, 4 + 5 * kFloat},
    Interleaved{GL_T2F_C3F_V3F, 2, 3, GL_FLOAT, false, 3, 2 * kFloat, 0, 5 * kFloat, 8 * kFloat},
    Interleaved{GL_T2F_N3F_V3F, 2, 0, 0, true, 3, 0, 2 * kFloat, 5 * kFloat, 8 * kFloat},
    Interleaved{GL_T2F_C4F_N3F_V3F, 2, 4, GL_FLOAT, true, 3, 2 * kFloat, 6 * kFloat, 9 * kFloat, 12 * kFloat},
    Interleaved{GL_T4F_C4F_N3F_V4F, 4, 4, GL_FLOAT, true, 4, 4 * kFloat, 8 * kFloat, 11 * kFloat, 15 * kFloat}};

}  // namespace

ClientState::ClientState() {
  for (std::size_t i = 0; i < kArrays; ++i) array[i].size = array_kind(i).largest;
  array[static_cast<std::size_t>(Array::edge_flag)].type = GL_UNSIGNED_BYTE;
}

std::size_t array_type_bytes(GLenum type) { return number_type_of(type).bytes; }
double array_number(GLenum type, const std::byte* at) {
  double number = 0;
  number_type_of(type).plain(at, 1, &number);
  return number;
}

void array_pointer(Context& context, Array which, GLint size, GLenum type, GLsizei stride, const void* pointer) {
  const std::size_t place = array_place(context.client, static_cast<std::size_t>(which));
  const ArrayKind& kind = array_kind(place);
  if (size < kind.least || size > kind.largest || stride < 0) return context.fail(GL_INVALID_VALUE);
  const bool is_known = context.is_embedded ? takes_array_type(type, which == Array::color)
                                            : type - GL_BYTE < 32 && (kind.types >> (type - GL_BYTE) & 1U) != 0;
  if (!is_known) return context.fail(GL_INVALID_ENUM);
  ArrayPointer& array = context.client.array[place];
  array = {array.enabled, size, type, stride, pointer, context.client.array_buffer};
}

void interleaved_arrays(Context& context, GLenum format, GLsizei stride, const void* pointer) {
  const auto found = std::ranges::find(kInterleaved, format, &Interleaved::format);
  if (found == kInterleaved.end()) return context.fail(GL_INVALID_ENUM);
  if (stride < 0) return context.fail(GL_INVALID_VALUE);
  if (stride == 0) stride = found->stride;
  ClientState& client = context.client;
  // An address, or an offset within a buffer; not arithmetic on a pointer, which may be null.
  const auto set = [&](Array which, int size, GLenum type, int at) {
    ArrayPointer& array = client.array[array_place(client, static_cast<std::size_t>(which))];
    array.enabled = size != 0;
    const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(pointer) + static_cast<std::uintptr_t>(at);
    const auto* const where = reinterpret_cast<const void*>(address);  // NOLINT(performance-no-int-to-ptr)
    if (size != 0) array = {true, size, type, stride, where, client.array_buffer};
  };
  for (const Array array : {Array::edge_flag, Array::index, Array::secondary_color, Array::fog_coord})
    client.array[static_cast<std::size_t>(array)].enabled = false;
  set(Array::tex_coord, found->texture_size, GL_FLOAT, 0);
  set(Array::color, found->color_size, found->color_type, found->color_at);
  set(Array::normal, found->has_normal ? 3 : 0, GL_FLOAT, found->normal_at);
  set(Array::vertex, found->vertex_size, GL_FLOAT, found->vertex_at);
}

void client_state(Context& context, GLenum name, bool enabled) {
  const std::size_t place = find_array(context.client, &ArrayKind::enable, name);
  if (place == kArrays) return context.fail(GL_INVALID_ENUM);
  context.client.array[place].enabled = enabled;
}

void client_active_texture(Context& context, GLenum unit) {
  if (unit < GL_TEXTURE0 || unit >= GL_TEXTURE0 + kTextureUnits) return context.fail(GL_INVALID_ENUM);
  context.client.active_texture = static_cast<int>(unit - GL_TEXTURE0);
}

void array_element(Context& context, GLint i) {
  if (i < 0) return context.fail(GL_INVALID_VALUE);
  const Streams streams(context);
  if (!streams.is_readable) return context.fail(GL_INVALID_OPERATION);
  streams.issue_vertex(context, static_cast<std::uint32_t>(i));
}

void draw_arrays(Context& context, GLenum mode, GLint first, GLsizei count) {
  if (!check_draw(context, mode, count)) return;
  if (first < 0) return context.fail(GL_INVALID_VALUE);
  // No element beyond the end of a buffer is drawn.
  const Streams streams(context);
  const std::size_t elements = streams[Array::vertex].elements(), at = static_cast<std::size_t>(first);
  const std::size_t drawn = std::min(static_cast<std::size_t>(count), elements > at ? elements - at : 0);
  draw(context, streams, mode, static_cast<std::uint32_t>(first), counting(drawn), true);
}

void draw_elements(Context& context, GLenum mode, GLsizei count, GLenum type, const void* indices) {
  if (!check_draw(context, mode, count)) return;
  if (type != GL_UNSIGNED_BYTE && type != GL_UNSIGNED_SHORT && type != GL_UNSIGNED_INT)
    return context.fail(GL_INVALID_ENUM);
  const Memory memory = memory_of(context, context.client.element_buffer, indices);
  if (!memory.is_readable()) return context.fail(GL_INVALID_OPERATION);
  const std::size_t bytes = number_type_of(type).bytes;
  thread_local std::vector<std::uint32_t> numbers;
  numbers.assign(std::min(static_cast<std::size_t>(count), memory.bytes / bytes), 0);
  const auto widen = [&]<class Number>(Number) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      Number number;
      std::memcpy(&number, memory.data + i * sizeof number, sizeof number);
      numbers[i] = number;
    }
  };
  if (type == GL_UNSIGNED_BYTE) widen(GLubyte());
  if (type == GL_UNSIGNED_SHORT) widen(GLushort());
  if (type == GL_UNSIGNED_INT) widen(GLuint());
  draw(context, Streams(context), mode, 0, numbers, false);
}

void draw_range_elements(Context& context, GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type,
                         const void* indices) {
  if (!check_draw(context, mode, count)) return;
  if (end < start) return context.fail(GL_INVALID_VALUE);
  draw_elements(context, mode, count, type, indices);
}

void multi_draw_arrays(Context& context, GLenum mode, const GLint* first, const GLsizei* count, GLsizei draws) {
  if (!check_draws(context, mode, count, draws)) return;
  for (GLsizei i = 0; i < draws; ++i) draw_arrays(context, mode, first[i], count[i]);
}

void multi_draw_elements(Context& context, GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                         GLsizei draws) {
  if (!check_draws(context, mode, count, draws)) return;
  for (GLsizei i = 0; i < draws; ++i) draw_elements(context, mode, count[i], type, indices[i]);
}

}  // namespace halfplane::gl
