#include "layers.hpp"

#include <algorithm>
#include <cmath>

#include "model/golden/golden.hpp"
#include "model/stages/fragment_ops.hpp"

namespace halfplane {
namespace {

/// Error bound of a factor of the real colours, 0...1, made from a stored colour with an error of `color` 255ths, and
/// `alpha` for its alpha.
double factor_error(BlendFactor factor, std::size_t channel, double color, double alpha) {
  switch (factor) {
    case BlendFactor::dst_color:
    case BlendFactor::one_minus_dst_color: return color / 255;
    case BlendFactor::dst_alpha:
    case BlendFactor::one_minus_dst_alpha: return alpha / 255;
    case BlendFactor::src_alpha_saturate: return channel == 3 ? 0 : alpha / 255;
    default: return 0;
  }
}

}  // namespace

void add_row(std::vector<LayerRow>& rows, const LayerRow& row) {
  const auto same = std::ranges::find_if(rows, [&row](const LayerRow& r) { return r.layers >= row.layers; });
  if (same == rows.end() || same->layers != row.layers) {
    rows.insert(same, row);
    return;
  }
  const double squares =
      same->rms * same->rms * static_cast<double>(same->pixels) + row.rms * row.rms * static_cast<double>(row.pixels);
  same->pixels += row.pixels;
  same->rms = std::sqrt(squares / static_cast<double>(same->pixels));
  same->max = std::max(same->max, row.max);
  same->bound = std::max(same->bound, row.bound);
  same->part_of_bound = std::max(same->part_of_bound, row.part_of_bound);
}

LayeredColors::LayeredColors(std::size_t pixels, ColorFormat format)
    : format_(format), most_{}, channels_(static_cast<std::size_t>(golden::channel_count(format))), at_(pixels) {
  const auto max = golden::channel_max(format);
  for (std::size_t c = 0; c < 4; ++c) most_[c] = max[c];
}

void LayeredColors::clear(std::size_t pixel, const std::array<double, 4>& color) {
  Pixel& at = at_[pixel];
  at = {};
  at.real = color;
  if (channels_ == 3) at.real[3] = 255;
  at.bound.fill(1);  // to 8 bits, then to the stored ones
  for (std::size_t c = 0; c < 4; ++c) at.is_certain[c] = color[c] == std::floor(color[c]);
}

double LayeredColors::bound_of_blend(const Pixel& before, const State& state, const golden::RealColor& source,
                                     std::size_t c) const {
  const bool is_narrow = format_ == ColorFormat::rgb565;
  const auto error_of = [&](std::size_t channel) {  // 255ths, as seen by the blend
    if (is_narrow && channel == 3) return 0.0;
    return before.bound[channel] * 255 / most_[channel] + (is_narrow ? 0.5 : 0.0);
  };
  const double d = before.real[c], e = error_of(c), alpha = error_of(3);
  double error = e;  // for min and max
  const BlendEquation equation = state.blend_equation[c == 3 ? 1 : 0];
  if (equation != BlendEquation::min && equation != BlendEquation::max) {
    const BlendFactors& f = *state.blend;
    golden::RealColor constant{};
    for (std::size_t i = 0; i < 4; ++i) constant[i] = state.blend_color[i];
    const BlendFactor of_source = c == 3 ? f.src_alpha : f.src, of_stored = c == 3 ? f.dst_alpha : f.dst;
    const double weight = golden::factor_value(of_stored, c, source, before.real, constant);
    error = e * weight + (d + e) * factor_error(of_stored, c, e, alpha) +
            source[c] * factor_error(of_source, c, e, alpha) + 0.5;
  }
  const double stored = error * most_[c] / 255 + (is_narrow ? (state.dither ? 1.0 : 0.5) : 0.0);
  return std::min(stored, most_[c]);
}

void LayeredColors::bound_logic_op(Pixel& at, const Pixel& before, const State& state, double source,
                                   std::size_t c) const {
  struct Codes {
    int low, high;
  };
  const int most = static_cast<int>(most_[c]);
  const auto within = [&](double value, double bound, bool is_certain) {
    constexpr double kTiny = 1e-4;  // more than a binary32 bound is off by, less than a code of 255 is from a tie
    if (is_certain) bound = 0.5 - kTiny;
    const Codes codes{static_cast<int>(std::ceil(value - bound - kTiny)),
                      static_cast<int>(std::floor(value + bound + kTiny))};
    return Codes{std::max(codes.low, 0), std::min(codes.high, most)};
  };
  const bool dithers = state.dither && format_ == ColorFormat::rgb565;
  const Codes s = within(source * most_[c] / 255, 1 - 1e-3, !dithers),
              d = within(before.real[c] * most_[c] / 255, before.bound[c], before.is_certain[c]);
  const int wanted = golden::nearest_code(at.real[c], most);
  int worst = 0;
  for (int i = s.low; i <= s.high; ++i)
    for (int j = d.low; j <= d.high; ++j)
      worst = std::max(worst, std::abs(golden::operated(state.logic_op, i, j, most) - wanted));
  at.is_certain[c] = worst == 0;
  at.bound[c] = static_cast<float>(worst * (1 + 1e-6) + 1e-6);  // and the error of a code in binary64
}

void LayeredColors::write(std::size_t pixel, const State& state, const std::array<std::uint8_t, 4>& color) {
  Pixel& at = at_[pixel];
  const ColorOps ops = color_ops(state, format_);
  golden::RealColor source{};
  for (std::size_t c = 0; c < 4; ++c) source[c] = color[c];
  const Pixel before = at;
  at.real = golden::blended(state, source, before.real, format_ == ColorFormat::rgba8888);
  if (channels_ == 3) at.real[3] = 255;
  for (std::size_t c = 0; c < channels_; ++c) {
    if (!state.color_mask[c]) continue;
    if (ops.logic != LogicOp::copy) {
      bound_logic_op(at, before, state, source[c], c);
      continue;
    }
    at.is_certain[c] = !ops.blends() && !ops.dithers;
    at.bound[c] = static_cast<float>(ops.blends() ? bound_of_blend(before, state, source, c) : ops.dithers ? 1.0 : 0.5);
  }
  at.layers = ops.reads_stored() ? before.layers + 1 : 0;
  at.is_layered = !ops.is_plain();
}

void LayeredColors::judge(std::size_t pixel, std::uint32_t stored) {
  const Pixel& at = at_[pixel];
  if (rows_.size() <= at.layers) rows_.resize(at.layers + std::size_t{1});
  LayerRow& row = rows_[at.layers];
  double worst = 0;
  for (std::size_t c = 0; c < channels_; ++c) {
    const double code = golden::stored_channel(stored, format_, static_cast<int>(c));
    const double error = std::abs(code - at.real[c] * most_[c] / 255);
    worst = std::max(worst, error);
    row.bound = std::max(row.bound, static_cast<double>(at.bound[c]));
    row.part_of_bound = std::max(row.part_of_bound, error / at.bound[c]);
  }
  row.layers = at.layers;
  ++row.pixels;
  row.max = std::max(row.max, worst);
  row.rms += worst * worst;
}

std::vector<LayerRow> LayeredColors::rows() const {
  std::vector<LayerRow> rows;
  for (LayerRow row : rows_) {
    if (row.pixels == 0) continue;
    row.rms = std::sqrt(row.rms / static_cast<double>(row.pixels));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace halfplane
