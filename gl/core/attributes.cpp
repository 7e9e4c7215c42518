// glPushAttrib and glPushClientAttrib (OpenGL 1.5, 6.1.14).
#include <array>
#include <mutex>

#include "commands.hpp"

namespace halfplane::gl {
namespace {

template <auto Member>
void copy(State& to, const State& from) {
  to.*Member = from.*Member;
}

struct Group {
  GLbitfield bit;
  void (*copy)(State& to, const State& from);
};
constexpr std::array<Group, 20> kGroups{{{GL_CURRENT_BIT, copy<&State::current>},
                                         {GL_POINT_BIT, copy<&State::point>},
                                         {GL_LINE_BIT, copy<&State::line>},
                                         {GL_POLYGON_BIT, copy<&State::polygon>},
                                         {GL_POLYGON_STIPPLE_BIT, copy<&State::stipple>},
                                         {GL_LIGHTING_BIT, copy<&State::lighting>},
                                         {GL_FOG_BIT, copy<&State::fog>},
                                         {GL_DEPTH_BUFFER_BIT, copy<&State::depth>},
                                         {GL_STENCIL_BUFFER_BIT, copy<&State::stencil>},
                                         {GL_VIEWPORT_BIT, copy<&State::viewport>},
                                         {GL_SCISSOR_BIT, copy<&State::scissor>},
                                         {GL_TRANSFORM_BIT, copy<&State::transform>},
                                         {GL_COLOR_BUFFER_BIT, copy<&State::color>},
                                         {GL_ACCUM_BUFFER_BIT, copy<&State::accum>},
                                         {GL_HINT_BIT, copy<&State::hint>},
                                         {GL_MULTISAMPLE_BIT, copy<&State::multisample>},
                                         {GL_EVAL_BIT, copy<&State::eval>},
                                         {GL_LIST_BIT, copy<&State::list>},
                                         {GL_PIXEL_MODE_BIT, copy<&State::pixel>},
                                         {GL_TEXTURE_BIT, copy<&State::texture>}}};

// Calls `visit` with each texture that a unit has bound. A name whose texture was deleted is unbound.
template <class Visit>
void visit_bound_textures(Context& context, const Visit& visit) {
  const std::lock_guard lock(context.shared->mutex);
  for (std::size_t u = 0; u < kTextureUnits; ++u)
    for (std::size_t i = 0; i < kTextureTargets.size(); ++i) {
      GLuint& name = context.state.texture.unit[u].bound[i];
      std::shared_ptr<TextureObject>& texture = context.bound_textures[u][i];
      if (texture == nullptr || texture->name != name) {
        const auto found = context.shared->textures.find(name);
        texture = found == context.shared->textures.end() ? nullptr : found->second;
      }
      if (texture == nullptr || texture->target != kTextureTargets[i]) name = 0;
      visit(name == 0 ? context.default_textures[i] : *texture);
    }
}

}  // namespace

void push_attrib(Context& context, GLbitfield mask) {
  if (context.attributes.size() >= kAttribDepth) return context.fail(GL_STACK_OVERFLOW);
  SavedAttributes& saved = context.attributes.emplace_back(SavedAttributes{mask, context.state, {}});
  if ((mask & GL_TEXTURE_BIT) != 0)
    visit_bound_textures(context, [&](const TextureParameters& texture) { saved.textures.push_back(texture); });
}

void pop_attrib(Context& context) {
  if (context.attributes.empty()) return context.fail(GL_STACK_UNDERFLOW);
  const SavedAttributes saved = std::move(context.attributes.back());
  context.attributes.pop_back();
  for (const Group& group : kGroups)
    if ((saved.mask & group.bit) != 0) group.copy(context.state, saved.state);
  if ((saved.mask & GL_ENABLE_BIT) != 0) copy_enables(context.state, saved.state);
  if ((saved.mask & GL_COLOR_BUFFER_BIT) != 0) follow_draw_buffer(context);
  track_color(context);  // current colour and the material that follows it may differ now
  if ((saved.mask & GL_TEXTURE_BIT) == 0) return;
  auto parameters = saved.textures.begin();
  const auto bound = saved.state.texture.unit;
  std::size_t i = 0;
  visit_bound_textures(context, [&](TextureObject& texture) {
    const GLuint name = bound[i / kTextureTargets.size()].bound[i % kTextureTargets.size()];
    if (texture.name == name) static_cast<TextureParameters&>(texture) = *parameters;
    ++parameters;
    ++i;
  });
}

void push_client_attrib(Context& context, GLbitfield mask) {
  if (context.client_attributes.size() >= kAttribDepth) return context.fail(GL_STACK_OVERFLOW);
  context.client_attributes.emplace_back(mask, context.client);
}

void pop_client_attrib(Context& context) {
  if (context.client_attributes.empty()) return context.fail(GL_STACK_UNDERFLOW);
  auto [mask, saved] = context.client_attributes.back();
  context.client_attributes.pop_back();
  ClientState& client = context.client;
  const PixelStore pack = client.pack, unpack = client.unpack;
  const bool keeps_pixels = (mask & GL_CLIENT_PIXEL_STORE_BIT) == 0;
  if ((mask & GL_CLIENT_VERTEX_ARRAY_BIT) != 0) client = saved;
  client.pack = keeps_pixels ? pack : saved.pack;
  client.unpack = keeps_pixels ? unpack : saved.unpack;
}

}  // namespace halfplane::gl
