// The context's state as the model's, and draws of the model in it.
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "../../model/signature.hpp"
#include "../../model/stages/color_ops.hpp"
#include "context.hpp"
#include "matrix.hpp"
#include "primitive.hpp"

namespace halfplane::gl {
namespace {

constexpr int kLargestScissor = 1048576;       ///< pixels, a bound of the model
constexpr double kLargestNumber = 1e12;        ///< likewise, of polygon offset and fog
constexpr double kClosestStart = 255 / 256.0;  ///< start of linear fog with end 1: the model's bound

template <class To>
using Table = std::initializer_list<std::pair<GLenum, To>>;
template <class To>
To find(const Table<To>& table, GLenum key) {
  const auto* const at = std::ranges::find(table, key, &std::pair<GLenum, To>::first);
  return at == table.end() ? table.begin()->second : at->second;
}

/// From GL_NEVER on.
constexpr auto kComparisons = [] {
  using enum DepthFunc;
  return std::array{never, less, equal, lequal, greater, notequal, gequal, always};
}();
DepthFunc compare_of(GLenum func) { return kComparisons[func - GL_NEVER]; }

/// From GL_SRC_COLOR and from GL_CONSTANT_COLOR on.
constexpr auto kFactors = [] {
  using enum BlendFactor;
  return std::array{src_color,           one_minus_src_color, src_alpha,           one_minus_src_alpha, dst_alpha,
                    one_minus_dst_alpha, dst_color,           one_minus_dst_color, src_alpha_saturate};
}();
constexpr auto kConstantFactors = [] {
  using enum BlendFactor;
  return std::array{constant_color, one_minus_constant_color, constant_alpha, one_minus_constant_alpha};
}();
BlendFactor factor_of(GLenum factor) {
  if (factor <= GL_ONE) return factor == GL_ZERO ? BlendFactor::zero : BlendFactor::one;
  return factor < GL_CONSTANT_COLOR ? kFactors[factor - GL_SRC_COLOR] : kConstantFactors[factor - GL_CONSTANT_COLOR];
}

StencilOp stencil_op_of(GLenum op) {
  return find<StencilOp>({{GL_KEEP, StencilOp::keep},
                          {GL_ZERO, StencilOp::zero},
                          {GL_REPLACE, StencilOp::replace},
                          {GL_INCR, StencilOp::incr},
                          {GL_DECR, StencilOp::decr},
                          {GL_INVERT, StencilOp::invert},
                          {GL_INCR_WRAP, StencilOp::incr_wrap},
                          {GL_DECR_WRAP, StencilOp::decr_wrap}},
                         op);
}

/// Held to low...high; a NaN is `low`.
std::uint8_t byte_of(double value) { return static_cast<std::uint8_t>(std::lround(held(value) * 255)); }

Rect scissor_of(const ScissorState& scissor) {
  const auto interval = [](int start, int size) {
    const std::int64_t first = std::max(start, 0);
    const std::int64_t end = std::min<std::int64_t>(std::int64_t{start} + size, kLargestScissor);
    return std::pair(static_cast<int>(std::min<std::int64_t>(first, kLargestScissor)),
                     static_cast<int>(std::max<std::int64_t>(end - first, 0)));
  };
  const auto [x, width] = interval(scissor.x, scissor.width);
  const auto [y, height] = interval(scissor.y, scissor.height);
  return {x, y, width, height};
}

/// None where the model's numbers do not reach.
std::optional<Fog> fog_of(const FogState& fog) {
  const auto is_number = [](double value) { return value >= 0 && value <= kLargestNumber; };
  if (fog.mode == GL_LINEAR) {
    if (!is_number(fog.start) || !is_number(fog.end) || fog.start > fog.end * kClosestStart) return std::nullopt;
    return Fog{FogKind::linear, fog.start, fog.end};
  }
  if (!is_number(fog.density)) return std::nullopt;
  return Fog{fog.mode == GL_EXP ? FogKind::exp : FogKind::exp2, fog.density, fog.density};
}

Stencil stencil_of(const StencilState& s) {
  return {.func = compare_of(s.func),
          .reference = static_cast<std::uint8_t>(std::clamp(s.reference, 0, 255)),
          .read_mask = static_cast<std::uint8_t>(s.value_mask & 255),
          .write_mask = static_cast<std::uint8_t>(s.write_mask & 255),
          .stencil_fails = stencil_op_of(s.fail),
          .depth_fails = stencil_op_of(s.depth_fail),
          .passes = stencil_op_of(s.depth_pass)};
}

void set_samples(const MultisampleState& multisample, int samples, halfplane::State& state) {
  if (samples == 1 || !multisample.enabled) return;
  state.line_rule = LineRule::rectangle;
  state.alpha_to_coverage = multisample.alpha_to_coverage;
  if (!multisample.coverage) return;
  const std::uint32_t all = (1U << samples) - 1;
  const std::uint32_t mask = (1U << std::lround(held(multisample.value) * samples)) - 1;
  state.sample_mask = multisample.invert ? all & ~mask : mask;
}

void set_fragment_operations(Context& context, halfplane::State& state) {
  const gl::State& from = context.state;
  const ColorState& color = from.color;
  state.depth_test = from.depth.test ? compare_of(from.depth.func) : DepthFunc::always;
  state.depth_write = from.depth.test && from.depth.write;
  state.color_mask = color.write;
  state.color_write = color.draw_buffer != GL_NONE && std::ranges::count(color.write, true) > 0;
  if (color.alpha_test) state.alpha_test = {compare_of(color.alpha_func), byte_of(color.alpha_reference)};
  if (color.blend && !color.logic_op) {
    state.blend = BlendFactors{factor_of(color.src_rgb), factor_of(color.dst_rgb), factor_of(color.src_alpha),
                               factor_of(color.dst_alpha)};
    state.blend_equation.fill(find<BlendEquation>({{GL_FUNC_ADD, BlendEquation::add},
                                                   {GL_FUNC_SUBTRACT, BlendEquation::subtract},
                                                   {GL_FUNC_REVERSE_SUBTRACT, BlendEquation::reverse_subtract},
                                                   {GL_MIN, BlendEquation::min},
                                                   {GL_MAX, BlendEquation::max}},
                                                  color.equation));
    std::ranges::transform(color.blend_color, state.blend_color.begin(), byte_of);
  }
  if (from.stencil.test) {
    state.stencil = stencil_of(from.stencil);
    if (context.drawable->frame.options().config.stencil_bits == 0)
      context.drawable->frame.missing("a stencil buffer", "the host keeps one");
  }
  state.dither = color.dither && context.drawable->frame.options().config.dither_units != 0;
}

/// Texels in the corner of sides that are powers of two, as hardware takes them.
halfplane::Texture padded(const halfplane::Texture& texels) {
  halfplane::Texture texture = texels;
  const auto side = [](int texel) { return static_cast<int>(std::bit_ceil(static_cast<unsigned>(texel))); };
  const TextureLevel& from = texels.level.front();
  TextureLevel level{side(from.width), side(from.height), {}};
  const auto from_width = static_cast<std::size_t>(from.width), width = static_cast<std::size_t>(level.width);
  level.code.resize(width * static_cast<std::size_t>(level.height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(from.height); ++y)
    std::copy_n(from.code.begin() + static_cast<std::ptrdiff_t>(y * from_width), from_width,
                level.code.begin() + static_cast<std::ptrdiff_t>(y * width));
  texture.mips = Mips::none;
  texture.level = {std::move(level)};
  return texture;
}

/// The two ends of an axis of a zoomed image: where in the window, and which texel. Cut to the target, because the guard
/// band is not far.
struct End {
  double at, texel;
};
std::optional<std::array<End, 2>> zoomed(double origin, double zoom, int texels, int target) {
  // The first pixel whose centre is inside; so that no centre lies on the border of two texels.
  if (zoom == std::rint(zoom)) origin = std::ceil(origin - 0.5);
  double first = (-1 - origin) / zoom, last = (target + 1 - origin) / zoom;
  if (!std::isfinite(first) || !std::isfinite(last)) return std::nullopt;
  if (zoom < 0) std::swap(first, last);
  first = std::max(first, 0.0);
  last = std::min<double>(last, texels);
  if (first >= last) return std::nullopt;
  return std::array{End{origin + zoom * first, first}, End{origin + zoom * last, last}};
}

/// PixelRange of an axis, and the texel of one: that of its centre.
struct PixelRange {
  int first, end;
};
PixelRange pixels_of(const std::array<End, 2>& ends, int target) {
  const auto pixel = [&](double at) { return static_cast<int>(held(std::ceil(at - 0.5), 0, target)); };
  const auto [low, high] = std::minmax(ends[0].at, ends[1].at);
  return {pixel(low), pixel(high)};
}
int texel_at(int pixel, const std::array<End, 2>& ends, double zoom, int texels) {
  return static_cast<int>(held(std::floor(ends[0].texel + (pixel + 0.5 - ends[0].at) / zoom), 0, texels - 1));
}

/// Bit by bit; rows of the truth table as in stored_operation().
std::uint8_t operated(unsigned op, unsigned source, unsigned stored) {
  const unsigned result = ((op & 1) != 0 ? source & stored : 0) | ((op & 2) != 0 ? source & ~stored : 0) |
                          ((op & 4) != 0 ? ~source & stored : 0) | ((op & 8) != 0 ? ~source & ~stored : 0);
  return static_cast<std::uint8_t>(result & 255);
}

void draw_channels(Context& context, halfplane::State state, Topology topology, std::span<Vertex> vertices,
                   std::span<const std::uint32_t> indices, const std::array<bool, 4>& channels,
                   const std::array<double, 4>& color) {
  for (std::size_t c = 0; c < 4; ++c) state.color_mask[c] = state.color_mask[c] && channels[c];
  for (Vertex& v : vertices) v.rgba = color;
  context.drawable->frame.draw(state, topology, vertices, indices);
}

/// LogicOp has the order of OpenGL's enumerants.
bool has_logic_unit(const Context& context) { return context.drawable->frame.options().config.logic_units != 0; }
static_assert(static_cast<int>(LogicOp::copy) == GL_COPY - GL_CLEAR &&
              static_cast<int>(LogicOp::invert) == GL_INVERT - GL_CLEAR &&
              static_cast<int>(LogicOp::set) == GL_SET - GL_CLEAR);

/// A logic operation on a channel whose bits are all `is_one` as one on stored bits: bit 0 is the result of stored ones,
/// bit 1 that of stored zeros.
unsigned stored_operation(unsigned op, bool is_one) { return (is_one ? op : op >> 2) & 3; }

/// A logic operation on any colours: the draw replaces the stored colour and marks its pixels by an alpha of 0, the host puts
/// both together. Where a draw comes to a pixel more than once, the last time counts.
void draw_through_host(Context& context, halfplane::State state, Topology topology, std::span<const Vertex> vertices,
                       std::span<const std::uint32_t> indices) {
  Frame& frame = context.drawable->frame;
  frame.missing("logic operations on colours that are not all zeros or ones", "the host carries them out");
  const unsigned op = context.state.color.logic_func - GL_CLEAR;
  const std::array<bool, 4> mask = state.color_mask;
  const auto before = frame.picture().color;
  halfplane::State mark = all_pixels();
  mark.color_mask = {false, false, false, true};
  fill_target(context, mark, {255, 255, 255, 255});
  state.color_mask.fill(true);
  state.blend = BlendFactors{BlendFactor::one, BlendFactor::zero, BlendFactor::zero, BlendFactor::zero};
  frame.draw(state, topology, vertices, indices);
  const Framebuffer& picture = frame.picture();
  TexelImage image{picture.width, picture.height, {}};
  for (int y = picture.height - 1; y >= 0; --y)
    for (int x = 0; x < picture.width; ++x) {
      const std::size_t at = picture.at(x, y);
      const auto stored = widen_color<std::uint32_t>(ColorFormat::rgba8888, before[at]);
      auto source = widen_color<std::uint32_t>(ColorFormat::rgba8888, picture.color[at]);
      const bool is_drawn = source[3] == 0;
      source[3] = static_cast<std::uint32_t>(vertices.front().rgba[3]);
      Texel& result = image.texel.emplace_back();
      for (std::size_t c = 0; c < 4; ++c)
        result[c] = is_drawn && mask[c] ? operated(op, source[c], stored[c]) : static_cast<std::uint8_t>(stored[c]);
    }
  draw_image(context, all_pixels(), image, 0, 0);
}

/// As draw_rectangle(), in a state of space window. Culling and texture are set here.
void draw_texels(Context& context, halfplane::State state, const halfplane::Texture& texels, double x, double y,
                 double zoom_x, double zoom_y, double z, double w, bool has_logic_op) {
  Frame& frame = context.drawable->frame;
  const auto across = zoomed(x, zoom_x, texels.width(), frame.width());
  const auto up = zoomed(y, zoom_y, texels.height(), frame.height());
  if (!across || !up) return;
  const Signature signature = signature_of(texels);
  // The highest bit keeps them apart from the revisions of textures.
  state.texture =
      frame.texture((signature.low ^ signature.high) | std::uint64_t{1} << 63, [&texels] { return padded(texels); });
  state.texture_min = TextureMin::nearest;
  state.texture_mag = TextureMag::nearest;
  state.texture_wrap = {TextureWrap::clamp, TextureWrap::clamp};
  state.texture_combine = TextureCombine::replace;
  state.cull = Cull::none;
  const auto side = [](int size) { return static_cast<double>(std::bit_ceil(static_cast<unsigned>(size))); };
  std::vector<Vertex> corners;
  for (const End& row : *up)
    for (const End& column : *across)
      corners.push_back({column.at,
                         row.at,
                         held(z),
                         w > 0 ? w : 1e-6,  // the distance that fog takes
                         {255, 255, 255, 255},
                         column.texel / side(texels.width()),
                         row.texel / side(texels.height())});
  static constexpr std::array<std::uint32_t, 4> kStrip{0, 1, 2, 3};
  if (has_logic_op) return draw_in(context, state, Topology::triangle_strip, corners, kStrip);
  frame.draw(state, Topology::triangle_strip, corners, kStrip);
}

}  // namespace

halfplane::State all_pixels() {
  halfplane::State state;
  state.space = Space::window;
  state.origin = Origin::bottom_left;
  state.depth_test = DepthFunc::always;
  state.depth_write = false;
  return state;
}

void fill_target(Context& context, const halfplane::State& state, const std::array<double, 4>& rgba) {
  Frame& frame = context.drawable->frame;
  std::vector<Vertex> corners;
  for (const int y : {0, frame.height()})
    for (const int x : {0, frame.width()})
      corners.push_back({static_cast<double>(x), static_cast<double>(y), 0, 1, rgba});
  static constexpr std::array<std::uint32_t, 4> kStrip{0, 1, 2, 3};
  frame.draw(state, Topology::triangle_strip, corners, kStrip);
}

halfplane::State clear_state(Context& context) {
  halfplane::State state;
  state.origin = Origin::bottom_left;
  if (context.state.scissor.test) state.scissor = scissor_of(context.state.scissor);
  return state;
}

bool has_hardware_fog(const FogState& fog) { return fog_of(fog).has_value(); }

std::optional<halfplane::State> hardware_state(Context& context, DrawKind kind) {
  if (context.drawable == nullptr) return std::nullopt;
  Frame& frame = context.drawable->frame;
  const gl::State& from = context.state;
  const PolygonState& polygon = from.polygon;
  if (kind == DrawKind::triangles && polygon.cull && polygon.cull_face == GL_FRONT_AND_BACK) return std::nullopt;
  halfplane::State state = clear_state(context);
  if (kind == DrawKind::rectangle) {
    state.space = Space::window;
  } else {
    const ViewportState& v = from.viewport;
    if (v.width <= 0 || v.height <= 0) return std::nullopt;
    state.viewport = {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.width),
                      static_cast<double>(v.height)};
    state.depth_range = {held(v.near), held(v.far)};
    state.shade = from.lighting.shade_model == GL_FLAT ? Shade::flat : Shade::smooth;
    state.provoking = Provoking::last;
  }
  set_fragment_operations(context, state);
  set_samples(from.multisample, frame.options().config.msaa_samples, state);
  if (kind == DrawKind::triangles) {
    if (polygon.cull) state.cull = polygon.cull_face == GL_BACK ? Cull::back : Cull::front;
    state.front = polygon.front_face == GL_CCW ? FrontFace::ccw : FrontFace::cw;
    state.color_interp = ColorInterp::perspective;
    if (polygon.offset_fill)
      state.polygon_offset = {held(polygon.offset_factor, -kLargestNumber, kLargestNumber),
                              held(polygon.offset_units, -kLargestNumber, kLargestNumber)};
    if (polygon.smooth) frame.missing("antialiased polygons", "their edges are as without");
  }
  // Wider ones would leave the guard band.
  const auto& config = frame.options().config;
  const double widest = held(config.guard_band - std::max(frame.width(), frame.height()) - 3, 1, kLargestLine);
  if (kind == DrawKind::lines) {
    state.smooth = from.line.smooth;
    const double width = held(from.line.width, 1, widest);
    state.line_width = from.line.smooth ? width : std::rint(width);
  }
  if (kind == DrawKind::points) {
    state.smooth = from.point.smooth;
    state.point_shape = from.point.smooth ? PointShape::round : PointShape::square;
    state.point_clip = PointClip::center;
    state.point_size = held(from.point.size, 1, widest);
  }
  if (from.fog.enabled) {
    state.fog = fog_of(from.fog);
    for (std::size_t c = 0; c < 3; ++c) state.fog_color[c] = byte_of(from.fog.color[c]);
  }
  return state;
}

void draw_in(Context& context, halfplane::State state, Topology topology, std::span<Vertex> vertices,
             std::span<const std::uint32_t> indices) {
  Frame& frame = context.drawable->frame;
  const unsigned op = context.state.color.logic_func - GL_CLEAR;
  const bool is_same_for_all = (op & 3) == op >> 2;
  if (vertices.empty() || !context.state.color.logic_op || context.state.color.logic_func == GL_COPY)
    return frame.draw(state, topology, vertices, indices);
  if (has_logic_unit(context)) {
    state.logic_op = static_cast<LogicOp>(op);
    return frame.draw(state, topology, vertices, indices);
  }
  const bool is_plain = !state.texture && !state.fog;
  if (context.state.color.logic_func == GL_COPY_INVERTED && is_plain) {
    for (Vertex& v : vertices)
      for (double& c : v.rgba) c = 255 - c;
    return frame.draw(state, topology, vertices, indices);
  }
  const std::array<double, 4> source = vertices.front().rgba;
  const auto is_black_or_white = [&](const Vertex& v) {
    return v.rgba == source && std::ranges::all_of(source, [](double c) { return c == 0 || c == 255; });
  };
  if (!is_same_for_all && !(is_plain && std::ranges::all_of(vertices, is_black_or_white))) {
    if (frame.options().config.color_format == ColorFormat::rgba8888)
      return draw_through_host(context, state, topology, vertices, indices);
    frame.missing("logic operations on colours that are not all zeros or ones", "the colour counts as the nearer");
  }
  state.texture.reset();
  state.fog.reset();
  std::array<bool, 4> replaced{}, inverted{};
  std::array<double, 4> color{};
  for (std::size_t c = 0; c < 4; ++c) {
    const unsigned operation = stored_operation(op, source[c] > 127);
    replaced[c] = operation == 0 || operation == 3;
    inverted[c] = operation == 2;
    color[c] = operation == 3 ? 255 : 0;
  }
  const bool inverts = std::ranges::count(inverted, true) > 0;
  if (!inverts || std::ranges::count(replaced, true) > 0) {
    draw_channels(context, state, topology, vertices, indices, replaced, color);
    if (state.depth_write) state.depth_test = DepthFunc::equal;
    state.depth_write = false;
    state.stencil.reset();
  }
  if (!inverts) return;
  state.blend = BlendFactors{BlendFactor::one_minus_dst_color, BlendFactor::zero, BlendFactor::one_minus_dst_alpha,
                             BlendFactor::zero};
  draw_channels(context, state, topology, vertices, indices, inverted, {255, 255, 255, 255});
}

void draw_image(Context& context, const halfplane::State& state, const TexelImage& image, int x, int y, double z,
                double w) {
  for (int top = 0; top < image.height; top += kLargestTexture)
    for (int left = 0; left < image.width; left += kLargestTexture) {
      TexelImage part{std::min(kLargestTexture, image.width - left), std::min(kLargestTexture, image.height - top), {}};
      for (int row = top; row < top + part.height; ++row) {
        const auto first = image.texel.begin() + std::ptrdiff_t{row} * image.width + left;
        part.texel.insert(part.texel.end(), first, first + part.width);
      }
      draw_texels(context, state, make_texture("pixels", part, TextureFormat::rgba8888, Mips::none), x + left, y + top,
                  1, 1, z, w, false);
    }
}

void draw_rectangle(Context& context, const halfplane::Texture& texels, double x, double y, double zoom_x,
                    double zoom_y, double z, double w) {
  const auto state = hardware_state(context, DrawKind::rectangle);
  if (!state) return;
  Frame& frame = context.drawable->frame;
  const unsigned op = context.state.color.logic_func - GL_CLEAR;
  const bool looks_at_both =
      context.state.color.logic_op && op != GL_COPY - GL_CLEAR && (op & 3) != op >> 2 && !has_logic_unit(context);
  const bool has_other_fog = context.state.fog.enabled && !state->fog;
  if (!looks_at_both && !has_other_fog) return draw_texels(context, *state, texels, x, y, zoom_x, zoom_y, z, w, true);

  const auto across = zoomed(x, zoom_x, texels.width(), frame.width());
  const auto up = zoomed(y, zoom_y, texels.height(), frame.height());
  if (!across || !up) return;
  const PixelRange columns = pixels_of(*across, frame.width()), rows = pixels_of(*up, frame.height());
  const auto for_each_pixel = [&](const auto& visit) {
    for (int row = rows.first; row < rows.end; ++row)
      for (int column = columns.first; column < columns.end; ++column)
        visit(column, row,
              texels.texel(0, texel_at(column, *across, zoom_x, texels.width()),
                           texel_at(row, *up, zoom_y, texels.height())));
  };
  if (has_other_fog) {
    std::vector<WindowFragment> fragments;
    for_each_pixel([&](int column, int row, const Texel& texel) {
      WindowFragment& f = fragments.emplace_back(WindowFragment{column, row, z, w, {}});
      std::ranges::transform(texel, f.color.begin(), [](std::uint8_t c) { return c / 255.0; });
    });
    return draw_fragments(context, fragments);
  }
  // No pixel comes twice, so that the host can put them together before any is drawn.
  if (columns.first >= columns.end || rows.first >= rows.end) return;
  const Framebuffer& picture = frame.picture();
  TexelImage image{columns.end - columns.first, rows.end - rows.first, {}};
  for_each_pixel([&](int column, int row, const Texel& source) {
    const auto stored = widen_color<std::uint32_t>(frame.options().config.color_format,
                                                   picture.color[picture.at(column, picture.height - 1 - row)]);
    Texel& result = image.texel.emplace_back();
    for (std::size_t c = 0; c < 4; ++c) result[c] = operated(op, source[c], stored[c]);
  });
  draw_image(context, *state, image, columns.first, rows.first, z, w);
}

}  // namespace halfplane::gl
