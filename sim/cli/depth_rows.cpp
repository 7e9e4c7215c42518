// The rows of `halfplane depth`: theory and measurement, as CSV and as tables.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <ostream>

#include "sim/cli/depth_study.hpp"
#include "sim/show/image/color_map.hpp"
#include "sim/study/depth/error_bound.hpp"
#include "sim/study/depth/measure.hpp"
#include "sim/study/depth/theory.hpp"

namespace halfplane {

std::string depth_number(double value) {
  if (std::isinf(value)) return "inf";
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

std::string short_text(double value) { return formatted("%.3g", value); }

std::string mapping_name(DepthMapping mapping) {
  return std::string(depth_mapping_names()[static_cast<std::size_t>(mapping)]);
}

void add_theory_rows(const DepthQuestion& question, DepthMapping mapping, const DepthFormat& format,
                     const std::function<void(double)>& progress, std::vector<DepthRow>& rows) {
  const ExactDepth theory(mapping, format, question.near, question.far);
  const DepthRow head{mapping_name(mapping), to_string(format), question.near_text, question.far_text, "", "", 0};
  const auto add = [&](const std::string& z, const char* metric, double value) {
    rows.push_back(head);
    rows.back().z = z;
    rows.back().metric = metric;
    rows.back().value = value;
  };
  for (std::size_t i = 0; i < question.z.size(); ++i) {
    const std::string& z = question.z[i];
    const double done = static_cast<double>(i) / static_cast<double>(question.z.size());
    progress(done);
    const DepthFigures figures = theory.at(parse_decimal(z, "--z"));
    add(z, "code", figures.code);
    add(z, "bin_width", figures.bin_width);
    add(z, "max_recon_err", figures.max_recon_err);
    add(z, "first_order", figures.first_order);
    if (!question.view) continue;
    const DepthVariant variant = make_variant(question.config, mapping, format, question.planes);
    const DepthBound bound(variant);
    const double depth = std::stod(z);
    const DepthBound::Separation separation = surface_separation(bound, depth, *question.view);
    add(z, "separation", separation.total());
    add(z, "separation_storage", separation.storage);
    add(z, "separation_datapath", separation.datapath);
    add(z, "separation_snap", separation.snap);
    // Measured: the fraction of overlapping fragments that fight.
    MeasureOptions order_alone;
    order_alone.wants_errors = false;
    order_alone.progress = [&](double) { progress(done); };
    for (const auto& [metric, part] : {std::pair{"fights_at_separation", 1.0}, {"fights_at_half", 0.5}}) {
      const DepthOrder order =
          measure_depth(two_planes(bound, depth, *question.view, part, question.seed), variant, order_alone).order;
      if (part == 1.0) add(z, "pairs_tried", static_cast<double>(order.pairs));
      if (order.pairs > 0) add(z, metric, order.rate());
    }
  }
  if (!question.length) return;
  const Rational low = question.low.value_or(question.near), high = question.high.value_or(question.far);
  add("", "longest_bin", theory.longest_bin(low, high));
  if (const auto z = theory.first_exceeding(*question.length, low, high)) add("", "z_exceeds", *z);
  if (const auto near = best_near(mapping, format, question.far, low, high, *question.length))
    add("", "best_near", *near);
  if (const auto bits = fewest_bits(mapping, question.near, question.far, low, high, *question.length))
    add("", "fewest_bits", *bits);
}

void add_measured_rows(const DepthQuestion& question, const DepthVariant& variant, const DepthMeasurement& m,
                       std::vector<DepthRow>& rows) {
  const auto add = [&](const std::string& z, const char* metric, double value) {
    rows.push_back({mapping_name(variant.mapping), to_string(variant.format), question.near_text, question.far_text, z,
                    metric, value});
  };
  add("", "pairs", static_cast<double>(m.order.pairs));
  add("", "ties", static_cast<double>(m.order.ties));
  add("", "inversions", static_cast<double>(m.order.inversions));
  // Without samples there is neither a rate nor an error: no row.
  if (m.order.pairs > 0) add("", "fight_rate", m.order.rate());
  if (m.total.count > 0) {
    add("", "error_max", m.total.max);
    add("", "error_rms", m.total.rms);
  }
  for (const DepthDecade& d : m.decades) {
    const std::string from = depth_number(d.from);
    add(from, "error_max", d.error.max);
    add(from, "error_rms", d.error.rms);
    add(from, "error_bound", d.bound);
    add(from, "snap_rms", d.snap.rms);
    add(from, "interpolation_rms", d.interpolation.rms);
    add(from, "storage_rms", d.storage.rms);
  }
}

void add_fewest_rows(const DepthQuestion& question, const std::vector<FewestBits>& fewest,
                     std::vector<DepthRow>& rows) {
  for (const FewestBits& f : fewest)
    if (f.bits)
      rows.push_back({mapping_name(f.mapping), "u" + std::to_string(*f.bits), question.near_text, question.far_text, "",
                      "fewest_bits_in_order", static_cast<double>(*f.bits)});
}

std::vector<std::string> length_answers(const DepthQuestion& question) {
  const Rational low = question.low.value_or(question.near), high = question.high.value_or(question.far);
  std::vector<std::pair<int, std::string>> needs;  // bits, variant
  for (std::size_t i = 1; i < depth_mapping_names().size(); ++i) {
    const auto mapping = static_cast<DepthMapping>(i);
    if (const auto bits = fewest_bits(mapping, question.near, question.far, low, high, *question.length))
      needs.emplace_back(*bits, mapping_name(mapping) + " u" + std::to_string(*bits));
  }
  for (const DepthMapping mapping : {DepthMapping::rev, DepthMapping::revinf})
    if (const auto format = smallest_float(mapping, question.near, question.far, low, high, *question.length))
      needs.emplace_back(format->bits, mapping_name(mapping) + " " + to_string(*format));
  std::stable_sort(needs.begin(), needs.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const std::string range = "every step between " + short_text(low.get_d()) + " and " + short_text(high.get_d()) +
                            " at most " + short_text(*question.length) + " long";
  if (needs.empty()) return {"Nothing up to 32 bits makes " + range + "."};
  std::string text = "With the fewest bits, " + needs[0].second + " makes " + range;
  for (std::size_t i = 1; i < needs.size(); ++i) text += (i == 1 ? "; then " : ", ") + needs[i].second;
  return {text + "."};
}

std::string depth_csv(const std::vector<DepthRow>& rows) {
  std::string text = "mapping,format,near,far,z,metric,value\n";
  for (const DepthRow& row : rows)
    text += row.mapping + ',' + row.format + ',' + row.near + ',' + row.far + ',' + row.z + ',' + row.metric + ',' +
            depth_number(row.value) + '\n';
  return text;
}

void print_theory(std::ostream& out, const std::vector<DepthRow>& rows) {
  out << "mapping   format         z               code      bin width     max error   first order\n";
  for (std::size_t i = 0; i + 3 < rows.size(); ++i) {
    if (rows[i].metric != "code") continue;
    char line[160];
    std::snprintf(line, sizeof line, "%-9s %-9s %10s %16.0f %14.6g %13.6g %13.6g\n", rows[i].mapping.c_str(),
                  rows[i].format.c_str(), short_number(std::stod(rows[i].z)).c_str(), rows[i].value, rows[i + 1].value,
                  rows[i + 2].value, rows[i + 3].value);
    out << line;
  }
  for (const DepthRow& row : rows)
    if (row.z.empty() || row.metric.starts_with("separation") || row.metric.starts_with("fights") ||
        row.metric == "pairs_tried")
      out << row.mapping << ' ' << row.format << ": " << row.metric << (row.z.empty() ? "" : " at " + row.z) << ' '
          << depth_number(row.value) << '\n';
}

namespace {

void print_sweep(std::ostream& out, const DepthSweep& sweep) {
  out << "\nfighting by " << sweep.what << '\n';
  for (const auto& line : sweep.lines) {
    if (line.x.empty()) continue;
    out << left_aligned(line.name, 10);
    for (std::size_t i = 0; i < line.x.size(); ++i)
      out << "  " << line.x[i] << ": " << short_text(100 * line.rate[i]) << " %";
    out << '\n';
  }
}

}  // namespace

void print_measured(std::ostream& out, const std::vector<DepthVariant>& variants, const SceneStudy& study) {
  out << "\nvariant         fighting        ties       swaps     rms error     max error  of bound\n";
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const DepthMeasurement& m = study.measured[i];
    const auto with = [](bool is_measured, const char* format, double value) {
      return is_measured ? formatted(format, value) : "-";
    };
    const bool has_pairs = m.order.pairs > 0, has_errors = m.total.count > 0;
    out << left_aligned(variants[i].name(), 13) << right_aligned(with(has_pairs, "%.4f %%", 100 * m.order.rate()), 11)
        << right_aligned(with(has_pairs, "%.0f", static_cast<double>(m.order.ties)), 12)
        << right_aligned(with(has_pairs, "%.0f", static_cast<double>(m.order.inversions)), 12)
        << right_aligned(with(has_errors, "%.6g", m.total.rms), 14)
        << right_aligned(with(has_errors, "%.6g", m.total.max), 14)
        << right_aligned(with(has_errors, "%.0f %%", 100 * m.worst_share), 10) << '\n';
  }
  for (const DepthSweep& sweep : study.sweeps)
    if (std::any_of(sweep.lines.begin(), sweep.lines.end(), [](const auto& line) { return !line.x.empty(); }))
      print_sweep(out, sweep);
}

}  // namespace halfplane
