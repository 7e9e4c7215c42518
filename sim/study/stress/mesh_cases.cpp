// Meshes: for any triangles, the samples of their union are covered exactly once.
#include <algorithm>
#include <set>

#include "sim/study/stress/cases.hpp"
#include "sim/study/stress/shapes.hpp"

namespace halfplane::stress {
namespace {

std::array<Point, 4> rectangle(std::int64_t left, std::int64_t top, std::int64_t right, std::int64_t bottom) {
  return {Point{left, top}, {right, top}, {right, bottom}, {left, bottom}};
}

/// Two triangles, by either diagonal.
void add_quad(Mesh& mesh, const std::array<Point, 4>& q, bool diagonal) {
  if (diagonal) {
    mesh.push_back({q[0], q[1], q[2]});
    mesh.push_back({q[0], q[2], q[3]});
  } else {
    mesh.push_back({q[0], q[1], q[3]});
    mesh.push_back({q[1], q[2], q[3]});
  }
}

/// `count` different integers in [low, high], sorted; fewer if there are not enough.
std::vector<std::int64_t> cuts(Random& random, std::int64_t low, std::int64_t high, int count) {
  std::set<std::int64_t> set{low, high};
  for (int i = 2; i < count; ++i) set.insert(random.integer(low, high));
  return {set.begin(), set.end()};
}

void delaunay_mesh(Unit& unit, int size, int points) {
  Random& random = unit.random;
  const int width = unit.width(size), height = unit.height(size);
  // On the half-pixel grid every second coordinate is a pixel centre, with ties everywhere.
  const std::int64_t step = random.coin() ? std::max(1, unit.pixel() / 2) : 1, pixel = unit.pixel();
  const Point low{-2 * pixel, -2 * pixel}, high{(width + 2) * pixel, (height + 2) * pixel};
  std::set<Point> set;
  for (int i = 0; i < points; ++i) {
    const std::int64_t x = random.integer(low.x / step + 1, high.x / step - 1) * step;
    set.insert({x, random.integer(low.y / step + 1, high.y / step - 1) * step});
  }
  const Mesh mesh = delaunay(low, high, set, unit.poll);
  std::int64_t area = 0;
  for (const Corner& t : mesh) area += doubled_area(t[0], t[1], t[2]);
  unit.require(area == 2 * (high.x - low.x) * (high.y - low.y) && mesh.size() == 2 * set.size() + 2, "mesh", {},
               "the triangulation does not fill its rectangle: a fault of the test itself");
  check_mesh(unit, mesh, width, height, rectangle(low.x, low.y, high.x, high.y));
}

}  // namespace

void pixel_centres(Unit& unit) {
  Random& random = unit.random;
  const int width = unit.width(8 + random.index(40)), height = unit.height(8 + random.index(40));
  const std::int64_t pixel = unit.pixel(), half = pixel / 2;
  // One after the other: compilers evaluate arguments in orders of their own.
  const auto some_cuts = [&random](int length) {
    const int most = 2 + random.index(8), last = length - 1 - random.index(3), first = random.index(3);
    return cuts(random, first, last, most);
  };
  const auto columns = some_cuts(width), rows = some_cuts(height);
  Mesh mesh;
  for (std::size_t j = 0; j + 1 < rows.size(); ++j)
    for (std::size_t i = 0; i + 1 < columns.size(); ++i)
      add_quad(mesh,
               rectangle(columns[i] * pixel + half, rows[j] * pixel + half, columns[i + 1] * pixel + half,
                         rows[j + 1] * pixel + half),
               random.coin());
  check_mesh(unit, mesh, width, height,
             rectangle(columns.front() * pixel + half, rows.front() * pixel + half, columns.back() * pixel + half,
                       rows.back() * pixel + half));
}

void fans(Unit& unit) {
  Random& random = unit.random;
  const int size = std::min(unit.width(16 + random.index(32)), unit.height(48));
  const std::int64_t pixel = unit.pixel(), half = pixel / 2, low = -2 * pixel, side = (size + 4) * pixel;
  // Near the top left, so that the hub of a fan of three lies inside its triangle.
  Point hub{(1 + random.index(size / 3)) * pixel, (1 + random.index(size / 3)) * pixel};
  const int kind = random.index(4);  // pixel corner, centre, half-edge point, anywhere
  hub.x += kind == 1 || kind == 2 ? half : kind == 3 ? random.index(static_cast<int>(pixel)) : 0;
  hub.y += kind == 1 ? half : kind == 3 ? random.index(static_cast<int>(pixel)) : 0;
  const std::size_t blades = 3 + static_cast<std::size_t>(random.index(62));
  // The rim: points along the border of a square, clockwise from its top left corner, its corners among them.
  std::set<std::int64_t> way{0, side, 3 * side};
  if (blades > 3) way.insert(2 * side);
  while (way.size() < blades) way.insert(random.integer(0, 4 * side - 1));
  std::vector<Point> rim;
  for (const std::int64_t w : way) {
    const std::int64_t along = w % side;
    const std::array<Point, 4> at{Point{low + along, low},
                                  {low + side, low + along},
                                  {low + side - along, low + side},
                                  {low, low + side - along}};
    rim.push_back(at[static_cast<std::size_t>(w / side)]);
  }
  Mesh mesh;
  for (std::size_t i = 0; i < rim.size(); ++i) mesh.push_back({hub, rim[i], rim[(i + 1) % rim.size()]});
  check_mesh(unit, mesh, size, size, rim);
}

void delaunay_small(Unit& unit) {
  const int points = 40 + unit.random.index(160), size = 20 + unit.random.index(44);  // one after the other, as above
  delaunay_mesh(unit, size, points);
}

void delaunay_large(Unit& unit) {
  const int size = std::min(unit.width(512), unit.height(512));
  delaunay_mesh(unit, size, size * size / 5);
}

void t_junctions(Unit& unit) {
  Random& random = unit.random;
  const int width = unit.width(40), height = unit.height(40);
  const Point a = random_point(unit, width, height, 1), far = random_point(unit, width, height, 1);
  // b - a a multiple of d, so that grid points lie exactly on the edge.
  const int pieces = 2 + random.index(12), piece = 1 + random.index(pieces - 1);
  const Point d{(far.x - a.x) / pieces, (far.y - a.y) / pieces};
  const Point b{a.x + pieces * d.x, a.y + pieces * d.y};
  const bool is_off = random.coin();
  Point t{a.x + piece * d.x, a.y + piece * d.y};
  if (is_off) {
    t.x += random.index(5) - 2;
    t.y += random.index(5) - 2;
  }
  Point above = random_point(unit, width, height, 2), below = random_point(unit, width, height, 2);
  if (doubled_area(a, b, above) < 0) std::swap(above, below);
  // Only if the pieces do not fold: then the junction adds or removes only its own sliver a, t, b.
  if (doubled_area(a, b, above) <= 0 || doubled_area(b, a, below) <= 0 || doubled_area(t, a, below) <= 0 ||
      doubled_area(b, t, below) <= 0)
    return;
  const Scene scene = mesh_scene(unit, {{a, b, above}, {a, t, below}, {t, b, below}}, width, height);
  const Rendering rendering = check_scene(unit, scene);
  const int bits = unit.config.subpixel_bits, side = doubled_area(a, b, t) > 0 ? 1 : -1;
  expect_count(unit, scene, rendering, [&](int x, int y) {
    return triangle_covers({a, b, above}, x, y, bits) + triangle_covers({b, a, below}, x, y, bits) +
           side * triangle_covers({a, t, b}, x, y, bits);
  });
}

void close_edges(Unit& unit) {
  Random& random = unit.random;
  const int size = std::min(unit.width(16 + random.index(40)), unit.height(56));
  const std::int64_t pixel = unit.pixel(), low = -2 * pixel, high = (size + 2) * pixel;
  const bool is_transposed = random.coin();
  const auto at = [&](std::int64_t along, std::int64_t across) {
    return is_transposed ? Point{across, along} : Point{along, across};
  };
  // Edges from one border to the other, in bundles one subpixel apart.
  std::vector<std::pair<std::int64_t, std::int64_t>> edges{{low, low}};
  while (edges.back().first < high && edges.back().second < high) {
    const auto [top, bottom] = edges.back();
    const bool is_close = random.index(3) != 0;
    const auto next = [&](std::int64_t from) {
      return std::min(high, from + (is_close ? random.index(2) : random.integer(0, 6 * pixel)));
    };
    const std::int64_t next_top = next(top);
    edges.emplace_back(next_top, next(bottom));
    if (edges.size() > 200) break;
  }
  edges.emplace_back(high, high);
  Mesh mesh;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    add_quad(mesh,
             {at(edges[i].first, low), at(edges[i + 1].first, low), at(edges[i + 1].second, high),
              at(edges[i].second, high)},
             random.coin());
  check_mesh(unit, mesh, size, size, rectangle(low, low, high, high));
}

}  // namespace halfplane::stress
