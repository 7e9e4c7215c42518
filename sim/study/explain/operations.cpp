#include "figures.hpp"

#include "model/draw_states.hpp"
#include "model/stages/fragment_ops.hpp"

namespace halfplane::explain {
namespace {

using Result = std::optional<Verdict>;  ///< none: the fragment continues

int color_bits(const FragmentAtWork& f) { return f.context.config.color_format == ColorFormat::rgb565 ? 16 : 32; }

Figure channels(std::string_view name, const std::array<std::uint32_t, 4>& color) {
  return {name, {color.begin(), color.end()}, 8};
}
Figure channels(std::string_view name, const Texel& color) { return {name, {color.begin(), color.end()}, 8}; }

std::string_view word_of(std::string_view state, const State& of) {
  const DrawState& row = draw_state(state);
  return row.words[row.value(of).word];
}

bool is_encoded(const FragmentAtWork& f) { return !f.context.depth_encode.is_identity(); }
Result encode(FragmentAtWork& f, OperationStep& step) {
  const int bits = f.context.depth_encode.format().bits;
  step.figures = {{"plane", {f.plane_depth}, f.context.config.depth_bits}, {"code", {f.depth}, bits}};
  return {};
}

const Stencil* stencil_of(const FragmentAtWork& f) {
  const auto& sides = f.context.fragment_ops.stencil;
  return sides ? &(*sides)[f.is_back ? 1 : 0] : nullptr;
}
bool changes_stencil(const FragmentAtWork& f) {
  const Stencil* stencil = stencil_of(f);
  return stencil != nullptr && writes_stencil(*stencil);
}
/// The test that drops the fragment.
Result failed_test(const FragmentAtWork& f) {
  return !f.passes_stencil ? Result(Verdict::stencil) : !f.passes_depth ? Result(Verdict::depth) : Result{};
}
/// A failed fragment has no further effect: no stencil value changes.
Result failed_for_good(const FragmentAtWork& f) { return changes_stencil(f) ? Result{} : failed_test(f); }

bool has_stencil(const FragmentAtWork& f) { return stencil_of(f) != nullptr; }
Result test_stencil(FragmentAtWork& f, OperationStep& step) {
  const Stencil& s = *stencil_of(f);
  step.figures = {{"func", {}, 0, draw_state("depth_test").words[static_cast<std::size_t>(s.func)]},
                  {"reference", {s.reference}, 8},
                  {"read", {s.read_mask}, 8},
                  {"stored", {f.stored.stencil}, 8}};
  f.passes_stencil =
      depth_passes(s.func, std::uint32_t{s.reference} & s.read_mask, std::uint32_t{f.stored.stencil} & s.read_mask);
  step.passes = f.passes_stencil;
  return f.passes_stencil ? Result{} : failed_for_good(f);
}

bool always(const FragmentAtWork&) { return true; }
Result test_depth(FragmentAtWork& f, OperationStep& step) {
  const int bits = f.context.depth_encode.format().bits;
  const DepthFunc func = f.context.fragment_ops.state.depth_test;
  step.figures = {{"func", {}, 0, draw_state("depth_test").words[static_cast<std::size_t>(func)]},
                  {"fragment", {f.depth}, bits},
                  {"stored", {f.stored.depth}, bits}};
  f.passes_depth = depth_passes(func, f.depth, f.stored.depth);
  step.passes = f.passes_depth;
  return failed_for_good(f);
}

bool tests_alpha(const FragmentAtWork& f) { return f.context.fragment_ops.alpha.func != DepthFunc::always; }
bool covers_by_alpha(const FragmentAtWork& f) { return f.context.fragment_ops.alpha_samples != 0; }
/// The fate of a fragment dropped by its alpha.
Result dropped_by_alpha(const FragmentAtWork& f) {
  const Result failed = failed_test(f);
  return failed ? failed : Result(Verdict::alpha);
}
Result test_alpha(FragmentAtWork& f, OperationStep& step) {
  const AlphaTest& test = f.context.fragment_ops.alpha;
  step.figures = {{"func", {}, 0, draw_state("depth_test").words[static_cast<std::size_t>(test.func)]},
                  {"fragment", {f.color[3]}, 8},
                  {"reference", {test.reference}, 8}};
  f.passes_alpha = depth_passes(test.func, f.color[3], std::uint32_t{test.reference});
  step.passes = f.passes_alpha;
  return f.passes_alpha ? Result{} : dropped_by_alpha(f);
}
Result cover_by_alpha(FragmentAtWork& f, OperationStep& step) {
  const auto samples = static_cast<std::uint32_t>(f.context.fragment_ops.alpha_samples);
  step.figures = {{"fragment", {f.color[3]}, 8},
                  {"samples_drawn", {samples_of_alpha(f.color[3], samples)}, 4},
                  {"sample", {f.sample}, 3}};
  step.passes = is_drawn_by_alpha(f.context.fragment_ops.alpha_samples, f.color[3], f.sample);
  return *step.passes ? Result{} : dropped_by_alpha(f);
}

Result change_stencil(FragmentAtWork& f, OperationStep& step) {
  const Stencil& s = *stencil_of(f);
  const StencilOp op = !f.passes_stencil ? s.stencil_fails : f.passes_depth ? s.passes : s.depth_fails;
  const auto after = apply_stencil(op, s, std::uint32_t{f.stored.stencil});
  step.figures = {{"before", {f.stored.stencil}, 8}, {"write", {s.write_mask}, 8}, {"after", {after}, 8}};
  f.stored.stencil = static_cast<std::uint8_t>(after);
  return failed_test(f);
}

bool writes_color(const FragmentAtWork& f) { return f.context.fragment_ops.state.color_write; }
bool is_seen(const FragmentAtWork& f) {
  return tests_alpha(f) || covers_by_alpha(f) || (writes_color(f) && !failed_test(f));
}
bool is_lit(const FragmentAtWork& f) { return f.surface != nullptr && f.context.phong && is_seen(f); }
Result add_light(FragmentAtWork& f, OperationStep& step) {
  const SurfaceSample& sample = f.surface->sample;
  step.figures = {{"diffuse", {sample.light.diffuse}, kLightFraction + 1},
                  {"specular", {sample.light.specular}, kLightFraction + 1},
                  channels("before", f.color)};
  for (std::size_t c = 0; c < 4; ++c) f.color[c] = sample.lit[c];
  step.figures.push_back(channels("after", f.color));
  return {};
}
bool is_textured(const FragmentAtWork& f) { return f.surface != nullptr && !f.surface->texture.empty() && is_seen(f); }
Result texture(FragmentAtWork& f, OperationStep& step) {
  const SurfaceSample& sample = f.surface->sample;
  step.figures = {{"combine", {}, 0, word_of("texture_combine", f.context.state)},
                  channels("before", f.color),
                  channels("texel", sample.texel)};
  const State& state = f.context.state;
  if (const auto& [r, g, b] = state.texture_constant; state.texture_combine == TextureCombine::blend)
    step.figures.push_back(channels("constant", Texel{r, g, b, 255}));
  for (std::size_t c = 0; c < 4; ++c) f.color[c] = sample.clear[c];
  step.figures.push_back(channels("after", f.color));
  return {};
}

bool is_fogged(const FragmentAtWork& f) { return f.surface != nullptr && f.context.fog && is_seen(f); }
Result add_fog(FragmentAtWork& f, OperationStep& step) {
  const SurfaceSample& sample = f.surface->sample;
  const FogTable& fog = *f.context.fog;
  const auto kind = static_cast<std::size_t>(fog.fog().kind);
  step.figures = {{"kind", {}, 0, draw_state("fog").numbers[0].words[kind]},
                  {"factor", {sample.fog}, kFogFactorBits + 1},
                  {"fog", {fog.color().begin(), fog.color().end()}, 8},
                  channels("before", f.color)};
  for (std::size_t c = 0; c < 4; ++c) f.color[c] = sample.color[c];
  step.figures.push_back(channels("after", f.color));
  return {};
}

bool blends(const FragmentAtWork& f) { return writes_color(f) && f.context.fragment_ops.color.blends(); }
Result blend(FragmentAtWork& f, OperationStep& step) {
  const auto stored = widen_color(f.context.config.color_format, f.stored.color);
  step.figures = {channels("before", f.color), channels("stored", stored)};
  f.color = blended(f.context.fragment_ops.color, f.color, stored);
  step.figures.push_back(channels("after", f.color));
  return {};
}
Result pack(FragmentAtWork& f, OperationStep& step) {
  const ColorOps& ops = f.context.fragment_ops.color;
  const auto threshold = dither_threshold(f.at.x, f.at.y);
  f.packed = ops.dithers ? pack_rgb565_dithered(f.color[0], f.color[1], f.color[2], threshold)
                         : pack_color(f.context.config.color_format, f.color);
  step.figures = {channels("before", f.color)};
  if (ops.dithers) step.figures.push_back({"threshold", {threshold}, 4});
  step.figures.push_back({"after", {f.packed}, color_bits(f)});
  return {};
}

bool has_logic_op(const FragmentAtWork& f) {
  return writes_color(f) && f.context.fragment_ops.color.logic != LogicOp::copy;
}
Result operate(FragmentAtWork& f, OperationStep& step) {
  step.figures = {{"op", {}, 0, word_of("logic_op", f.context.state)},
                  {"before", {f.packed}, color_bits(f)},
                  {"stored", {f.stored.color}, color_bits(f)}};
  const std::uint32_t all = f.context.config.color_format == ColorFormat::rgb565 ? 0xffffU : ~0U;
  f.packed = operated(LogicTerms(f.context.fragment_ops.color.logic), f.packed, f.stored.color) & all;
  step.figures.push_back({"after", {f.packed}, color_bits(f)});
  return {};
}

bool writes_depth(const FragmentAtWork& f) { return f.context.fragment_ops.state.depth_write; }
Result write_depth(FragmentAtWork& f, OperationStep& step) {
  const int bits = f.context.depth_encode.format().bits;
  step.figures = {{"before", {f.stored.depth}, bits}, {"after", {f.depth}, bits}};
  f.stored.depth = f.depth;
  return {};
}
Result write_color(FragmentAtWork& f, OperationStep& step) {
  const std::uint32_t bits = written_bits(f.context.fragment_ops.color, f.context.config.color_format);
  const std::uint32_t after = write_where(bits, f.packed, f.stored.color);
  step.figures = {{"before", {f.stored.color}, color_bits(f)}};
  if (f.context.fragment_ops.color.writes != ColorOps{}.writes) step.figures.push_back({"mask", {bits}, color_bits(f)});
  step.figures.push_back({"after", {after}, color_bits(f)});
  f.stored.color = after;
  return {};
}

/// In program order of a fragment. `stage`: the hardware stage that executes it.
struct Operation {
  std::string_view name;
  Stage stage;
  bool (*is_of)(const FragmentAtWork&);
  Result (*run)(FragmentAtWork&, OperationStep&);
};
constexpr Operation kOperations[] = {
    {"depth_encode", Stage::interpolate, is_encoded, encode},
    {"stencil_test", Stage::depth_test, has_stencil, test_stencil},
    {"depth_test", Stage::depth_test, always, test_depth},
    {"light", Stage::texture_unit, is_lit, add_light},
    {"texture", Stage::texture_unit, is_textured, texture},
    {"fog", Stage::rop, is_fogged, add_fog},
    {"alpha_test", Stage::depth_test, tests_alpha, test_alpha},
    {"alpha_to_coverage", Stage::depth_test, covers_by_alpha, cover_by_alpha},
    {"write_stencil", Stage::depth_test, changes_stencil, change_stencil},
    {"blend", Stage::rop, blends, blend},
    {"pack_color", Stage::rop, writes_color, pack},
    {"logic_op", Stage::rop, has_logic_op, operate},
    {"write_depth", Stage::framebuffer, writes_depth, write_depth},
    {"write_color", Stage::framebuffer, writes_color, write_color},
};

}  // namespace

Outcome run_operations(FragmentAtWork& fragment, std::vector<OperationStep>& steps) {
  fragment.depth = fragment.context.depth_encode(fragment.plane_depth);
  for (const Operation& operation : kOperations) {
    if (!operation.is_of(fragment)) continue;
    OperationStep& step = steps.emplace_back(OperationStep{operation.name, operation.stage, {}, {}});
    if (const Result verdict = operation.run(fragment, step)) return Outcome(*verdict);
  }
  if (!fragment.context.fragment_ops.state.writes()) return Outcome(Verdict::masked);
  fragment.stored.owner = static_cast<std::int32_t>(fragment.primitive);
  return Outcome(Verdict::written);
}

}  // namespace halfplane::explain
