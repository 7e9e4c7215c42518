#include "target.hpp"

#include <cstring>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "../pipeline.hpp"
#include "functional.hpp"

namespace halfplane {

struct Target::Memory {
  Memory(const Config& config_, Scene empty_) : config(config_), engine(config_), empty(std::move(empty_)) {}

  const Config config;
  FunctionalEngine engine;
  const Scene empty;                   ///< the target alone: what every scene drawn here begins as
  Framebuffer taken;                   ///< from the caller's memory; drawn on next
  const Framebuffer* frame = nullptr;  ///< `taken`, or the engine's

  Counters render(const Scene& scene) {
    RenderOptions options;
    options.onto = frame;
    const Rendering& rendering = engine.render(scene, options);
    frame = &rendering.frame;
    return rendering.counters;
  }
};

Target::Target(const Config& config, int width, int height, std::optional<std::array<double, 2>> planes) {
  Scene empty;
  empty.name = "target";
  empty.width = width;
  empty.height = height;
  empty.planes = planes;
  memory_ = std::make_unique<Memory>(config, std::move(empty));
  (void)memory_->render(memory_->empty);
}

Target::~Target() = default;
Target::Target(Target&&) noexcept = default;
Target& Target::operator=(Target&&) noexcept = default;

void Target::clear(const Clear& what, const State& state) {
  Scene scene = memory_->empty;
  scene.states.push_back(state);
  scene.commands.emplace_back(Clear{0, what.color, what.depth});
  (void)memory_->render(scene);
}

Counters Target::draw(const State& state, Topology topology, std::span<const Vertex> vertices,
                      std::span<const std::uint32_t> indices) {
  Scene scene = memory_->empty;
  scene.vertices.assign(vertices.begin(), vertices.end());
  scene.indices.assign(indices.begin(), indices.end());
  scene.states.push_back(state);
  scene.commands.emplace_back(Draw{.topology = topology, .count = indices.size()});
  return memory_->render(scene);
}

Counters Target::draw(const State& state, Topology topology, std::span<const Vertex> vertices) {
  std::vector<std::uint32_t> indices(vertices.size());
  std::iota(indices.begin(), indices.end(), 0U);
  return draw(state, topology, vertices, indices);
}

Counters Target::draw(const Scene& scene) {
  if (scene.planes != memory_->empty.planes)
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

/// Row `y` of an image in memory.
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
  const std::uint32_t largest = DepthEncode(config, memory_->empty.planes).of_window(1.0);
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
  // What was taken over is the colour and the depth of each of a pixel's samples.
  for (Framebuffer& sample : onto.samples) {
    if (memory.color != nullptr) sample.color = onto.color;
    if (memory.depth != nullptr) sample.depth = onto.depth;
  }
  memory_->taken = std::move(onto);
  memory_->frame = &memory_->taken;
}

}  // namespace halfplane
