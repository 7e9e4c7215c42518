// Replays the fragments of a scene through operations with arithmetic other than the pipeline's.
#include <algorithm>

#include "against_hypotheses.hpp"
#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/stages/cull.hpp"
#include "model/stages/depth_encode.hpp"
#include "model/stages/fragment_ops.hpp"

namespace halfplane {
namespace {

constexpr std::size_t kReplayedTogether = 5;  // framebuffers at a time, 9 bytes a pixel each
constexpr int kDitherSide = 4;                // of the matrix

using Products = ForeignArithmetic::Products;

/// Combines two products of codes of 8 bits; the divisor of a product is 255.
std::uint32_t sum_of_products(Products products, BlendEquation equation, std::uint32_t a, std::uint32_t b) {
  const auto divided = [products](std::uint32_t value) {
    return products == Products::shifted ? value >> 8
           : products == Products::cut   ? value / 255
                                         : divide_by_255<std::uint32_t>(value);
  };
  const bool is_apart = products == Products::rounded_apart;
  const auto difference = [&](std::uint32_t of, std::uint32_t less) {
    if (is_apart) return std::max(divided(of), divided(less)) - divided(less);
    return divided(std::max(of, less) - less);
  };
  switch (equation) {
    case BlendEquation::subtract: return difference(a, b);
    case BlendEquation::reverse_subtract: return difference(b, a);
    default: return std::min(is_apart ? divided(a) + divided(b) : divided(a + b), 255U);
  }
}

Channels<std::uint32_t> blended_by(Products products, const ColorOps& ops, const Channels<std::uint32_t>& source,
                                   const Channels<std::uint32_t>& stored) {
  auto result = blended(ops, source, stored);
  for (std::size_t c = 0; c < 4; ++c) {
    const BlendEquation equation = ops.equation[c == 3 ? 1 : 0];
    if (equation == BlendEquation::min || equation == BlendEquation::max) continue;
    const auto factor = [&](BlendFactor of) {
      return blend_factor<std::uint32_t>(of, c, source, stored, ops.constant);
    };
    const BlendFactors& f = ops.factors;
    result[c] = sum_of_products(products, equation, source[c] * factor(c == 3 ? f.src_alpha : f.src),
                                stored[c] * factor(c == 3 ? f.dst_alpha : f.dst));
  }
  return result;
}

/// Colours of rgb565 with their upper bits stored.
Channels<std::uint32_t> cut_to_codes(const Channels<std::uint32_t>& c) {
  return widen_color<std::uint32_t>(ColorFormat::rgb565, c[0] >> 3 << 11 | c[1] >> 2 << 5 | c[2] >> 3);
}

/// A framebuffer whose operations have other arithmetic.
struct ForeignTarget {
  ForeignArithmetic arithmetic;
  Rendering rendering;

  void clear(const Scene& scene, Clear command, const Config& config) {
    if (arithmetic.cuts_codes && command.color) {
      const auto cut =
          cut_to_codes(unpack_color(ColorFormat::rgba8888, clear_color(*command.color, ColorFormat::rgba8888)));
      std::copy(cut.begin(), cut.end(), command.color->begin());
    }
    halfplane::clear(rendering, scene, command, config);
  }

  void apply(FragmentOps ops, ColorFormat format, TestedFragment fragment, Channels<std::uint32_t> color) {
    Framebuffer& frame = rendering.frame;
    const std::size_t at = frame.at(fragment.x, fragment.y);
    fragment.x += arithmetic.dither_x;
    fragment.y += arithmetic.dither_y;
    const bool cuts = arithmetic.cuts_codes && !ops.color.dithers;
    const bool blends = arithmetic.products != Products::rounded && ops.color.blends();
    if ((cuts || blends) && depth_passes(ops.alpha.func, color[3], ops.alpha.reference)) {
      ops.alpha = {};  // it has tested the source's alpha
      if (ops.color.blends())
        color = blended_by(arithmetic.products, ops.color, color, widen_color(format, frame.color[at]));
      if (cuts) color = cut_to_codes(color);
      ops.color.factors = {};
      ops.color.equation = {};
    }
    (void)apply_fragment(ops, format, fragment, [&color] { return color; },
                         {frame.depth[at], frame.color[at], frame.stencil[at]});
  }
};

class Replay {
 public:
  Replay(const HypothesisScene& of, const std::vector<ForeignArithmetic>& arithmetic)
      : of_(of), config_(with_alpha(of.config, of.scene)), encode_(config_, of.scene.planes) {
    const Rendering empty = make_rendering(of.scene, config_, {});
    for (const ForeignArithmetic& one : arithmetic) targets_.push_back({one, empty});
  }

  std::vector<ImageValues> run() && {
    RenderOptions options;
    options.rules = of_.rules;
    options.skip = skip_none();
    options.fragment_tap = [this](const TappedFragment& fragment) { add(fragment); };
    (void)render_scalar(of_.scene, of_.config, options);
    clears_before(of_.scene.commands.size());
    std::vector<ImageValues> images;
    for (const ForeignTarget& target : targets_)
      images.push_back(image_values(target.rendering.frame, config_.color_format, of_.is_depth));
    return images;
  }

 private:
  void clears_before(std::size_t command) {
    for (; next_command_ < command; ++next_command_)
      if (const auto* clear = std::get_if<Clear>(&of_.scene.commands[next_command_]))
        for (ForeignTarget& target : targets_) target.clear(of_.scene, *clear, config_);
  }

  void add(const TappedFragment& fragment) {
    clears_before(fragment.draw);
    const State& state = of_.scene.states[std::get<Draw>(of_.scene.commands[fragment.draw]).state];
    PerPlane<std::uint32_t> code{};
    for (std::size_t p = 0; p < code.size(); ++p) code[p] = fragment.plane[p].code;
    Channels<std::uint32_t> color = color_channels(code);
    if (config_.alpha_units == 0) color[3] = 255;
    if (fragment.surface)
      for (std::size_t c = 0; c < 4; ++c) color[c] = fragment.surface->color[c];
    TestedFragment tested{encode_(code[kDepthPlane]), fragment.x, fragment.y};
    if (fragment.triangle != nullptr) {
      const auto& v = fragment.triangle->v;
      tested.is_back = shows_back(signed_area(v[0], v[1], v[2]), state.front);
    }
    const FragmentOps ops = fragment_ops(state, config_.color_format);
    for (ForeignTarget& target : targets_) target.apply(ops, config_.color_format, tested, color);
  }

  const HypothesisScene& of_;
  const Config config_;
  const DepthEncode encode_;
  std::vector<ForeignTarget> targets_;
  std::size_t next_command_ = 0;
};

}  // namespace

std::optional<std::vector<ImageValues>> replay(const HypothesisScene& of, const ImageValues& expected,
                                               const std::vector<ForeignArithmetic>& arithmetic) {
  std::vector<ForeignArithmetic> with_own{ForeignArithmetic{}};
  with_own.insert(with_own.end(), arithmetic.begin(), arithmetic.end());
  std::vector<ImageValues> images = Replay(of, with_own).run();
  if (images.front() != expected) return {};
  images.erase(images.begin());
  return images;
}

std::vector<ReplayGroup> replay_groups(const HypothesisScene& of) {
  std::vector<ReplayGroup> groups;
  if (of.is_depth) return groups;
  const auto add = [&groups](ForeignDifference kind, std::string change, const ForeignArithmetic& arithmetic) {
    if (groups.empty() || groups.back().arithmetic.size() + 1 == kReplayedTogether) groups.emplace_back();
    groups.back().kind.push_back(kind);
    groups.back().change.push_back(std::move(change));
    groups.back().arithmetic.push_back(arithmetic);
  };
  const auto is_any = [&of](auto&& has) {
    for (std::size_t s = 0; s < of.scene.states.size(); ++s)
      if (of.is_touched[s] && has(of.scene.states[s])) return true;
    return false;
  };
  if (is_any([](const State& s) { return s.blend.has_value(); })) {
    add(ForeignDifference::blend, "products of blending cut, not rounded", {.products = Products::cut});
    add(ForeignDifference::blend, "products of blending shifted by 8, not divided by 255",
        {.products = Products::shifted});
    add(ForeignDifference::blend, "products of blending rounded one by one", {.products = Products::rounded_apart});
  }
  if (of.config.color_format == ColorFormat::rgb565)
    add(ForeignDifference::color, "codes cut to 5 and 6 bits, not rounded", {.cuts_codes = true});
  if (of.config.color_format == ColorFormat::rgb565 && is_any([](const State& s) { return s.dither; }))
    for (int y = 0; y < kDitherSide; ++y)
      for (int x = 0; x < kDitherSide; ++x)
        if (x != 0 || y != 0)
          add(ForeignDifference::dither,
              "the matrix of dithering moved by " + std::to_string(x) + " " + std::to_string(y),
              {.dither_x = x, .dither_y = y});
  return groups;
}

}  // namespace halfplane
