// Vertices of one kind as a draw of the model.
#pragma once

#include <cstdint>
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

/// Memory of this thread that is kept from draw to draw.
template <class Element>
std::vector<Element>& empty_scratch() {
  thread_local std::vector<Element> elements;
  elements.clear();
  return elements;
}

/// Why the host has to shade the fragments of these vertices; null: the model's units have all that it takes.
[[nodiscard]] const char* why_shaded(Context& context, std::span<const ShadedVertex> vertices);

/// Whether fog between two vertices is not nearly linear.
[[nodiscard]] bool fog_bends(const FogState& fog, const ShadedVertex& a, const ShadedVertex& b);

/// Draws vertices in their first colour.
void draw_batch(Context& context, const BatchKind& group, std::span<const ShadedVertex> vertices,
                std::span<const std::uint32_t> indices);

}  // namespace halfplane::gl
