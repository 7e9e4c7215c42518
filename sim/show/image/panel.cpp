#include "sim/show/image/panel.hpp"

#include <algorithm>
#include <cmath>

#include "sim/show/image/color_map.hpp"

namespace halfplane {

namespace {

// Indexed by CoverageClass. The three faults: hues of Okabe and Ito's palette, distinguishable for colour-blind readers
// too.
constexpr std::array<PixelKind, 5> kClasses{{{kNotCompared, "neither", 0},
                                             {{0x6e, 0x75, 0x80}, "both", 1},
                                             {{0xf0, 0x6a, 0x1e}, "missing", 3},
                                             {{0x56, 0xb4, 0xe9}, "extra", 4},
                                             {{0xf0, 0xe4, 0x42}, "other primitive", 2}}};

int reduction(int width, int height) { return (std::max(width, height) + kMaxPanelSide - 1) / kMaxPanelSide; }

std::string reduction_note(int factor) {
  if (factor == 1) return "";
  const std::string n = std::to_string(factor);
  return ", worst of " + n + "x" + n;
}

// Calls merge(target index, source index) for every source pixel, in blocks of factor x factor.
template <typename Merge>
void for_each_in_blocks(int width, int height, int factor, Merge merge) {
  const int reduced_width = (width + factor - 1) / factor;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      merge(static_cast<std::size_t>(y / factor) * static_cast<std::size_t>(reduced_width) +
                static_cast<std::size_t>(x / factor),
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
}

Picture reduced_canvas(int width, int height, int factor) {
  return Picture((width + factor - 1) / factor, (height + factor - 1) / factor, kNotCompared);
}

void store(Picture& picture, std::size_t pixel, Rgb color) {
  picture.rgb[3 * pixel] = color.r;
  picture.rgb[3 * pixel + 1] = color.g;
  picture.rgb[3 * pixel + 2] = color.b;
}

struct ErrorStatistics {
  std::size_t compared = 0, beyond = 0;
  double max = 0, mean = 0, rms = 0;  // max of the magnitudes
  double range = 1;                   // end of the scale
};

ErrorStatistics measure(std::span<const float> errors) {
  ErrorStatistics result;
  std::vector<float> magnitudes;
  double sum = 0, squares = 0;
  for (const float error : errors) {
    if (std::isnan(error)) continue;
    magnitudes.push_back(std::abs(error));
    sum += error;
    squares += static_cast<double>(error) * error;
  }
  result.compared = magnitudes.size();
  if (magnitudes.empty()) return result;
  const auto count = static_cast<double>(magnitudes.size());
  result.mean = sum / count;
  result.rms = std::sqrt(squares / count);
  result.max = *std::max_element(magnitudes.begin(), magnitudes.end());
  const auto most = magnitudes.begin() + static_cast<std::ptrdiff_t>((count - 1) * 0.995);
  std::nth_element(magnitudes.begin(), most, magnitudes.end());
  const bool outliers = *most > 0 && result.max > 4 * *most;  // 4: a larger factor would cost the rest its contrast
  result.range = nice_ceiling(outliers ? *most : result.max);
  for (const float magnitude : magnitudes)
    if (magnitude > result.range) ++result.beyond;
  return result;
}

std::string error_note(const ErrorStatistics& statistics, bool diverging, std::string_view figures) {
  if (statistics.compared == 0) return "no pixel compared";
  std::string text(figures);
  if (figures.empty()) {
    text = "max " + short_number(statistics.max) + "  rms " + short_number(statistics.rms);
    if (diverging) text += "  mean " + short_number(statistics.mean);
  }
  if (statistics.beyond > 0) text += "  beyond scale: " + std::to_string(statistics.beyond);
  return text;
}

}  // namespace

Panel kinds_panel(std::string_view caption, int width, int height, std::span<const std::uint8_t> kinds,
                  std::span<const PixelKind> styles) {
  const int factor = reduction(width, height);
  Panel panel;
  panel.caption = std::string(caption) + reduction_note(factor);
  panel.picture = reduced_canvas(width, height, factor);
  std::vector<std::size_t> counts(styles.size());
  std::vector<int> ranks(panel.picture.rgb.size() / 3, -1);
  for_each_in_blocks(width, height, factor, [&](std::size_t target, std::size_t source) {
    const PixelKind& kind = styles[kinds[source]];
    ++counts[kinds[source]];
    if (kind.rank <= ranks[target]) return;
    ranks[target] = kind.rank;
    store(panel.picture, target, kind.color);
  });
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < styles.size(); ++i)
    if (styles[i].is_listed || counts[i] > 0)
      entries.push_back({styles[i].color, std::string(styles[i].label) + " " + std::to_string(counts[i])});
  panel.legend = std::move(entries);
  return panel;
}

Panel coverage_panel(int width, int height, std::span<const CoverageClass> classes) {
  std::vector<std::uint8_t> kinds(classes.size());
  std::ranges::transform(classes, kinds.begin(), [](CoverageClass of) { return static_cast<std::uint8_t>(of); });
  return kinds_panel("coverage difference, pixels", width, height, kinds, kClasses);
}

Panel picture_panel(std::string_view caption, const Picture& picture) {
  const int factor = reduction(picture.width, picture.height);
  Panel panel;
  panel.caption = caption;
  if (factor > 1) panel.caption += ", reduced 1:" + std::to_string(factor);
  panel.picture = factor > 1 ? shrink(picture, factor) : picture;
  return panel;
}

Panel error_panel(std::string_view caption, int width, int height, std::span<const float> errors, std::string_view unit,
                  bool diverging, std::string_view figures) {
  const int factor = reduction(width, height);
  const ErrorStatistics statistics = measure(errors);
  Panel panel;
  panel.caption = std::string(caption) + ", " + std::string(unit) + reduction_note(factor);
  panel.note = error_note(statistics, diverging, figures);
  panel.picture = reduced_canvas(width, height, factor);
  panel.legend = ScaleLegend{diverging, statistics.range, std::string(unit)};
  std::vector<float> largest(panel.picture.rgb.size() / 3, -1.0f);
  for_each_in_blocks(width, height, factor, [&](std::size_t target, std::size_t source) {
    const float error = errors[source];
    if (std::isnan(error) || std::abs(error) <= largest[target]) return;
    largest[target] = std::abs(error);
    const double t = error / statistics.range;
    store(panel.picture, target, diverging ? diverging_color(t) : sequential_color(std::abs(t)));
  });
  return panel;
}

ScaleLegend log_scale(double least, double high, std::string_view unit, std::string_view rest) {
  ScaleLegend scale{false, 1, std::string(unit), std::string(rest), 0.1};
  if (!(high > 0) || !std::isfinite(high)) return scale;
  // 1e-9: a power of ten is its own end
  const double last = std::ceil(std::log10(high) - 1e-9), first = std::floor(std::log10(least) + 1e-9);
  scale.range = std::pow(10.0, last);
  scale.low = std::pow(10.0, std::clamp(first, last - 4, last - 1));
  scale.is_cut = first < last - 4;
  return scale;
}

Panel log_panel(std::string_view caption, int width, int height, std::span<const float> values, std::string_view unit,
                std::string_view rest) {
  const int factor = reduction(width, height);
  double least = INFINITY, most = 0, sum = 0;
  std::size_t count = 0;
  for (const float value : values) {
    if (!(value > 0)) continue;
    least = std::min<double>(least, value);
    most = std::max<double>(most, value);
    sum += value;
    ++count;
  }
  const ScaleLegend scale = log_scale(least, most, unit, rest);
  Panel panel;
  panel.caption = std::string(caption) + ", logarithmic" + reduction_note(factor);
  panel.note = count == 0 ? "no pixel has any"
                          : "max " + short_number(most) + "  mean " + short_number(sum / static_cast<double>(count)) +
                                " of " + std::to_string(count) + " pixels";
  panel.picture = reduced_canvas(width, height, factor);
  std::vector<float> largest(panel.picture.rgb.size() / 3, 0.0f);
  for_each_in_blocks(width, height, factor, [&](std::size_t target, std::size_t source) {
    const float value = values[source];
    if (!(value > largest[target])) return;
    largest[target] = value;
    store(panel.picture, target, sequential_color(std::log(value / scale.low) / std::log(scale.range / scale.low)));
  });
  panel.legend = scale;
  return panel;
}

std::vector<std::string> panel_names() {
  std::vector<std::string> names(kPanelNames.begin(), kPanelNames.end());
  const auto add = [&names](const auto& more) { names.insert(names.end(), more.begin(), more.end()); };
  add(kTexturePanelNames);
  add(kAgainstPanelNames);
  add(kAffinePanelNames);
  return names;
}

Picture comparison_sheet(const ComparisonSheet& sheet) {
  const int width = sheet.width, height = sheet.height;
  std::vector<NamedPanel> panels{
      {"model", picture_panel("model", sheet.model)},
      {"golden", picture_panel("golden", sheet.golden)},
      {"coverage", coverage_panel(width, height, sheet.coverage)},
      {"depth", error_panel("depth error", width, height, sheet.depth_error, "LSB", true, sheet.depth_figures)},
      {"color", error_panel("colour error, worst channel", width, height, sheet.color_error, "LSB", false,
                            sheet.color_figures)}};
  if (!sheet.summary.empty()) {
    NamedPanel text{"summary", {}};
    text.panel.caption = "summary";
    text.panel.lines = sheet.summary;
    panels.push_back(std::move(text));
  }
  panels.insert(panels.end(), sheet.more.begin(), sheet.more.end());
  std::vector<Panel> shown;
  if (sheet.panels.empty())
    for (NamedPanel& one : panels) shown.push_back(std::move(one.panel));
  for (const std::string& name : sheet.panels) {
    const auto at = std::ranges::find(panels, name, &NamedPanel::name);
    if (at != panels.end()) shown.push_back(at->panel);
  }
  const int columns = sheet.panels.empty() ? (width > 2 * height ? 2 : 3) : std::min(3, static_cast<int>(shown.size()));
  return compose_sheet(sheet.title, shown, columns);
}

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
