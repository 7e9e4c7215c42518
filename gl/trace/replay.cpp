#include "replay.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <list>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "../core/arrays.hpp"
#include "../core/commands.hpp"
#include "../core/entry_points.hpp"
#include "trace_file.hpp"

namespace halfplane::gl {
namespace {

/// Bytes that a command may read; more than that is not carried out.
constexpr double kFarthestReach = double{1 << 30};

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}
bool begins_with_one_of(std::string_view name, std::initializer_list<std::string_view> beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(), [&](auto beginning) { return name.starts_with(beginning); });
}

/// glDrawArraysEXT as glDrawArrays.
std::string_view core_name(std::string_view name) {
  for (const std::string_view suffix : {"ARB", "EXT", "OES"})
    if (name.ends_with(suffix)) return name.substr(0, name.size() - suffix.size());
  return name;
}

// --- recorded calls as calls of entry points

/// Arguments for a pointer whose memory the trace lacks.
enum class Addresses { none, null, offsets };

/// Everything that a call's arguments point at. To outlive them.
using HeldMemory = std::list<std::vector<std::byte>>;

/// Writes a number as an entry point takes it, or reads it from memory; bytes lie from the lowest on.
void put(const TraceValue& value, const Parameter& type, void* to) {
  const auto single = static_cast<float>(value.real);
  const void* const from = !type.is_real                 ? static_cast<const void*>(&value.integer)
                           : type.bytes == sizeof single ? static_cast<const void*>(&single)
                                                         : &value.real;
  std::memcpy(to, from, type.bytes);
}

/// The memory that a pointer's argument holds.
std::vector<std::byte> memory_of(const TraceValue& value, const Parameter& type, std::size_t reach) {
  const bool is_array = value.kind == TraceValue::Kind::array;
  const std::size_t size = is_array ? value.items.size() * type.bytes : value.bytes.size();
  std::vector<std::byte> memory(std::max(size + 1, reach));  // a string ends in 0
  std::byte* to = memory.data();
  if (!is_array) std::memcpy(to, value.bytes.data(), size);
  for (const TraceValue& item : value.items) {
    put(item, type, to);
    to += type.bytes;
  }
  return memory;
}

/// Calls `entry` with recorded arguments, whose memory is put into `held`, followed by zeros up to `reach` bytes: those that
/// the command may read however short the recorded memory is. False: it takes other arguments, or a pointer that it must not
/// get. Not for commands that write to the program's memory.
bool call_entry(const EntryPoint& entry, const std::vector<TraceValue>& values, std::size_t reach, Addresses addresses,
                HeldMemory& held) {
  std::array<std::uint64_t, 16> arguments{};
  if (values.size() != entry.parameters.size() || values.size() > arguments.size()) return false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const TraceValue& value = values[i];
    const Parameter& type = entry.parameters[i];
    const bool has_memory =
        value.kind == TraceValue::Kind::bytes || (value.kind == TraceValue::Kind::array && type.bytes != 0);
    if (!type.is_pointer) {
      put(value, type, &arguments[i]);
    } else if (has_memory) {
      arguments[i] = reinterpret_cast<std::uintptr_t>(held.emplace_back(memory_of(value, type, reach)).data());
    } else {
      const bool is_null = value.kind == TraceValue::Kind::null;
      if (addresses == Addresses::none || (!is_null && addresses != Addresses::offsets)) return false;
      arguments[i] = static_cast<std::uint64_t>(value.integer);
    }
  }
  entry.call(entry.function, arguments.data());
  return true;
}

// --- surfaces, contexts, frames

/// Information in GLX and EGL calls that a replay needs.
struct Binding {
  std::int64_t context = 0, draw = 0, read = 0;
};
std::optional<Binding> binding_of(const TraceCall& call) {
  if (!is_one_of(call.function(),
                 {"glXMakeCurrent", "glXMakeContextCurrent", "glXMakeCurrentReadSGI", "eglMakeCurrent"}))
    return std::nullopt;
  const std::int64_t draw = call.argument("drawable", "draw").integer;
  const bool has_read = call.argument("read").kind != TraceValue::Kind::null;
  return Binding{call.argument("ctx", "context").integer, draw, has_read ? call.argument("read").integer : draw};
}
/// The surface that a call swaps.
std::optional<std::int64_t> swapped_by(const TraceCall& call) {
  if (!begins_with_one_of(call.function(), {"glXSwapBuffers", "eglSwapBuffers"})) return std::nullopt;
  return call.argument("drawable", "surface").integer;
}
bool creates_context(std::string_view name) {
  return name == "eglCreateContext" ||
         (name.starts_with("glXCreate") && name.find("Context") != std::string_view::npos);
}

/// Finds surfaces, their sizes and their frames.
class Survey {
 public:
  void take(const TraceCall& call) {
    const std::string& name = call.function();
    if (const auto binding = binding_of(call)) {
      drawn_[call.thread] = binding->draw;
      if (binding->draw != 0) contents.surfaces[binding->draw];
    } else if (const auto swapped = swapped_by(call)) {
      contents.surfaces[*swapped];
      ++contents.frames;
    } else if (begins_with_one_of(name, {"glXCreatePbuffer", "glXCreateGLXPbuffer", "eglCreatePbuffer"})) {
      fixed_size(call);
    } else if (name == "glViewport" && call.argument("x").integer == 0 && call.argument("y").integer == 0) {
      const auto drawn = contents.surfaces.find(drawn_[call.thread]);
      if (drawn == contents.surfaces.end() || drawn->second.has_fixed_size) return;
      grow(drawn->second.width, call.argument("width").integer);
      grow(drawn->second.height, call.argument("height").integer);
    }
  }

  TraceContents contents;

 private:
  static void grow(int& size, std::int64_t to) {
    size = static_cast<int>(std::clamp<std::int64_t>(to, size, std::numeric_limits<int>::max()));
  }
  void fixed_size(const TraceCall& call) {
    TraceContents::Surface& surface = contents.surfaces[call.result.integer] = {};
    surface.has_fixed_size = true;
    grow(surface.width, call.argument("width").integer);
    grow(surface.height, call.argument("height").integer);
    const std::vector<TraceValue>& pairs = call.argument("attribList", "attrib_list", "attribs").items;
    for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) {
      constexpr std::array<std::int64_t, 2> kWidths{0x8041, 0x3057}, kHeights{0x8040, 0x3056};  // GLX's, EGL's
      const std::int64_t key = pairs[i].integer, value = pairs[i + 1].integer;
      if (std::find(kWidths.begin(), kWidths.end(), key) != kWidths.end()) grow(surface.width, value);
      if (std::find(kHeights.begin(), kHeights.end(), key) != kHeights.end()) grow(surface.height, value);
    }
  }

  std::map<std::uint64_t, std::int64_t> drawn_;  ///< by thread
};

class Replay {
 public:
  Replay(const TraceContents& contents, const Options& options, int frames, const ReplayHooks& hooks)
      : contents_(contents), options_(options), frames_(frames), hooks_(hooks) {}
  ~Replay() { make_current(nullptr, nullptr, nullptr); }
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  /// False: all frames have been drawn.
  bool take(const TraceCall& call);
  /// For a program that never swaps.
  void finish() {
    if (contents_.unswapped != 0) end_frame(contents_.unswapped);
  }

 private:
  void create_context(const TraceCall& call);
  void bind(const Binding& binding);
  Drawable* surface(std::int64_t id);
  void end_frame(std::int64_t id);
  void command(const TraceCall& call);
  bool carry_out(const TraceCall& call, Context& context);
  void warn_once(const std::string& function, const std::string& what) {
    if (warned_.insert(function).second) hooks_.warn(function + " " + what);
  }

  // Checks that keep commands inside the trace's memory.
  using Bytes = std::span<const std::byte>;
  [[nodiscard]] static double reach(const TraceCall& call, const Context& context);
  [[nodiscard]] std::optional<Bytes> memory_of(const Context& context, const ArrayPointer& array) const;
  [[nodiscard]] bool arrays_hold(const Context& context, std::int64_t index) const;
  // Of `call` or one of its several draws.
  bool draw_arrays(const TraceCall& call, Context& context, std::int64_t first, std::int64_t count) const;
  bool draw_elements(const TraceCall& call, Context& context, std::int64_t count, const TraceValue& indices) const;
  bool multi_draw(const TraceCall& call, Context& context) const;
  bool map(const TraceCall& call, Context& context);
  void copy_to_map(const TraceCall& call);

  const TraceContents& contents_;
  const Options& options_;
  const int frames_;
  const ReplayHooks& hooks_;
  int frame_ = 0;
  std::map<std::int64_t, std::unique_ptr<Drawable>> surfaces_;
  std::map<std::int64_t, std::unique_ptr<Context>> contexts_;
  std::map<std::uint64_t, Binding> bindings_;  ///< by thread
  std::uint64_t thread_ = 0;                   ///< whose binding is the current one
  std::set<std::string> warned_;
  /// Memory that commands keep pointers to, until the same command of the same context and unit points elsewhere.
  std::map<std::tuple<const Context*, std::string, int>, HeldMemory> kept_;
  /// Buffers by the address that they were mapped at when the program ran.
  struct Mapped {
    std::weak_ptr<SharedObjects> shared;
    GLuint buffer = 0;
  };
  std::map<std::int64_t, Mapped> mapped_;
};

bool Replay::take(const TraceCall& call) {
  const std::string& name = call.function();
  if (creates_context(name)) {
    create_context(call);
  } else if (const auto binding = binding_of(call)) {
    bindings_[call.thread] = *binding;
    thread_ = call.thread;
    bind(*binding);
  } else if (const auto swapped = swapped_by(call)) {
    end_frame(*swapped);
    return frame_ < frames_;
  } else if (name == "memcpy") {
    copy_to_map(call);
  } else if (name == "glXUseXFont") {
    warn_once(name, "needs the X server's fonts; left out");
  } else if (name.starts_with("gl") && !name.starts_with("glX")) {
    command(call);
  }
  return true;
}

void Replay::create_context(const TraceCall& call) {
  if (call.result.integer == 0) return;
  const auto shares = contexts_.find(call.argument("shareList", "share_list", "share_context", "share").integer);
  auto context =
      shares == contexts_.end() ? std::make_unique<Context>() : std::make_unique<Context>(shares->second->shared);
  std::unique_ptr<Context>& place = contexts_[call.result.integer];
  if (place != nullptr) make_current(nullptr, nullptr, nullptr);
  place = std::move(context);
}

void Replay::bind(const Binding& binding) {
  const auto context = contexts_.find(binding.context);
  Drawable* draw = surface(binding.draw);
  Drawable* read = surface(binding.read);
  const bool is_whole = context != contexts_.end() && draw != nullptr && read != nullptr;
  make_current(is_whole ? context->second.get() : nullptr, is_whole ? draw : nullptr, is_whole ? read : nullptr);
}

Drawable* Replay::surface(std::int64_t id) {
  const auto known = contents_.surfaces.find(id);
  if (known == contents_.surfaces.end()) return nullptr;
  std::unique_ptr<Drawable>& place = surfaces_[id];
  if (place == nullptr) {
    place = std::make_unique<Drawable>(options_, std::max(1, known->second.width), std::max(1, known->second.height));
  }
  return place.get();
}

void Replay::end_frame(std::int64_t id) {
  Drawable* drawable = surface(id);
  if (drawable == nullptr) return;
  drawable->draw_to(false);
  hooks_.frame(frame_++, drawable->frame);
  drawable->swap();
  if (Context* const context = current(); context != nullptr) follow_draw_buffer(*context);
}

void Replay::command(const TraceCall& call) {
  if (call.thread != thread_) {
    thread_ = call.thread;
    bind(bindings_[thread_]);
  }
  Context* context = current();
  if (context == nullptr) return;
  // Names are made by their first use as OpenGL 1.5 allows, so that they are the recorded ones. Other questions change nothing.
  if (begins_with_one_of(call.function(), {"glGen", "glGet", "glIs", "glReadPixels", "glAreTexturesResident",
                                           "glLockArrays", "glUnlockArrays"}) &&
      !call.function().starts_with("glGenerate"))
    return;
  try {
    if (!carry_out(call, *context))
      warn_once(call.function(), "is no command of OpenGL 1.5, or its memory is not in the trace; left out");
  } catch (const std::exception& error) {
    warn_once(call.function(), std::string("failed: ") + error.what());
  }
}

bool Replay::carry_out(const TraceCall& call, Context& context) {
  const std::string_view name = core_name(call.function());
  if (name.starts_with("glMultiDraw")) return multi_draw(call, context);
  if (is_one_of(name, {"glMapBuffer", "glUnmapBuffer"})) return map(call, context);
  const auto integer = [&](auto... names) { return call.argument(names...).integer; };
  if (name == "glDrawArrays") return draw_arrays(call, context, integer("first"), integer("count"));
  if (name.ends_with("Elements")) return draw_elements(call, context, integer("count"), call.argument("indices"));
  const auto entry = entry_points().find(call.function());
  if (entry == entry_points().end()) return false;
  if (name == "glArrayElement" && !arrays_hold(context, integer("i"))) return false;

  const double bytes = reach(call, context);
  if (bytes > kFarthestReach) return false;
  if (is_one_of(name, {"glSelectBuffer", "glFeedbackBuffer"})) {
    auto& memory = kept_[{&context, std::string(name), 0}];
    memory.clear();
    void* at = memory.emplace_back(static_cast<std::size_t>(bytes)).data();
    const auto size = static_cast<GLsizei>(integer("size"));
    if (name == "glSelectBuffer")
      select_buffer(context, size, static_cast<GLuint*>(at));
    else
      feedback_buffer(context, size, static_cast<GLenum>(integer("type")), static_cast<GLfloat*>(at));
    return true;
  }
  const bool is_pointer = name.ends_with("Pointer") || name == "glInterleavedArrays";
  const bool is_optional = is_pointer || name.starts_with("glTexImage") || name == "glBufferData";
  const Addresses addresses = is_pointer && context.client.array_buffer != 0 ? Addresses::offsets
                              : is_optional                                  ? Addresses::null
                                                                             : Addresses::none;
  HeldMemory held;
  if (!call_entry(entry->second, call.arguments, static_cast<std::size_t>(bytes), addresses, held)) return false;
  if (is_pointer) kept_[{&context, std::string(name), context.client.active_texture}] = std::move(held);
  return true;
}

double Replay::reach(const TraceCall& call, const Context& context) {
  const auto points_at_memory = [](const TraceValue& value) {
    return value.kind == TraceValue::Kind::bytes || value.kind == TraceValue::Kind::array;
  };
  if (std::none_of(call.arguments.begin(), call.arguments.end(), points_at_memory) &&
      call.argument("buffer").kind == TraceValue::Kind::null)
    return 0;
  const auto number = [&](auto... names) { return std::max(0.0, call.argument(names...).real); };
  const bool is_stipple = call.function() == "glPolygonStipple";
  double bytes = 256;  // sixteen doubles and more
  if (const double width = is_stipple ? 32 : number("width"); width > 0) {
    const PixelStore& store = context.client.unpack;
    const double row = std::max<double>(width, store.row_length) + store.skip_pixels + 16;
    const double rows = std::max(std::max<double>(is_stipple ? 32 : 1, number("height")), double(store.image_height));
    bytes += 16 * row * (rows + store.skip_rows) * (std::max(1.0, number("depth")) + store.skip_images);
  }
  bytes += 8 * number("stride") * number("order");
  bytes += 8 * (number("ustride") * number("uorder") + number("vstride") * number("vorder"));
  bytes += 8 * (number("n") + number("count") + number("mapsize"));
  bytes += call.function().ends_with("Buffer") ? 4 * number("size") : number("size");
  return bytes;
}

std::optional<Replay::Bytes> Replay::memory_of(const Context& context, const ArrayPointer& array) const {
  if (array.buffer != 0) {
    const auto found = context.shared->buffers.find(array.buffer);
    if (found == context.shared->buffers.end() || found->second == nullptr) return std::nullopt;
    const std::vector<std::byte>& data = found->second->data;
    const auto offset = reinterpret_cast<std::uintptr_t>(array.pointer);
    if (offset > data.size()) return std::nullopt;
    return Bytes(data).subspan(offset);
  }
  const auto* at = static_cast<const std::byte*>(array.pointer);
  for (const auto& [key, blocks] : kept_)
    for (const std::vector<std::byte>& block : blocks)
      if (std::less_equal<>()(block.data(), at) && std::less<>()(at, block.data() + block.size()))
        return Bytes(at, block.data() + block.size());
  return std::nullopt;
}

bool Replay::arrays_hold(const Context& context, std::int64_t index) const {
  return index >= 0 && std::ranges::all_of(context.client.array, [&](const ArrayPointer& array) {
           if (!array.enabled) return true;
           const std::uint64_t bytes = static_cast<std::uint64_t>(array.size) * array_type_bytes(array.type);
           const std::uint64_t stride = array.stride != 0 ? static_cast<std::uint64_t>(array.stride) : bytes;
           const auto memory = memory_of(context, array);
           return memory && static_cast<std::uint64_t>(index) * stride + bytes <= memory->size();
         });
}

bool Replay::draw_arrays(const TraceCall& call, Context& context, std::int64_t first, std::int64_t count) const {
  if (first < 0 || count < 0 || (count > 0 && !arrays_hold(context, first + count - 1))) return false;
  gl::draw_arrays(context, static_cast<GLenum>(call.argument("mode").integer), static_cast<GLint>(first),
                  static_cast<GLsizei>(count));
  return true;
}

bool Replay::draw_elements(const TraceCall& call, Context& context, std::int64_t count,
                           const TraceValue& indices) const {
  const auto argument = [&](const char* name) { return static_cast<GLuint>(call.argument(name).integer); };
  const GLenum type = argument("type");
  if (count < 0 || (type != GL_UNSIGNED_BYTE && type != GL_UNSIGNED_SHORT && type != GL_UNSIGNED_INT)) return false;
  ArrayPointer array{.pointer = reinterpret_cast<const void*>(indices.integer),
                     .buffer = context.client.element_buffer};
  std::optional<Bytes> bytes = std::as_bytes(std::span(indices.bytes));
  if (array.buffer != 0)
    bytes = memory_of(context, array);
  else
    array.pointer = indices.bytes.data();
  const std::uint64_t size = array_type_bytes(type);
  if (!bytes || bytes->size() < static_cast<std::uint64_t>(count) * size) return false;
  std::uint32_t largest = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    std::uint32_t index = 0;  // little-endian
    std::memcpy(&index, bytes->data() + i * size, size);
    largest = std::max(largest, index);
  }
  if (!arrays_hold(context, largest)) return false;
  const auto size_of_draw = static_cast<GLsizei>(count);
  if (core_name(call.function()) == "glDrawRangeElements")
    draw_range_elements(context, argument("mode"), argument("start"), argument("end"), size_of_draw, type,
                        array.pointer);
  else
    gl::draw_elements(context, argument("mode"), size_of_draw, type, array.pointer);
  return true;
}

bool Replay::multi_draw(const TraceCall& call, Context& context) const {
  // Equal to as many single draws (OpenGL 1.5, 2.8).
  const bool is_elements = core_name(call.function()) == "glMultiDrawElements";
  const std::vector<TraceValue>& counts = call.argument("count").items;
  const std::vector<TraceValue>& places = call.argument(is_elements ? "indices" : "first").items;
  bool is_done = counts.size() == places.size();
  for (std::size_t i = 0; is_done && i < counts.size(); ++i)
    is_done = is_elements ? draw_elements(call, context, counts[i].integer, places[i])
                          : draw_arrays(call, context, places[i].integer, counts[i].integer);
  return is_done;
}

bool Replay::map(const TraceCall& call, Context& context) {
  const auto target = static_cast<GLenum>(call.argument("target").integer);
  if (core_name(call.function()) == "glUnmapBuffer") {
    unmap_buffer(context, target);
    return true;
  }
  map_buffer(context, target, static_cast<GLenum>(call.argument("access").integer));
  const bool is_element = target == GL_ELEMENT_ARRAY_BUFFER;
  mapped_[call.result.integer] = {context.shared,
                                  is_element ? context.client.element_buffer : context.client.array_buffer};
  return true;
}

void Replay::copy_to_map(const TraceCall& call) {
  // apitrace records a program's stores into a mapped buffer as one copy.
  const std::int64_t to = call.argument("dest").integer;
  const std::string& from = call.argument("src").bytes;
  auto mapping = mapped_.upper_bound(to);
  if (mapping == mapped_.begin()) return;
  --mapping;
  const auto shared = mapping->second.shared.lock();
  if (shared == nullptr) return;
  const auto buffer = shared->buffers.find(mapping->second.buffer);
  if (buffer == shared->buffers.end() || buffer->second == nullptr) return;
  std::vector<std::byte>& data = buffer->second->data;
  const auto offset = static_cast<std::uint64_t>(to - mapping->first);
  if (offset <= data.size() && from.size() <= data.size() - offset)
    std::memcpy(data.data() + offset, from.data(), from.size());
}

}  // namespace

TraceContents survey(const std::string& path) {
  TraceFile file(path);
  Survey survey;
  try {
    for (TraceCall call; file.next(call);) survey.take(call);
  } catch (const InputError& error) {
    survey.contents.damage = error.what();
  }
  TraceContents contents = std::move(survey.contents);
  if (contents.frames > 0) return contents;
  for (const auto& [id, surface] : contents.surfaces) {
    if (surface.width == 0 || surface.height == 0) continue;
    contents.unswapped = id;
    contents.frames = 1;
    return contents;
  }
  throw InputError(contents.damage.empty() ? path + ": nothing is drawn in this trace" : contents.damage);
}

void replay(const std::string& path, const TraceContents& contents, const Options& options, int frames,
            const ReplayHooks& hooks) {
  if (frames <= 0) return;
  TraceFile file(path);
  Replay replay(contents, options, frames, hooks);
  for (TraceCall call; file.next(call);)
    if (!replay.take(call)) return;
  replay.finish();
}

}  // namespace halfplane::gl
