#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <utility>

#include "../../model/stages/color_ops.hpp"
#include "host_shader.hpp"
#include "matrix.hpp"
#include "parameter.hpp"
#include "primitive.hpp"
#include "texture.hpp"

namespace halfplane::gl {
namespace {

struct Range {
  int first = 0, last = 0;  ///< the index after it
};

/// The pixels within [0, size) whose centres lie in the zoomed square of texel `i`, with its lower edge.
Range zoomed(double origin, double zoom, int i, int size) {
  const auto pixel = [size](double edge) {
    const double first = std::ceil(edge - 0.5);
    return first > 0 ? static_cast<int>(std::min(first, static_cast<double>(size))) : 0;  // NaN: 0
  };
  const int a = pixel(origin + zoom * i), b = pixel(origin + zoom * (i + 1));
  return {std::min(a, b), std::max(a, b)};
}

/// Calls visit(x, y, pixel) for each pixel of the window that a zoomed image covers.
template <class Visit>
void for_each_covered(const Context& context, const Image& image, double x, double y, const Visit& visit) {
  const Frame& frame = context.drawable->frame;
  const PixelState& state = context.state.pixel;
  for (int j = 0; j < image.height; ++j) {
    const Range rows = zoomed(y, state.zoom_y, j, frame.height());
    for (int i = 0; i < image.width && rows.first < rows.last; ++i) {
      const Range columns = zoomed(x, state.zoom_x, i, frame.width());
      const auto& pixel =
          image
              .pixel[static_cast<std::size_t>(j) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(i)];
      for (int row = rows.first; row < rows.last; ++row)
        for (int column = columns.first; column < columns.last; ++column) visit(column, row, pixel);
    }
  }
}

/// The color sum after the texture.
Vec4 with_secondary(const Context& context, Vec4 color) {
  for (std::size_t c = 0; c < 3; ++c) color[c] = std::min(color[c] + context.state.current.raster.secondary[c], 1.0);
  return color;
}
/// The textures at the raster position, where they are magnified.
Vec4 textured(const Context& context, const TextureEnvironments& environments, const Vec4& color) {
  std::array<TexturePlace, kTextureUnits> places;
  for (std::size_t unit = 0; unit < kTextureUnits; ++unit)
    places[unit].at = context.state.current.raster.tex_coord[unit];
  return with_secondary(context, environments(color, places));
}
Vec4 raster_color(const Context& context) {
  return textured(context, TextureEnvironments(context), context.state.current.raster.color);
}

/// Fragments are handed on in batches of this size.
constexpr std::size_t kBatch = 1 << 16;

void draw_colors(Context& context, const Image& image, double x, double y) {
  const RasterPosition& raster = context.state.current.raster;
  const PixelState& state = context.state.pixel;
  const TextureEnvironments environments(context);
  const bool is_plain =
      textured_units(context) == 0 && raster.secondary[0] == 0 && raster.secondary[1] == 0 && raster.secondary[2] == 0;
  const auto texel = [&](const std::array<float, 4>& pixel) {
    if (is_plain) return texel_of(pixel);
    const Vec4 color{held(pixel[0]), held(pixel[1]), held(pixel[2]), held(pixel[3])};
    const Vec4 drawn = textured(context, environments, color);
    return texel_of({static_cast<float>(drawn[0]), static_cast<float>(drawn[1]), static_cast<float>(drawn[2]),
                     static_cast<float>(drawn[3])});
  };
  for (int bottom = 0; bottom < image.height; bottom += kLargestTexture)
    for (int left = 0; left < image.width; left += kLargestTexture) {
      TexelImage tile{
          std::min(image.width - left, kLargestTexture), std::min(image.height - bottom, kLargestTexture), {}};
      for (int j = bottom; j < bottom + tile.height; ++j) {
        const auto row = image.pixel.begin() + std::ptrdiff_t{j} * image.width + left;
        std::transform(row, row + tile.width, std::back_inserter(tile.texel), texel);
      }
      draw_rectangle(context, make_texture("pixels", tile, TextureFormat::rgba8888, Mips::none),
                     x + state.zoom_x * left, y + state.zoom_y * bottom, state.zoom_x, state.zoom_y, raster.window[2],
                     raster.distance);
    }
}

void draw_depths(Context& context, const Image& image, double x, double y) {
  const RasterPosition& raster = context.state.current.raster;
  const Vec4 color = raster_color(context);
  std::vector<WindowFragment> fragments;
  for_each_covered(context, image, x, y, [&](int column, int row, const std::array<float, 4>& pixel) {
    fragments.push_back({column, row, held(pixel[0]), raster.distance, color});
    if (fragments.size() < kBatch) return;
    draw_fragments(context, fragments);
    fragments.clear();
  });
  draw_fragments(context, fragments);
}

/// Stencil values are written without tests, but for ownership and scissor: a draw for each value that is there.
void draw_stencils(Context& context, const Image& image, double x, double y) {
  std::array<std::vector<WindowFragment>, 256> of_value;
  for_each_covered(context, image, x, y, [&](int column, int row, const std::array<float, 4>& pixel) {
    of_value[static_cast<std::size_t>(pixel[0]) & 255].push_back({column, row});
  });
  const State saved = context.state;
  State& state = context.state;
  state.depth.test = state.fog.enabled = state.point.smooth = state.lighting.enabled = false;
  state.color.alpha_test = state.color.blend = state.color.logic_op = false;
  state.color.write.fill(false);
  state.multisample.enabled = false;
  for (TextureUnit& unit : state.texture.unit) unit.enabled.fill(false);
  state.stencil.test = true;
  state.stencil.func = GL_ALWAYS;
  state.stencil.fail = state.stencil.depth_fail = state.stencil.depth_pass = GL_REPLACE;
  for (std::size_t value = 0; value < of_value.size(); ++value) {
    if (of_value[value].empty()) continue;
    state.stencil.reference = static_cast<int>(value);
    ++context.revision;
    draw_fragments(context, of_value[value]);
  }
  state = saved;
  ++context.revision;
}

/// Pixels after glPixelTransfer, their lower left corner at the raster position plus (x, y) times the zoom.
void draw_image(Context& context, const Image& image, double x, double y) {
  if (context.drawable == nullptr || image.pixel.empty()) return;
  const Vec4& window = context.state.current.raster.window;
  const PixelState& state = context.state.pixel;
  const auto draw = image.format == GL_DEPTH_COMPONENT ? draw_depths
                    : image.format == GL_STENCIL_INDEX ? draw_stencils
                                                       : draw_colors;
  draw(context, image, window[0] + state.zoom_x * x, window[1] + state.zoom_y * y);
}

/// Whether there is a stencil buffer to draw to or read from; else GL_INVALID_OPERATION.
bool has_stencil(Context& context, const Drawable* drawable) {
  const bool has = drawable == nullptr || drawable->frame.options().config.stencil_bits != 0;
  if (!has) context.fail(GL_INVALID_OPERATION);
  return has;
}

/// A depth code as window z.
double depth_of(const Config& config, std::uint32_t code) {
  const double value = config.depth_format.kind == DepthFormat::Kind::plane
                           ? code / (std::ldexp(1.0, config.depth_bits) - 1)
                           : static_cast<double>(depth_value(config.depth_format, code));
  return is_reversed(config.depth_mapping) ? 1 - value : value;
}

/// A parameter of glPixelStore: its names of the two sets, and a number or a switch of either.
struct StoreParameter {
  GLenum unpack, pack;
  int PixelStore::*number;
  bool PixelStore::*flag;
};
constexpr auto kStoreParameters = std::to_array<StoreParameter>({
    {GL_UNPACK_SWAP_BYTES, GL_PACK_SWAP_BYTES, nullptr, &PixelStore::swap_bytes},
    {GL_UNPACK_LSB_FIRST, GL_PACK_LSB_FIRST, nullptr, &PixelStore::lsb_first},
    {GL_UNPACK_ROW_LENGTH, GL_PACK_ROW_LENGTH, &PixelStore::row_length, nullptr},
    {GL_UNPACK_SKIP_ROWS, GL_PACK_SKIP_ROWS, &PixelStore::skip_rows, nullptr},
    {GL_UNPACK_SKIP_PIXELS, GL_PACK_SKIP_PIXELS, &PixelStore::skip_pixels, nullptr},
    {GL_UNPACK_ALIGNMENT, GL_PACK_ALIGNMENT, &PixelStore::alignment, nullptr},
    {GL_UNPACK_SKIP_IMAGES, GL_PACK_SKIP_IMAGES, &PixelStore::skip_images, nullptr},
    {GL_UNPACK_IMAGE_HEIGHT, GL_PACK_IMAGE_HEIGHT, &PixelStore::image_height, nullptr},
});

}  // namespace

void draw_pixels(Context& context, std::shared_ptr<const Image> image) {
  if (image->format == GL_STENCIL_INDEX && !has_stencil(context, context.drawable)) return;
  if (!context.state.current.raster.valid || feed_raster(context, GL_DRAW_PIXEL_TOKEN)) return;
  draw_image(context, *transferred(context, std::move(image)), 0, 0);
}

void bitmap(Context& context, const std::shared_ptr<const Bitmap>& bitmap, double x_origin, double y_origin,
            double x_move, double y_move) {
  RasterPosition& raster = context.state.current.raster;
  if (!raster.valid) return;
  if (!feed_raster(context, GL_BITMAP_TOKEN) && context.drawable != nullptr && !bitmap->bit.empty()) {
    const Frame& frame = context.drawable->frame;
    const double left = std::floor(raster.window[0] - x_origin), bottom = std::floor(raster.window[1] - y_origin);
    const Vec4 color = raster_color(context);
    std::vector<WindowFragment> fragments;
    std::size_t bit = 0;
    for (int j = 0; j < bitmap->height; ++j)
      for (int i = 0; i < bitmap->width; ++i) {
        const double x = left + i, y = bottom + j;
        if (bitmap->bit[bit++] && x >= 0 && y >= 0 && x < frame.width() && y < frame.height())
          fragments.push_back({static_cast<int>(x), static_cast<int>(y), raster.window[2], raster.distance, color});
      }
    draw_fragments(context, fragments);
  }
  raster.window[0] += x_move;
  raster.window[1] += y_move;
}

void copy_pixels(Context& context, GLint x, GLint y, GLsizei width, GLsizei height, GLenum type) {
  if (type != GL_COLOR && type != GL_DEPTH && type != GL_STENCIL) return context.fail(GL_INVALID_ENUM);
  if (width < 0 || height < 0) return context.fail(GL_INVALID_VALUE);
  if (type == GL_STENCIL && !(has_stencil(context, context.drawable) && has_stencil(context, context.read_drawable)))
    return;
  if (!context.state.current.raster.valid || feed_raster(context, GL_COPY_PIXEL_TOKEN)) return;
  if (context.read_drawable == nullptr) return;
  // Pixels outside the window are undefined, and not copied.
  const Frame& frame = context.read_drawable->frame;
  const auto part = [](GLint first, GLsizei count, int size) {
    const std::int64_t last = std::min<std::int64_t>(std::int64_t{first} + count, size);
    return Range{std::max(first, 0), static_cast<int>(std::max<std::int64_t>(last, std::max(first, 0)))};
  };
  const Range columns = part(x, width, frame.width()), rows = part(y, height, frame.height());
  const GLenum format = type == GL_COLOR ? GL_RGBA : type == GL_DEPTH ? GL_DEPTH_COMPONENT : GL_STENCIL_INDEX;
  auto image = std::make_shared<const Image>(
      read_rectangle(context, columns.first, rows.first, columns.last - columns.first, rows.last - rows.first, format));
  draw_image(context, *transferred(context, std::move(image)), double{1} * columns.first - x,
             double{1} * rows.first - y);
}

void read_pixels(Context& context, GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,
                 void* pixels) {
  if (const GLenum error = check_format(format, type); error != GL_NO_ERROR) return context.fail(error);
  if (width < 0 || height < 0) return context.fail(GL_INVALID_VALUE);
  if (format == GL_COLOR_INDEX) return context.fail(GL_INVALID_OPERATION);  // the framebuffer holds RGBA
  if (format == GL_STENCIL_INDEX && !has_stencil(context, context.read_drawable)) return;
  const bool is_color = format != GL_DEPTH_COMPONENT && format != GL_STENCIL_INDEX;
  auto image =
      std::make_shared<const Image>(read_rectangle(context, x, y, width, height, is_color ? GLenum{GL_RGBA} : format));
  pack(context, *transferred(context, std::move(image)), format, type, pixels);
}

void pixel_zoom(Context& context, double x, double y) {
  context.state.pixel.zoom_x = x;
  context.state.pixel.zoom_y = y;
}

std::optional<Place> transfer_place(PixelState& state, GLenum pname) {
  constexpr std::array<GLenum, 8> kChannels{GL_RED_SCALE,  GL_RED_BIAS,  GL_GREEN_SCALE, GL_GREEN_BIAS,
                                            GL_BLUE_SCALE, GL_BLUE_BIAS, GL_ALPHA_SCALE, GL_ALPHA_BIAS};
  if (const auto found = std::ranges::find(kChannels, pname); found != kChannels.end()) {
    const auto i = static_cast<std::size_t>(found - kChannels.begin());
    return Place{&(i % 2 == 0 ? state.scale : state.bias)[i / 2]};
  }
  switch (pname) {
    case GL_DEPTH_SCALE: return Place{&state.depth_scale};
    case GL_DEPTH_BIAS: return Place{&state.depth_bias};
    case GL_INDEX_SHIFT: return Place{&state.index_shift};
    case GL_INDEX_OFFSET: return Place{&state.index_offset};
    case GL_MAP_COLOR: return Place{&state.map_color};
    case GL_MAP_STENCIL: return Place{&state.map_stencil};
    default: return std::nullopt;
  }
}

void pixel_transfer(Context& context, GLenum pname, double value) {
  set_parameter(context, transfer_place(context.state.pixel, pname), {{value}});
}

void pixel_map(Context& context, GLenum map, const std::shared_ptr<const std::vector<float>>& values) {
  if (map < GL_PIXEL_MAP_I_TO_I || map > GL_PIXEL_MAP_A_TO_A) return context.fail(GL_INVALID_ENUM);
  const bool is_of_indices = map <= GL_PIXEL_MAP_I_TO_A, holds_indices = map <= GL_PIXEL_MAP_S_TO_S;
  if (values == nullptr || values->empty() || (is_of_indices && !std::has_single_bit(values->size())))
    return context.fail(GL_INVALID_VALUE);
  std::vector<float> table = *values;
  for (float& value : table) {
    if (!holds_indices || std::isnan(value)) value = static_cast<float>(held(value));
    if (holds_indices) value = std::clamp(value, -2147483648.0F, 4294967296.0F);
  }
  context.pixel_maps[map] = std::move(table);
}

std::optional<Place> store_place(ClientState& client, GLenum pname) {
  const auto* row = std::ranges::find_if(
      kStoreParameters, [pname](const StoreParameter& p) { return p.unpack == pname || p.pack == pname; });
  if (row == kStoreParameters.end()) return std::nullopt;
  PixelStore& store = row->unpack == pname ? client.unpack : client.pack;
  return row->flag != nullptr ? Place{&(store.*row->flag)} : Place{.where = &(store.*row->number), .low = 0};
}

void pixel_store(Context& context, GLenum pname, double value) {
  const bool is_alignment = pname == GL_UNPACK_ALIGNMENT || pname == GL_PACK_ALIGNMENT;
  if (const double rows = std::round(value); is_alignment && rows != 1 && rows != 2 && rows != 4 && rows != 8)
    return context.fail(GL_INVALID_VALUE);
  set_parameter(context, store_place(context.client, pname), {{value}});
}

Image read_rectangle(Context& context, int x, int y, int width, int height, GLenum format) {
  Image image{width, height, 1, format, {}};
  image.pixel.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), {});
  if (context.read_drawable == nullptr || image.pixel.empty()) return image;
  Frame& frame = context.read_drawable->frame;
  const Config& config = frame.options().config;
  const Framebuffer& picture = frame.picture();
  const Framebuffer::Image& color = context.read_drawable->colors(reads_front(context));
  for (int j = 0; j < height; ++j) {
    const std::int64_t row = picture.height - 1 - (std::int64_t{y} + j);  // the picture's are from the top
    if (row < 0 || row >= picture.height) continue;
    const auto first = static_cast<int>(std::clamp<std::int64_t>(-std::int64_t{x}, 0, width));
    const auto last = static_cast<int>(std::clamp<std::int64_t>(std::int64_t{picture.width} - x, first, width));
    for (int i = first; i < last; ++i) {
      const std::size_t at = picture.at(x + i, static_cast<int>(row));
      auto& pixel =
          image.pixel[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
      if (format == GL_RGBA) {
        const auto channels = widen_color<std::uint32_t>(config.color_format, color[at]);
        for (std::size_t c = 0; c < 4; ++c) pixel[c] = static_cast<float>(channels[c]) / 255;
      } else {
        pixel[0] = format == GL_STENCIL_INDEX ? static_cast<float>(picture.stencil[at])
                                              : static_cast<float>(depth_of(config, picture.depth[at]));
      }
    }
  }
  return image;
}

}  // namespace halfplane::gl
