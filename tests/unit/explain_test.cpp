#include "sim/study/explain/explain.hpp"
#include "halfplane_paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>

#include "model/capture/capture.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/hardware.hpp"
#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/golden/golden.hpp"
#include "model/host/texture_memory.hpp"
#include "model/stages/texture_unit.hpp"
#include "sim/config_file.hpp"
#include "sim/cosim/random_scene.hpp"
#include "sim/scene/load.hpp"
#include "sim/scene/random.hpp"
#include "sim/study/explain/line_walk.hpp"
#include "sim/study/explain/verify.hpp"

namespace halfplane::explain::explain_test {
namespace {

constexpr std::uint64_t kSeed = 26;

/// The results of every other path through the program for a scene.
struct Witnesses {
  Rendering functional, scalar, hardware;
  golden::Image golden;
  std::map<std::array<int, 3>, std::vector<TappedFragment>> fragments;  ///< by x, y, sample

  Witnesses(const Scene& scene, const Config& config) {
    RenderOptions options;
    options.want_ids = true;
    functional = render_functional(scene, config, options);
    options.want_count = true;
    options.skip = skip_none();
    options.fragment_tap = [this, &scene, &config](const TappedFragment& f) {
      const State& state = scene.states[std::get<Draw>(scene.commands[f.draw]).state];
      const bool is_drawn = config.msaa_samples == 1 || (state.sample_mask.value_or(~0U) >> f.sample & 1U) != 0;
      if (is_drawn) fragments[{f.x, f.y, f.sample}].push_back(f);
    };
    scalar = render_scalar(scene, config, options);
    try {
      hardware = render_hardware(scene, config);
    } catch (const InputError&) {  // it cannot draw the scene: there is nothing to compare
    }
    golden = golden::render(scene, config);
  }
};

/// The stored values of the sample, where pixels have several.
void expect_stored(const Framebuffer& image, const PixelHistory& pixel, const Stored& stored) {
  const Framebuffer& frame = image.samples.empty() ? image : image.samples[static_cast<std::size_t>(pixel.sample)];
  const std::size_t at = frame.at(pixel.at.x, pixel.at.y);
  EXPECT_EQ(frame.stencil[at], stored.stencil);
  EXPECT_EQ(frame.depth[at], stored.depth);
  EXPECT_EQ(frame.color[at], stored.color);
}

/// Every figure of a pixel that another path computes as well. Returns the number of fragments.
std::size_t expect_told(const PixelHistory& pixel, const Scene& scene, const Witnesses& w) {
  const auto [x, y] = pixel.at;
  const auto p = static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.width) + static_cast<std::size_t>(x);
  expect_stored(w.functional.frame, pixel, pixel.model);
  expect_stored(w.functional.frame, pixel, pixel.engine);
  const auto k = static_cast<std::size_t>(pixel.sample);
  const Owners& owners = w.functional.sample_owners.empty() ? w.functional : w.functional.sample_owners[k];
  EXPECT_EQ(owners.ids[p], pixel.model.owner);
  if (pixel.hardware) expect_stored(w.hardware.frame, pixel, *pixel.hardware);
  const golden::Samples& golden_samples = w.golden.samples.empty() ? w.golden : w.golden.samples[k];
  EXPECT_EQ(golden_samples.depth[p], pixel.golden.depth);
  EXPECT_EQ(golden_samples.color[p], pixel.golden.color);
  EXPECT_EQ(golden_samples.ids[p], pixel.golden.rounded.owner);

  const auto found = w.fragments.find({x, y, pixel.sample});
  const std::vector<TappedFragment> none;
  const std::vector<TappedFragment>& fragments = found == w.fragments.end() ? none : found->second;
  std::size_t next = 0, golden = 0;
  std::int32_t owner = -1;
  for (const Entry& entry : pixel.history) {
    golden += entry.golden && entry.golden->fragment ? 1 : 0;
    if (entry.kind == Kind::clear) {
      if (entry.outcome.verdict == Verdict::written) owner = -1;
      continue;
    }
    if (entry.outcome.verdict == Verdict::written) owner = static_cast<std::int32_t>(*entry.primitive);
    if (!has_fragment(entry.specification.verdict)) {
      EXPECT_TRUE(entry.planes.empty());
      continue;
    }
    if (next == fragments.size()) {
      ADD_FAILURE() << "more fragments are told than there are";
      return next;
    }
    const TappedFragment& fragment = fragments[next++];
    EXPECT_EQ(fragment.primitive, *entry.primitive);
    EXPECT_EQ(fragment.draw, entry.draw);
    if (entry.kind == Kind::triangle && !w.scalar.frame.samples.empty()) {
      EXPECT_EQ(fragment.shaded_at, entry.shaded_at);
    }
    for (std::size_t i = 0; i < entry.planes.size(); ++i) {
      EXPECT_EQ(fragment.plane[i].unrounded, entry.planes[i].unrounded) << entry.planes[i].name;
      EXPECT_EQ(fragment.plane[i].code, entry.planes[i].code) << entry.planes[i].name;
      if (!entry.planes[i].parts) continue;
      const Parts& parts = *entry.planes[i].parts;
      const double total = entry.planes[i].code - *entry.planes[i].golden;
      EXPECT_NEAR(std::ldexp(parts.snap + parts.interpolation + parts.storage, -exact::kGridBits), total, 1e-6);
    }
    if (fragment.surface) {
      EXPECT_EQ(fragment.surface->color, entry.surface->sample.color);
      EXPECT_EQ(fragment.surface->texel, entry.surface->sample.texel);
    }
  }
  EXPECT_EQ(next, fragments.size()) << "fewer fragments are told than there are";
  if (w.golden.samples.empty()) {
    EXPECT_EQ(w.scalar.count[p], fragments.size());
    EXPECT_EQ(w.golden.count[p], golden);
  }
  EXPECT_EQ(owner, pixel.model.owner);
  return next;
}

/// Half of them anywhere, half where something was drawn.
std::vector<Pixel> some_pixels(Random& random, const Scene& scene, const Witnesses& w, std::size_t count) {
  std::vector<Pixel> pixels, drawn;
  for (const auto& [place, list] : w.fragments) drawn.push_back({place[0], place[1]});
  for (std::size_t i = 0; i < count; ++i)
    if (i % 2 == 0 || drawn.empty())
      pixels.push_back({static_cast<int>(random.next() % static_cast<unsigned>(scene.width)),
                        static_cast<int>(random.next() % static_cast<unsigned>(scene.height))});
    else
      pixels.push_back(drawn[random.next() % drawn.size()]);
  return pixels;
}

TEST(Explain, ThousandRandomPixelsAgreeWithImageGoldenAndHardware) {
  std::cout << "seed " << kSeed << '\n';
  Random random(kSeed);
  std::size_t pixels = 0, fragments = 0;
  std::uint64_t checks = 0;
  std::map<std::string_view, int> verdicts;
  for (int scene_number = 0; pixels < 1000; ++scene_number) {
    Config config = preset(std::array{"tiny", "small", "embedded", "full"}[static_cast<std::size_t>(scene_number) % 4]);
    if (scene_number % 3 == 2 && config.cache_kind == CacheKind::blocks) config.frame_order = FrameOrder::bins;
    const std::uint64_t seed = random.next();
    SCOPED_TRACE("halfplane convert --random 150 --config " + config.preset + ", scene seed " + std::to_string(seed));
    const Scene scene = random_scene(config, seed, 150);
    const Witnesses witnesses(scene, config);
    const auto at = some_pixels(random, scene, witnesses, 25);
    const Explanation told = explain(scene, config, at);
    EXPECT_EQ(told.no_hardware, "");
    for (const std::string& difference : told.differences) ADD_FAILURE() << difference;
    checks += told.checks;
    for (const PixelHistory& pixel : told.pixels) {
      SCOPED_TRACE("pixel " + std::to_string(pixel.at.x) + " " + std::to_string(pixel.at.y));
      fragments += expect_told(pixel, scene, witnesses);
      for (const Entry& entry : pixel.history) ++verdicts[info(entry.outcome.verdict).name];
      ++pixels;
    }
    if (HasFailure()) return;
  }
  std::cout << pixels << " pixels, " << fragments << " fragments, " << checks << " figures compared\n";
  for (const auto& [name, count] : verdicts) std::cout << name << ' ' << count << '\n';
  EXPECT_GE(pixels, 1000U);
  EXPECT_GE(fragments, 2000U);
  for (const char* name :
       {"zero_area", "backface", "empty", "scissor", "tiles_outside", "uncovered", "depth", "masked", "written"})
    EXPECT_GT(verdicts[name], 0) << name << " never came";
}

/// Weights add up to 1, and a texel's address is where the texture unit's memory has it.
void expect_texels(const SurfaceFigure& surface, const Scene& scene, const Config& config) {
  if (surface.texture.empty()) return;
  std::uint64_t sum = 0;
  const TextureMemory memory(scene, config);
  for (const TexelFigure& texel : surface.texels) {
    sum += texel.weight;
    if (!texel.address) continue;
    const auto found = std::ranges::find(scene.textures, surface.texture, &Texture::name);
    const TextureFormat format = stored_format(found->format);
    std::array<std::uint8_t, 4> bytes{};
    memory.read(*texel.address, std::span(bytes).first(std::size_t{1} << texel_size_log2(format)));
    const std::uint32_t code = bytes[0] | bytes[1] << 8 | bytes[2] << 16 | std::uint32_t{bytes[3]} << 24;
    EXPECT_EQ(decode_texel(format, code, {}), texel.color);
  }
  EXPECT_EQ(sum, 1U << 24);
}

/// Whether the table of operations has fog, and leaves the surface's colour out. Which alpha it has does not matter.
bool is_told_in_fog(const Entry& entry) {
  for (const OperationStep& step : entry.operations) {
    if (step.name != "fog") continue;
    const SurfaceSample& sample = entry.surface->sample;
    EXPECT_EQ(step.figures[1].values[0], sample.fog);
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_EQ(step.figures[3].values[c], sample.clear[c]);
      EXPECT_EQ(step.figures[4].values[c], sample.color[c]);
    }
    return true;
  }
  return false;
}

/// Scenes that random scenes of the hardware do not include: clip space, clipped pieces, colours over w, textures, fog,
/// edges and corners of triangles, depth formats of the model alone.
TEST(Explain, ScenesOfEveryKindAgreeToo) {
  std::cout << "seed " << kSeed << '\n';
  Random random(kSeed);
  struct Case {
    const char *scene, *preset, *key, *value;
    bool has_fog = false;
  };
  const std::string folder = HALFPLANE_SOURCE_DIR "/docs/texture/";
  std::size_t fragments = 0, textured = 0, over_w = 0, cut = 0, lines = 0, fogged = 0;
  for (const auto& [name, preset_name, key, value, has_fog] : {Case{"city", "embedded", "depth.bits", "16"},
                                                               {"city", "full", "depth.bits", "24"},
                                                               {"walk", "embedded", "depth.bits", "16"},
                                                               {"walk", "full", "frame.order", "bins"},
                                                               {"wireframe", "embedded", "frame.order", "bins"},
                                                               {"star", "small", "depth.bits", "16"},
                                                               {"teapot:2", "embedded", "depth.format", "uf4.12"},
                                                               {"floor.hpt", "full", "texture.unit", "off"},
                                                               {"hardware.hpt", "embedded", "texture.unit", "bilinear"},
                                                               {"floor.hpt", "embedded", "texture.unit", "trilinear"},
                                                               {"floor.hpt", "embedded", "depth.bits", "16", true},
                                                               {"walk", "full", "depth.bits", "24", true},
                                                               {"wall.hpt", "embedded", "texture.unit", "off"}}) {
    SCOPED_TRACE(name);
    Config config = preset(preset_name);
    set_by_key(config, key, value);
    const bool is_capture = std::string_view(name).ends_with(".hpt");
    std::vector<std::string> warnings;
    const SceneRequest request{is_capture ? folder + name : name, is_capture ? 0 : 160, is_capture ? 0 : 120, "", 1};
    Scene scene = load_scene(request, warnings);
    if (config.frame_order == FrameOrder::bins && scene.name == "walk")
      for (State& state : scene.states) state.color_interp = ColorInterp::perspective;
    for (State& state : scene.states)
      if (has_fog) state.fog = Fog{FogKind::exp2, 0.2, 0.2}, state.fog_color = {200, 100, 50};
    const Witnesses witnesses(scene, config);
    const Explanation told = explain(scene, config, some_pixels(random, scene, witnesses, 60));
    for (const std::string& difference : told.differences) ADD_FAILURE() << difference;
    for (const PixelHistory& pixel : told.pixels) {
      SCOPED_TRACE("pixel " + std::to_string(pixel.at.x) + " " + std::to_string(pixel.at.y));
      fragments += expect_told(pixel, scene, witnesses);
      for (const Entry& entry : pixel.history) {
        textured += entry.surface && !entry.surface->texture.empty() ? 1 : 0;
        over_w += entry.surface && entry.surface->texture.empty() ? 1 : 0;
        cut += entry.is_cut ? 1 : 0;
        if (entry.surface) expect_texels(*entry.surface, scene, config);
        lines += entry.kind == Kind::line ? 1 : 0;
        fogged += is_told_in_fog(entry) ? 1 : 0;
      }
    }
    if (HasFailure()) return;
  }
  std::cout << fragments << " fragments, " << textured << " textured, " << cut << " of clipped pieces, " << lines
            << " lines, " << over_w << " over w, " << fogged << " in fog\n";
  EXPECT_GT(fragments, 300U);
  EXPECT_GT(textured, 50U);
  EXPECT_GT(cut, 10U);
  EXPECT_GT(lines, 50U);
  EXPECT_GT(over_w, 10U);
  EXPECT_GT(fogged, 30U);
}

TEST(Explain, StencilsOfTheHardwareAgreeToo) {
  std::cout << "seed " << kSeed << '\n';
  Random random(kSeed);
  Config config = preset("embedded");
  config.stencil_bits = 8;
  config.alpha_units = 1;
  std::size_t changed = 0, failed = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    config.frame_order = seed % 4 == 0 ? FrameOrder::bins : FrameOrder::program;
    SCOPED_TRACE("scene seed " + std::to_string(seed));
    const Scene scene = random_scene(config, seed, 80);
    const Witnesses witnesses(scene, config);
    const Explanation told = explain(scene, config, some_pixels(random, scene, witnesses, 30));
    for (const std::string& difference : told.differences) ADD_FAILURE() << difference;
    for (const PixelHistory& pixel : told.pixels) {
      ASSERT_TRUE(pixel.hardware.has_value());
      EXPECT_EQ(pixel.hardware->stencil, pixel.model.stencil);
      for (const Entry& entry : pixel.history) {
        failed += entry.specification.verdict == Verdict::stencil ? 1 : 0;
        for (const OperationStep& step : entry.operations)
          changed += entry.kind != Kind::clear && step.name == "write_stencil" ? 1 : 0;
      }
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(changed, 100U);
  EXPECT_GT(failed, 50U);
}

TEST(Explain, AWideLineNearADiagonalMayLieAlongTheOtherAxisInTheGolden) {
  const Scene scene = read_capture(
      "halfplane 1\ntarget 64 64\nclear color 0 0 0 255 depth 1\nspace window\nstate line_width 31\nv 20 20 .5\nv 40 "
      "40.01 "
      ".5\nl 0 1\n",
      "diagonal.hpt");
  for (const Pixel pixel : {Pixel{50, 36}, Pixel{30, 30}, Pixel{36, 50}, Pixel{24, 10}}) {
    const Explanation told = explain(scene, preset("embedded"), {pixel});
    for (const std::string& difference : told.differences) ADD_FAILURE() << difference;
    std::size_t drawn = 0;
    for (const Entry& entry : told.pixels[0].history)
      if (entry.kind == Kind::line && has_fragment(entry.specification.verdict)) {
        ++drawn;
        const bool is_beside = entry.golden && entry.golden->fragment;
        EXPECT_TRUE(is_beside || pixel.x != 30) << "not beside the strand that draws";
      }
    EXPECT_LE(drawn, 1U);
  }
}

/// Several samples a pixel, with masks, and coverage from alpha: each sample by itself, and the resulting pixel.
TEST(Explain, SamplesOfAPixelAgreeToo) {
  std::cout << "seed " << kSeed << '\n';
  Random random(kSeed);
  struct Case {
    const char *preset, *samples, *pattern;
  };
  std::size_t fragments = 0, off_centre = 0, left_out = 0, by_alpha = 0;
  for (const auto& [name, samples, pattern] :
       {Case{"tiny", "2", "standard"}, Case{"embedded", "4", "standard"}, Case{"embedded", "8", "standard"},
        Case{"full", "4", "standard"}, Case{"embedded", "2", "0.25,0.5;0.75,0.5"}, Case{"small", "4", "standard"}}) {
    SCOPED_TRACE(std::string(name) + ", " + samples + " samples");
    Config config = preset(name);
    set_by_key(config, "msaa.samples", samples);
    set_by_key(config, "msaa.pattern", pattern);
    const std::uint64_t seed = random.next();
    Scene scene = random_scene(config, seed, 120);
    for (State& state : scene.states) {
      if (random.next() % 3 == 0) state.sample_mask = static_cast<std::uint8_t>(random.next());
      state.alpha_to_coverage = random.next() % 4 == 0;
    }
    const Witnesses witnesses(scene, config);
    const Explanation told = explain(scene, config, some_pixels(random, scene, witnesses, 40));
    EXPECT_EQ(told.pixels.size(), 40U * static_cast<std::size_t>(config.msaa_samples));
    EXPECT_NE(told.no_hardware, "");
    for (const std::string& difference : told.differences) ADD_FAILURE() << difference;
    for (const PixelHistory& pixel : told.pixels) {
      SCOPED_TRACE("pixel " + std::to_string(pixel.at.x) + " " + std::to_string(pixel.at.y) + " sample " +
                   std::to_string(pixel.sample));
      fragments += expect_told(pixel, scene, witnesses);
      EXPECT_EQ(pixel.resolved.has_value(), pixel.sample == 0);
      if (pixel.resolved) {
        const std::size_t at = witnesses.functional.frame.at(pixel.at.x, pixel.at.y);
        EXPECT_EQ(pixel.resolved->model.color, witnesses.functional.frame.color[at]);
        EXPECT_EQ(pixel.resolved->model.depth, witnesses.functional.frame.depth[at]);
        EXPECT_EQ(pixel.resolved->golden.rounded.color, witnesses.golden.frame.color[at]);
      }
      for (const Entry& entry : pixel.history) {
        off_centre += entry.shaded_at && *entry.shaded_at >= 0 ? 1 : 0;
        left_out += entry.is_left_out ? 1 : 0;
        by_alpha += entry.specification.verdict == Verdict::alpha ? 1 : 0;
      }
    }
    if (HasFailure()) return;
  }
  std::cout << fragments << " fragments, " << off_centre << " with a colour from a sample, " << left_out
            << " left out by the mask, " << by_alpha << " by alpha\n";
  EXPECT_GT(fragments, 1000U);
  EXPECT_GT(off_centre, 20U);
  EXPECT_GT(left_out, 50U);
  EXPECT_GT(by_alpha, 20U);
}

TEST(Explain, TextbookLinesAreTheRegisters) {
  std::cout << "seed " << kSeed << '\n';
  Random random(kSeed);
  const Config config = preset("embedded");
  const Widths widths = derive_widths(config);
  const PixelBounds limit{-2000, -2000, 2000, 2000};
  const auto end = [&random] {
    SnappedVertex v;
    v.x = static_cast<std::int32_t>(random.next() % 2000) - 1000;
    v.y = static_cast<std::int32_t>(random.next() % 2000) - 1000;
    return v;
  };
  for (int n = 0; n < 2000; ++n) {
    DrawnLine line;
    line.start = end();
    line.end = n % 8 == 0 ? line.start : end();
    if (n % 8 == 1) line.end.y = line.start.y + line.end.x - line.start.x;  // a diagonal
    const auto p = bresenham_steps(line, widths.grid_bits), f = midpoint_steps(line, widths.grid_bits);
    for (const LineRule rule : {LineRule::bresenham, LineRule::midpoint}) {
      const auto steps = register_steps(line, rule, false, limit, widths);
      ASSERT_EQ(steps.size(), p.size());
      ASSERT_EQ(steps.size(), f.size());
      for (std::size_t i = 0; i < steps.size(); ++i) {
        ASSERT_EQ(steps[i].x, p[i].x) << n << " step " << i;
        ASSERT_EQ(steps[i].y, p[i].y) << n << " step " << i;
        ASSERT_EQ(f[i].error, p[i].error) << "one integer, added up and evaluated";
        const bool is_last = i + 1 == steps.size();
        ASSERT_TRUE(is_last || steps[i].moves == p[i].moves) << n << " step " << i;
      }
    }
  }
}

/// Changes one figure; the comparison must notice.
TEST(Explain, AChangedFigureIsADifference) {
  const Config config = preset("embedded");
  const Scene scene = random_scene(config, kSeed, 60);
  const Explanation told = explain(scene, config, {{scene.width / 2, scene.height / 2}});
  ASSERT_EQ(told.differences.size(), 0U);
  using Change = void (*)(Explanation&);
  const Change changes[] = {[](Explanation& e) { e.pixels[0].engine.depth ^= 1; },
                            [](Explanation& e) { e.pixels[0].engine.color ^= 1; },
                            [](Explanation& e) { ++e.pixels[0].engine.owner; },
                            [](Explanation& e) { e.pixels[0].hardware->color ^= 1; },
                            [](Explanation& e) { e.pixels[0].engine.stencil ^= 1; },
                            [](Explanation& e) {
                              e.pixels[0].rtl = Stored{e.pixels[0].hardware->depth ^ 1, 0, -1};
                            },
                            [](Explanation& e) {
                              for (Entry& entry : e.pixels[0].history)
                                if (entry.oracle) entry.oracle->covers = !entry.oracle->covers;
                            }};
  for (const Change change : changes) {
    Explanation changed = told;
    change(changed);
    verify(config, changed);
    EXPECT_GT(changed.differences.size(), 0U) << &change - changes;
  }
  Config several = config;
  several.msaa_samples = 4;
  Explanation changed = explain(scene, several, {{scene.width / 2, scene.height / 2}});
  ASSERT_EQ(changed.differences.size(), 0U);
  changed.pixels[0].resolved->engine.color ^= 1;
  verify(several, changed);
  EXPECT_EQ(changed.differences.size(), 1U);
}

TEST(Explain, PixelsOutsideAreRefused) {
  const Config config = preset("tiny");
  const Scene scene = random_scene(config, kSeed, 10);
  EXPECT_THROW((void)explain(scene, config, {{scene.width, 0}}), InputError);
  EXPECT_THROW((void)explain(scene, config, {{0, -1}}), InputError);
}

}  // namespace
}  // namespace halfplane::explain::explain_test
