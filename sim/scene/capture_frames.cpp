#include "sim/scene/capture_frames.hpp"

#include <algorithm>
#include <map>
#include <span>

#include "model/host/primitives.hpp"

namespace halfplane {
namespace {

/// The vertices of the draws, from the lowest index to the highest: the vertices of a frame are adjacent in most
/// captures.
void take_vertices(const Scene& from, Scene& to) {
  std::uint32_t low = kRestart, high = 0;
  for (const std::uint32_t index : to.indices) {
    if (index == kRestart) continue;
    low = std::min(low, index);
    high = std::max(high, index);
  }
  if (low > high) return;
  const auto part = [low, high](const auto& all) {
    const auto last = std::min<std::size_t>(std::size_t{high} + 1, all.size()),
               first = std::min<std::size_t>(low, last);
    const std::span whole(all);
    const auto taken = whole.subspan(first, last - first);
    return std::remove_cvref_t<decltype(all)>(taken.begin(), taken.end());
  };
  to.vertices = part(from.vertices);
  to.normals = part(from.normals);
  for (std::uint32_t& index : to.indices)
    if (index != kRestart) index -= low;
}

}  // namespace

std::vector<FrameCommands> frames_of(const Scene& scene) {
  std::vector<FrameCommands> frames;
  std::size_t first = 0;
  for (std::size_t i = 0; i < scene.commands.size(); ++i)
    if (std::holds_alternative<EndFrame>(scene.commands[i])) {
      frames.push_back({first, i});
      first = i + 1;
    }
  if (first < scene.commands.size() || frames.empty()) frames.push_back({first, scene.commands.size()});
  return frames;
}

Scene frame_scene(const Scene& scene, const FrameCommands& frame) {
  Scene made;
  made.name = scene.name;
  made.width = scene.width;
  made.height = scene.height;
  made.planes = scene.planes;
  made.objects = scene.objects;
  std::map<std::uint32_t, std::uint32_t> states, textures;  // old number to new number
  const auto own_state = [&](std::uint32_t number) {
    const auto [place, is_new] = states.try_emplace(number, static_cast<std::uint32_t>(made.states.size()));
    if (!is_new) return place->second;
    State state = scene.states[number];
    if (state.texture) {
      const auto [texture, is_first] =
          textures.try_emplace(*state.texture, static_cast<std::uint32_t>(made.textures.size()));
      if (is_first) made.textures.push_back(scene.textures[*state.texture]);
      state.texture = texture->second;
    }
    made.states.push_back(state);
    return place->second;
  };
  for (std::size_t i = frame.first; i < frame.end; ++i) {
    made.commands.push_back(scene.commands[i]);
    if (auto* clear = std::get_if<Clear>(&made.commands.back())) clear->state = own_state(clear->state);
    auto* draw = std::get_if<Draw>(&made.commands.back());
    if (draw == nullptr) continue;
    draw->state = own_state(draw->state);
    const auto indices = std::span(scene.indices).subspan(draw->first, draw->count);
    draw->first = made.indices.size();
    made.indices.insert(made.indices.end(), indices.begin(), indices.end());
  }
  take_vertices(scene, made);
  return made;
}

bool goes_on(const Scene& scene, const FrameCommands& frame) {
  const std::span commands = std::span(scene.commands).subspan(frame.first, frame.end - frame.first);
  bool color = false, depth = false, stencil = false;
  for (const Command& command : commands) {
    const auto* clear = std::get_if<Clear>(&command);
    if (clear == nullptr) break;
    if (clear_rect(scene, *clear) != Rect{0, 0, scene.width, scene.height}) continue;
    color |= clear->color.has_value();
    depth |= clear->depth.has_value();
    stencil |= clear->stencil.has_value();
  }
  const bool looks_at_stencil = std::ranges::any_of(commands, [&scene](const Command& command) {
    const auto* draw = std::get_if<Draw>(&command);
    return draw != nullptr && scene.states[draw->state].stencil.has_value();
  });
  return !color || !depth || (looks_at_stencil && !stencil);
}

}  // namespace halfplane
