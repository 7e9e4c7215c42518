#include "target.hpp"

#include <cstring>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "../host/primitives.hpp"
#include "functional.hpp"

namespace halfplane {

struct Target::Memory {
  /// The scene of one clear or draw, whose memory is reused. It keeps its texture, which is decoded once and not for each
  /// draw.
  struct Canvas {
    Scene scene;
    std::vector<TexelBlocks> texels;  ///< of its texture, after the first draw with it

    /// The scene with only the texture and one state.
    Scene& with(const State& state) {
      scene.vertices.clear();
      scene.normals.clear();
      scene.indices.clear();
      scene.states.assign(1, state);
      if (state.texture) scene.states[0].texture = 0;
      scene.commands.clear();
      return scene;
    }
  };

  Memory(const Config& config_, Scene empty) : config(config_), engine(config_), plain{std::move(empty), {}} {}

  const Config config;
  FunctionalEngine engine;
  Canvas plain;                        ///< for draws without a texture
  std::vector<Canvas> textured;        ///< for draws with a texture, by its number
  Framebuffer taken;                   ///< copied from the caller's memory; drawn on next
  const Framebuffer* frame = nullptr;  ///< `taken`, or the engine's
  int threads = 1;

  template <class Drawn>
  Counters render(const Drawn& scene) {
    RenderOptions options;
    options.onto = frame;
    options.threads = threads;
    const Rendering& rendering = engine.render(scene, options);
    frame = &rendering.frame;
    return rendering.counters;
  }

  [[nodiscard]] Canvas canvas_with(Texture texture) const {
    const Scene& size = plain.scene;
    Canvas canvas;
    canvas.scene.name = size.name;
    canvas.scene.width = size.width;
    canvas.scene.height = size.height;
    canvas.scene.planes = size.planes;
    canvas.scene.textures.push_back(std::move(texture));
    validate(canvas.scene);
    return canvas;
  }

  [[nodiscard]] Canvas& canvas_of(const State& state) {
    if (!state.texture) return plain;
    if (*state.texture >= textured.size())
      throw InputError("target: texture " + std::to_string(*state.texture) + ", but there are " +
                       std::to_string(textured.size()));
    return textured[*state.texture];
  }
};

Target::Target(const Config& config, int width, int height, std::optional<std::array<double, 2>> planes) {
  Scene empty;
  empty.name = "target";
  empty.width = width;
  empty.height = height;
  empty.planes = planes;
  memory_ = std::make_unique<Memory>(config, std::move(empty));
  (void)memory_->render(memory_->plain.scene);
}

Target::~Target() = default;
Target::Target(Target&&) noexcept = default;
Target& Target::operator=(Target&&) noexcept = default;

void Target::set_threads(int threads) {
  constexpr int kMost = 1024;
  if (threads < 1 || threads > kMost)
    throw InputError("target: " + std::to_string(threads) + " threads; give 1 to " + std::to_string(kMost));
  memory_->threads = threads;
}

std::uint32_t Target::add_texture(Texture texture) {
  memory_->textured.push_back(memory_->canvas_with(std::move(texture)));
  return static_cast<std::uint32_t>(memory_->textured.size() - 1);
}

void Target::replace_texture(std::uint32_t number, Texture texture) {
  State names;
  names.texture = number;
  memory_->canvas_of(names) = memory_->canvas_with(std::move(texture));
}

void Target::clear(const Clear& what, const State& state) {
  State untextured = state;
  untextured.texture.reset();
  Scene& scene = memory_->plain.with(untextured);
  scene.commands.emplace_back(Clear{0, what.color, what.depth, what.stencil});
  (void)memory_->render(scene);
}

Counters Target::draw(const State& state, Topology topology, std::span<const Vertex> vertices,
                      std::span<const std::uint32_t> indices, std::span<const std::array<double, 3>> normals) {
  Memory::Canvas& canvas = memory_->canvas_of(state);
  Scene& scene = canvas.with(state);
  scene.vertices.assign(vertices.begin(), vertices.end());
  scene.normals.assign(normals.begin(), normals.end());
  scene.indices.assign(indices.begin(), indices.end());
  scene.commands.emplace_back(Draw{.topology = topology, .count = indices.size()});
  if (!state.texture) return memory_->render(scene);
  PreparedScene prepared(scene, std::move(canvas.texels));
  const Counters counters = memory_->render(prepared);
  canvas.texels = std::move(prepared.textures);
  return counters;
}

Counters Target::draw(const State& state, Topology topology, std::span<const Vertex> vertices) {
  std::vector<std::uint32_t> indices(vertices.size());
  std::iota(indices.begin(), indices.end(), 0U);
  return draw(state, topology, vertices, indices);
}

Counters Target::draw(const Scene& scene) {
  if (scene.planes != memory_->plain.scene.planes)
    throw InputError((scene.name.empty() ? "scene" : scene.name) +
                     ": its planes are not those of the target; give both the same, or none");
  return memory_->render(scene);
}

const Framebuffer& Target::frame() const { return *memory_->frame; }

namespace {

std::size_t color_bytes(const Config& config) { return config.color_format == ColorFormat::rgb565 ? 2 : 4; }

void check_memory(const PixelMemory& memory, const Config& config, int width) {
  const auto pixels = static_cast<std::size_t>(width);
  const auto check = [](const char* name, std::size_t pitch, std::size_t bytes, std::size_t row) {
    if (pitch < row || pitch % bytes != 0)
      throw InputError(std::string(name) + "_pitch of " + std::to_string(pitch) + " bytes; give a multiple of " +
                       std::to_string(bytes) + " of at least " + std::to_string(row));
  };
  if (memory.color != nullptr) check("color", memory.color_pitch, color_bytes(config), pixels * color_bytes(config));
  if (memory.depth != nullptr) check("depth", memory.depth_pitch, sizeof *memory.depth, pixels * sizeof *memory.depth);
}

std::byte* row_of(void* image, std::size_t pitch, int y) {
  return static_cast<std::byte*>(image) + pitch * static_cast<std::size_t>(y);
}

}  // namespace

void Target::copy_to(const PixelMemory& memory) const {
  const Framebuffer& from = frame();
  check_memory(memory, memory_->config, from.width);
  const std::size_t bytes = color_bytes(memory_->config);
  for (int y = 0; y < from.height; ++y) {
    const std::uint32_t *color = &from.color[from.at(0, y)], *depth = &from.depth[from.at(0, y)];
    if (memory.depth != nullptr)
      std::memcpy(row_of(memory.depth, memory.depth_pitch, y), depth,
                  sizeof *depth * static_cast<std::size_t>(from.width));
    if (memory.color == nullptr) continue;
    std::byte* to = row_of(memory.color, memory.color_pitch, y);
    if (bytes == 4) {
      std::memcpy(to, color, bytes * static_cast<std::size_t>(from.width));
    } else {
      for (std::size_t x = 0; x < static_cast<std::size_t>(from.width); ++x) {
        const auto code = static_cast<std::uint16_t>(color[x]);
        std::memcpy(to + bytes * x, &code, bytes);
      }
    }
  }
}

void Target::copy_from(const PixelMemory& memory) {
  Framebuffer onto = frame();
  const Config& config = memory_->config;
  check_memory(memory, config, onto.width);
  const std::size_t bytes = color_bytes(config);
  const std::uint32_t largest = DepthEncode(config, memory_->plain.scene.planes).of_window(1.0);
  for (int y = 0; y < onto.height; ++y) {
    std::uint32_t *color = &onto.color[onto.at(0, y)], *depth = &onto.depth[onto.at(0, y)];
    if (memory.depth != nullptr)
      std::memcpy(depth, row_of(memory.depth, memory.depth_pitch, y),
                  sizeof *depth * static_cast<std::size_t>(onto.width));
    for (int x = 0; memory.depth != nullptr && x < onto.width; ++x)
      if (depth[x] > largest)
        throw InputError("depth code " + std::to_string(depth[x]) + " at " + std::to_string(x) + ", " +
                         std::to_string(y) + "; the largest of this format is " + std::to_string(largest));
    if (memory.color == nullptr) continue;
    const std::byte* from = row_of(memory.color, memory.color_pitch, y);
    if (bytes == 4) {
      std::memcpy(color, from, bytes * static_cast<std::size_t>(onto.width));
    } else {
      for (std::size_t x = 0; x < static_cast<std::size_t>(onto.width); ++x) {
        std::uint16_t code = 0;
        std::memcpy(&code, from + bytes * x, bytes);
        color[x] = code;
      }
    }
  }
  // The image taken over gives colour and depth of every sample of a pixel.
  for (Framebuffer& sample : onto.samples) {
    if (memory.color != nullptr) sample.color = onto.color;
    if (memory.depth != nullptr) sample.depth = onto.depth;
  }
  memory_->taken = std::move(onto);
  memory_->frame = &memory_->taken;
}

}  // namespace halfplane
