#include <algorithm>
#include <array>

#include "panel.hpp"

namespace halfplane {
namespace {

/// By number of draws; the last also stands for more. Light on dark, and two draws distinct from both neighbours in
/// hue.
constexpr std::array<Rgb, 4> kColors{Rgb{0x2c, 0x2e, 0x33}, Rgb{0x9a, 0xa3, 0xb2}, Rgb{0xff, 0xa0, 0x2e},
                                     Rgb{0xf0, 0x3c, 0x78}};
constexpr std::array<const char*, 4> kLabels{"not drawn", "once", "twice", "more often"};

}  // namespace

Panel draws_panel(int width, int height, std::span<const std::uint32_t> counts) {
  Panel panel;
  panel.caption = "draws of each sample";
  panel.picture = Picture(width, height, kColors[0]);
  std::array<std::size_t, kColors.size()> pixels{};
  for (std::size_t p = 0; p < counts.size(); ++p) {
    const std::size_t kind = std::min<std::size_t>(counts[p], kColors.size() - 1);
    ++pixels[kind];
    const auto row = static_cast<std::size_t>(width);
    set_pixel(panel.picture, static_cast<int>(p % row), static_cast<int>(p / row), kColors[kind]);
  }
  std::vector<LegendEntry> entries;
  for (std::size_t kind = 0; kind < kColors.size(); ++kind)
    entries.push_back({kColors[kind], std::string(kLabels[kind]) + " " + std::to_string(pixels[kind])});
  panel.legend = std::move(entries);
  return panel;
}

Picture draws_sheet(std::string_view title, const Picture& color, std::span<const std::uint32_t> counts) {
  std::array<Panel, 2> panels{Panel{}, draws_panel(color.width, color.height, counts)};
  panels[0].caption = "model";
  panels[0].picture = color;
  return compose_sheet(title, panels, 2);
}

Picture heat_sheet(std::string_view title, const Picture& color, std::span<const float> values, std::string_view unit,
                   std::span<const std::uint32_t> counts) {
  std::array<Panel, 3> panels{
      Panel{}, log_panel(std::string(unit) + " of each pixel", color.width, color.height, values, unit, "none"),
      draws_panel(color.width, color.height, counts)};
  panels[0].caption = "model";
  panels[0].picture = color;
  return compose_sheet(title, panels, 3);
}

}  // namespace halfplane
