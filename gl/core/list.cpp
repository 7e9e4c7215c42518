#include "list.hpp"

#include <algorithm>
#include <cmath>

#include "arrays.hpp"
#include "entry_conversions.hpp"
#include "primitive.hpp"
#include "shading.hpp"

namespace halfplane::gl {

void* DisplayList::add(Play call, std::size_t bytes, CallKind kind) {
  const std::size_t padded = (bytes + kAlignment - 1) / kAlignment * kAlignment, at = calls_.size();
  calls_.resize(at + sizeof(Header) + padded);
  new (&calls_[at]) Header{call, static_cast<std::uint32_t>(padded), kind};
  return calls_.data() + at + sizeof(Header);
}

void DisplayList::add_vertices(GLenum mode, const InputVertices& vertices, std::span<const std::uint32_t> indices) {
  new (add(nullptr, sizeof(JoinedCall), CallKind::joined)) JoinedCall{joined_.size(), 0};
  joined_.push_back({mode, vertices, {indices.begin(), indices.end()}});
}

void DisplayList::play(Context& context) const {
  auto owned = owned_.begin();
  for (std::size_t at = 0; at < calls_.size();) {
    const Header& call = header(at);
    const void* const arguments = calls_.data() + at + sizeof(Header);
    at = after(at);
    if (call.kind == CallKind::joined) {
      if (context.inside_begin()) continue;
      const JoinedCall& joined = *static_cast<const JoinedCall*>(arguments);
      const auto& [mode, vertices, indices] = joined_[joined.which];
      draw_joined(context, mode, vertices, indices);
      at += joined.bytes;
    } else if (call.play != nullptr) {
      call.play(context, arguments);
    } else {
      (*owned++)(context);
    }
  }
}

std::optional<std::size_t> DisplayList::end_of_vertices(std::size_t at, Context& collector) const {
  collector.primitive = Context::kNoPrimitive;
  collector.error = GL_NO_ERROR;
  for (; at < calls_.size(); at = after(at)) {
    const CallKind kind = header(at).kind;
    if (kind == CallKind::other || kind == CallKind::joined) return std::nullopt;
    if (kind == CallKind::end) break;
    header(at).play(collector, calls_.data() + at + sizeof(Header));
  }
  const bool is_whole = at < calls_.size() && collector.error == GL_NO_ERROR && collector.input.is_complete();
  return is_whole ? std::optional(after(at)) : std::nullopt;
}

void DisplayList::join_vertices() {
  DisplayList joined;
  std::optional<Context> collector;  // for most lists none: it is large
  std::size_t copied = 0;
  const auto copy_to = [&](std::size_t end) {
    const auto at = [&](std::size_t place) { return calls_.begin() + static_cast<std::ptrdiff_t>(place); };
    joined.calls_.insert(joined.calls_.end(), at(copied), at(end));
    copied = end;
  };
  for (std::size_t at = 0; at < calls_.size();) {
    const bool begins = header(at).kind == CallKind::begin;
    if (begins && !collector) collector.emplace();
    const auto end = begins ? end_of_vertices(at, *collector) : std::nullopt;
    if (end) {
      copy_to(at);
      new (joined.add(nullptr, sizeof(JoinedCall), CallKind::joined)) JoinedCall{joined_.size(), *end - at};
      const auto all = counting(collector->input.size());
      joined_.push_back({collector->primitive, collector->input, {all.begin(), all.end()}});
    }
    at = end ? *end : after(at);
  }
  copy_to(calls_.size());
  calls_ = std::move(joined.calls_);
}

void new_list(Context& context, GLuint name, GLenum mode) {
  if (name == 0) return context.fail(GL_INVALID_VALUE);
  if (mode != GL_COMPILE && mode != GL_COMPILE_AND_EXECUTE) return context.fail(GL_INVALID_ENUM);
  if (context.compiling != nullptr) return context.fail(GL_INVALID_OPERATION);
  context.compiling = std::make_shared<DisplayList>();
  context.compiling_name = name;
  context.compiles_and_executes = mode == GL_COMPILE_AND_EXECUTE;
}

void end_list(Context& context) {
  if (context.compiling == nullptr) return context.fail(GL_INVALID_OPERATION);
  context.compiling->join_vertices();
  const std::lock_guard lock(context.shared->mutex);
  context.shared->lists[context.compiling_name] = std::exchange(context.compiling, nullptr);
}

// The list is kept while it runs, whatever becomes of its name.
void call_list(Context& context, GLuint name) {
  if (context.list_depth >= kListNesting) return;
  std::shared_ptr<const DisplayList> list;
  {
    const std::lock_guard lock(context.shared->mutex);
    const auto found = context.shared->lists.find(name);
    if (found == context.shared->lists.end()) return;
    list = found->second;
  }
  struct Depth {
    int& depth;
    explicit Depth(int& of) : depth(of) { ++depth; }
    ~Depth() { --depth; }
  } const depth(context.list_depth);
  list->play(context);
}

void call_lists(Context& context, std::shared_ptr<const std::vector<GLuint>> offsets) {
  const GLuint base = context.state.list.base;
  for (const GLuint offset : *offsets) call_list(context, base + offset);
}

void list_base(Context& context, GLuint base) { context.state.list.base = base; }

GLuint gen_lists(Context& context, GLsizei range) {
  if (range < 0) return context.fail(GL_INVALID_VALUE), 0;
  if (range == 0) return 0;
  const std::lock_guard lock(context.shared->mutex);
  auto& lists = context.shared->lists;
  // Names after the largest one, or else in the first gap.
  const auto count = static_cast<GLuint>(range);
  const GLuint largest =
      std::max(lists.empty() ? 0 : lists.rbegin()->first, context.compiling != nullptr ? context.compiling_name : 0);
  GLuint first = largest + 1;
  if (~GLuint{0} - largest < count) {
    first = 1;
    for (const auto& [name, list] : lists) {
      if (name - first >= count && !(context.compiling_name - first < count)) break;
      first = name + 1;
    }
    if (first == 0 || ~GLuint{0} - first < count - 1) return 0;
  }
  for (GLuint i = 0; i < count; ++i) lists.emplace_hint(lists.end(), first + i, std::make_shared<DisplayList>());
  return first;
}

void delete_lists(Context& context, GLuint name, GLsizei range) {
  if (range < 0) return context.fail(GL_INVALID_VALUE);
  const std::lock_guard lock(context.shared->mutex);
  auto& lists = context.shared->lists;
  const std::uint64_t end = std::uint64_t{name} + static_cast<std::uint64_t>(range);
  auto last = lists.lower_bound(name);
  while (last != lists.end() && last->first < end) last = lists.erase(last);
}

GLboolean is_list(Context& context, GLuint name) {
  const std::lock_guard lock(context.shared->mutex);
  return context.shared->lists.contains(name);
}

std::shared_ptr<const std::vector<GLuint>> list_names(Context& context, GLsizei n, GLenum type, const void* lists) {
  if (type < GL_BYTE || type > GL_4_BYTES) return list_error(context, GL_INVALID_ENUM), nullptr;
  if (n < 0) return list_error(context, GL_INVALID_VALUE), nullptr;
  const bool is_bytes = type >= GL_2_BYTES;  // and so on: the first byte is the highest
  const std::size_t size = is_bytes ? type - GL_2_BYTES + 2 : array_type_bytes(type);
  auto names = std::make_shared<std::vector<GLuint>>();
  const auto* at = static_cast<const std::byte*>(lists);
  for (GLsizei i = 0; i < n; ++i, at += size) {
    GLuint& name = names->emplace_back(0);
    if (is_bytes)
      for (std::size_t b = 0; b < size; ++b) name = name << 8 | std::to_integer<GLuint>(at[b]);
    else
      name = converted<GLuint>(std::trunc(array_number(type, at)), ValueKind::integer);
  }
  return names;
}

}  // namespace halfplane::gl
