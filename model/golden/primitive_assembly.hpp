// Golden primitive assembly: the vertices of a draw one by one, and a primitive whenever one is complete.
//
// In: a draw's indices, with kRestart. Out: primitives in program order, and the provoking vertex of each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "../scene.hpp"

namespace halfplane::golden {

/// One input primitive.
struct Primitive {
  std::size_t corners = 3;               ///< 3: triangle, 2: line, 1: point
  std::array<std::uint32_t, 3> index{};  ///< into Scene::vertices; of a triangle the provoking vertex first
  std::uint32_t provoking = 0;           ///< into Scene::vertices
};

/// Takes a draw's indices in order. `Visit` is called with every Primitive.
template <class Visit>
class Assembler {
 public:
  Assembler(Topology topology, Provoking provoking, Visit& visit)
      : topology_(topology), is_last_(provoking == Provoking::last), visit_(visit) {}

  void take(std::uint32_t index) {
    if (index == kRestart) return end();
    if (count_ == 0) first_ = index;
    ++count_;
    complete(index);
    before_ = {before_[1], index};
  }

  /// Ends the draw, or one of its strips: a loop closes, an incomplete primitive is dropped.
  void end() {
    if (topology_ == Topology::line_loop && count_ > 1) line(before_[1], first_);
    count_ = 0;
  }

 private:
  /// `index` is vertex number count_ of the strip; the two before it are in before_.
  void complete(std::uint32_t index) {
    const auto [older, old] = before_;
    switch (topology_) {
      case Topology::triangles:
        if (count_ % 3 == 0) triangle(older, old, index);
        return;
      case Topology::triangle_strip:
        if (count_ < 3) return;
        // Every other triangle is reversed, so that all have the same facing.
        if (count_ % 2 == 1) return triangle(older, old, index);
        return is_last_ ? visit_(Primitive{3, {index, old, older}, index})
                        : visit_(Primitive{3, {older, index, old}, older});
      case Topology::triangle_fan:
        // The centre gives no triangle its colour: the first of the other vertices does, or the last.
        if (count_ >= 3)
          is_last_ ? visit_(Primitive{3, {index, first_, old}, index})
                   : visit_(Primitive{3, {old, index, first_}, old});
        return;
      case Topology::lines:
        if (count_ % 2 == 0) line(old, index);
        return;
      case Topology::line_strip:
      case Topology::line_loop:
        if (count_ >= 2) line(old, index);
        return;
      case Topology::points: return visit_(Primitive{1, {index, index, index}, index});
    }
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    is_last_ ? visit_(Primitive{3, {c, a, b}, c}) : visit_(Primitive{3, {a, b, c}, a});
  }
  void line(std::uint32_t start, std::uint32_t end) { visit_(Primitive{2, {start, end, end}, is_last_ ? end : start}); }

  Topology topology_;
  bool is_last_;
  Visit& visit_;
  std::size_t count_ = 0;                  // vertices since the last restart
  std::uint32_t first_ = 0;                // the first of them
  std::array<std::uint32_t, 2> before_{};  // the latest two of them
};

/// Calls visit(Primitive) for the primitives of one draw.
template <class Visit>
void for_each_primitive(const Scene& scene, const Draw& draw, Provoking provoking, Visit&& visit) {
  Assembler assembler(draw.topology, provoking, visit);
  for (std::size_t i = 0; i < draw.count; ++i) assembler.take(scene.indices[draw.first + i]);
  assembler.end();
}

}  // namespace halfplane::golden
