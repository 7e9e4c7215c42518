#include "against.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>

#include "model/capture/capture_textures.hpp"
#include "model/engines/functional.hpp"
#include "model/engines/scalar.hpp"
#include "model/golden/exact.hpp"
#include "model/stages/depth_encode.hpp"
#include "sim/show/image/framebuffer_files.hpp"

namespace halfplane {
namespace {

constexpr int kMostSubpixelBits = 8;       // of the variants that a pixel is put down to the snap by
constexpr std::uint32_t kDepthCodes = 16;  // so far a depth may be off and still be of the same fragment

std::uint32_t packed_rgb(Rgb c) { return c.r | std::uint32_t{c.g} << 8 | std::uint32_t{c.b} << 16; }

/// An image of ours in the form of the foreign one.
std::vector<std::uint32_t> values_of(const Framebuffer& frame, ColorFormat format, bool is_depth) {
  if (is_depth) return depth_codes(frame);
  const Picture picture = color_picture(frame, format);
  std::vector<std::uint32_t> values;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) values.push_back(packed_rgb(picture.get(x, y)));
  return values;
}

std::uint32_t shown_color(std::uint32_t stored, ColorFormat format) {
  Framebuffer one(1, 1, 1);
  one.color[0] = stored;
  return packed_rgb(color_picture(one, format).get(0, 0));
}

double distance_between(std::uint32_t a, std::uint32_t b, bool is_depth) {
  if (is_depth) return std::abs(static_cast<double>(a) - static_cast<double>(b));
  int worst = 0;
  for (int shift = 0; shift < 24; shift += 8)
    worst = std::max(worst, std::abs(static_cast<int>(a >> shift & 255) - static_cast<int>(b >> shift & 255)));
  return worst;
}

/// What may show at a pixel that differs.
struct Candidates {
  std::vector<std::uint32_t> fragments;  ///< of samples inside a triangle, of lines and points
  std::vector<std::uint32_t> border;     ///< of samples exactly on a border
};

/// The scene's fragments at some pixels, those on borders too whoever owns them.
std::map<std::size_t, Candidates> candidates_at(const Scene& scene, const Config& config, const StudyRules& rules,
                                                const std::vector<std::uint32_t>& differing, bool is_depth) {
  std::map<std::size_t, Candidates> found;
  for (const std::uint32_t p : differing) found[p];
  const Widths widths = derive_widths(config);
  const DepthEncode encode(config, scene.planes);
  RenderOptions options;
  options.rules = rules;
  options.rules.fill_rule = FillRule::inclusive;
  options.skip = skip_none();
  options.fragment_tap = [&](const TappedFragment& fragment) {
    const auto at = found.find(static_cast<std::size_t>(fragment.y) * static_cast<std::size_t>(scene.width) +
                               static_cast<std::size_t>(fragment.x));
    if (at == found.end()) return;
    const auto code = [&](std::size_t p) { return fragment.plane[p].code; };
    std::array<std::uint32_t, 4> color{code(1), code(2), code(3), code(4)};
    if (fragment.surface)
      for (std::size_t c = 0; c < 4; ++c) color[c] = fragment.surface->color[c];
    const std::uint32_t value =
        is_depth ? encode(code(kDepthPlane)) : shown_color(pack_color(config.color_format, color), config.color_format);
    const bool is_on_border = fragment.triangle != nullptr &&
                              exact::is_on_border(*fragment.triangle, fragment.x, fragment.y, widths.grid_bits);
    (is_on_border ? at->second.border : at->second.fragments).push_back(value);
  };
  (void)render_scalar(scene, config, options);
  return found;
}

/// What clears leave, and an empty target.
std::vector<std::uint32_t> cleared_values(const Scene& scene, const Config& config, bool is_depth) {
  const DepthEncode encode(config, scene.planes);
  std::vector<std::uint32_t> values{is_depth ? encode.of_window(1) : 0};
  for (const Command& command : scene.commands)
    if (const auto* clear = std::get_if<Clear>(&command)) {
      if (is_depth && clear->depth) values.push_back(encode.of_window(*clear->depth));
      if (!is_depth && clear->color)
        values.push_back(shown_color(clear_color(*clear->color, config.color_format), config.color_format));
    }
  return values;
}

/// Distance of a pixel's centre from the side from a to b, subpixels.
double distance_from_side(const SnappedVertex& a, const SnappedVertex& b, double px, double py) {
  const double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
  const double t = length > 0 ? std::clamp(((px - a.x) * dx + (py - a.y) * dy) / length, 0.0, 1.0) : 0.0;
  return std::hypot(px - a.x - t * dx, py - a.y - t * dy);
}

/// Of the differing pixels those past which a side of a triangle runs within a subpixel and a half: another snap, or an edge
/// function with fewer bits, may decide there otherwise.
std::vector<bool> pixels_at_sides(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& differing,
                                  int width, int height, int grid_bits) {
  constexpr double kNear = 1.5;  // subpixels
  std::vector<bool> is_differing(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
      is_near = is_differing;
  for (const std::uint32_t p : differing) is_differing[p] = true;
  for (const Triangle& triangle : triangles) {
    const auto& v = triangle.v;
    const auto [left, right] = std::minmax({v[0].x, v[1].x, v[2].x});
    const auto [top, bottom] = std::minmax({v[0].y, v[1].y, v[2].y});
    for (int y = std::max(0, (top >> grid_bits) - 1); y <= std::min(height - 1, (bottom >> grid_bits) + 1); ++y)
      for (int x = std::max(0, (left >> grid_bits) - 1); x <= std::min(width - 1, (right >> grid_bits) + 1); ++x) {
        const auto p = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        if (!is_differing[p] || is_near[p]) continue;
        const double px = std::ldexp(x + 0.5, grid_bits), py = std::ldexp(y + 0.5, grid_bits);
        for (std::size_t i = 0; i < 3; ++i)
          if (distance_from_side(v[i], v[(i + 1) % 3], px, py) <= kNear) is_near[p] = true;
      }
  }
  return is_near;
}

/// The scene with another snap, if one is the foreign image but for a quarter as many pixels as differ: it explains most of
/// what differs and changes little that does not, which is no coincidence. The golden, which snaps nothing, and other
/// subpixel bits, where the scene can be drawn so.
std::optional<std::vector<std::uint32_t>> common_variant(const Scene& scene, const Config& config,
                                                         const Comparison& comparison, const StudyRules& rules,
                                                         const std::vector<std::uint32_t>& differing,
                                                         const ForeignImage& image) {
  const auto explains = [&](const std::vector<std::uint32_t>& variant) {
    std::size_t left = 0;
    for (std::size_t p = 0; p < variant.size(); ++p) left += variant[p] != image.value[p] ? 1 : 0;
    return 4 * left <= differing.size();
  };
  if (auto unsnapped = values_of(comparison.golden.frame, config.color_format, image.is_depth); explains(unsnapped))
    return unsnapped;
  for (int bits = 0; bits <= kMostSubpixelBits; ++bits) {
    if (bits == config.subpixel_bits) continue;
    Config other = config;
    other.subpixel_bits = bits;
    try {
      RenderOptions options;
      options.rules = rules;
      const Rendering drawn =
          rules == StudyRules{} ? render_functional(scene, other) : render_scalar(scene, other, options);
      if (auto variant = values_of(drawn.frame, config.color_format, image.is_depth); explains(variant)) return variant;
    } catch (const InputError&) {  // too wide together with the rest of this configuration
    }
  }
  return {};
}

/// Whether a pixel beside this one shows about the same: a primitive that ends there with us may end here with others.
bool is_beside(const std::vector<std::uint32_t>& ours, int width, std::uint32_t p, std::uint32_t got, bool is_depth,
               double near) {
  const int x = static_cast<int>(p) % width, y = static_cast<int>(p) / width;
  const int height = static_cast<int>(ours.size()) / width;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      if (x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= height) continue;
      const auto beside =
          static_cast<std::size_t>(y + dy) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x + dx);
      if (distance_between(ours[beside], got, is_depth) <= near) return true;
    }
  return false;
}

bool holds(const std::vector<std::uint32_t>& values, std::uint32_t value) {
  return std::ranges::find(values, value) != values.end();
}

}  // namespace

double DifferenceStats::rms() const {
  return pixels == 0 ? 0 : std::sqrt(sum_of_squares / static_cast<double>(pixels));
}

AgainstResult compare_against(const Scene& scene, const Config& config, const Comparison& comparison,
                              const StudyRules& rules, const ForeignImage& image) {
  const std::vector<std::uint32_t> ours = values_of(comparison.rendering.frame, config.color_format, image.is_depth);
  AgainstResult result;
  result.pixels = ours.size();
  std::vector<std::uint32_t> differing;
  for (std::size_t p = 0; p < ours.size(); ++p)
    if (ours[p] != image.value[p]) differing.push_back(static_cast<std::uint32_t>(p));
  result.different = differing.size();
  if (differing.empty()) return result;
  const auto candidates = candidates_at(scene, config, rules, differing, image.is_depth);
  const auto cleared = cleared_values(scene, config, image.is_depth);
  const auto variant = common_variant(scene, config, comparison, rules, differing, image);
  const auto is_at_side = pixels_at_sides(comparison.rendering.triangles, differing, scene.width, scene.height,
                                          derive_widths(config).grid_bits);
  // A code of 5 bits is 8 or 9 of 8 bits.
  const double near = image.is_depth ? kDepthCodes : config.color_format == ColorFormat::rgb565 ? 9 : 1;
  for (const std::uint32_t p : differing) {
    const std::uint32_t got = image.value[p];
    const Candidates& here = candidates.at(p);
    const bool is_another = holds(here.fragments, got) || holds(cleared, got);
    const double distance = distance_between(ours[p], got, image.is_depth);
    ForeignDifference kind = ForeignDifference::other;
    if (variant && (*variant)[p] == got)
      kind = ForeignDifference::snap;
    else if (!here.border.empty() && (is_another || holds(here.border, got)))
      kind = ForeignDifference::edge_rule;
    else if (is_another && is_at_side[p])
      kind = ForeignDifference::snap;
    else if (is_another && (holds(here.fragments, got) || distance > near))
      kind = ForeignDifference::depth;
    else if (distance <= near)
      kind = image.is_depth ? ForeignDifference::depth : ForeignDifference::color;
    else if (is_at_side[p] && is_beside(ours, scene.width, p, got, image.is_depth, near))
      kind = ForeignDifference::snap;
    DifferenceStats& stats = result.kinds[static_cast<std::size_t>(kind)];
    ++stats.pixels;
    stats.max = std::max(stats.max, distance);
    stats.sum_of_squares += distance * distance;
    if (!result.first) {
      const auto width = static_cast<std::uint32_t>(scene.width);
      result.first = {static_cast<int>(p % width), static_cast<int>(p / width), kind, ours[p], got};
    }
  }
  return result;
}

ForeignImage read_foreign_image(const std::string& path, int width, int height) {
  ForeignImage image;
  if (path.ends_with(".png")) {
    const TexelImage picture = read_image_file(path);
    image.width = picture.width;
    image.height = picture.height;
    for (const Texel& t : picture.texel) image.value.push_back(packed_rgb({t[0], t[1], t[2]}));
  } else if (path.ends_with(".npy")) {
    image.is_depth = true;
    std::ifstream file(path, std::ios::binary);
    if (!file) throw InputError(path + ": there is no such file; give the image to be judged");
    // No more than an image of this size can have, and a byte: a file may have no end at all.
    constexpr std::size_t kLongestHeader = 10 + 65535;
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::string bytes(kLongestHeader + 4 * pixels + 1, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    const bool is_npy = bytes.size() > 10 && bytes.starts_with(std::string_view("\x93NUMPY\x01\x00", 8));
    const std::size_t length =
        is_npy ? static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]) : 0;
    const std::string header = is_npy ? bytes.substr(10, length) : "";
    const std::size_t shape = header.find("'shape': (");
    const bool is_u4 = header.find("'<u4'") != std::string::npos && header.find("False") != std::string::npos;
    if (!is_u4 || shape == std::string::npos ||
        std::sscanf(header.c_str() + shape, "'shape': (%d, %d)", &image.height, &image.width) != 2)
      throw InputError(path +
                       ": this is no array of depth codes; give .npy, format 1.0, <u4, C order, (height, width)");
    if (image.width == width && image.height == height) {
      if (bytes.size() != 10 + length + 4 * pixels)
        throw InputError(path + ": the file " + (bytes.size() < 10 + length + 4 * pixels ? "is cut short" : "goes on") +
                         " where its codes should end; write it again");
      image.value.resize(pixels);
      std::memcpy(image.value.data(), bytes.data() + 10 + length, 4 * pixels);
    }
  } else {
    throw InputError("--against: '" + path + "' is no image; give a colour picture .png or depth codes .npy");
  }
  if (image.width != width || image.height != height)
    throw InputError(path + ": " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                     " pixels, and the scene is drawn with " + std::to_string(width) + "x" + std::to_string(height) +
                     "; give the same --size");
  return image;
}

}  // namespace halfplane
