#include "sim/scene/polygon.hpp"

#include <algorithm>

#include "model/fixed.hpp"

namespace halfplane {
namespace {

// A corner on a grid of 2^48 steps across the polygon's plane: there the side of a line is decided exactly, so that
// decisions cannot contradict each other.
struct GridPoint {
  std::int64_t x = 0, y = 0;
  bool operator==(const GridPoint&) const = default;
};
constexpr double kGrid = 281474976710656.0;  // 2^48

// Twice the signed area of (a, b, c), grid units squared: at most 2 * 2^49 * 2^49, within 101 bits.
int128 area(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return static_cast<int128>(b.x - a.x) * (c.y - a.y) - static_cast<int128>(b.y - a.y) * (c.x - a.x);
}

// Newell's sum: the area-weighted normal of any polygon, planar or nearly so.
Vec3 polygon_normal(std::span<const Vec3> corners) {
  Vec3 sum{};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum = add(sum, cross(subtract(corners[i], corners[0]), subtract(corners[i + 1], corners[0])));
  }
  return sum;
}

// The corners projected along the axis nearest to the normal, oriented so that the polygon's area is positive.
std::vector<GridPoint> project(std::span<const Vec3> corners, const Vec3& normal) {
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::abs(normal[i]) > std::abs(normal[axis])) axis = i;
  }
  std::size_t right = (axis + 1) % 3, up = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(right, up);
  Vec3 low = corners[0], high = corners[0];
  for (const Vec3& corner : corners) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], corner[i]);
      high[i] = std::max(high[i], corner[i]);
    }
  }
  const double extent = std::max({high[right] - low[right], high[up] - low[up], 1e-300});
  std::vector<GridPoint> points;
  points.reserve(corners.size());
  for (const Vec3& corner : corners) {
    points.push_back({static_cast<std::int64_t>((corner[right] - low[right]) / extent * kGrid),
                      static_cast<std::int64_t>((corner[up] - low[up]) / extent * kGrid)});
  }
  return points;
}

// The ring of corners not yet cut off. An ear is a convex corner whose triangle contains no other corner; cutting one
// off affects only its two neighbours, so each step costs one test of the corners that could block it.
class EarClipper {
 public:
  explicit EarClipper(std::vector<GridPoint> points) : points_(std::move(points)) {
    const auto count = static_cast<std::uint32_t>(points_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      previous_.push_back(i == 0 ? count - 1 : i - 1);
      next_.push_back(i + 1 == count ? 0 : i + 1);
    }
    gone_.assign(count, false);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (turn(i) <= 0) blockers_.push_back(i);
    }
  }

  void run(std::vector<std::array<std::uint32_t, 3>>& triangles) {
    std::uint32_t left = static_cast<std::uint32_t>(points_.size());
    for (const bool relaxed : {false, true}) {
      relaxed_ = relaxed;  // second round: flat corners may be cut, and touching is allowed
      std::vector<std::uint32_t> queue;
      for (std::uint32_t i = 0; i < points_.size(); ++i) queue.push_back(i);
      for (std::size_t head = 0; head < queue.size() && left > 3; ++head) {
        const std::uint32_t corner = queue[head];
        if (gone_[corner] || !is_ear(corner)) continue;
        cut(corner, triangles);
        --left;
        queue.push_back(previous_[corner]);
        queue.push_back(next_[corner]);
      }
    }
    finish_as_fan(triangles);
  }

 private:
  int128 turn(std::uint32_t i) const { return area(points_[previous_[i]], points_[i], points_[next_[i]]); }

  bool is_ear(std::uint32_t corner) {
    const GridPoint &a = points_[previous_[corner]], &b = points_[corner], &c = points_[next_[corner]];
    const int128 size = area(a, b, c);
    if (size < 0 || (size == 0 && !relaxed_)) return false;
    const auto [left, right] = std::minmax({a.x, b.x, c.x});
    const auto [low, high] = std::minmax({a.y, b.y, c.y});
    const int128 least = relaxed_ ? 1 : 0;  // a corner on the triangle's edge blocks only in the first round
    for (const std::uint32_t other : blockers_) {
      const GridPoint& p = points_[other];
      if (gone_[other] || p.x < left || p.x > right || p.y < low || p.y > high) continue;
      if (p == a || p == b || p == c) continue;  // where a polygon touches itself
      if (area(a, b, p) >= least && area(b, c, p) >= least && area(c, a, p) >= least) return false;
    }
    return true;
  }

  void cut(std::uint32_t corner, std::vector<std::array<std::uint32_t, 3>>& triangles) {
    triangles.push_back({previous_[corner], corner, next_[corner]});
    next_[previous_[corner]] = next_[corner];
    previous_[next_[corner]] = previous_[corner];
    gone_[corner] = true;
    // A corner that has become convex blocks no longer; dead ones are dropped from time to time.
    if (++cuts_ % 64 == 0) std::erase_if(blockers_, [this](std::uint32_t i) { return gone_[i] || turn(i) > 0; });
  }

  void finish_as_fan(std::vector<std::array<std::uint32_t, 3>>& triangles) {
    std::uint32_t first = 0;
    while (gone_[first]) ++first;
    for (std::uint32_t i = next_[first]; next_[i] != first; i = next_[i]) triangles.push_back({first, i, next_[i]});
  }

  std::vector<GridPoint> points_;
  std::vector<std::uint32_t> previous_, next_, blockers_;
  std::vector<bool> gone_;
  std::size_t cuts_ = 0;
  bool relaxed_ = false;
};

}  // namespace

bool triangulate_polygon(std::span<const Vec3> corners, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const auto count = static_cast<std::uint32_t>(corners.size());
  const auto fan = [&] {
    for (std::uint32_t i = 1; i + 1 < count; ++i) triangles.push_back({0, i, i + 1});
    return true;
  };
  if (count == 3) return fan();
  const Vec3 normal = polygon_normal(corners);
  if (length(normal) == 0) return fan();
  std::vector<GridPoint> points = project(corners, normal);
  bool convex = true;
  for (std::size_t i = 0; i < count && convex; ++i) {
    convex = area(points[i], points[(i + 1) % count], points[(i + 2) % count]) > 0;
  }
  if (convex) return fan();
  if (count > kLargestConcavePolygon) return false;
  EarClipper(std::move(points)).run(triangles);
  return true;
}

}  // namespace halfplane
