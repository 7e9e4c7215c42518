// Polygons, lines and points: which pixel centres they cover. Every primitive adds 8 to what is stored, so that the red
// channel says how often a pixel was drawn.
#pragma once

#include <algorithm>
#include <cmath>

#include "judge.hpp"

namespace halfplane::judges {

struct Corner {
  int x, y;  ///< 1/16 pixel
};

inline std::string vertex(Corner c) { return text("v %.4f %.4f .5 1 8 8 8 255\n", c.x / 16.0, c.y / 16.0); }
inline std::string raster_head() {
  return "halfplane 1\ntarget 32 32\nspace window\nclear color 0 0 0 255 depth 1\nstate depth_test always\n"
         "state blend one one zero one\n";
}
inline int times_drawn(const Framebuffer& frame, int x, int y, const Config& config) {
  const Channels c = channels(frame.color[frame.at(x, y)], config);
  return config.color_format == ColorFormat::rgba8888 ? c.code[0] / 8 : c.code[0];
}

/// Twice the area of the edge's triangle with the centre of pixel (x, y): positive to its right, y down.
inline long side(Corner a, Corner b, int x, int y) {
  return long{b.x - a.x} * (16 * y + 8 - a.y) - long{b.y - a.y} * (16 * x + 8 - a.x);
}

/// A convex polygon, clockwise on the screen, drawn as a fan about its first corner or about a point inside.
struct Polygon {
  std::string_view name;
  std::vector<Corner> corners;
};

/// Every pixel whose centre lies inside is drawn once, outside never, on the border at most once; with `strict` a centre on
/// the border belongs to a top or a left edge.
inline std::string polygon_verdict(const std::vector<Corner>& p, bool strict, const Framebuffer& frame,
                                   const Config& config) {
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      bool is_inside = true, is_outside = false, is_owned = true;
      for (std::size_t i = 0; i < p.size(); ++i) {
        const Corner a = p[i], b = p[(i + 1) % p.size()];
        const long s = side(a, b, x, y);
        is_inside &= s > 0;
        is_outside |= s < 0;
        is_owned &= s != 0 || b.y < a.y || (b.y == a.y && b.x > a.x);  // going up on the left, or right on the top
      }
      const int drawn = times_drawn(frame, x, y, config);
      const bool is_right = is_inside    ? drawn == 1
                            : is_outside ? drawn == 0
                            : strict     ? drawn == (is_owned ? 1 : 0)
                                         : drawn <= 1;
      if (!is_right)
        return at(x, y,
                  text("drawn %d times, %s", drawn,
                       is_inside    ? "inside"
                       : is_outside ? "outside"
                                    : "on an edge"));
    }
  return "";
}

inline std::string fan(const std::vector<Corner>& p, Corner centre, bool about_centre) {
  std::string capture = raster_head();
  for (const Corner& c : p) capture += vertex(c);
  const auto n = static_cast<int>(p.size());
  if (!about_centre) {
    for (int i = 1; i + 1 < n; ++i) capture += text("t 0 %d %d\n", i, i + 1);
    return capture;
  }
  capture += vertex(centre);
  for (int i = 0; i < n; ++i) capture += text("t %d %d %d\n", n, i, (i + 1) % n);
  return capture;
}

/// Whether the segment leaves the diamond of pixel (x, y): 1 it does, 0 not, -1 the diamond's border decides.
inline int leaves_diamond(Corner a, Corner b, int x, int y) {
  const double cx = x + .5, cy = y + .5, ax = a.x / 16.0 - cx, ay = a.y / 16.0 - cy, dx = (b.x - a.x) / 16.0,
               dy = (b.y - a.y) / 16.0;
  const auto distance = [&](double t) { return std::abs(ax + t * dx) + std::abs(ay + t * dy); };
  double least = std::min(distance(0), distance(1));  // convex and linear between these
  for (const double t : {dx != 0 ? -ax / dx : 0, dy != 0 ? -ay / dy : 0})
    if (t > 0 && t < 1) least = std::min(least, distance(t));
  if (std::abs(least - .5) < 1e-9 || std::abs(distance(1) - .5) < 1e-9) return -1;
  return least < .5 && distance(1) > .5 ? 1 : 0;
}

inline std::vector<Case> rasterization() {
  std::vector<Case> cases;
  const std::vector<Polygon> polygons{
      {"corners_on_centres", {{24, 24}, {424, 24}, {24, 424}}},
      {"square_on_centres", {{40, 40}, {360, 40}, {360, 360}, {40, 360}}},
      {"square_on_corners", {{32, 32}, {352, 32}, {352, 352}, {32, 352}}},
      {"diamond_on_centres", {{248, 24}, {472, 248}, {248, 472}, {24, 248}}},
      {"half_slopes", {{24, 136}, {248, 24}, {472, 136}, {248, 248}}},
      {"sliver", {{3, 5}, {500, 247}, {3, 7}}},
      {"upright_sliver", {{100, 8}, {104, 500}, {96, 500}}},
      {"one_centre", {{120, 120}, {136, 120}, {136, 136}, {120, 136}}},
      {"smaller_than_a_pixel", {{129, 129}, {133, 130}, {130, 134}}},
      {"hexagon", {{168, 40}, {328, 40}, {456, 248}, {328, 456}, {168, 456}, {40, 248}}},
      {"beyond_the_target", {{-640, -320}, {1200, 200}, {100, 900}}},
      {"tile_corners", {{128, 128}, {384, 128}, {384, 384}, {128, 384}}}};
  for (const Polygon& polygon : polygons) {
    const auto& p = polygon.corners;
    const Corner centre{(p[0].x + p[1].x + p[2].x) / 3, (p[0].y + p[1].y + p[2].y) / 3};
    auto mirrored = p;  // the fill rule turned over: bottom and right edges own what lies on them
    for (Corner& c : mirrored) ++c.x, ++c.y;
    for (const bool about_centre : {false, true}) {
      Case& one = cases.emplace_back();
      one.name = "triangles/" + std::string(polygon.name) + (about_centre ? "/about_centre" : "/fan");
      one.capture = fan(p, centre, about_centre);
      one.verdict = [p](const Framebuffer& f, const Config& c) { return polygon_verdict(p, true, f, c); };
      if (polygon.name.ends_with("centres") || polygon.name == "one_centre" || polygon.name == "half_slopes")
        one.wrong = fan(mirrored, centre, about_centre);
    }
    auto turned = p;  // the other winding is the same picture without culling
    std::reverse(turned.begin(), turned.end());
    cases.push_back({"triangles/" + std::string(polygon.name) + "/counter_clockwise", fan(turned, centre, false),
                     [p](const Framebuffer& f, const Config& c) { return polygon_verdict(p, true, f, c); },
                     // an edge that two triangles own
                     p.size() > 3 && polygon.name != "one_centre" ? fan(turned, centre, false) + "t 0 1 2\n" : ""});
  }
  const Corner ends[][2] = {
      {{40, 41}, {440, 41}},  {{440, 43}, {40, 43}},  {{41, 40}, {41, 440}},  {{43, 440}, {43, 40}},
      {{17, 33}, {401, 230}}, {{401, 230}, {17, 33}}, {{33, 17}, {230, 401}}, {{230, 401}, {33, 17}},
      {{33, 401}, {230, 17}}, {{17, 230}, {401, 33}}, {{401, 33}, {17, 230}}, {{230, 17}, {33, 401}},
      {{50, 50}, {61, 53}},   {{8, 8}, {500, 499}},   {{100, 90}, {101, 91}}, {{-300, 77}, {800, 201}}};
  for (const auto& [a, b] : ends) {
    const auto line = [](Corner from, Corner to) {
      return raster_head() + "state line_rule diamond\n" + vertex(from) + vertex(to) + "l 0 1\n";
    };
    cases.push_back({text("lines/%d_%d_to_%d_%d", a.x, a.y, b.x, b.y), line(a, b),
                     [a = a, b = b](const Framebuffer& frame, const Config& config) -> std::string {
                       for (int y = 0; y < frame.height; ++y)
                         for (int x = 0; x < frame.width; ++x) {
                           const int wanted = leaves_diamond(a, b, x, y), drawn = times_drawn(frame, x, y, config);
                           if (wanted >= 0 && drawn != wanted)
                             return at(x, y, text("drawn %d times, not %d", drawn, wanted));
                         }
                       return "";
                     },
                     line({a.x, a.y + 48}, {b.x + 48, b.y + 48})});
  }
  for (const double size : {1.0, 1.5, 2.0, 3.0, 5.25, 8.0, 16.0, 31.0})
    for (const Corner p : {Corner{251, 243}, Corner{256, 256}, Corner{8, 200}}) {
      const auto point = [](Corner c, double s) {
        return raster_head() + text("state point_size %g\n", s) + vertex(c) + "p 0\n";
      };
      cases.push_back({text("points/%g_at_%d_%d", size, p.x, p.y), point(p, size),
                       [p, size](const Framebuffer& frame, const Config& config) -> std::string {
                         for (int y = 0; y < frame.height; ++y)
                           for (int x = 0; x < frame.width; ++x) {
                             const double dx = x + .5 - p.x / 16.0, dy = y + .5 - p.y / 16.0;
                             const bool is_in = dx >= -size / 2 && dx < size / 2 && dy >= -size / 2 && dy < size / 2;
                             if (const int drawn = times_drawn(frame, x, y, config); drawn != (is_in ? 1 : 0))
                               return at(x, y, text("drawn %d times", drawn));
                           }
                         return "";
                       },
                       point(p, size + 2)});
    }
  return cases;
}

}  // namespace halfplane::judges
