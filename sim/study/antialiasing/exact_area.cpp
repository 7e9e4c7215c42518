#include "sim/study/antialiasing/exact_area.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace halfplane::antialiasing {
namespace {

struct Point {
  mpq_class x, y;
};
using Polygon = std::vector<Point>;

/// The part of the polygon with sign * (coordinate - border) >= 0, for one coordinate of a point.
Polygon clipped(const Polygon& polygon, mpq_class Point::*coordinate, const mpq_class& border, int sign) {
  const auto inside_by = [&](const Point& p) { return mpq_class(sign * (p.*coordinate - border)); };
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const mpq_class da = inside_by(a), db = inside_by(b);
    if (da >= 0) kept.push_back(a);
    if ((da < 0) == (db < 0)) continue;
    const mpq_class t = da / (da - db);
    kept.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)});
  }
  return kept;
}

mpq_class area_of(const Polygon& polygon) {
  mpq_class doubled = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    doubled += a.x * b.y - b.x * a.y;
  }
  return abs(doubled) / 2;
}

Polygon in_pixels(const Triangle& triangle, int grid_bits) {
  Polygon polygon;
  for (const SnappedVertex& v : triangle.v) {
    Point p{mpq_class(v.x, 1L << grid_bits), mpq_class(v.y, 1L << grid_bits)};
    p.x.canonicalize();
    p.y.canonicalize();
    polygon.push_back(p);
  }
  return polygon;
}

/// The part of a triangle between two lines at distance 1.
Polygon strip(const Polygon& polygon, mpq_class Point::*coordinate, int from) {
  return clipped(clipped(polygon, coordinate, from, 1), coordinate, from + 1, -1);
}

}  // namespace

mpq_class covered_area(const Triangle& triangle, int x, int y, int grid_bits) {
  return area_of(strip(strip(in_pixels(triangle, grid_bits), &Point::y, y), &Point::x, x));
}

std::vector<double> covered_areas(const std::vector<Triangle>& triangles, int width, int height, int grid_bits) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<mpq_class> sum(pixels);
  for (const Triangle& triangle : triangles) {
    const Polygon polygon = in_pixels(triangle, grid_bits);
    const auto [top, bottom] = std::minmax({triangle.v[0].y, triangle.v[1].y, triangle.v[2].y});
    for (int y = std::max(0, top >> grid_bits); y <= std::min(height - 1, bottom >> grid_bits); ++y) {
      const Polygon row = strip(polygon, &Point::y, y);
      if (row.empty()) continue;
      mpq_class left = row[0].x, right = left;
      for (const Point& p : row) {
        left = std::min(left, p.x);
        right = std::max(right, p.x);
      }
      const int first = std::max(0, static_cast<int>(std::floor(left.get_d())) - 1);  // get_d() may round
      const int last = std::min(width - 1, static_cast<int>(std::floor(right.get_d())) + 1);
      for (int x = first; x <= last; ++x)
        sum[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] +=
            area_of(strip(row, &Point::x, x));
    }
  }
  std::vector<double> areas;
  for (const mpq_class& area : sum) areas.push_back(area.get_d());
  return areas;
}

}  // namespace halfplane::antialiasing
