#include "sim/study/stress/delaunay.hpp"

#include <cstddef>

namespace halfplane::stress {
namespace {

/// Positive when p lies strictly inside the circle through a, b, c of positive area. Exact for |coordinates| < 2^29.
int128 in_circle(Point a, Point b, Point c, Point p) {
  const auto lift = [&](Point q) { return int128{q.x - p.x} * (q.x - p.x) + int128{q.y - p.y} * (q.y - p.y); };
  return lift(a) * doubled_area(p, b, c) + lift(b) * doubled_area(a, p, c) + lift(c) * doubled_area(a, b, p);
}

constexpr int kNone = -1;

class Triangulation {
 public:
  Triangulation(Point low, Point high) {
    const Point right{high.x, low.y}, left{low.x, high.y};
    cells_.push_back({{low, right, left}, {1, kNone, kNone}, true});
    cells_.push_back({{high, left, right}, {0, kNone, kNone}, true});
  }

  void insert(Point p) {
    find_cavity(p);
    // One new triangle on each border edge; its neighbours around p are found by their common vertex.
    const int first_new = static_cast<int>(cells_.size());
    for (const Border& edge : border_) {
      const int number = static_cast<int>(cells_.size());
      cells_.push_back({{edge.from, edge.to, p}, {kNone, kNone, edge.outside}, true});
      if (edge.outside != kNone) neighbour_across(edge.outside, edge.to, edge.from) = number;
    }
    const int end = static_cast<int>(cells_.size());
    for (int i = first_new; i < end; ++i)
      for (int k = first_new; k < end; ++k)
        if (cell(i).corner[1] == cell(k).corner[0]) {
          cell(i).neighbour[0] = k;  // across (to, p)
          cell(k).neighbour[1] = i;  // across (p, from)
        }
    last_ = first_new;
  }

  [[nodiscard]] Mesh mesh() const {
    Mesh mesh;
    for (const Cell& c : cells_)
      if (c.is_alive) mesh.push_back(c.corner);
    return mesh;
  }

 private:
  struct Cell {
    Corner corner;
    std::array<int, 3> neighbour;  ///< neighbour[i] is across the edge opposite corner i
    bool is_alive;
  };
  struct Border {
    Point from, to;
    int outside;
  };

  Cell& cell(int i) { return cells_[static_cast<std::size_t>(i)]; }

  int& neighbour_across(int i, Point from, Point to) {
    Cell& c = cell(i);
    for (std::size_t k = 0; k < 2; ++k)
      if (c.corner[(k + 1) % 3] == from && c.corner[(k + 2) % 3] == to) return c.neighbour[k];
    return c.neighbour[2];
  }

  /// Removes the triangles whose circle contains p, and lists the edges around them.
  void find_cavity(Point p) {
    int at = last_;
    for (bool is_there = false; !is_there;) {
      is_there = true;
      for (std::size_t i = 0; i < 3 && is_there; ++i)
        if (doubled_area(cell(at).corner[(i + 1) % 3], cell(at).corner[(i + 2) % 3], p) < 0) {
          at = cell(at).neighbour[i];
          is_there = false;
        }
    }
    border_.clear();
    cell(at).is_alive = false;
    for (std::vector<int> open{at}; !open.empty();) {
      const int here = open.back();
      open.pop_back();
      for (std::size_t i = 0; i < 3; ++i) {
        const int next = cell(here).neighbour[i];
        if (next != kNone && !cell(next).is_alive) continue;
        const auto& q = next == kNone ? cell(here).corner : cell(next).corner;
        if (next != kNone && in_circle(q[0], q[1], q[2], p) > 0) {
          cell(next).is_alive = false;
          open.push_back(next);
        } else {
          border_.push_back({cell(here).corner[(i + 1) % 3], cell(here).corner[(i + 2) % 3], next});
        }
      }
    }
  }

  std::vector<Cell> cells_;
  std::vector<Border> border_;
  int last_ = 0;
};

}  // namespace

Mesh delaunay(Point low, Point high, const std::set<Point>& points, const std::function<void()>& poll) {
  Triangulation triangulation(low, high);
  std::size_t done = 0;
  for (const Point& p : points) {
    if (poll && done++ % 1024 == 0) poll();
    triangulation.insert(p);
  }
  return triangulation.mesh();
}

}  // namespace halfplane::stress
