#include "batch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "../../model/attributes.hpp"
#include "../../model/signature.hpp"
#include "context.hpp"
#include "host_shader.hpp"
#include "matrix.hpp"
#include "shade_kernels.hpp"

namespace halfplane::gl {
namespace {

bool makes_triangles(Topology topology) {
  return topology == Topology::triangles || topology == Topology::triangle_strip || topology == Topology::triangle_fan;
}

const DrawSetup::OfKind& setup_of(Context& context, DrawSetup& setup, DrawKind kind, bool has_texture) {
  DrawSetup::OfKind& of = setup.kind[static_cast<std::size_t>(kind)][has_texture ? 1 : 0];
  if (std::exchange(of.is_known, true)) return of;
  of.state = hardware_state(context, kind);
  if (of.state && has_texture) of.use = use_texture(context, setup.unit, *of.state);
  return of;
}

/// Draws vertices in their first colour.
class Batch {
 public:
  Batch(Context& context, const BatchKind& group, const ShadedVertices& vertices,
        std::span<const std::uint32_t> indices, const BatchTraits& traits)
      : context_(context), group_(group), vertices_(vertices), indices_(indices), traits_(traits) {}

  void draw() {
    DrawSetup& setup = draw_setup(context_);
    unit_ = setup.unit;
    const DrawSetup::OfKind& of_kind =
        setup_of(context_, setup, group_.kind,
                 setup.units != 0 && makes_triangles(group_.topology) && !group_.is_stippled && !group_.is_shaded);
    if (!of_kind.state) return;
    state_ = *of_kind.state;
    use_ = of_kind.use;
    if (state_.texture) state_.color_interp = ColorInterp::perspective;
    if (group_.is_window) state_.space = Space::window;
    if (group_.is_window && group_.kind != DrawKind::rectangle) cut_to_viewport();
    if (group_.topology == Topology::points) state_.point_size = group_.point_size;
    is_textured_ = state_.texture.has_value();
    if (group_.is_stippled && !group_.is_shaded) stipple();
    const FogState& fog = context_.state.fog;
    has_host_fog_ = fog.enabled && !(state_.fog && traits_.is_fogged_by_w);
    if (has_host_fog_) state_.fog.reset();
    if (group_.is_shaded)
      return draw_shaded(context_, state_, vertices_.rows(),
                         {.has_fog = has_host_fog_, .is_stippled = group_.is_stippled});
    if (has_host_fog_ && traits_.has_one_color) state_.shade = Shade::smooth;  // fog has not one colour
    const bool colors_differ = !traits_.has_one_color || (has_host_fog_ && !is_textured_);
    // As exact, and hardware of any configuration has it.
    if (!colors_differ || traits_.has_one_w || state_.shade == Shade::flat) state_.color_interp = ColorInterp::affine;
    const Options& options = context_.drawable->frame.options();
    if (state_.color_interp == ColorInterp::perspective && !has_colors_over_w(options.config) &&
        options.on_missing != OnMissing::host) {
      missing("colours over w", "they are affine in the window; perspective.colors=1 has them");
      state_.color_interp = ColorInterp::affine;
    }
    draw_in(context_, state_, group_.topology, model_vertices(), indices_);
  }

 private:
  void missing(const char* what, const char* instead) { context_.drawable->frame.missing(what, instead); }

  /// As clip space does it.
  void cut_to_viewport() {
    const ViewportState& v = context_.state.viewport;
    Rect& cut = state_.scissor ? *state_.scissor : state_.scissor.emplace(Rect{v.x, v.y, v.width, v.height});
    const auto limit = [](int& start, int& size, int low, int length) {
      const std::int64_t end = std::min(std::int64_t{start} + size, std::int64_t{low} + length);
      start = std::max(start, low);
      size = static_cast<int>(std::clamp<std::int64_t>(end - start, 0, kLargestViewport));
    };
    limit(cut.x, cut.width, v.x, v.width);
    limit(cut.y, cut.height, v.y, v.height);
    limit(cut.x, cut.width, 0, kLargestViewport);
    limit(cut.y, cut.height, 0, kLargestViewport);
    cut.x = std::min(cut.x, kLargestViewport);
    cut.y = std::min(cut.y, kLargestViewport);
  }

  /// Numbers of the model's vertices, in their order, in columns as those of ShadedVertices.
  using ModelBlock = std::array<Column, VertexNumbers().size()>;
  static constexpr std::size_t kModelColor = 4, kModelU = 8;

  [[nodiscard]] std::span<Vertex> model_vertices() const {
    const std::span<Vertex> model = scratch<Vertex>(vertices_.size());  // one batch is drawn at a time
    std::size_t at = 0;
    ModelBlock to{};
    for (const ShadedVertices::Block& from : vertices_.blocks()) {
      place(from, to);
      paint(from, to);
      for (std::size_t lane = 0; lane < std::min(kVertexLanes, model.size() - at); ++lane) {
        VertexNumbers numbers;
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = to[i][lane];
        model[at + lane] = vertex_of(numbers);
      }
      at += kVertexLanes;
    }
    return model;
  }

  /// Positions and texture coordinates. Where q differs, x y z w divided by q are the same place, and what is interpolated
  /// over w / q is the projected coordinate.
  void place(const ShadedVertices::Block& from, ModelBlock& to) const {
    for (std::size_t c = 0; c < 4; ++c) to[c] = from[ShadedVertices::kClip + c];
    if (group_.is_stippled)
      for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t i = 0; i < kVertexLanes; ++i) to[kModelU + c][i] = to[c][i] / 32;
    if (!is_textured_) return;
    const Column* const tex = &from[ShadedVertices::kTexCoord + 4 * unit_];
    Column q;
    for (std::size_t i = 0; i < kVertexLanes; ++i)
      q[i] = tex[3][i] > 0 || (traits_.has_one_q && tex[3][i] != 0) ? tex[3][i] : 1;
    if (!traits_.has_one_q && traits_.has_positive_q)
      for (std::size_t c = group_.is_window ? 3 : 0; c < 4; ++c)
        for (std::size_t i = 0; i < kVertexLanes; ++i) to[c][i] /= q[i];
    if (group_.is_stippled) return;
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t i = 0; i < kVertexLanes; ++i) {
        const double coordinate = tex[c][i] / q[i];
        to[kModelU + c][i] = std::abs(coordinate) <= std::numeric_limits<double>::max() ? coordinate : 0;
      }
  }

  void paint(const ShadedVertices::Block& from, ModelBlock& to) const {
    const Vec4& fog = context_.state.fog.color;
    Column factor;
    const bool is_fogged = has_host_fog_ && !is_textured_;
    if (is_fogged)
      for (std::size_t i = 0; i < kVertexLanes; ++i)
        factor[i] = fog_factor(context_.state.fog, from[ShadedVertices::kFogDistance][i]);
    for (std::size_t c = 0; c < 4; ++c) {
      Column& channel = to[kModelColor + c];
      channel = from[ShadedVertices::kColor + c];
      if (c < 3 && !is_textured_)
        for (std::size_t i = 0; i < kVertexLanes; ++i)
          channel[i] = held(channel[i] + from[ShadedVertices::kSecondary + c][i]);
      if (c < 3 && is_fogged)
        for (std::size_t i = 0; i < kVertexLanes; ++i)
          if (factor[i] < 1) channel[i] = factor[i] * channel[i] + (1 - factor[i]) * fog[c];
      if (is_textured_ && (c < 3 ? use_.replaces_rgb : use_.replaces_alpha)) channel.fill(1);
      // A texel of the stipple is alpha: this one must tell it from none.
      const double least = c == 3 && group_.is_stippled ? 1 / 255.0 : 0;
      for (double& value : channel) value = 255 * held(value, least);
    }
  }

  /// The pattern as a texture over the window, whose zeros the alpha test drops.
  void stipple() {
    const auto& rows = context_.state.stipple.row;
    SignatureHash hash;
    for (const std::uint32_t row : rows) hash.add(row);
    state_.texture = context_.drawable->frame.texture(hash.signature().low | std::uint64_t{1} << 63, [&rows] {
      halfplane::Texture texture;
      texture.name = "stipple";
      TextureLevel& level = texture.level.emplace_back(TextureLevel{32, 32, {}});
      for (const std::uint32_t row : rows)
        for (unsigned x = 0; x < 32; ++x) level.code.push_back((row >> (31 - x) & 1) != 0 ? 0xffffffffU : 0xffffff00U);
      return texture;
    });
    state_.texture_interp = TextureInterp::affine;
    const AlphaTest& test = state_.alpha_test;
    const bool fails_zero = test.func == DepthFunc::never || test.func == DepthFunc::greater ||
                            (test.func == DepthFunc::gequal && test.reference > 0) ||
                            (test.func == DepthFunc::equal && test.reference > 0) ||
                            (test.func == DepthFunc::notequal && test.reference == 0);
    if (test.func != DepthFunc::always && !fails_zero)
      missing("stippled polygons whose alpha test passes an alpha of 0", "they are drawn without the alpha test");
    if (!fails_zero) state_.alpha_test = {DepthFunc::greater, 0};
  }

  Context& context_;
  BatchKind group_;
  const ShadedVertices& vertices_;
  std::span<const std::uint32_t> indices_;
  BatchTraits traits_;
  std::size_t unit_ = 0;  ///< DrawSetup::unit
  halfplane::State state_;
  TextureUse use_;
  bool is_textured_ = false, has_host_fog_ = false;
};

}  // namespace

BatchTraits traits_of(const ShadedVertices& vertices, std::size_t unit) {
  return shade_kernels().traits(vertices.blocks(), unit);
}

DrawSetup& draw_setup(Context& context) {
  if (!context.draw_setup) context.draw_setup = std::make_shared<DrawSetup>();
  DrawSetup& setup = *context.draw_setup;
  const std::uint64_t frame = context.drawable == nullptr ? 0 : context.drawable->frame.revision();
  if (setup.revision == context.revision && setup.frame == frame) return setup;
  setup.revision = context.revision;
  setup.frame = frame;
  setup.units = textured_units(context);
  setup.unit = setup.units == 0 ? 0 : static_cast<std::size_t>(std::countr_zero(setup.units));
  setup.beyond.reset();
  for (auto& of : setup.kind)
    for (DrawSetup::OfKind& kind : of) kind.is_known = false;
  return setup;
}

const char* why_shaded(Context& context, const BatchTraits& traits) {
  DrawSetup& setup = draw_setup(context);
  if (setup.units == 0) return nullptr;
  if (!setup.beyond) setup.beyond = beyond_texture_unit(context, setup.units);
  if (*setup.beyond != nullptr) return *setup.beyond;
  const gl::State& state = context.state;
  if (state.polygon.stipple) return "stippled polygons with a texture";
  if (traits.has_secondary) return "colours that are added to a texture";
  if (state.fog.enabled && !(has_hardware_fog(state.fog) && traits.is_fogged_by_w))
    return "fog of a texture by other distances than w";
  if (!traits.has_one_q && (!traits.has_positive_q || !traits.has_one_color || state.fog.enabled))
    return "projective textures under colours or fog, or with a q of 0 or less";
  return nullptr;
}

bool fog_bends(const FogState& fog, const ShadedVertex& a, const ShadedVertex& b) {
  constexpr double kMost = 8 / 255.0;
  if (a.clip[3] <= 0 || b.clip[3] <= 0) return true;  // the distance has a least value between them
  return std::abs(fog_factor(fog, a.fog_distance) - fog_factor(fog, b.fog_distance)) > kMost;
}

void draw_batch(Context& context, const BatchKind& group, const ShadedVertices& vertices,
                std::span<const std::uint32_t> indices, const BatchTraits& traits) {
  if (!vertices.empty() && !indices.empty()) Batch(context, group, vertices, indices, traits).draw();
}

}  // namespace halfplane::gl
