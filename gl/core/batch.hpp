// Vertices of one kind as a draw of the model.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "primitive.hpp"

namespace halfplane::gl {

/// What one draw of the model has in common.
struct BatchKind {
  DrawKind kind = DrawKind::triangles;
  Topology topology = Topology::triangles;
  bool is_window = false;    ///< ShadedVertex::clip is x, y, z in the window, and the w of clip space
  bool is_stippled = false;  ///< polygons, in the window
  bool is_shaded = false;    ///< triangles whose fragments the host shades
  double point_size = 1;
  bool operator==(const BatchKind&) const = default;
};

/// What decides how a batch of vertices is drawn.
struct BatchTraits {
  bool has_one_color = true, has_one_w = true, has_one_q = true, has_positive_q = true;
  bool has_secondary = false;
  bool is_fogged_by_w = true;  ///< clip w is the distance that fog takes
  bool is_two_sided = false;   ///< the back has other colours
};
/// `unit`: DrawSetup::unit.
[[nodiscard]] BatchTraits traits_of(const ShadedVertices& vertices, std::size_t unit);

/// What the context's state says of draws, found once for each Context::revision and Frame::revision().
struct DrawSetup {
  /// Draws of one kind: with or without the texture of `unit`.
  struct OfKind {
    bool is_known = false;
    std::optional<halfplane::State> state;  ///< none: nothing can be drawn
    TextureUse use;
  };
  std::uint64_t revision = 0, frame = 0;
  unsigned units = 0;                 ///< textured_units()
  std::size_t unit = 0;               ///< the first of them
  std::optional<const char*> beyond;  ///< beyond_texture_unit()
  std::array<std::array<OfKind, 2>, 4> kind;
};
/// That of the current state. Valid until the next call.
[[nodiscard]] DrawSetup& draw_setup(Context& context);

/// Memory of this thread that is kept from draw to draw.
template <class Element>
std::vector<Element>& empty_scratch() {
  thread_local std::vector<Element> elements;
  elements.clear();
  return elements;
}

/// `count` elements with any values, in memory of this thread that the next call takes again; not that of empty_scratch().
template <class Element>
std::span<Element> scratch(std::size_t count) {
  thread_local std::vector<Element> elements;
  if (elements.size() < count) elements.resize(count);
  return {elements.data(), count};
}

/// Why the host has to shade the fragments of such vertices; null: the model's units have all that it takes.
[[nodiscard]] const char* why_shaded(Context& context, const BatchTraits& traits);

/// Whether fog between two vertices is not nearly linear.
[[nodiscard]] bool fog_bends(const FogState& fog, const ShadedVertex& a, const ShadedVertex& b);

/// Draws vertices in their first colour.
void draw_batch(Context& context, const BatchKind& group, const ShadedVertices& vertices,
                std::span<const std::uint32_t> indices, const BatchTraits& traits);

}  // namespace halfplane::gl
