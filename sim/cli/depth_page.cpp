// The JSON of `halfplane depth`, its pictures and its page.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "sim/cli/depth_study.hpp"
#include "sim/show/image/color_map.hpp"
#include "sim/show/image/panel.hpp"
#include "sim/show/image/picture.hpp"
#include "sim/show/image/png.hpp"
#include "sim/show/report/page.hpp"
#include "sim/study/depth/theory.hpp"

namespace halfplane {

HALFPLANE_JSON_OF_MEMBERS(DepthRow, mapping, format, near, far, z, metric, value)  // null for infinity
HALFPLANE_JSON_OF_MEMBERS(CodeShare, from, to, codes, share)
HALFPLANE_JSON_OF_MEMBERS(DepthCurve, z, bin_width, max_recon_err, first_order)
HALFPLANE_JSON_OF_MEMBERS(DepthSweep::Line, name, x, rate)
HALFPLANE_JSON_OF_MEMBERS(DepthSweep, what, unit, lines)

namespace {

constexpr std::array<Rgb, 4> kFightColors{kNotCompared, {0x4a, 0x55, 0x60}, {0xf2, 0xbf, 0x4b}, {0xe0, 0x45, 0x2b}};

/// One pixel per block of factor x factor: color(worst), with `worst` the largest of key(value).
template <class Value, class Key, class Color>
Picture reduced(int width, int height, std::span<const Value> values, int max_width, Key&& key, Color&& color) {
  const int factor = (width + max_width - 1) / max_width;
  Picture picture((width + factor - 1) / factor, (height + factor - 1) / factor);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      double worst = -1;
      for (int j = y * factor; j < std::min(height, (y + 1) * factor); ++j)
        for (int i = x * factor; i < std::min(width, (x + 1) * factor); ++i)
          worst = std::max(
              worst,
              key(values[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)]));
      set_pixel(picture, x, y, color(worst));
    }
  return picture;
}

/// Magnitudes from `low` (dark) to `high` (bright) on a logarithmic scale; NaN, for undrawn pixels, is grey. A picture
/// wider than `max_width` is reduced by a whole factor; each pixel then shows the worst of its block.
Picture error_map(int width, int height, std::span<const float> errors, double low, double high, int max_width) {
  return reduced(
      width, height, errors, max_width, [](float e) { return std::isnan(e) ? -1.0 : static_cast<double>(std::abs(e)); },
      [low, high](double worst) {
        if (worst < 0) return kNotCompared;
        return sequential_color(worst <= low ? 0.0 : std::log(worst / low) / std::log(high / low));
      });
}

/// 0 background, 1 overlapping and in order, 2 a tie, 3 an inversion; likewise reduced.
Picture fight_map(int width, int height, std::span<const std::uint8_t> fights, int max_width) {
  return reduced(
      width, height, fights, max_width, [](std::uint8_t f) { return static_cast<double>(f); },
      [](double worst) { return kFightColors[static_cast<std::size_t>(std::max(worst, 0.0))]; });
}

/// Null if no error was measured.
Json depth_part_json(const ErrorMoments& m) {
  const auto known = [&m](double value) { return or_null(m.count != 0, value); };
  return {{"max", known(m.max)}, {"rms", known(m.rms)}};
}

Json measured_json(const DepthMeasurement& m) {
  Json decades = Json::array();
  for (const DepthDecade& d : m.decades)
    decades.push_back({{"from", d.from},
                       {"to", d.to},
                       {"fragments", d.error.count},
                       {"max", d.error.max},
                       {"rms", d.error.rms},
                       {"mean", d.error.mean},
                       {"p999", d.error.p999},
                       {"bound", d.bound},
                       {"worst_share_of_bound", d.worst_share},
                       {"parts",
                        {{"snap", depth_part_json(d.snap)},
                         {"interpolation", depth_part_json(d.interpolation)},
                         {"storage", depth_part_json(d.storage)}}}});
  return {{"fragments", m.fragments},
          {"beyond", m.beyond},
          {"eye_min", m.eye_min},
          {"eye_max", m.eye_max},
          {"pairs", m.order.pairs},
          {"ties", m.order.ties},
          {"inversions", m.order.inversions},
          {"rate", or_null(m.order.pairs != 0, m.order.rate())},
          {"fighting_pixels", m.order.fighting_pixels},
          {"nearest_fight", or_null(m.order.fights() != 0, m.order.nearest_fight)},
          {"worst_share_of_bound", or_null(m.total.count != 0, m.worst_share)},
          {"stage_mismatches", m.stage_mismatches},
          {"parts",
           {{"snap", depth_part_json(m.snap)},
            {"interpolation", depth_part_json(m.interpolation)},
            {"storage", depth_part_json(m.storage)},
            {"total", depth_part_json(m.total)}}},
          {"decades", decades}};
}

/// One series of the report: a mapping and a format, without measurements.
Json series_json(const DepthVariant& variant, const DepthQuestion& question) {
  const ExactDepth theory(variant.mapping, variant.format, question.near, question.far);
  std::vector<NamedDepth> asked;
  for (const std::string& z : question.z) asked.push_back({parse_decimal(z, "--z"), std::stod(z)});
  Json exceeds = Json::array();
  const double far = question.planes[1];
  std::vector<double> lengths;
  for (int power = -6; power <= -2; ++power)
    lengths.push_back(std::pow(10.0, std::floor(std::log10(far) + 0.5) + power));
  if (question.length) lengths.push_back(*question.length);
  std::sort(lengths.begin(), lengths.end());
  for (const double length : lengths) {
    const auto z = theory.first_exceeding(length, question.near, question.far);
    exceeds.push_back({{"length", length}, {"z", z}});
  }
  const DepthEncode encode(variant.config, variant.planes);
  const bool is_turned = is_reversed(variant.mapping);
  return {{"name", variant.name()},
          {"mapping", mapping_name(variant.mapping)},
          {"format", to_string(variant.format)},
          {"storage_bits", variant.format.bits},
          {"plane_bits", variant.config.depth_bits},
          {"order", is_turned ? "greater" : "less"},
          {"clear_code", encode.of_window(is_turned ? 0 : 1)},
          {"hardware", hardware_cost(variant)},
          {"codes_used", codes_in_use(theory)},
          {"curve", depth_curve(theory, 181, asked)},
          {"decades", codes_by_decade(theory)},
          {"exceeds", exceeds},
          {"measured", nullptr}};
}

std::string data_uri(const Picture& picture) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::vector<std::uint8_t> bytes = encode_png(picture);
  std::string text = "data:image/png;base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// The same scale for the errors of every variant: four whole decades that end above the largest p99.9.
ScaleLegend map_scale(const std::vector<DepthMeasurement>& measured) {
  double high = 0;
  for (const DepthMeasurement& m : measured) high = std::max(high, m.total.p999);
  if (!(high > 0)) high = 1;
  ScaleLegend scale = log_scale(high / 1e6, high, "in eye depth", "not drawn");
  scale.is_cut = true;  // an error may be 0
  return scale;
}

const std::vector<std::string> kFightLegend{"grey: two surfaces or more, in order", "yellow: two with the same code",
                                            "red: two that are swapped"};

const std::vector<std::string> kHeatLegend{"error of the visible surface, in eye depth",
                                           "the scale is logarithmic, and one for all"};

/// Pictures of all variants on one sheet, with the meaning of their colours.
void write_depth_sheet(const std::string& path, const std::string& title, const std::vector<std::string>& legend,
                       const std::vector<DepthVariant>& variants, const std::vector<Picture>& pictures,
                       const std::vector<std::string>& notes, const Legend& scale) {
  if (path.empty()) return;
  std::vector<Panel> panels;
  for (std::size_t i = 0; i < variants.size(); ++i)
    panels.push_back({variants[i].name(), notes[i], pictures[i], scale, {}});
  panels.push_back({"colours", "", {}, {}, legend});
  write_png(path, compose_sheet(title, panels, std::min(3, static_cast<int>(panels.size()))));
}

/// A scene's variants as pictures, with captions.
struct DepthPictures {
  std::vector<Picture> heats, fights;
  std::vector<std::string> heat_notes, fight_notes;
};

DepthPictures depth_pictures(const Scene& scene, const SceneStudy& study, const ScaleLegend& scale) {
  constexpr int kMaxWidth = 640;
  DepthPictures pictures;
  for (const DepthMeasurement& m : study.measured) {
    pictures.heats.push_back(error_map(scene.width, scene.height, m.error, scale.low, scale.range, kMaxWidth));
    pictures.fights.push_back(fight_map(scene.width, scene.height, m.fights, kMaxWidth));
    pictures.heat_notes.push_back(m.total.count == 0 ? "no error measured"
                                                     : "all fragments: max " + short_text(m.total.max) + ", rms " +
                                                           short_text(m.total.rms));
    pictures.fight_notes.push_back(m.order.pairs == 0
                                       ? "no pair of fragments overlaps"
                                       : std::to_string(m.order.ties) + " ties, " + std::to_string(m.order.inversions) +
                                             " swaps of " + std::to_string(m.order.pairs) + " pairs");
  }
  return pictures;
}

}  // namespace

Json study_json(const DepthQuestion& question, const std::vector<DepthRow>& rows,
                const std::vector<DepthVariant>& variants, const SceneStudy& study) {
  Json series = Json::array(), trials = Json::array();
  for (std::size_t i = 0; i < variants.size(); ++i) {
    series.push_back(series_json(variants[i], question));
    if (!study.measured.empty()) series.back()["measured"] = measured_json(study.measured[i]);
  }
  for (const DepthTrial& trial : study.trials)
    trials.push_back({{"what", trial.what},
                      {"options", trial.options},
                      {"name", trial.variant.name()},
                      {"measured", measured_json(trial.result)}});
  Json fewest = Json::array();
  for (const FewestBits& f : study.fewest)
    fewest.push_back({{"mapping", mapping_name(f.mapping)},
                      {"bits", f.bits},
                      {"pairs", f.pairs},
                      {"rate", f.rate},
                      {"rate_one_less", f.one_less},
                      {"rtl", f.is_in_rtl}});
  return {{"rows", rows},
          {"series", series},
          {"trials", trials},
          {"sweeps", study.sweeps},
          {"fight_rate", question.fight_rate},
          {"fewest_bits", fewest},
          {"answers", study.answers}};
}

void write_depth_files(const DepthPaths& paths, const std::string& title, const DepthQuestion& question,
                       const Json& result, const Scene* scene, const std::vector<DepthVariant>& variants,
                       const SceneStudy& study) {
  Json page = result;
  page["version"] = HALFPLANE_VERSION;
  page["config"] = label(question.config);
  if (scene != nullptr && !study.measured[0].error.empty()) {
    const ScaleLegend scale = map_scale(study.measured);
    const DepthPictures pictures = depth_pictures(*scene, study, scale);
    write_depth_sheet(paths.heat, title, kHeatLegend, variants, pictures.heats, pictures.heat_notes, scale);
    write_depth_sheet(paths.fights, title, kFightLegend, variants, pictures.fights, pictures.fight_notes, {});
    const DepthMeasurement& first = study.measured[0];
    page["scene"] = {{"name", result["scene"]},      {"width", scene->width},        {"height", scene->height},
                     {"fragments", first.fragments}, {"triangles", first.triangles}, {"eye_min", first.eye_min},
                     {"eye_max", first.eye_max}};
    page["heat_legend"] = joined(kHeatLegend, "; ");
    page["heat_scale"] = data_uri(scale_picture(scale, 640));
    page["fight_legend"] = joined(kFightLegend, "; ");
    for (std::size_t i = 0; i < variants.size(); ++i) {
      page["series"][i]["measured"]["heat"] = data_uri(pictures.heats[i]);
      page["series"][i]["measured"]["fight"] = data_uri(pictures.fights[i]);
    }
  }
  if (!paths.page.empty()) write_page(paths.page, kDepthPage, page);
}

}  // namespace halfplane
