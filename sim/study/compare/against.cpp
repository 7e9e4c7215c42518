#include "against.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>

#include "against_hypotheses.hpp"
#include "model/capture/capture_textures.hpp"
#include "model/engines/scalar.hpp"
#include "model/engines/tapped_fragment.hpp"
#include "model/golden/exact.hpp"
#include "model/stages/depth_encode.hpp"
#include "sim/show/image/framebuffer_files.hpp"

namespace halfplane {
namespace {

constexpr std::uint32_t kDepthCodes = 16;  // largest depth difference within one fragment
constexpr std::uint64_t kProof = 3;        // pixels that a hypothesis must predict for each wrong one, to be believed

std::uint32_t packed_rgb(Rgb c) { return c.r | std::uint32_t{c.g} << 8 | std::uint32_t{c.b} << 16; }

std::uint32_t shown_color(std::uint32_t stored, ColorFormat format) {
  Framebuffer one(1, 1, 1);
  one.color[0] = stored;
  return packed_rgb(color_picture(one, format).get(0, 0));
}

/// The difference of two values, and whether it is within a tolerance.
class Judge {
 public:
  Judge(const ForeignImage& image, ColorFormat format, const Tolerance& tolerance)
      : is_depth_(image.is_depth), tolerance_(tolerance) {
    if (format == ColorFormat::rgb565) largest_ = {31, 63, 31};
  }

  [[nodiscard]] double distance(std::uint32_t a, std::uint32_t b) const { return distance_between(a, b, is_depth_); }
  [[nodiscard]] bool is_same(std::uint32_t a, std::uint32_t b) const {
    if (a == b) return true;
    if (is_depth_) return (a < b ? b - a : a - b) <= tolerance_.depth;
    if (tolerance_.color == 0) return false;
    for (int c = 0; c < 3; ++c)
      if (std::abs(code(a, c) - code(b, c)) > static_cast<int>(tolerance_.color)) return false;
    return true;
  }

 private:
  /// The code nearest to a channel of 8 bits.
  [[nodiscard]] int code(std::uint32_t rgb, int channel) const {
    return (static_cast<int>(rgb >> 8 * channel & 255) * largest_[static_cast<std::size_t>(channel)] * 2 + 255) / 510;
  }

  bool is_depth_;
  Tolerance tolerance_;
  std::array<int, 3> largest_{255, 255, 255};  // codes of R, G, B
};

/// Possible values of a pixel that differs.
struct Candidates {
  std::vector<std::uint32_t> fragments;      ///< of samples inside a triangle, of lines and points
  std::vector<std::uint32_t> border;         ///< of samples exactly on a border
  std::optional<std::uint32_t> shown_state;  ///< of the fragment shown by the model
};

struct CandidatePixels {
  std::map<std::size_t, Candidates> at;
  std::vector<bool> is_touched;  ///< by state: a fragment with it is among them
};

/// The scene's fragments at some pixels, including fragments on borders for either owner.
CandidatePixels candidates_at(const Scene& scene, const Config& config, const StudyRules& rules,
                              const std::vector<std::uint32_t>& differing, bool is_depth,
                              const std::vector<std::int32_t>& owners) {
  CandidatePixels result{{}, std::vector<bool>(scene.states.size())};
  std::map<std::size_t, Candidates>& found = result.at;
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
    const std::uint32_t state = std::get<Draw>(scene.commands[fragment.draw]).state;
    result.is_touched[state] = true;
    if (owners[at->first] == static_cast<std::int32_t>(fragment.primitive)) at->second.shown_state = state;
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
  return result;
}

/// Values left by clears and by an empty target.
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

/// The differing pixels within a subpixel and a half of a triangle's side: another snap, or an edge function with fewer
/// bits, may decide differently there.
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

/// The predictions of a hypothesis for the differing pixels.
struct Prediction {
  ForeignDifference kind = ForeignDifference::other;
  std::string change;
  std::vector<std::uint32_t> right;  ///< pixels predicted correctly
  std::uint64_t wrong = 0;           ///< pixels changed and not predicted
};

/// Draws hypotheses and attributes pixels to the ones beyond coincidence.
class HypothesisTest {
 public:
  HypothesisTest(const HypothesisScene& of, const ImageValues& expected, const ForeignImage& image, const Judge& judge,
                 std::uint64_t different)
      : of_(of), expected_(expected), image_(image), judge_(judge), different_(different) {}

  void run(const std::function<void(double fraction)>& progress) {
    const std::vector<Hypothesis> list = hypotheses(of_);
    const std::vector<ReplayGroup> groups = replay_groups(of_);
    std::size_t done = 0;
    const auto count = [&] {
      if (progress) progress(static_cast<double>(done++) / static_cast<double>(list.size() + groups.size()));
    };
    for (const Hypothesis& one : list) {
      count();
      if (const auto values = one.draw()) judge(one.kind, one.change, *values);
      if (is_certain_) return;
    }
    for (const ReplayGroup& group : groups) {
      count();
      const auto images = replay(of_, expected_, group.arithmetic);
      for (std::size_t i = 0; images && i < images->size(); ++i) judge(group.kind[i], group.change[i], (*images)[i]);
      if (!images || is_certain_) return;
    }
  }

  /// The kinds of pixels, by the hypothesis that explains most first; other pixels are unchanged.
  std::vector<Explanation> explain(std::vector<std::uint8_t>& kind_of) && {
    std::vector<Explanation> explanations;
    while (true) {
      const auto best = std::ranges::max_element(predictions_, {}, [](const Prediction& p) { return p.right.size(); });
      if (best == predictions_.end() || best->right.empty()) return explanations;
      explanations.push_back({best->kind, best->change, best->right.size()});
      for (const std::uint32_t p : best->right)
        kind_of[p] = static_cast<std::uint8_t>(1 + static_cast<int>(best->kind));
      for (Prediction& other : predictions_) {
        std::erase_if(other.right, [&kind_of](std::uint32_t p) { return kind_of[p] != 0; });
        if (!is_believed(other)) other.right.clear();
      }
    }
  }

 private:
  static bool is_believed(const Prediction& p) { return p.right.size() >= kProof * p.wrong; }

  void judge(ForeignDifference kind, const std::string& change, const ImageValues& values) {
    Prediction prediction{kind, change, {}, 0};
    for (std::size_t p = 0; p < values.size(); ++p) {
      if (values[p] == expected_[p]) continue;
      if (!judge_.is_same(values[p], image_.value[p]))
        ++prediction.wrong;
      else if (!judge_.is_same(expected_[p], image_.value[p]))
        prediction.right.push_back(static_cast<std::uint32_t>(p));
    }
    if (prediction.right.empty() || !is_believed(prediction)) return;
    is_certain_ = prediction.wrong == 0 && prediction.right.size() == different_;
    predictions_.push_back(std::move(prediction));
  }

  const HypothesisScene& of_;
  const ImageValues& expected_;
  const ForeignImage& image_;
  const Judge& judge_;
  std::uint64_t different_;
  std::vector<Prediction> predictions_;
  bool is_certain_ = false;  // the last one predicts all of it
};

/// Whether a neighbouring pixel shows about the same: a primitive that ends there in our image may end here in others.
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

/// The operation that made the colour of a fragment, and may be off by a code: the last of several.
ForeignDifference last_operation(const Scene& scene, const std::optional<std::uint32_t>& state, ColorFormat format) {
  if (!state) return ForeignDifference::color;
  const State& of = scene.states[*state];
  if (of.dither && format == ColorFormat::rgb565) return ForeignDifference::dither;
  if (of.blend) return ForeignDifference::blend;
  return of.texture ? ForeignDifference::texture : ForeignDifference::color;
}

/// The kind of one pixel that no hypothesis explains.
class PixelKinds {
 public:
  PixelKinds(const Scene& scene, const Config& config, const AgainstResult& result, const ForeignImage& image,
             const Judge& judge, const CandidatePixels& candidates, const std::vector<bool>& is_at_side)
      : scene_(scene),
        config_(config),
        result_(result),
        image_(image),
        judge_(judge),
        candidates_(candidates),
        is_at_side_(is_at_side),
        cleared_(cleared_values(scene, config, image.is_depth)),
        // A code of 5 bits is 8 or 9 of 8 bits.
        near_(image.is_depth                               ? kDepthCodes
              : config.color_format == ColorFormat::rgb565 ? 9
                                                           : 1) {}

  [[nodiscard]] ForeignDifference at(std::uint32_t p) const {
    const std::uint32_t found = image_.value[p];
    const Candidates& here = candidates_.at.at(p);
    const bool is_another = holds(here.fragments, found) || holds(cleared_, found);
    const double distance = judge_.distance(result_.expected[p], found);
    if (!here.border.empty() && (is_another || holds(here.border, found))) return ForeignDifference::edge_rule;
    if (is_another && is_at_side_[p]) return ForeignDifference::snap;
    if (is_another && (holds(here.fragments, found) || distance > near_)) return ForeignDifference::depth;
    if (distance <= near_)
      return image_.is_depth ? ForeignDifference::depth
                             : last_operation(scene_, here.shown_state, config_.color_format);
    if (is_at_side_[p] && is_beside(result_.expected, scene_.width, p, found, image_.is_depth, near_))
      return ForeignDifference::snap;
    return ForeignDifference::other;
  }

 private:
  const Scene& scene_;
  const Config& config_;
  const AgainstResult& result_;
  const ForeignImage& image_;
  const Judge& judge_;
  const CandidatePixels& candidates_;
  const std::vector<bool>& is_at_side_;
  const std::vector<std::uint32_t> cleared_;
  const double near_;
};

/// Kinds of the pixels that have none yet. If a colour without an operation is off, operations do not explain the
/// others.
void classify_rest(const PixelKinds& kinds, const std::vector<std::uint32_t>& differing,
                   std::vector<std::uint8_t>& kind_of) {
  constexpr auto is_operation = [](ForeignDifference kind) {
    return kind == ForeignDifference::texture || kind == ForeignDifference::blend || kind == ForeignDifference::dither;
  };
  std::vector<std::uint32_t> of_operations;
  bool has_color = false;
  for (const std::uint32_t p : differing) {
    if (kind_of[p] != 0) continue;
    const ForeignDifference kind = kinds.at(p);
    kind_of[p] = static_cast<std::uint8_t>(1 + static_cast<int>(kind));
    has_color = has_color || kind == ForeignDifference::color;
    if (is_operation(kind)) of_operations.push_back(p);
  }
  if (!has_color) return;
  for (const std::uint32_t p : of_operations) kind_of[p] = 1 + static_cast<std::uint8_t>(ForeignDifference::color);
}

}  // namespace

double DifferenceStats::rms() const {
  return pixels == 0 ? 0 : std::sqrt(sum_of_squares / static_cast<double>(pixels));
}

double distance_between(std::uint32_t a, std::uint32_t b, bool is_depth) {
  if (is_depth) return std::abs(static_cast<double>(a) - static_cast<double>(b));
  int worst = 0;
  for (int shift = 0; shift < 24; shift += 8)
    worst = std::max(worst, std::abs(static_cast<int>(a >> shift & 255) - static_cast<int>(b >> shift & 255)));
  return worst;
}

ImageValues image_values(const Framebuffer& frame, ColorFormat format, bool is_depth) {
  if (is_depth) return depth_codes(frame);
  const Picture picture = color_picture(frame, format);
  ImageValues values;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) values.push_back(packed_rgb(picture.get(x, y)));
  return values;
}

AgainstResult compare_against(const Scene& scene, const Config& config, const Comparison& comparison,
                              const ForeignImage& image, const AgainstOptions& options) {
  AgainstResult result;
  result.expected = image_values(comparison.rendering.frame, config.color_format, image.is_depth);
  result.pixels = result.expected.size();
  result.kind_of.assign(result.expected.size(), 0);
  const Judge judge(image, config.color_format, options.tolerance);
  std::vector<std::uint32_t> differing;
  for (std::size_t p = 0; p < result.expected.size(); ++p) {
    if (result.expected[p] == image.value[p]) continue;
    if (judge.is_same(result.expected[p], image.value[p]))
      ++result.within_tolerance;
    else
      differing.push_back(static_cast<std::uint32_t>(p));
  }
  result.different = differing.size();
  if (differing.empty()) return result;
  const CandidatePixels candidates =
      candidates_at(scene, config, options.rules, differing, image.is_depth, comparison.rendering.ids);
  const HypothesisScene of{
      scene, config, options.rules, comparison.golden.frame, image.is_depth, candidates.is_touched};
  HypothesisTest test(of, result.expected, image, judge, result.different);
  test.run(options.progress);
  result.explanations = std::move(test).explain(result.kind_of);
  const std::vector<bool> is_at_side = pixels_at_sides(comparison.rendering.triangles, differing, scene.width,
                                                       scene.height, derive_widths(config).grid_bits);
  classify_rest(PixelKinds(scene, config, result, image, judge, candidates, is_at_side), differing, result.kind_of);
  for (const std::uint32_t p : differing) {
    const auto kind = static_cast<ForeignDifference>(result.kind_of[p] - 1);
    const double distance = judge.distance(result.expected[p], image.value[p]);
    DifferenceStats& stats = result.kinds[static_cast<std::size_t>(kind)];
    ++stats.pixels;
    stats.max = std::max(stats.max, distance);
    stats.sum_of_squares += distance * distance;
    const auto width = static_cast<std::uint32_t>(scene.width);
    const ForeignPixel pixel{static_cast<int>(p % width), static_cast<int>(p / width), kind, result.expected[p],
                             image.value[p]};
    if (!result.first_pixel) result.first_pixel = pixel;
    if (result.first.size() < options.listed) result.first.push_back(pixel);
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
    // The maximum for an image of this size, and a byte: a file may have no end at all.
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
