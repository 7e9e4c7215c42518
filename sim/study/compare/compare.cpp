#include "compare.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "eye_depth.hpp"
#include "fragment_frame.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/golden/exact_line.hpp"
#include "model/stages/depth_encode.hpp"
#include "model/stages/fragment_ops.hpp"
#include "sim/study/compare/coverage.hpp"
#include "sim/study/compare/fragment_judge.hpp"

namespace halfplane {
namespace {

constexpr double kGrid = 1 << exact::kGridBits;  // a power of two: scaling by it is exact

double to_lsb(std::int64_t error) { return static_cast<double>(error) / kGrid; }

/// A real value in LSB on the grid of 2^-20 LSB.
std::int64_t on_grid(double lsb) { return static_cast<std::int64_t>(std::floor(lsb * kGrid + 0.5)); }

/// The four values of one quantity at one pixel, on the grid.
struct Values {
  std::int64_t u = 0, s = 0, h = 0, d = 0;
};

struct PartSets {
  PartSet snap, interpolation, storage, total;

  void add(const Values& v) {
    snap.add(v.s - v.u);
    interpolation.add(v.h - v.s);
    storage.add(v.d - v.h);
    total.add(v.d - v.u);
  }
  [[nodiscard]] ErrorParts stats() const {
    return {snap.stats(), interpolation.stats(), storage.stats(), total.stats()};
  }
};

/// One quantity, in LSB: the exact value S between the snapped vertices, and the hardware's H before storage rounding.
struct ExactAndHardware {
  exact::Rational exact, hardware;
};

/// A pixel that the model owns, and its expected content.
struct OwnedPixel {
  std::size_t p = 0;                       ///< y * width + x
  std::size_t at = 0;                      ///< in a Framebuffer
  std::uint32_t draw = 0;                  ///< index into Scene::commands
  bool is_line = false;                    ///< or a point
  PerPlane<ExactAndHardware> plane{};      ///< all judged planes
  const SurfaceSample* surface = nullptr;  ///< source of its colour, if not a plane
};

/// Whether model and golden show the same primitive at a pixel, at each of its samples.
bool shows_same(const Comparison& c, std::size_t p) {
  if (c.golden.samples.empty()) return c.golden.ids[p] == c.rendering.ids[p];
  for (std::size_t k = 0; k < c.golden.samples.size(); ++k)
    if (c.golden.samples[k].ids[p] != c.rendering.sample_owners[k].ids[p]) return false;
  return true;
}

/// Compares the stored values with the result of the golden's operations on the fragments, over the owned pixels, and
/// collects every attribute error.
class AttributeComparison {
 public:
  /// `made`: the specification's rendering, whose fragments went to `frames`, one for each sample of a pixel.
  /// `perspective`: the golden's picture with all colours interpolated so; empty: not requested.
  AttributeComparison(const Scene& scene, const Config& config, const std::vector<FragmentFrame>& frames,
                      const Rendering& made, const golden::Image& perspective, Comparison& result)
      : scene_(scene),
        config_(config),
        frames_(frames),
        made_(made),
        perspective_(perspective),
        widths_(derive_widths(config)),
        planes_(judged_planes(config)),
        result_(result),
        depth_max_(std::ldexp(1.0, config.depth_bits) - 1),
        depth_encode_(config, scene.planes),
        eye_mappings_(fit_eye_mappings(result.golden.outlines, scene.commands.size())),
        texture_(result.depth_error_lsb.size()) {}

  /// `progress` gets the fraction of the pixels done.
  void run(const std::function<void(double)>& progress) {
    const double parts = static_cast<double>(frames_.size());
    for (std::size_t k = 0; k < frames_.size(); ++k)
      sample(k, [&](double part) { progress((static_cast<double>(k) + part) / parts); });
    if (frames_.size() > 1) resolved_colors();
    result_.depth_lsb = depth_.stats();
    result_.color_lsb = color_.stats();
    if (const ErrorStats eye = eye_.stats(); eye.count > 0) result_.depth_eye = eye;
    result_.parts = depth_parts_.stats();
    result_.color_parts = color_parts_.stats();
    result_.affine = affine_.stats();
    result_.affine_coordinate = affine_coordinate_.stats();
    result_.datapath = datapath_.stats();
    result_.line_datapath = line_datapath_.stats();
    result_.color_datapath = color_datapath_.stats();
    result_.color_over_w = color_over_w_.stats();
    result_.fog = fog_.stats();
    result_.light = light_.stats();
    if (has_texture_) result_.texture = std::move(texture_).result();
    result_.layers = layer_rows_;
    result_.datapath_bias = datapath_bias_.stats();
    result_.color_datapath_bias = color_datapath_bias_.stats();
  }

 private:
  /// The content of a sample of each pixel: in the model, in the specification, in the golden.
  struct View {
    const Framebuffer &stored, &made;
    const std::vector<std::int32_t>& ids;
    const golden::Samples& golden;
    const golden::Samples& perspective;
  };
  [[nodiscard]] View view(std::size_t k) const {
    const Rendering& model = result_.rendering;
    if (frames_.size() == 1) return {model.frame, made_.frame, model.ids, result_.golden, perspective_};
    const bool has_perspective = !perspective_.samples.empty();
    return {model.frame.samples[k], made_.frame.samples[k], model.sample_owners[k].ids, result_.golden.samples[k],
            has_perspective ? perspective_.samples[k] : perspective_};
  }

  /// Compares all pixels, at one of their samples.
  void sample(std::size_t k, const std::function<void(double)>& progress) {
    frame_ = &frames_[k];
    oracle_.reset();
    sample_ = k;
    view_.emplace(view(k));
    layers_.emplace(frame_->layers());
    for (std::size_t p = 0; p < frame_->owners().size(); ++p)
      result_.stage_mismatches += view_->ids[p] != frame_->owners()[p] ? 1 : 0;
    const OwnedPixels owned(*frame_);
    result_.visible_triangles = std::max(result_.visible_triangles, owned.triangles);
    for (std::size_t i = 0; i < owned.pixels.size(); ++i) {
      if (i % 4096 == 0) progress(static_cast<double>(i) / static_cast<double>(owned.pixels.size()));
      pixel(owned_pixel(owned.pixels[i]));
    }
    for (const LayerRow& row : layers_->rows()) add_row(layer_rows_, row);
  }

  /// Compares the resolved colour of each pixel: the mean of its samples, rounded, and the golden's.
  void resolved_colors() {
    const auto max = golden::channel_max(config_.color_format);
    const Framebuffer& frame = result_.rendering.frame;
    const double samples = static_cast<double>(frames_.size());
    for (int y = 0; y < frame.height; ++y)
      for (int x = 0; x < frame.width; ++x) {
        const std::size_t p =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x);
        const std::size_t at = frame.at(x, y);
        double worst = 0;
        const bool is_same = shows_same(result_, p) && result_.golden.ids[p] >= 0;
        for (int channel = 0; channel < golden::channel_count(config_.color_format); ++channel) {
          const auto c = static_cast<std::size_t>(channel);
          double sum = 0;
          for (const Framebuffer& of : frame.samples)
            sum += golden::stored_channel(of.color[at], config_.color_format, channel);
          const int stored = golden::stored_channel(frame.color[at], config_.color_format, channel);
          result_.stage_mismatches += stored != static_cast<int>(std::floor(sum / samples + 0.5)) ? 1 : 0;
          if (!is_same) continue;
          const double error = stored - result_.golden.color[p][c] * max[c] / 255;
          color_.add(error);
          if (std::abs(error) > std::abs(worst)) worst = error;
        }
        result_.stage_mismatches += frame.depth[at] != frame.samples.front().depth[at] ? 1 : 0;
        if (is_same) result_.color_error_lsb[p] = static_cast<float>(worst);
      }
  }

  [[nodiscard]] const State& state_of(std::uint32_t command) const {
    return scene_.states[std::get<Draw>(scene_.commands[command]).state];
  }

  [[nodiscard]] OwnedPixel owned_pixel(std::size_t p) {
    const TappedFragment& f = frame_->shown(p);
    OwnedPixel pixel{p, made_.frame.at(f.x, f.y), f.draw, f.kind != PrimitiveKind::triangle, {}};
    if (!pixel.is_line && (!oracle_ || oracle_item_ != f.item)) {
      oracle_.emplace(seen_triangle(f, static_cast<int>(sample_)), widths_.grid_bits);
      oracle_item_ = f.item;
      shaded_at_.reset();
    }
    if (!pixel.is_line && shaded_at_ != f.shaded_at) {
      const Triangle shaded = seen_triangle(f, f.shaded_at);
      color_oracle_.emplace(shaded, widths_.grid_bits);
      surface_oracle_.reset();
      if (f.surface) surface_oracle_.emplace(scene_, config_, shaded, offset_of(f.shaded_at));
      shaded_at_ = f.shaded_at;
    }
    if (f.surface) pixel.surface = &*f.surface;
    const exact::PlaneWeights of_depth = pixel.is_line ? exact::PlaneWeights{} : oracle_->weights_at(f.x, f.y);
    const exact::PlaneWeights of_color =
        pixel.is_line || frames_.size() == 1 ? of_depth : color_oracle_->weights_at(f.x, f.y);
    for (std::size_t i = 0; i < planes_.size(); ++i)
      pixel.plane[i] = {exact_value(f, planes_[i].is_depth ? of_depth : of_color, i),
                        {f.plane[i].unrounded, int128{1} << f.guard_bits}};
    return pixel;
  }

  /// Offset from the centre to a sample; -1: the centre.
  [[nodiscard]] SampleOffset offset_of(int place) const {
    return place < 0 || frames_.size() == 1 ? SampleOffset{} : widths_.sample_offset[static_cast<std::size_t>(place)];
  }
  /// The triangle of a fragment as seen from there.
  [[nodiscard]] Triangle seen_triangle(const TappedFragment& f, int place) const {
    return exact::seen_from(made_.triangles[f.item], offset_of(place));
  }

  [[nodiscard]] exact::Rational exact_value(const TappedFragment& f, const exact::PlaneWeights& weights,
                                            std::size_t plane) const {
    if (f.kind == PrimitiveKind::triangle) return weights.plane(plane_codes(made_.triangles[f.item], plane));
    if (f.kind == PrimitiveKind::point) return {made_.points[f.item].at.code[plane], 1};
    const DrawnLine& drawn = made_.lines[f.item];
    const exact::Line line{drawn.start, drawn.end, state_of(f.draw).line_rule, drawn.drops_last, widths_.grid_bits};
    return exact::plane_at(line, f.x, f.y, drawn.start.code[plane], drawn.end.code[plane]);
  }

  void pixel(const OwnedPixel& pixel) {
    const State& state = state_of(pixel.draw);
    // It must be the same primitive: otherwise U - D would be the distance of two surfaces.
    const std::int32_t owner = frame_->owners()[pixel.p];
    const bool same_visible = view_->golden.ids[pixel.p] == owner && view_->ids[pixel.p] == owner;
    result_.compared_pixels += same_visible ? 1 : 0;
    const FragmentState writes = fragment_state(state, config_.color_format);
    if (writes.depth_write) depth(pixel, view_->stored.depth[pixel.at], same_visible);
    if (writes.color_write) color(pixel, view_->stored.color[pixel.at], same_visible);
  }

  void depth(const OwnedPixel& pixel, std::uint32_t stored, bool same_visible) {
    Values v;
    v.s = exact::on_grid(pixel.plane[kDepthPlane].exact);
    v.h = exact::on_grid(pixel.plane[kDepthPlane].hardware);
    v.d = depth_encode_.is_identity() ? std::int64_t{stored} << exact::kGridBits
                                      : on_grid(static_cast<double>(depth_encode_.plane_value(stored)) * depth_max_);
    result_.stage_mismatches += stored != view_->made.depth[pixel.at] ? 1 : 0;
    // In a format other than the plane's, storage is a step after the datapath.
    const std::int64_t datapath = depth_encode_.is_identity() ? v.d : v.h;
    if (pixel.is_line) {
      line_datapath_.add(to_lsb(datapath - v.s));
    } else {
      datapath_.add(to_lsb(datapath - v.s));
      datapath_bias_.add(to_lsb(v.h - v.s));
    }
    if (!same_visible) return;
    const double u = view_->golden.depth[pixel.p];
    v.u = on_grid(u);
    depth_parts_.add(v);
    depth_.add(to_lsb(v.d - v.u));
    if (sample_ == 0) result_.depth_error_lsb[pixel.p] = static_cast<float>(to_lsb(v.d - v.u));
    if (const auto& mapping = eye_mappings_[pixel.draw]) {
      const auto of_d = mapping->eye_depth(to_lsb(v.d) / depth_max_), of_u = mapping->eye_depth(u / depth_max_);
      if (of_d && of_u)
        eye_.add(*of_d - *of_u);
      else
        ++result_.beyond_eye;
    }
  }

  /// The error of affine interpolation in one channel, whose value is `u`.
  void affine(std::size_t p, std::int64_t u, int channel) {
    if (view_->perspective.color.empty()) return;
    const auto c = static_cast<std::size_t>(channel);
    const std::int64_t cost =
        u - on_grid(view_->perspective.color[p][c] * golden::channel_max(config_.color_format)[c] / 255);
    affine_.add(cost);
    if (sample_ != 0) return;
    float& worst = result_.affine_error_lsb[p];
    const auto error = static_cast<float>(to_lsb(cost));
    if (channel == 0 || std::abs(error) > std::abs(worst)) worst = error;
  }

  void affine_texels(std::size_t p, double texels) {
    if (view_->perspective.color.empty()) return;
    affine_coordinate_.add(texels);
    if (sample_ == 0) result_.affine_texels[p] = static_cast<float>(texels);
  }

  /// A colour of several fragments: the part of its error due to the operations.
  void layered_color(const OwnedPixel& pixel, std::uint32_t stored, bool same_visible) {
    layers_->judge(pixel.p, stored);
    if (!same_visible || frames_.size() > 1) return;
    const auto max = golden::channel_max(config_.color_format);
    double worst = 0;
    for (int channel = 0; channel < golden::channel_count(config_.color_format); ++channel) {
      const auto c = static_cast<std::size_t>(channel);
      const double error = golden::stored_channel(stored, config_.color_format, channel) -
                           result_.golden.color[pixel.p][c] * max[c] / 255;
      color_.add(error);
      if (std::abs(error) > std::abs(worst)) worst = error;
    }
    result_.color_error_lsb[pixel.p] = static_cast<float>(worst);
  }

  void color(const OwnedPixel& pixel, std::uint32_t stored, bool same_visible) {
    const auto max = golden::channel_max(config_.color_format);
    result_.stage_mismatches += stored != view_->made.color[pixel.at] ? 1 : 0;
    if (layers_->is_layered(pixel.p)) return layered_color(pixel, stored, same_visible);
    double worst = 0;
    const golden::Color surface = pixel.surface != nullptr ? exact_surface(pixel) : golden::Color{};
    for (int channel = 0; channel < golden::channel_count(config_.color_format); ++channel) {
      const auto c = static_cast<std::size_t>(channel);
      Values v;
      v.d = std::int64_t{golden::stored_channel(stored, config_.color_format, channel)} << exact::kGridBits;
      if (pixel.surface != nullptr) {
        v.s = on_grid(surface[c] * max[c] / 255);
        v.h = exact::on_grid({pixel.surface->color[c], 1}, max[c], 255);
      } else {
        v.s = exact::on_grid(pixel.plane[kColorPlane + c].exact, max[c], 255);
        v.h = exact::on_grid(pixel.plane[kColorPlane + c].hardware, max[c], 255);
        color_datapath_.add(to_lsb(v.d - v.s));
        color_datapath_bias_.add(to_lsb(v.h - v.s));
      }
      if (!same_visible) continue;
      v.u = on_grid(view_->golden.color[pixel.p][c] * max[c] / 255);
      color_parts_.add(v);
      affine(pixel.p, v.u, channel);
      if (frames_.size() > 1) continue;  // the pixel's one colour is compared after all samples
      const double error = to_lsb(v.d - v.u);
      color_.add(error);
      if (std::abs(error) > std::abs(worst)) worst = error;
    }
    if (same_visible && frames_.size() == 1) result_.color_error_lsb[pixel.p] = static_cast<float>(worst);
  }

  /// The exact surface of a pixel; its errors are collected.
  [[nodiscard]] golden::Color exact_surface(const OwnedPixel& pixel) {
    const TappedFragment& f = frame_->shown(pixel.p);
    const SurfaceErrors errors = surface_oracle_->errors(*pixel.surface, f.x, f.y);
    if (std::isfinite(errors.color.bound)) color_over_w_.add(errors.color.value);
    if (errors.has_fog) fog_.add(errors.fog.value);
    if (errors.is_lit) light_.add(errors.light.value);
    has_texture_ = has_texture_ || errors.has_texture;
    if (errors.has_texture) {
      texture_.add(pixel.p, errors);
      affine_texels(pixel.p, surface_oracle_->affine_texels(f.x, f.y));
    }
    return errors.exact;
  }

  const Scene& scene_;
  const Config& config_;
  const std::vector<FragmentFrame>& frames_;
  const FragmentFrame* frame_ = nullptr;  // of the current sample
  std::size_t sample_ = 0;                // its number
  std::optional<View> view_;              // its content
  const Rendering& made_;
  const golden::Image& perspective_;
  const Widths widths_;
  const std::vector<JudgedPlane> planes_;
  Comparison& result_;
  double depth_max_;  // 2^B - 1
  DepthEncode depth_encode_;
  std::vector<std::optional<EyeMapping>> eye_mappings_;
  std::optional<exact::TriangleOracle> oracle_;        // of the current triangle
  std::uint32_t oracle_item_ = 0;                      // its number
  std::optional<exact::TriangleOracle> color_oracle_;  // oracle of its colour where the current pixel is shaded
  std::optional<SurfaceOracle> surface_oracle_;        // likewise
  std::optional<int> shaded_at_;                       // shading point of that oracle
  ErrorSet depth_, color_, eye_;
  MomentSet datapath_, line_datapath_, color_datapath_, datapath_bias_, color_datapath_bias_, color_over_w_, fog_,
      light_;
  TextureErrorSets texture_;
  std::optional<LayeredColors> layers_;  // of the current sample
  std::vector<LayerRow> layer_rows_;
  bool has_texture_ = false;
  PartSets depth_parts_, color_parts_;
  PartSet affine_;
  MomentSet affine_coordinate_;
};

CoverageClass classify(std::uint32_t golden_count, std::uint32_t model_count, bool same_visible) {
  if (golden_count > model_count) return CoverageClass::missing;
  if (golden_count < model_count) return CoverageClass::extra;
  if (!same_visible) return CoverageClass::other;
  return golden_count == 0 ? CoverageClass::none : CoverageClass::both;
}

std::uint64_t different_pixels(const Scene& scene, const Framebuffer& a, const Framebuffer& b) {
  std::uint64_t different = 0;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const std::size_t at = a.at(x, y), bt = b.at(x, y);
      different += a.depth[at] != b.depth[bt] || a.color[at] != b.color[bt] ? 1 : 0;
    }
  for (std::size_t k = 0; k < a.samples.size(); ++k) different += different_pixels(scene, a.samples[k], b.samples[k]);
  return different;
}

/// Whether the planes are made by the pipeline's rules.
bool has_own_planes(const StudyRules& rules) {
  return rules.gradients == Gradients::one_reciprocal && rules.accumulator == Accumulator::wrap;
}

/// Draws with the specification; every fragment goes to the judge, and through the golden's operations.
Rendering draw_fragments(const Scene& scene, const Config& config, const CompareOptions& options, FragmentJudge& judge,
                         std::vector<FragmentFrame>& frames, const std::function<void(double)>& progress) {
  RenderOptions render_options;
  render_options.progress = progress;
  render_options.skip = options.skip;
  render_options.rules = options.rules;
  render_options.fragment_tap = [&](const TappedFragment& fragment) {
    judge.add(fragment);
    frames[static_cast<std::size_t>(fragment.sample)].add(fragment);
  };
  const Engine specification = options.specification ? options.specification : render_scalar;
  Rendering rendering = specification(scene, config, render_options);
  for (FragmentFrame& frame : frames) frame.finish();
  return rendering;
}

}  // namespace

Comparison compare(const Scene& scene, const Config& plain_config, const CompareOptions& options) {
  const Config config = with_alpha(plain_config, scene);
  Comparison result;
  std::vector<CoverageLog> logs = coverage_logs(config);
  RenderOptions render_options;
  render_options.skip = options.skip;
  render_options.rules = options.rules;
  render_options.want_count = render_options.want_ids = render_options.want_triangles = true;
  render_options.coverage_tap = [&logs](std::uint32_t triangle, int tile_x, int tile_y, const TileMask& mask,
                                        int sample) {
    logs[static_cast<std::size_t>(sample)].add(triangle, tile_x, tile_y, mask);
  };
  PixelLog pixel_log;
  render_options.pixel_tap = [&pixel_log](std::uint32_t primitive, int x, int y) { pixel_log.add(primitive, x, y); };
  golden::Options golden_options;
  golden_options.precision = options.precision;
  golden_options.want_outlines = true;
  const auto part = [&options](double from, double to) {
    return [&options, from, to](double fraction) {
      if (options.progress) options.progress(from + (to - from) * fraction);
    };
  };
  render_options.progress = part(0, 0.2);
  golden_options.progress = part(0.4, 0.6);
  const bool is_default = options.rules == StudyRules{};
  const Engine engine = options.engine ? options.engine : is_default ? render_functional : render_scalar;
  result.rendering = engine(scene, config, render_options);
  FragmentJudge judge(scene, config, options.rules.fill_rule);
  std::vector<FragmentFrame> frames;
  for (int k = 0; k < config.msaa_samples; ++k) frames.emplace_back(scene, config, k);
  const Rendering made = draw_fragments(scene, config, options, judge, frames, part(0.2, 0.4));
  result.fragments = judge.finish(made);
  if (!has_own_planes(options.rules))
    result.fragments.planes.clear();  // wrong on purpose; the stored values show by how much
  result.golden = golden::render(scene, config, golden_options);
  golden::Image perspective;
  if (options.wants_affine_cost) {
    golden_options.color_interp = ColorInterp::perspective;
    golden_options.texture_interp = TextureInterp::perspective;
    golden_options.want_outlines = false;
    golden_options.progress = part(0.6, 0.8);
    perspective = golden::render(scene, config, golden_options);
    result.perspective = perspective.frame;
  }
  if (has_light_of_fragments(scene)) {
    golden_options.color_interp.reset();
    golden_options.texture_interp.reset();
    golden_options.want_outlines = false;
    golden_options.progress = part(0.8, 0.8);
    const golden::Image at_vertices = golden::render(lit_at_vertices(scene), config, golden_options);
    result.per_vertex = per_vertex_rows(scene, config, result.rendering, result.golden, at_vertices);
  }
  // With taps the functional engine draws by the stages: without them it must draw the same.
  if (is_default && !options.engine) {
    RenderOptions plain;
    plain.skip = options.skip;
    plain.progress = part(0.8, 0.8);
    result.stage_mismatches += different_pixels(scene, result.rendering.frame, engine(scene, config, plain).frame);
  }

  for (CoverageLog& log : logs) log.sort();
  result.oracle = check_coverage(scene, config, result.rendering.triangles, logs, options.rules.fill_rule);
  pixel_log.sort();
  check_line_coverage(scene, config, result.rendering, pixel_log, result.oracle);
  result.coverage = compare_counts(scene, result.rendering.count, result.golden, config.subpixel_bits);
  const std::size_t pixels = result.rendering.count.size();
  result.coverage_class.resize(pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    result.coverage_class[p] = classify(result.golden.count[p], result.rendering.count[p], shows_same(result, p));
    result.missing_pixels += result.coverage_class[p] == CoverageClass::missing ? 1 : 0;
    result.extra_pixels += result.coverage_class[p] == CoverageClass::extra ? 1 : 0;
    result.other_visible += result.coverage_class[p] == CoverageClass::other ? 1 : 0;
  }
  result.depth_error_lsb.assign(pixels, std::numeric_limits<float>::quiet_NaN());
  result.color_error_lsb = result.depth_error_lsb;
  if (options.wants_affine_cost) result.affine_error_lsb = result.affine_texels = result.depth_error_lsb;
  AttributeComparison(scene, config, frames, made, perspective, result).run(part(0.8, 1));
  return result;
}

}  // namespace halfplane
