// The comparison picture: panels with captions and legends on one dark sheet.
//
// Pixels stay whole: small pictures are enlarged by an integer factor, pictures wider or higher than kMaxPanelSide are
// reduced by one, and then a pixel of a difference panel shows the worst of its block, so that no difference is lost.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sim/show/image/coverage_class.hpp"
#include "sim/show/image/picture.hpp"

namespace halfplane {

inline constexpr int kMaxPanelSide = 2048;            // pixels
inline constexpr Rgb kNotCompared{0x2c, 0x2e, 0x33};  // neutral: on neither colour map

/// A colour with its meaning.
struct LegendEntry {
  Rgb color;
  std::string label;
};

/// The colours of a scale from low to high.
struct ScaleLegend {
  bool diverging = true;  ///< -range...range, otherwise 0...range
  double range = 1;
  std::string unit;
  std::string rest = "not compared";  ///< meaning of pixels off the scale
  double low = 0;                     ///< > 0: logarithmic low...range; smaller values have the colour of `low`
  bool is_cut = false;                ///< some value is less than `low`
};

/// A number next to a scale; `at` is its place, 0...1.
struct ScaleTick {
  double at = 0;
  std::string label;
};

/// The numbers that fit next to a bar of that many pixels; the last one has the unit.
[[nodiscard]] std::vector<ScaleTick> scale_ticks(const ScaleLegend& scale, int bar);

/// A scale alone, for pages with their own pictures.
[[nodiscard]] Picture scale_picture(const ScaleLegend& scale, int width);

using Legend = std::variant<std::monostate, std::vector<LegendEntry>, ScaleLegend>;

/// One cell of a sheet. Without a picture it shows its lines as text; lines with tabs form a table. Text that is wider
/// than its cell is wrapped.
struct Panel {
  std::string caption;
  std::string note;  ///< below the picture: statistics
  Picture picture;
  Legend legend;
  std::vector<std::string> lines;
};

/// A kind of pixels in a panel.
struct PixelKind {
  Rgb color;
  std::string_view label;
  int rank = 0;           ///< the higher rank wins when a block is reduced to one pixel
  bool is_listed = true;  ///< listed in the legend even without such pixels
};

/// Colours and counts of kinds. `kinds` contains width * height indices into `styles`.
[[nodiscard]] Panel kinds_panel(std::string_view caption, int width, int height, std::span<const std::uint8_t> kinds,
                                std::span<const PixelKind> styles);

/// Colours and counts of the classes. `classes` holds width * height values.
[[nodiscard]] Panel coverage_panel(int width, int height, std::span<const CoverageClass> classes);

/// Signed errors on the diverging map, or with `diverging` false magnitudes on the sequential one. NaN: not compared,
/// shown dark. The scale ends at a round number above all values; if a few outliers would flatten the rest, above 99.5
/// % of them, and the note counts the outliers. `figures` begins the note in place of the pixels' own max, rms and
/// mean: the figures given elsewhere for the same errors.
[[nodiscard]] Panel error_panel(std::string_view caption, int width, int height, std::span<const float> errors,
                                std::string_view unit, bool diverging, std::string_view figures = {});

/// Magnitudes on the sequential map on a logarithmic scale, in at most four whole decades. 0 is `rest`.
[[nodiscard]] Panel log_panel(std::string_view caption, int width, int height, std::span<const float> values,
                              std::string_view unit, std::string_view rest);

/// The scale of log_panel() for values up to `high`; `least`: the smallest value that counts.
[[nodiscard]] ScaleLegend log_scale(double least, double high, std::string_view unit, std::string_view rest);

/// How often each sample was drawn: shows cracks and double draws. `counts` contains width * height values.
[[nodiscard]] Panel draws_panel(int width, int height, std::span<const std::uint32_t> counts);

/// A picture alone; a picture that is too large is reduced, as the caption says.
[[nodiscard]] Panel picture_panel(std::string_view caption, const Picture& picture);

/// Panels in rows of `columns`, aligned, under one title. Columns share a width and rows a height.
[[nodiscard]] Picture compose_sheet(std::string_view title, std::span<const Panel> panels, int columns);

/// A panel with its name for selection.
struct NamedPanel {
  std::string_view name;  ///< one of panel_names()
  Panel panel;
};

/// All panels that `compare` shows of one scene. All vectors contain width * height values, row 0 at the top.
struct ComparisonSheet {
  std::string title;  ///< scene, configuration and size
  int width = 0, height = 0;
  Picture model, golden;
  std::vector<CoverageClass> coverage;
  std::vector<float> depth_error;            ///< signed, LSB; NaN where not compared
  std::vector<float> color_error;            ///< largest absolute error of the channels, LSB; NaN where not compared
  std::string depth_figures, color_figures;  ///< the errors in `summary`; empty: the pixels' own
  std::vector<std::string> summary;          ///< the sixth cell: figures and bounds, one per line; left out when empty
  std::vector<NamedPanel> more;              ///< textures, another image, interpolation; shown after the six
  std::vector<std::string> panels;           ///< names of the panels to show, in this order; empty: all
};

/// The panels of a comparison sheet, and additional ones: for textures, for another image, for affine interpolation.
inline constexpr std::array<std::string_view, 6> kPanelNames{"model", "golden", "coverage",
                                                             "depth", "color",  "summary"};
inline constexpr std::array<std::string_view, 5> kTexturePanelNames{"coordinate", "footprints", "level", "weights",
                                                                    "rounding"};
inline constexpr std::array<std::string_view, 3> kAgainstPanelNames{"against", "difference", "kinds"};
inline constexpr std::array<std::string_view, 3> kAffinePanelNames{"perspective", "affine", "affine_coordinate"};

[[nodiscard]] std::vector<std::string> panel_names();

/// Colour picture and draws panel side by side.
[[nodiscard]] Picture draws_sheet(std::string_view title, const Picture& color, std::span<const std::uint32_t> counts);

/// Colour picture, `values` of each pixel (for example cycles) and draws panel side by side.
[[nodiscard]] Picture heat_sheet(std::string_view title, const Picture& color, std::span<const float> values,
                                 std::string_view unit, std::span<const std::uint32_t> counts);

[[nodiscard]] Picture comparison_sheet(const ComparisonSheet& sheet);

}  // namespace halfplane
