#include "host_shader.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "../../model/host/clip_fan.hpp"
#include "../../model/host/viewport.hpp"
#include "../../model/signature.hpp"
#include "../../model/stages/fragment_ops.hpp"
#include "clip.hpp"
#include "context.hpp"
#include "environment.hpp"
#include "matrix.hpp"

namespace halfplane::gl {
namespace {

/// a x + b y + c of pixels.
using Linear = std::array<double, 3>;
double at(const Linear& l, double x, double y) { return l[0] * x + l[1] * y + l[2]; }

Linear cross(const Linear& a, const Linear& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Columns and rows of pixels, the last ones not included.
struct PixelBox {
  int left = 0, bottom = 0, right = 0, top = 0;
  [[nodiscard]] int width() const { return right - left; }
  [[nodiscard]] int height() const { return top - bottom; }
  [[nodiscard]] bool is_empty() const { return left >= right || bottom >= top; }
};

/// From the coordinates of vertices to pixels from the bottom left, as the model has them.
struct Window {
  Space space;
  Viewport viewport;

  /// x w, y w and w.
  [[nodiscard]] Linear homogeneous(const ShadedVertex& v) const {
    const auto& [x, y, z, w] = v.clip;
    if (space == Space::window) return {x * w, y * w, w};
    return {viewport.x * w + (x + w) * viewport.width / 2, viewport.y * w + (y + w) * viewport.height / 2, w};
  }
  [[nodiscard]] std::array<double, 2> position(const ShadedVertex& v) const {
    if (space == Space::window) return {v.clip[0], v.clip[1]};
    const Linear h = homogeneous(v);
    return {h[0] / h[2], h[1] / h[2]};
  }
};

/// A triangle that is to be shaded: what its vertices weigh at a pixel, over w.
struct Piece {
  std::span<const ShadedVertex> vertices;  ///< three
  std::array<Linear, 3> weight{};
  std::array<double, 3> margin{};                  ///< of a weight, that pixels may lie outside
  std::array<TexturePlace, kTextureUnits> places;  ///< changes of coordinates, which are 0
  std::vector<ShadedVertex> polygon;               ///< the part of it that the model need not cut
  PixelBox box;
  int x = 0, y = 0;  ///< of the box in the image
};

class Shader {
 public:
  Shader(const Context& context, const Shading& shading, const AlphaTest& test)
      : fog_(context.state.fog),
        stipple_(context.state.stipple),
        environments_(context),
        shading_(shading),
        test_(test) {}

  /// A stippled polygon's fragments that are not to be drawn have an alpha of 0, and no others have.
  [[nodiscard]] Texel operator()(const Piece& piece, int x, int y, const std::array<double, 3>& weight) const {
    if (!shading_.is_stippled) return color(piece, weight);
    if ((stipple_.row[static_cast<std::size_t>(y % 32)] >> (31 - x % 32) & 1) == 0) return {};
    Texel texel = color(piece, weight);
    if (!depth_passes(test_.func, texel[3], test_.reference)) return {};
    texel[3] = std::max<std::uint8_t>(texel[3], 1);
    return texel;
  }

 private:
  [[nodiscard]] Texel color(const Piece& piece, const std::array<double, 3>& weight) const {
    std::array<double, 3> part = weight;  // held to the triangle: extrapolated colours may be anything
    for (double& p : part) p = std::max(p, 0.0);
    const double sum = part[0] + part[1] + part[2];
    Vec4 rgba{}, secondary{};
    double distance = 0;
    std::array<TexturePlace, kTextureUnits> places = piece.places;
    for (std::size_t i = 0; i < 3; ++i) {
      const ShadedVertex& v = piece.vertices[i];
      const double share = part[i] / sum;
      distance += share * v.fog_distance;
      for (std::size_t c = 0; c < 4; ++c) {
        rgba[c] += share * v.color[0][c];
        secondary[c] += share * v.secondary[0][c];
        for (std::size_t unit = 0; unit < kTextureUnits; ++unit) places[unit].at[c] += part[i] * v.tex_coord[unit][c];
      }
    }
    for (double& channel : rgba) channel = held(channel);
    rgba = environments_(rgba, places);
    const double factor = shading_.has_fog ? fog_factor(fog_, distance) : 1;
    std::array<float, 4> result{0, 0, 0, static_cast<float>(rgba[3])};
    for (std::size_t c = 0; c < 3; ++c)
      result[c] = static_cast<float>(factor * held(rgba[c] + secondary[c]) + (1 - factor) * held(fog_.color[c]));
    return texel_of(result);
  }

  const FogState& fog_;
  const StippleState& stipple_;
  TextureEnvironments environments_;
  Shading shading_;
  AlphaTest test_;
};

/// Triangles in order, packed into images row by row, and drawn.
class Packer {
 public:
  /// `part`: of the target, no wider and no higher than a texture.
  Packer(Context& context, const halfplane::State& state, const Shading& shading, const PixelBox& part)
      : context_(context),
        frame_(context.drawable->frame),
        config_(frame_.options().config),
        state_(state),
        window_{state_.space, state_.viewport.value_or(Viewport{})},
        shader_(context, shading, state_.alpha_test),
        // Snapping moves an edge by half a subpixel; one of several samples may be covered where the centre is not.
        margin_(std::ldexp(1.0, -config_.subpixel_bits) + (config_.msaa_samples > 1 ? 1 : 0)) {
    if (shading.is_stippled) state_.alpha_test = {DepthFunc::greater, 0};
    state_.texture_min = TextureMin::nearest;
    state_.texture_mag = TextureMag::nearest;
    state_.texture_interp = TextureInterp::affine;
    state_.texture_wrap = {TextureWrap::clamp, TextureWrap::clamp};
    state_.texture_combine = TextureCombine::replace;
    state_.color_interp = ColorInterp::affine;
    state_.shade = Shade::smooth;
    bounds_ = part;
    const auto cut = [this](double left, double bottom, double width, double height) {
      bounds_.left = static_cast<int>(std::max<double>(bounds_.left, left));
      bounds_.bottom = static_cast<int>(std::max<double>(bounds_.bottom, bottom));
      bounds_.right = static_cast<int>(std::min<double>(bounds_.right, left + width));
      bounds_.top = static_cast<int>(std::min<double>(bounds_.top, bottom + height));
    };
    if (state_.scissor) cut(state_.scissor->x, state_.scissor->y, state_.scissor->width, state_.scissor->height);
    if (state_.space == Space::clip)
      cut(window_.viewport.x, window_.viewport.y, window_.viewport.width, window_.viewport.height);
    if (!bounds_.is_empty() && (part.width() < frame_.width() || part.height() < frame_.height()))
      state_.scissor = Rect{bounds_.left, bounds_.bottom, bounds_.width(), bounds_.height()};
  }

  void draw(std::span<const ShadedVertex> triangles) {
    for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
      Piece piece;
      piece.vertices = triangles.subspan(i, 3);
      if (prepare(piece)) pieces_.push_back(std::move(piece));
    }
    for (std::size_t first = 0; first < pieces_.size();) {
      const std::size_t end = pack(first);
      draw_image(std::span(pieces_).subspan(first, end - first));
      first = end;
    }
  }

 private:
  /// False: nothing of it is seen.
  bool prepare(Piece& piece) const {
    std::array<Linear, 3> corner;
    for (std::size_t i = 0; i < 3; ++i) corner[i] = window_.homogeneous(piece.vertices[i]);
    piece.polygon.assign(piece.vertices.begin(), piece.vertices.end());
    if (state_.space == Space::clip) clip_as_model(piece.polygon);
    if (piece.polygon.empty()) return false;
    // (x, y, 1) is the sum of the corners times their weights.
    for (std::size_t i = 0; i < 3; ++i) piece.weight[i] = cross(corner[(i + 1) % 3], corner[(i + 2) % 3]);
    const Linear& first = corner[0];
    const double volume = first[0] * piece.weight[0][0] + first[1] * piece.weight[0][1] + first[2] * piece.weight[0][2];
    if (!std::isfinite(1 / volume)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      for (double& c : piece.weight[i]) c /= volume;
      piece.margin[i] = margin_ * std::hypot(piece.weight[i][0], piece.weight[i][1]);
    }
    for (std::size_t unit = 0; unit < kTextureUnits; ++unit) {
      TexturePlace& place = piece.places[unit];
      place.at = {};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t c = 0; c < 4; ++c) {
          place.dx[c] += piece.weight[i][0] * piece.vertices[i].tex_coord[unit][c];
          place.dy[c] += piece.weight[i][1] * piece.vertices[i].tex_coord[unit][c];
        }
    }
    double left = bounds_.right, bottom = bounds_.top, right = bounds_.left, top = bounds_.bottom;
    for (const ShadedVertex& v : piece.polygon) {
      if (!(v.clip[3] > 0)) return false;
      const auto [x, y] = window_.position(v);
      if (!std::isfinite(x) || !std::isfinite(y)) return false;
      left = std::min(left, x), right = std::max(right, x);
      bottom = std::min(bottom, y), top = std::max(top, y);
    }
    const auto pixel = [](double place, int low, int high) { return static_cast<int>(held(place, low, high)); };
    piece.box = {pixel(std::floor(left - margin_), bounds_.left, bounds_.right),
                 pixel(std::floor(bottom - margin_), bounds_.bottom, bounds_.top),
                 pixel(std::ceil(right + margin_), bounds_.left, bounds_.right),
                 pixel(std::ceil(top + margin_), bounds_.bottom, bounds_.top)};
    return !piece.box.is_empty();
  }

  /// Cuts a triangle of clip space where the model would, and begins the fan of what is left where the model does, so that
  /// depths are those of the same triangle without this shader.
  void clip_as_model(Vertices& polygon) const {
    const Viewport viewport = effective_viewport(state_, frame_.width(), frame_.height());
    // What is cut here must not be cut again by a rounding error, which would split edges that lie in a plane.
    constexpr double kInside = 0x1p-20;  // pixels, far less than a subpixel
    const double limit = guard_band_limit(config_) - kInside;
    clip(polygon, guard_band_planes(state_.clip_z, viewport, limit));
    for (ShadedVertex& v : polygon) v.clip[2] = held(v.clip[2], -v.clip[3], v.clip[3]);
    if (polygon.size() <= 3) return;
    std::vector<SnappedVertex> snapped;
    for (const ShadedVertex& v : polygon) {
      const Vertex vertex{v.clip[0], v.clip[1], v.clip[2], v.clip[3]};
      const WindowPosition p = to_window(vertex, state_, viewport);
      snapped.push_back(snap_vertex({held(p.x, -limit, limit), held(p.y, -limit, limit), held(p.z)}, vertex, config_,
                                    {}, snap_origin(state_, config_)));
    }
    const auto start = static_cast<std::ptrdiff_t>(fan_start(snapped));
    std::rotate(polygon.begin(), polygon.begin() + start, polygon.end());
  }

  /// Places pieces from `first` on in an image, and says which one is the next that has no place there.
  std::size_t pack(std::size_t first) {
    constexpr int kLargestImage = 2048;  // texels of a side
    double area = 0;
    int widest = 1;
    for (const Piece& piece : std::span(pieces_).subspan(first)) {
      area += double{1} * piece.box.width() * piece.box.height();
      widest = std::max(widest, piece.box.width());
    }
    const auto side = [](double texels) {
      return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(texels, 1.0))));
    };
    width_ = std::max(side(widest), std::min(side(std::sqrt(area)), kLargestImage));
    int x = 0, y = 0, row = 0;
    for (std::size_t i = first; i < pieces_.size(); ++i) {
      Piece& piece = pieces_[i];
      if (x + piece.box.width() > width_) x = 0, y += std::exchange(row, 0);
      if (i > first && y + piece.box.height() > kLargestImage) return height_ = side(y + row), i;
      piece.x = x, piece.y = y;
      x += piece.box.width();
      row = std::max(row, piece.box.height());
    }
    height_ = side(y + row);
    return pieces_.size();
  }

  void draw_image(std::span<const Piece> pieces) {
    halfplane::Texture texture;
    texture.name = "fragments";
    TextureLevel& level = texture.level.emplace_back(TextureLevel{width_, height_, {}});
    level.code.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    for (const Piece& piece : pieces) {
      shade(piece, level);
      const auto first = static_cast<std::uint32_t>(vertices.size());
      for (const ShadedVertex& v : piece.polygon) {
        const auto [x, y] = window_.position(v);
        vertices.push_back({v.clip[0],
                            v.clip[1],
                            v.clip[2],
                            v.clip[3],
                            {255, 255, 255, 255},
                            (snapped(x) - piece.box.left + piece.x) / width_,
                            (snapped(y) - piece.box.bottom + piece.y) / height_});
      }
      for (std::uint32_t i = 1; i + 1 < piece.polygon.size(); ++i)
        indices.insert(indices.end(), {first, first + i, first + i + 1});
    }
    const Signature signature = signature_of(texture);
    // The highest bit keeps them apart from the revisions of textures.
    state_.texture = frame_.texture((signature.low ^ signature.high) | std::uint64_t{1} << 63,
                                    [&texture] { return std::move(texture); });
    draw_in(context_, state_, Topology::triangles, vertices, indices);
  }

  /// The grid that the model's vertices lie on, so that its planes of coordinates are exact.
  [[nodiscard]] double snapped(double place) const {
    return std::ldexp(std::rint(std::ldexp(place, config_.subpixel_bits)), -config_.subpixel_bits);
  }

  void shade(const Piece& piece, TextureLevel& level) const {
    for (int row = piece.box.bottom; row < piece.box.top; ++row)
      for (int column = piece.box.left; column < piece.box.right; ++column) {
        const double x = column + 0.5, y = row + 0.5;
        std::array<double, 3> weight;
        bool is_near = true;
        for (std::size_t i = 0; i < 3; ++i) {
          weight[i] = at(piece.weight[i], x, y);
          is_near &= weight[i] >= -piece.margin[i];
        }
        if (!is_near || !(weight[0] > 0 || weight[1] > 0 || weight[2] > 0)) continue;
        const Texel texel = shader_(piece, column, row, weight);
        const auto place =
            static_cast<std::size_t>(row - piece.box.bottom + piece.y) * static_cast<std::size_t>(width_) +
            static_cast<std::size_t>(column - piece.box.left + piece.x);
        level.code[place] =
            std::uint32_t{texel[0]} << 24 | std::uint32_t{texel[1]} << 16 | std::uint32_t{texel[2]} << 8 | texel[3];
      }
  }

  Context& context_;
  Frame& frame_;
  const Config& config_;
  halfplane::State state_;
  Window window_;
  Shader shader_;
  double margin_;    ///< pixels around a triangle that it may cover
  PixelBox bounds_;  ///< of what can be seen
  std::vector<Piece> pieces_;
  int width_ = 1, height_ = 1;  ///< of the image at work
};

}  // namespace

TextureEnvironments::TextureEnvironments(const Context& context) : state_(context.state.texture) {
  for (std::size_t unit = 0; unit < kTextureUnits; ++unit)
    if (const TextureObject* texture = sampled_texture(context, static_cast<int>(unit)))
      sampler_[unit].emplace(*texture, state_.unit[unit].lod_bias);
}

Vec4 TextureEnvironments::operator()(const Vec4& primary, const std::array<TexturePlace, kTextureUnits>& places) const {
  std::array<Vec4, kTextureUnits> textures;
  textures.fill({0, 0, 0, 1});  // of a unit without one, which the specification leaves undefined
  for (std::size_t unit = 0; unit < kTextureUnits; ++unit)
    if (sampler_[unit]) textures[unit] = (*sampler_[unit])(places[unit]);
  Vec4 color = primary;
  for (std::size_t unit = 0; unit < kTextureUnits; ++unit) {
    if (!sampler_[unit]) continue;
    const Vec4 previous = color;
    const TextureUnit& state = state_.unit[unit];
    const auto source = [&](GLenum name, std::size_t channel, std::size_t) {
      const Vec4& of = name == GL_CONSTANT        ? state.env_color
                       : name == GL_PRIMARY_COLOR ? primary
                       : name == GL_PREVIOUS      ? previous
                                                  : textures[name == GL_TEXTURE ? unit : name - GL_TEXTURE0];
      return of[channel];
    };
    const auto& [rgb, alpha] = state.combine;
    for (std::size_t c = 0; c < 4; ++c) {
      const TextureCombiner& combiner = c < 3 || rgb.function == GL_DOT3_RGBA ? rgb : alpha;
      color[c] = held(state.env_mode == GL_COMBINE
                          ? combined<double>(combiner, c, source) * combiner.scale
                          : plain<double>(state, sampler_[unit]->base(), c, previous[c], textures[unit]));
    }
  }
  return color;
}

double fog_factor(const FogState& fog, double distance) {
  const double x = fog.density * distance;
  if (fog.mode == GL_LINEAR) return held((fog.end - distance) / (fog.end - fog.start));
  return held(std::exp(fog.mode == GL_EXP ? -x : -x * x));
}

void draw_shaded(Context& context, const halfplane::State& state, std::span<const ShadedVertex> vertices,
                 const Shading& shading) {
  const int width = context.drawable->frame.width(), height = context.drawable->frame.height();
  for (int y = 0; y < height; y += kLargestTexture)
    for (int x = 0; x < width; x += kLargestTexture)
      Packer(context, state, shading,
             {x, y, std::min(x + kLargestTexture, width), std::min(y + kLargestTexture, height)})
          .draw(vertices);
}

}  // namespace halfplane::gl
