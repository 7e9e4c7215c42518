// Targets of the C interface: halfplane::Target, with textures by name and a state that lines of a capture say.
#include <algorithm>
#include <numeric>

#include "handles.hpp"
#include "input.hpp"
#include "model/engines/target.hpp"

using namespace halfplane;
using namespace halfplane::capi;

struct halfplane_target {
  Target target;
  Scene empty;                       ///< size and planes; its textures are a texel each, for their names
  State state{};                     ///< of the next draw
  CounterNames counters{named({})};  ///< of the last call that drew
};

namespace {

constexpr const char* kWhat = "the target";

Scene empty_scene(int width, int height, const double* planes) {
  Scene scene;
  scene.name = "target";
  scene.width = width;
  scene.height = height;
  if (planes != nullptr) scene.planes = {planes[0], planes[1]};
  validate(scene);
  return scene;
}

/// Adds a texture, or puts it in the place of the one of its name.
void keep_texture(halfplane_target& made, Texture texture) {
  Texture name{texture.name, TextureFormat::l8, Mips::none, {}, {{1, 1, {0}}}};
  const auto found = std::ranges::find(made.empty.textures, texture.name, &Texture::name);
  if (found != made.empty.textures.end()) {
    made.target.replace_texture(static_cast<std::uint32_t>(found - made.empty.textures.begin()), std::move(texture));
    return;
  }
  made.empty.textures.reserve(made.empty.textures.size() + 1);  // after the next line nothing may fail
  (void)made.target.add_texture(std::move(texture));
  made.empty.textures.push_back(std::move(name));
}

void say(halfplane_target& made, std::string_view lines) {
  Said said = read_lines(made.empty.width, made.empty.height, made.empty.textures, lines);
  if (said.scene.planes && said.scene.planes != made.empty.planes)
    throw InputError("lines: the planes of the target are given by halfplane_target_new");
  for (std::size_t i = made.empty.textures.size(); i < said.scene.textures.size(); ++i)
    keep_texture(made, std::move(said.scene.textures[i]));
  for (const Command& command : said.scene.commands)
    if (const auto* clear = std::get_if<Clear>(&command)) made.target.clear(*clear, said.scene.states[clear->state]);
  made.state = said.state;
}

void draw(halfplane_target& made, Topology topology, const Vertices& given, const std::uint32_t* indices,
          std::size_t count) {
  std::vector<std::uint32_t> in_order;
  if (indices == nullptr) {
    in_order.resize(given.vertices.size());
    std::iota(in_order.begin(), in_order.end(), 0U);
  }
  const std::span<const std::uint32_t> used =
      indices == nullptr ? std::span<const std::uint32_t>(in_order) : std::span(indices, count);
  check_indices(used, given.vertices.size(), "draw");
  made.counters = named(made.target.draw(made.state, topology, given.vertices, used, given.normals));
}

}  // namespace

extern "C" {

halfplane_target* halfplane_target_new(const halfplane_config* config, int width, int height, const double* planes) {
  return guarded(nullptr, [&] {
    Scene empty = empty_scene(width, height, planes);
    Target target(required(config, "the configuration").config, width, height, empty.planes);
    return new halfplane_target{std::move(target), std::move(empty)};
  });
}
int halfplane_target_set_threads(halfplane_target* target, int threads) {
  return guarded(-1, [&] {
    required(target, kWhat).target.set_threads(threads);
    return 0;
  });
}
int halfplane_target_say(halfplane_target* target, const char* lines, size_t bytes) {
  return guarded(-1, [&] {
    say(required(target, kWhat), std::string_view(&required(lines, "the text"), bytes));
    return 0;
  });
}
int halfplane_target_texture(halfplane_target* target, const char* name, int width, int height, const uint8_t* rgba,
                             const char* format, const char* mips) {
  return guarded(-1, [&] {
    keep_texture(required(target, kWhat), read_texture(text(name, "the texture's name"), width, height, rgba,
                                                       text(format, "the format"), text(mips, "the kind of mips")));
    return 0;
  });
}
int halfplane_target_clear(halfplane_target* target, const double* color, const double* depth, int stencil) {
  return guarded(-1, [&] {
    halfplane_target& made = required(target, kWhat);
    if (stencil < -1 || stencil > 255)
      throw InputError("a stencil of " + std::to_string(stencil) + "; give 0 to 255, or -1 to leave it");
    Clear clear;
    if (color != nullptr) std::copy_n(color, 4, clear.color.emplace().begin());
    if (depth != nullptr) clear.depth = *depth;
    if (stencil >= 0) clear.stencil = static_cast<std::uint8_t>(stencil);
    made.target.clear(clear, made.state);
    return 0;
  });
}
int halfplane_target_draw(halfplane_target* target, const char* topology, const halfplane_layout* layout,
                          const void* data, size_t bytes, size_t vertices, const uint32_t* indices, size_t count) {
  return guarded(-1, [&] {
    draw(required(target, kWhat), topology_of(text(topology, "the topology")),
         read_vertices(required(layout, "the layout"), data, bytes, vertices), indices, count);
    return 0;
  });
}
int halfplane_target_draw_scene(halfplane_target* target, const halfplane_scene* scene) {
  return guarded(-1, [&] {
    halfplane_target& made = required(target, kWhat);
    made.counters = named(made.target.draw(required(scene, "the scene").scene));
    return 0;
  });
}
int64_t halfplane_target_plane(const halfplane_target* target, const char* plane, uint32_t* values, size_t count) {
  return guarded(std::int64_t{-1}, [&] {
    return copy_plane(required(target, kWhat).target.frame(), text(plane, "the plane"),
                      &required(values, "the room for the values"), count);
  });
}
int64_t halfplane_target_counter(const halfplane_target* target, const char* name) {
  return guarded(std::int64_t{-1},
                 [&] { return counter(required(target, kWhat).counters, text(name, "the counter")); });
}
int halfplane_target_copy_to(const halfplane_target* target, void* color, size_t color_pitch, uint32_t* depth,
                             size_t depth_pitch) {
  return guarded(-1, [&] {
    required(target, kWhat).target.copy_to({color, color_pitch, depth, depth_pitch});
    return 0;
  });
}
int halfplane_target_copy_from(halfplane_target* target, const void* color, size_t color_pitch, const uint32_t* depth,
                               size_t depth_pitch) {
  return guarded(-1, [&] {
    // PixelMemory serves both ways, and copy_from() only reads it.
    required(target, kWhat)
        .target.copy_from({const_cast<void*>(color), color_pitch, const_cast<std::uint32_t*>(depth), depth_pitch});
    return 0;
  });
}
void halfplane_target_free(halfplane_target* target) { delete target; }

}  // extern "C"
