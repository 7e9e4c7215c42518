#include "picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "model/stages/fragment_ops.hpp"
#include "model/widths.hpp"

namespace halfplane::explain {
namespace {

constexpr int kPictureSide = 720;             // pixels of the grid, about
constexpr int kLegendWidth = 400, kGap = 16;  // pixels
constexpr Rgb kPaper{0x16, 0x18, 0x1b}, kInk{0xe8, 0xea, 0xed}, kMuted{0xa3, 0xab, 0xb3}, kGrid{0x55, 0x5c, 0x64};
// The palette of the pages (sim/show/report/page.css), distinguishable with any colour vision.
constexpr std::array<Rgb, 7> kPalette{{{0x4b, 0xa3, 0xe3},
                                       {0xf5, 0x83, 0x3c},
                                       {0x23, 0xc6, 0x99},
                                       {0xe0, 0x8f, 0xc2},
                                       {0xf2, 0xbf, 0x4b},
                                       {0x9f, 0xd6, 0xf7},
                                       {0xc9, 0xce, 0xd3}}};

struct Spot {
  double x = 0, y = 0;  ///< pixels of the target
};

/// A drawn primitive: its first entry in the box.
struct Shown {
  const Entry* entry = nullptr;
  Rgb color;
};

bool is_piece(const Entry& a, const Entry& b) {
  return a.primitive == b.primitive && a.draw == b.draw && a.piece == b.piece && a.kind == b.kind;
}

std::vector<Shown> shown_primitives(const Explanation& around, const Rect& box) {
  std::vector<const Entry*> covering, near;
  const auto add = [](std::vector<const Entry*>& list, const Entry& entry) {
    if (std::ranges::none_of(list, [&](const Entry* other) { return is_piece(*other, entry); })) list.push_back(&entry);
  };
  for (const PixelHistory& pixel : around.pixels) {
    if (!is_in(box, pixel.at)) continue;
    for (const Entry& entry : pixel.history) {
      if (entry.kind == Kind::clear || entry.corners.empty()) continue;
      add(near, entry);
      if (has_fragment(entry.specification.verdict)) add(covering, entry);
    }
  }
  std::vector<Shown> shown;
  for (const Entry* entry : covering.empty() ? near : covering)
    shown.push_back({entry, kPalette[shown.size() % kPalette.size()]});
  return shown;
}

/// The grid, and the mapping of target positions to it.
struct Canvas {
  Picture picture;
  Window window;
  int scale = 1;  ///< of the picture per pixel

  [[nodiscard]] int at_x(double x) const { return static_cast<int>(std::lround((x - window.left) * scale)); }
  [[nodiscard]] int at_y(double y) const { return static_cast<int>(std::lround((y - window.top) * scale)); }
};

/// The visible part of the segment; none if invisible (Liang and Barsky).
std::optional<std::array<Spot, 2>> visible_part(const Spot& a, const Spot& b, const Window& window) {
  double from = 0, to = 1;
  const auto clip = [&](double direction, double room) {
    if (direction == 0) return room >= 0;
    const double t = room / direction;
    direction < 0 ? from = std::max(from, t) : to = std::min(to, t);
    return from <= to;
  };
  const double dx = b.x - a.x, dy = b.y - a.y, left = window.left - 1, top = window.top - 1;
  const double right = window.left + window.width + 1, bottom = window.top + window.height + 1;
  if (!clip(-dx, a.x - left) || !clip(dx, right - a.x) || !clip(-dy, a.y - top) || !clip(dy, bottom - a.y)) return {};
  return std::array<Spot, 2>{Spot{a.x + from * dx, a.y + from * dy}, Spot{a.x + to * dx, a.y + to * dy}};
}

/// `is_snapped`: a line two wide; otherwise dots.
void draw_edge(Canvas& canvas, const Spot& a, const Spot& b, Rgb color, bool is_snapped) {
  const auto part = visible_part(a, b, canvas.window);
  if (!part) return;
  const auto [p, q] = *part;
  const int x0 = canvas.at_x(p.x), y0 = canvas.at_y(p.y), x1 = canvas.at_x(q.x), y1 = canvas.at_y(q.y);
  if (is_snapped) {
    draw_line(canvas.picture, x0, y0, x1, y1, color);
    const bool is_flat = std::abs(x1 - x0) > std::abs(y1 - y0);
    draw_line(canvas.picture, x0 + (is_flat ? 0 : 1), y0 + (is_flat ? 1 : 0), x1 + (is_flat ? 0 : 1),
              y1 + (is_flat ? 1 : 0), color);
    return;
  }
  const int steps = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
  for (int i = 0; i <= steps; i += 5)
    fill_rect(canvas.picture, {x0 + (x1 - x0) * i / std::max(1, steps), y0 + (y1 - y0) * i / std::max(1, steps), 2, 2},
              color);
}

void draw_outline(Canvas& canvas, const std::vector<Spot>& corners, Rgb color, bool is_snapped) {
  if (corners.size() == 1) return draw_edge(canvas, corners[0], corners[0], color, is_snapped);
  const std::size_t edges = corners.size() == 2 ? 1 : corners.size();
  for (std::size_t i = 0; i < edges; ++i)
    draw_edge(canvas, corners[i], corners[(i + 1) % corners.size()], color, is_snapped);
}

void draw_primitive(Canvas& canvas, const Shown& shown, int grid_bits) {
  const Entry& entry = *shown.entry;
  std::vector<Spot> snapped, real;
  for (const SnappedVertex& v : entry.corners)
    snapped.push_back({std::ldexp(v.x, -grid_bits), std::ldexp(v.y, -grid_bits)});
  if (entry.kind == Kind::point && !snapped.empty()) {
    const Spot at = snapped[0];
    const double half = std::ldexp(entry.point_size, -grid_bits - 1);
    snapped.clear();
    const int corners = entry.point_shape == PointShape::round ? 48 : 4;
    const double reach = corners == 4 ? half * std::numbers::sqrt2 : half;  // from the centre to a corner
    for (int i = 0; i < corners; ++i) {
      const double angle = (2 * i + 1) * std::numbers::pi / corners;
      snapped.push_back({at.x + reach * std::cos(angle), at.y + reach * std::sin(angle)});
    }
  }
  if (entry.golden && entry.golden->outline)
    for (std::size_t i = 0; i < entry.golden->outline->corners; ++i)
      real.push_back({entry.golden->outline->x[i], entry.golden->outline->y[i]});
  const Rgb c = shown.color;
  if (entry.kind != Kind::point)
    draw_outline(canvas, real,
                 {static_cast<std::uint8_t>(c.r / 2 + 127), static_cast<std::uint8_t>(c.g / 2 + 127),
                  static_cast<std::uint8_t>(c.b / 2 + 127)},
                 false);
  draw_outline(canvas, snapped, c, true);
}

Rgb stored_rgb(std::uint32_t color, ColorFormat format) {
  const auto c = unpack_color(format, color);
  if (format == ColorFormat::rgba8888)
    return {static_cast<std::uint8_t>(c[0]), static_cast<std::uint8_t>(c[1]), static_cast<std::uint8_t>(c[2])};
  return {static_cast<std::uint8_t>(c[0] << 3 | c[0] >> 2), static_cast<std::uint8_t>(c[1] << 2 | c[1] >> 4),
          static_cast<std::uint8_t>(c[2] << 3 | c[2] >> 2)};
}

/// The stored colours and the grid.
void draw_pixels(Canvas& canvas, const Explanation& around, const Rect& box, const Config& config) {
  const int scale = canvas.scale;
  for (const PixelHistory& pixel : around.pixels) {
    if (pixel.sample != 0) continue;
    const int x = canvas.at_x(pixel.at.x), y = canvas.at_y(pixel.at.y);
    const Stored& stored = pixel.resolved ? pixel.resolved->model : pixel.model;
    fill_rect(canvas.picture, {x, y, scale, scale}, stored_rgb(stored.color, config.color_format));
    frame_rect(canvas.picture, {x, y, scale + 1, scale + 1}, kGrid);
  }
  const Rect frame{canvas.at_x(box.x), canvas.at_y(box.y), box.width * scale + 1, box.height * scale + 1};
  frame_rect(canvas.picture, frame, kInk);
  frame_rect(canvas.picture, {frame.x + 1, frame.y + 1, frame.width - 2, frame.height - 2}, kPaper);
}

/// A dot at each sample, and a mark around it for each covering primitive: number n in one of eight places.
void draw_samples(Canvas& canvas, const Explanation& around, const std::vector<Shown>& shown) {
  constexpr std::array<std::array<int, 2>, 8> kPlaces{
      {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}, {0, -1}, {0, 1}, {-1, 0}, {1, 0}}};
  const int room = around.samples == 1 ? canvas.scale : canvas.scale / (around.samples < 8 ? 2 : 3);
  const int mark = std::max(3, room / 12), step = mark + 2;  // next to the dot
  for (const PixelHistory& pixel : around.pixels) {
    const int x = canvas.at_x(pixel.at.x + std::ldexp(pixel.place.x, -kPatternFraction)),
              y = canvas.at_y(pixel.at.y + std::ldexp(pixel.place.y, -kPatternFraction));
    fill_rect(canvas.picture, {x - 2, y - 2, 5, 5}, kPaper);
    fill_rect(canvas.picture, {x - 1, y - 1, 3, 3}, kInk);
    for (std::size_t n = 0; n < shown.size(); ++n)
      for (const Entry& entry : pixel.history) {
        if (!is_piece(entry, *shown[n].entry) || !has_fragment(entry.specification.verdict)) continue;
        const auto& place = kPlaces[n % kPlaces.size()];
        const Rect at{x + place[0] * step - mark / 2, y + place[1] * step - mark / 2, mark, mark};
        fill_rect(canvas.picture, {at.x - 1, at.y - 1, mark + 2, mark + 2}, kPaper);
        fill_rect(canvas.picture, at, shown[n].color);
      }
  }
}

std::string shown_text(const Entry& entry, int samples) {
  return "#" + std::to_string(entry.primitive.value_or(0)) + " " +
         std::string(kKindNames[static_cast<std::size_t>(entry.kind)]) +
         (entry.piece != 0 ? " piece " + std::to_string(entry.piece) : "") +
         (samples == 1 ? ": " + std::string(info(entry.outcome.verdict).name) : std::string());
}

void draw_legend(Picture& sheet, int x, int y, const std::vector<Shown>& shown, int samples, int height) {
  const auto line = [&](const std::string& text, Rgb color) {
    for (const std::string& part : wrap_text(text, kLegendWidth, 1)) {
      draw_text(sheet, x, y, part, color, 1);
      y += text_height(1) + 4;
    }
  };
  line(samples == 1 ? "white dot: the sample of a pixel" : "white dots: the samples of a pixel", kInk);
  line("lines: edges after the snap; dots: before it", kInk);
  line("squares: primitives that cover the sample, in the colours below, visible or hidden", kInk);
  y += text_height(1);
  for (std::size_t n = 0; n < shown.size(); ++n) {
    if (y > height - 3 * text_height(1)) {
      line("and " + std::to_string(shown.size() - n) + " more", kMuted);
      return;
    }
    line(shown_text(*shown[n].entry, samples), shown[n].color);
  }
}

}  // namespace

bool is_in(const Rect& box, Pixel at) {
  return at.x >= box.x && at.x < box.x + box.width && at.y >= box.y && at.y < box.y + box.height;
}

Window window_around(const Rect& box, int margin, const Scene& scene) {
  const int left = std::max(0, box.x - margin), top = std::max(0, box.y - margin);
  const int right = std::min(scene.width, box.x + box.width + margin);
  const int bottom = std::min(scene.height, box.y + box.height + margin);
  return {left, top, right - left, bottom - top};
}

Picture neighbourhood_picture(const Explanation& around, const Window& window, const Rect& box, const Config& config,
                              std::string_view title) {
  const int scale = std::clamp(kPictureSide / std::max(window.width, window.height), 6, 96);
  Canvas canvas{Picture(window.width * scale + 1, window.height * scale + 1, kPaper), window, scale};
  const std::vector<Shown> shown = shown_primitives(around, box);
  draw_pixels(canvas, around, box, config);
  const int grid_bits = derive_widths(config).grid_bits;
  for (const Shown& one : shown) draw_primitive(canvas, one, grid_bits);
  draw_samples(canvas, around, shown);
  const int top = 2 * kGap + text_height(2);
  const int height = std::max(canvas.picture.height, 200);
  Picture sheet(canvas.picture.width + kLegendWidth + 3 * kGap, height + top + kGap, kPaper);
  draw_text(sheet, kGap, kGap, title, kInk, 2);
  draw_picture(sheet, canvas.picture, kGap, top);
  draw_legend(sheet, canvas.picture.width + 2 * kGap, top, shown, around.samples, top + height);
  return sheet;
}

}  // namespace halfplane::explain
