#include "sim/study/depth/answers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace halfplane {
namespace {

std::string text(const char* format, double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string number(double value) { return text("%.4g", value); }
std::string percent(double part) { return text("%.3g %%", 100 * part); }

DepthFormat unorm(int bits) { return {DepthFormat::Kind::unorm, bits, 0, 0}; }

DepthFormat small_float(int exponent_bits, int bits) {
  return {DepthFormat::Kind::small_float, bits, exponent_bits, bits - exponent_bits};
}

/// A format with one more bit; none if there is no room for it.
std::optional<DepthFormat> wider(DepthFormat format) {
  using Kind = DepthFormat::Kind;
  if (format.kind == Kind::ieee || format.bits >= 32 || (format.is_float() && format.mantissa_bits >= 24))
    return std::nullopt;
  ++format.bits;
  if (format.is_float()) ++format.mantissa_bits;
  return format;
}

struct Trials {
  const DepthVariant& base;
  std::vector<DepthTrial> list;

  /// Leaves out the base itself, and formats that the configuration cannot hold.
  void add(const std::string& what, const std::string& options, const Config& config, DepthMapping mapping,
           const DepthFormat& format, const DepthPlanes& planes) {
    if (mapping == base.mapping && format == base.format && planes == base.planes &&
        config.subpixel_bits == base.config.subpixel_bits)
      return;
    try {
      list.push_back({what, options, make_variant(config, mapping, format, planes), {}});
    } catch (const InputError&) {  // widths that do not fit: not a possible change of this configuration
    }
  }
};

/// The decade with the largest errors: by the sum of squares.
const DepthDecade* worst_decade(const DepthMeasurement& m) {
  const auto weight = [](const DepthDecade& d) {
    return d.error.rms * d.error.rms * static_cast<double>(d.error.count);
  };
  const auto worst =
      std::max_element(m.decades.begin(), m.decades.end(),
                       [&](const DepthDecade& a, const DepthDecade& b) { return weight(a) < weight(b); });
  return worst == m.decades.end() ? nullptr : &*worst;
}

/// Compares fights to a tenth of a percent of the pairs, and then the rms error: a few pairs do not matter.
bool is_better(const DepthMeasurement& a, const DepthMeasurement& b) {
  const auto permille = [](const DepthMeasurement& m) { return std::round(1000 * m.order.rate()); };
  if (permille(a) != permille(b)) return permille(a) < permille(b);
  return a.total.rms < b.total.rms;
}

std::string fights(const DepthMeasurement& m) {
  return (m.order.fights() == 0 ? "" : percent(m.order.rate()) + " fighting, ") + "rms error " + number(m.total.rms);
}

std::string bits_of(const FewestBits& fewest) {
  const std::string name(depth_mapping_names()[static_cast<std::size_t>(fewest.mapping)]);
  if (!fewest.bits) return "32 bits of " + name + " are not enough (" + percent(fewest.rate) + " fight)";
  std::string text = std::to_string(*fewest.bits) + " bits of " + name + " (" + percent(fewest.rate) + " fight";
  if (fewest.one_less) text += "; with " + std::to_string(*fewest.bits - 1) + " bits " + percent(*fewest.one_less);
  return text + ")" + (fewest.is_in_rtl ? "" : ", which the RTL does not store");
}

}  // namespace

std::string fewest_bits_answer(std::span<const FewestBits> fewest, const DepthPlanes& planes, double rate) {
  std::string text = "For fewer than " + percent(rate) + " of " + std::to_string(fewest[0].pairs) +
                     " overlapping pairs of fragments to fight at near " + number(planes[0]) + ": " +
                     bits_of(fewest[0]);
  for (const FewestBits& other : fewest.subspan(1)) text += "; or " + bits_of(other);
  return text + ". Measured on this view: another may need more.";
}

std::vector<DepthTrial> try_changes(const Scene& scene, const DepthVariant& base, const DepthMeasurement& measured,
                                    int threads, const std::function<void(double fraction)>& progress) {
  Trials trials{base, {}};
  const Config& config = base.config;
  const int bits = base.format.bits;
  const auto option = [](DepthMapping mapping, const DepthFormat& format) {
    return "--mapping " + std::string(depth_mapping_names()[static_cast<std::size_t>(mapping)]) + " --format " +
           to_string(format);
  };
  // A hundredth before the nearest sample: its triangle may come nearer between samples.
  if (const double near = 0.99 * measured.eye_min; near > 1.05 * base.planes[0]) {
    const DepthPlanes planes{std::stod(text("%.3g", near)), base.planes[1]};
    trials.add("the near plane at " + number(planes[0]), "--near " + number(planes[0]), config, base.mapping,
               base.format, planes);
  }
  if (bits == 32) {
    trials.add("reversed f32", "--mapping rev --format f32", config, DepthMapping::rev, parse_depth_format("f32"),
               base.planes);
  } else {
    for (const int exponent : {3, 4, 5})
      if (bits - exponent >= 1 && bits - exponent <= 24) {
        const DepthFormat format = small_float(exponent, bits);
        trials.add("reversed " + to_string(format), option(DepthMapping::rev, format), config, DepthMapping::rev,
                   format, base.planes);
      }
  }
  trials.add("w " + to_string(unorm(bits)), option(DepthMapping::w, unorm(bits)), config, DepthMapping::w, unorm(bits),
             base.planes);
  if (const auto format = wider(base.format))
    trials.add("one more bit", "--format " + to_string(*format), config, base.mapping, *format, base.planes);
  Config finer = config;
  finer.subpixel_bits += 2;
  trials.add("two more subpixel bits", "--set subpixel.bits=" + std::to_string(finer.subpixel_bits), finer,
             base.mapping, base.format, base.planes);

  std::vector<DepthVariant> variants;
  for (const DepthTrial& trial : trials.list) variants.push_back(trial.variant);
  MeasureOptions options;
  options.progress = progress;
  auto results = measure_depths(scene, variants, options, threads);
  for (std::size_t i = 0; i < results.size(); ++i) trials.list[i].result = std::move(results[i]);
  std::erase_if(trials.list, [](const DepthTrial& trial) { return !trial.result.is_whole; });
  std::stable_sort(trials.list.begin(), trials.list.end(),
                   [](const DepthTrial& a, const DepthTrial& b) { return is_better(a.result, b.result); });
  return std::move(trials.list);
}

std::vector<std::string> depth_answers(const DepthVariant& base, const DepthMeasurement& measured,
                                       const std::vector<DepthTrial>& trials) {
  std::vector<std::string> answers;
  const DepthOrder& order = measured.order;
  std::string lost = base.name() + " between " + number(base.planes[0]) + " and " + number(base.planes[1]) + ": ";
  if (order.pairs == 0)
    lost += "no two surfaces overlap in a pixel";
  else if (order.fights() == 0)
    lost += "none of " + std::to_string(order.pairs) + " overlapping pairs of fragments fights";
  else
    lost += percent(order.rate()) + " of " + std::to_string(order.pairs) + " overlapping pairs of fragments fight (" +
            std::to_string(order.ties) + " tie, " + std::to_string(order.inversions) + " are swapped), from depth " +
            number(order.nearest_fight) + " on";
  lost += "; eye depth is off by up to " + number(measured.total.max) + " (rms " + number(measured.total.rms) + ")";
  const std::pair<const char*, double> parts[] = {{"the snap of the vertices' x, y and depth", measured.snap.rms},
                                                  {"interpolation", measured.interpolation.rms},
                                                  {"storage", measured.storage.rms}};
  const auto largest =
      std::max_element(std::begin(parts), std::end(parts), [](auto& a, auto& b) { return a.second < b.second; });
  lost += ", mostly by " + std::string(largest->first) + " (rms " + number(largest->second) + ")";
  if (const DepthDecade* worst = worst_decade(measured); worst != nullptr && measured.decades.size() > 1)
    lost += " and mostly between depths " + number(std::max(worst->from, measured.eye_min)) + " and " +
            number(std::min(worst->to, measured.eye_max));
  answers.push_back(lost + ".");
  if (trials.empty()) return answers;

  const DepthTrial& best = trials.front();
  const bool helps = is_better(best.result, measured);
  if (helps)
    answers.push_back("Of what was tried, " + best.what + " (" + best.options + ") helps most: " + fights(best.result) +
                      ", instead of " + fights(measured) + ".");
  else
    answers.push_back("Nothing that was tried is better than this.");
  std::string others;
  for (std::size_t i = helps ? 1 : 0; i < trials.size(); ++i)
    others += (others.empty() ? "The others: " : "; ") + trials[i].what + " (" + trials[i].options +
              "): " + fights(trials[i].result) + (is_better(trials[i].result, measured) ? "" : ", no better");
  if (!others.empty()) answers.push_back(others + ".");
  return answers;
}

std::vector<DepthSweep> sweep_depth(const Scene& scene, const Config& config, const std::vector<DepthMapping>& mappings,
                                    int bits, const DepthPlanes& planes, int threads,
                                    const std::function<void(double fraction)>& progress) {
  std::vector<DepthSweep> sweeps{{"storage bits", "bits", {}}, {"subpixel bits", "bits", {}}};
  std::vector<DepthVariant> variants;
  struct Place {
    std::size_t sweep, line;
    double x;
  };
  std::vector<Place> places;
  const auto add = [&](std::size_t sweep, double x, const Config& base, DepthMapping mapping,
                       const DepthFormat& format) {
    try {
      variants.push_back(make_variant(base, mapping, format, planes));
      places.push_back({sweep, sweeps[sweep].lines.size() - 1, x});
    } catch (const InputError&) {  // impossible in this configuration
    }
  };
  const auto storage_bits = [bits](auto&& visit) {
    for (int b = bits - 6; b <= bits + 6; b += 2)
      if (b >= 8 && b <= 32) visit(b);
  };
  for (const DepthMapping mapping : mappings) {
    const std::string name(depth_mapping_names()[static_cast<std::size_t>(mapping)]);
    sweeps[0].lines.push_back({name + " u", {}, {}});
    storage_bits([&](int b) { add(0, b, config, mapping, unorm(b)); });
    sweeps[1].lines.push_back({name + " u" + std::to_string(bits), {}, {}});
    for (int s = 0; s <= 8; s += 2) {
      Config finer = config;
      finer.subpixel_bits = s;
      add(1, s, finer, mapping, unorm(bits));
    }
  }
  sweeps[0].lines.push_back({"rev uf4", {}, {}});
  storage_bits([&](int b) {
    if (b - 4 <= 24) add(0, b, config, DepthMapping::rev, small_float(4, b));
  });
  MeasureOptions options;
  options.wants_errors = false;
  options.progress = progress;
  const auto results = measure_depths(scene, variants, options, threads);
  bool is_whole = true;
  for (std::size_t i = 0; i < results.size(); ++i) {
    is_whole = is_whole && results[i].is_whole;
    if (!results[i].is_whole) continue;
    if (results[i].order.pairs == 0) continue;  // no overlaps: no rate
    auto& line = sweeps[places[i].sweep].lines[places[i].line];
    line.x.push_back(places[i].x);
    line.rate.push_back(results[i].order.rate());
  }
  if (is_whole) return sweeps;
  for (DepthSweep& sweep : sweeps)
    std::erase_if(sweep.lines, [](const DepthSweep::Line& line) { return line.x.empty(); });
  std::erase_if(sweeps, [](const DepthSweep& sweep) { return sweep.lines.empty(); });
  return sweeps;
}

}  // namespace halfplane
