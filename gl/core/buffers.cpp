// Buffer objects and occlusion queries (OpenGL 1.5, 2.9, 4.1.7).
#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "commands.hpp"
#include "context.hpp"
#include "matrix.hpp"

namespace halfplane::gl {
namespace {

/// The binding of a target; null and GL_INVALID_ENUM for an unknown target.
GLuint* binding_of(Context& context, GLenum target) {
  if (target == GL_ARRAY_BUFFER) return &context.client.array_buffer;
  if (target == GL_ELEMENT_ARRAY_BUFFER) return &context.client.element_buffer;
  return context.fail(GL_INVALID_ENUM), nullptr;
}

/// The buffer that is bound to a target; null and an error where there is none.
std::shared_ptr<BufferObject> bound_buffer(Context& context, GLenum target) {
  const GLuint* const binding = binding_of(context, target);
  if (binding == nullptr) return nullptr;
  auto buffer = *binding == 0 ? nullptr : context.shared->buffer(*binding);
  if (buffer == nullptr) context.fail(GL_INVALID_OPERATION);
  return buffer;
}

/// The part of a buffer that a command names; null and an error where it may not.
std::byte* part_of(Context& context, GLenum target, GLintptr offset, GLsizeiptr size) {
  const auto buffer = bound_buffer(context, target);
  if (buffer == nullptr) return nullptr;
  const auto bytes = static_cast<GLsizeiptr>(buffer->data.size());
  const GLenum error = offset < 0 || size < 0 || offset > bytes || size > bytes - offset ? GL_INVALID_VALUE
                       : buffer->mapped                                                  ? GL_INVALID_OPERATION
                                                                                         : GL_NO_ERROR;
  if (error != GL_NO_ERROR) return context.fail(error), nullptr;
  return buffer->data.data() + offset;
}

std::uint64_t samples_passed(const Context& context) {
  return context.drawable == nullptr ? 0 : context.drawable->frame.samples_passed();
}

}  // namespace

void bind_buffer(Context& context, GLenum target, GLuint name) {
  GLuint* const binding = binding_of(context, target);
  if (binding == nullptr) return;
  *binding = name;
  if (name == 0) return;
  const std::lock_guard lock(context.shared->mutex);
  auto& buffer = context.shared->buffers[name];
  if (buffer == nullptr) buffer = std::make_shared<BufferObject>();
}

void delete_buffers(Context& context, GLsizei n, const GLuint* names) {
  if (n < 0) return context.fail(GL_INVALID_VALUE);
  ClientState& client = context.client;
  const std::lock_guard lock(context.shared->mutex);
  for (GLsizei i = 0; i < n; ++i) {
    if (names[i] == 0 || context.shared->buffers.erase(names[i]) == 0) continue;
    const auto unbind = [&](GLuint& binding) {
      if (binding == names[i]) binding = 0;
    };
    unbind(client.array_buffer), unbind(client.element_buffer);
    for (ArrayPointer& array : client.array)
      if (array.buffer == names[i]) array.buffer = 0, array.pointer = nullptr;
  }
}

void gen_buffers(Context& context, GLsizei n, GLuint* names) {
  const std::lock_guard lock(context.shared->mutex);
  generate(context, context.shared->buffers, n, names);
}

GLboolean is_buffer(Context& context, GLuint name) {
  return context.shared->buffer(name) != nullptr ? GL_TRUE : GL_FALSE;
}

void buffer_data(Context& context, GLenum target, GLsizeiptr size, const void* data, GLenum usage) {
  // Streamed, static and dynamic: for drawing, reading and copying each.
  const bool is_usage = usage >= GL_STREAM_DRAW && usage <= GL_DYNAMIC_COPY && usage % 4 != 3;
  if (binding_of(context, target) == nullptr) return;
  if (!is_usage) return context.fail(GL_INVALID_ENUM);
  if (size < 0) return context.fail(GL_INVALID_VALUE);
  const auto buffer = bound_buffer(context, target);
  if (buffer == nullptr) return;
  try {
    const auto* const bytes = static_cast<const std::byte*>(data);
    if (data != nullptr)
      buffer->data.assign(bytes, bytes + size);
    else
      buffer->data.assign(static_cast<std::size_t>(size), std::byte{});
  } catch (const std::exception&) {  // too long, or no memory
    buffer->data.clear();
    return context.fail(GL_OUT_OF_MEMORY);
  }
  buffer->usage = usage;
  buffer->access = GL_READ_WRITE;
  buffer->mapped = false;
}

void buffer_sub_data(Context& context, GLenum target, GLintptr offset, GLsizeiptr size, const void* data) {
  std::byte* const part = part_of(context, target, offset, size);
  if (part != nullptr && size > 0) std::memcpy(part, data, static_cast<std::size_t>(size));
}

void get_buffer_sub_data(Context& context, GLenum target, GLintptr offset, GLsizeiptr size, void* data) {
  const std::byte* const part = part_of(context, target, offset, size);
  if (part != nullptr && size > 0) std::memcpy(data, part, static_cast<std::size_t>(size));
}

void* map_buffer(Context& context, GLenum target, GLenum access) {
  GLenum checked = 0;
  if (binding_of(context, target) == nullptr) return nullptr;
  set_enum(context, checked, access, {GL_READ_ONLY, GL_WRITE_ONLY, GL_READ_WRITE});
  if (checked == 0) return nullptr;
  const auto buffer = bound_buffer(context, target);
  if (buffer == nullptr) return nullptr;
  if (buffer->mapped) return context.fail(GL_INVALID_OPERATION), nullptr;
  buffer->data.reserve(1);  // null says that it could not be mapped
  buffer->access = access;
  buffer->mapped = true;
  return buffer->data.data();
}

GLboolean unmap_buffer(Context& context, GLenum target) {
  const auto buffer = bound_buffer(context, target);
  if (buffer == nullptr) return GL_FALSE;
  if (!buffer->mapped) return context.fail(GL_INVALID_OPERATION), GL_FALSE;
  buffer->mapped = false;
  return GL_TRUE;
}

void get_buffer_parameter(Context& context, GLenum target, GLenum pname, GLint* params) {
  if (binding_of(context, target) == nullptr) return;
  GLenum checked = 0;
  set_enum(context, checked, pname, {GL_BUFFER_SIZE, GL_BUFFER_USAGE, GL_BUFFER_ACCESS, GL_BUFFER_MAPPED});
  if (checked == 0) return;
  const auto buffer = bound_buffer(context, target);
  if (buffer == nullptr) return;
  switch (pname) {
    case GL_BUFFER_SIZE:
      *params = static_cast<GLint>(std::min<std::size_t>(buffer->data.size(), std::numeric_limits<GLint>::max()));
      return;
    case GL_BUFFER_USAGE: *params = static_cast<GLint>(buffer->usage); return;
    case GL_BUFFER_ACCESS: *params = static_cast<GLint>(buffer->access); return;
    default: *params = buffer->mapped ? GL_TRUE : GL_FALSE;
  }
}

void get_buffer_pointer(Context& context, GLenum target, GLenum pname, void** params) {
  if (binding_of(context, target) == nullptr) return;
  if (pname != GL_BUFFER_MAP_POINTER) return context.fail(GL_INVALID_ENUM);
  const auto buffer = bound_buffer(context, target);
  if (buffer != nullptr) *params = buffer->mapped ? buffer->data.data() : nullptr;
}

void gen_queries(Context& context, GLsizei n, GLuint* names) { generate(context, context.queries, n, names); }

void delete_queries(Context& context, GLsizei n, const GLuint* names) {
  if (n < 0) return context.fail(GL_INVALID_VALUE);
  for (GLsizei i = 0; i < n; ++i) {
    if (names[i] == context.active_query) context.active_query = 0;
    context.queries.erase(names[i]);
  }
}

GLboolean is_query(Context& context, GLuint name) {
  const auto found = context.queries.find(name);
  return found != context.queries.end() && found->second.exists ? GL_TRUE : GL_FALSE;
}

void begin_query(Context& context, GLenum target, GLuint name) {
  if (target != GL_SAMPLES_PASSED) return context.fail(GL_INVALID_ENUM);
  if (name == 0 || context.active_query != 0) return context.fail(GL_INVALID_OPERATION);
  context.queries[name] = {.exists = true, .active = true, .begun_at = samples_passed(context)};
  context.active_query = name;
}

void end_query(Context& context, GLenum target) {
  if (target != GL_SAMPLES_PASSED) return context.fail(GL_INVALID_ENUM);
  if (context.active_query == 0) return context.fail(GL_INVALID_OPERATION);
  Query& query = context.queries[std::exchange(context.active_query, 0)];
  // Another drawable may have been made current, with fewer samples.
  const std::uint64_t now = samples_passed(context);
  query.samples = now > query.begun_at ? now - query.begun_at : 0;
  query.active = false;
}

void get_query(Context& context, GLenum target, GLenum pname, GLint* params) {
  if (target != GL_SAMPLES_PASSED) return context.fail(GL_INVALID_ENUM);
  if (pname == GL_CURRENT_QUERY)
    *params = static_cast<GLint>(context.active_query);
  else if (pname == GL_QUERY_COUNTER_BITS)
    *params = std::numeric_limits<GLuint>::digits;
  else
    context.fail(GL_INVALID_ENUM);
}

void get_query_object(Context& context, GLuint name, GLenum pname, GLint* params) {
  const auto found = context.queries.find(name);
  if (found == context.queries.end() || !found->second.exists || found->second.active)
    return context.fail(GL_INVALID_OPERATION);
  if (pname == GL_QUERY_RESULT)
    *params = static_cast<GLint>(
        static_cast<GLuint>(std::min<std::uint64_t>(found->second.samples, std::numeric_limits<GLuint>::max())));
  else if (pname == GL_QUERY_RESULT_AVAILABLE)
    *params = GL_TRUE;
  else
    context.fail(GL_INVALID_ENUM);
}

}  // namespace halfplane::gl
