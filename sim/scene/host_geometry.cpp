#include "sim/scene/host_geometry.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "model/fixed.hpp"
#include "model/host/primitive_assembly.hpp"

namespace halfplane {
namespace {

constexpr double kLargestFixedPixel = 32767;  // s15.16
constexpr double kLargestSingle = 0x1p96;     // no product of two with a size in pixels, and no sum of them, overflows
constexpr std::int64_t kWholeParameter = std::int64_t{1} << 31;

/// A window of pixels as the host's target, and its derived constants.
struct HostView {
  ClipZ clip_z;
  std::array<double, 2> depth_range;
  Viewport viewport;
  double limit;
};

struct SingleHost {
  using Distance = float;

  static double rounded(double v) {
    if (!(std::abs(v) <= kLargestSingle))
      throw InputError(
          "--transform binary32: a coordinate of this scene or camera is beyond 2^96; scale the model down, or take "
          "binary64");
    return static_cast<double>(static_cast<float>(v));
  }

  static Distance distance(const ClipPlane& plane, const Vertex& v) {
    const auto product = [](double a, double b) { return static_cast<float>(a) * static_cast<float>(b); };
    float sum = product(plane.a, v.x);
    sum += product(plane.b, v.y);
    sum += product(plane.c, v.z);
    sum += product(plane.d, v.w);
    return sum;
  }

  /// Parameter of the cut from the inside end.
  static float parameter(Distance in, Distance out) {
    const float whole = in - out;
    return in / whole;
  }

  static double mix(double from, double to, float t) {
    const float difference = static_cast<float>(to) - static_cast<float>(from);
    const float step = t * difference;
    return static_cast<double>(static_cast<float>(from) + step);
  }

  static double smallest_w() { return static_cast<double>(std::numeric_limits<float>::min()); }

  static WindowPosition window(const Vertex& v, const HostView& view) {
    const float w = static_cast<float>(v.w);
    // From -1...1 to a range of `size` that begins at `first`.
    const auto place = [](float ndc, double first, double size) {
      const float half = (ndc + 1.0F) / 2.0F;
      const float offset = half * static_cast<float>(size);
      return static_cast<double>(static_cast<float>(first) + offset);
    };
    const float x = static_cast<float>(v.x) / w, y = static_cast<float>(v.y) / w, z = static_cast<float>(v.z) / w;
    const float depth = view.clip_z == ClipZ::zero_one ? z : (z + 1.0F) / 2.0F;
    const auto [near, far] = view.depth_range;
    const float offset = static_cast<float>(far - near) * std::clamp(depth, 0.0F, 1.0F);
    return {place(x, view.viewport.x, view.viewport.width), place(-y, view.viewport.y, view.viewport.height),
            static_cast<double>(static_cast<float>(near) + offset)};
  }
};

struct FixedHost {
  using Distance = std::int64_t;  ///< 32 fraction bits

  static double rounded(double v) { return from_s15_16(to_s15_16(v)); }
  /// Exact: v is already rounded.
  static std::int64_t fixed(double v) { return static_cast<std::int64_t>(std::ldexp(v, 16)); }

  static Distance distance(const ClipPlane& plane, const Vertex& v) {
    // |coefficients| < 2^31.6 and |coordinates| <= 2^31, and of the four products two are not 0: below 2^63.
    return fixed(plane.a) * fixed(v.x) + fixed(plane.b) * fixed(v.y) + fixed(plane.c) * fixed(v.z) +
           fixed(plane.d) * fixed(v.w);
  }

  static std::int64_t parameter(Distance in, Distance out) {
    const std::uint64_t whole = static_cast<std::uint64_t>(in) + (0 - static_cast<std::uint64_t>(out));
    const int shift = std::max(0, static_cast<int>(std::bit_width(whole)) - 32);
    const std::uint64_t divisor = whole >> shift;
    return static_cast<std::int64_t>((((static_cast<std::uint64_t>(in) >> shift) << 31) + divisor / 2) / divisor);
  }

  static double mix(double from, double to, std::int64_t t) {
    const std::int64_t first = fixed(from);  // |difference| < 2^32 and t <= 2^31: below 2^63 with the rounding
    return from_s15_16(first + (((fixed(to) - first) * t + kWholeParameter / 2) >> 31));
  }

  static double smallest_w() { return 0x1p-16; }

  /// floor(n / d + 1/2), d > 0.
  static std::int64_t divided(std::int64_t n, std::int64_t d) {
    n += d / 2;
    return n >= 0 ? n / d : -((-n + d - 1) / d);
  }

  static WindowPosition window(const Vertex& v, const HostView& view) {
    const std::int64_t w = fixed(v.w);
    const auto half = [](double size) { return fixed(rounded(size / 2)); };
    const auto place = [w, half](std::int64_t at, double first, double size) {
      return from_s15_16(fixed(rounded(first)) + half(size) + divided(at * half(size), w));
    };
    const std::int64_t z = fixed(v.z);
    const std::int64_t up = view.clip_z == ClipZ::zero_one ? 2 * z : z + w;  // at most 2 w for a depth in 0...1
    const std::int64_t depth = divided(std::clamp<std::int64_t>(up, 0, 2 * w) << 30, w);
    const auto range = [](double d) { return static_cast<std::int64_t>(std::ldexp(d, 31)); };
    const std::int64_t near = range(view.depth_range[0]), far = range(view.depth_range[1]);
    const std::int64_t mapped = near + (((far - near) * depth + kWholeParameter / 2) >> 31);
    return {place(fixed(v.x), view.viewport.x, view.viewport.width),
            place(-fixed(v.y), view.viewport.y, view.viewport.height), std::ldexp(static_cast<double>(mapped), -31)};
  }
};

template <class Host>
HostVertex rounded_in(HostVertex v) {
  VertexNumbers numbers = numbers_of(v.vertex);
  for (double& number : numbers) number = Host::rounded(number);
  v.vertex = vertex_of(numbers);
  for (double& part : v.normal) part = Host::rounded(part);
  return v;
}

template <class Host>
HostVertex cut_in(const HostVertex& in, const HostVertex& out, typename Host::Distance d_in,
                  typename Host::Distance d_out) {
  const auto t = Host::parameter(d_in, d_out);
  HostVertex made;
  VertexNumbers numbers = numbers_of(in.vertex);
  std::ranges::transform(numbers, numbers_of(out.vertex), numbers.begin(),
                         [t](double from, double to) { return Host::mix(from, to, t); });
  made.vertex = vertex_of(numbers);
  for (std::size_t i = 0; i < 3; ++i) made.normal[i] = Host::mix(in.normal[i], out.normal[i], t);
  return made;
}

template <class Host>
unsigned outcode_in(const ClipPlanes& planes, const Vertex& v) {
  unsigned code = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) code |= (Host::distance(planes[i], v) >= 0 ? 0U : 1U) << i;
  return code;
}

/// Sutherland and Hodgman, plane by plane. Rounded corners may make a polygon slightly concave, so the number of
/// corners is unbounded.
template <class Host>
std::vector<HostVertex> clip_triangle_in(const ClipPlanes& planes, std::vector<HostVertex> polygon) {
  for (const ClipPlane& plane : planes) {
    std::vector<HostVertex> result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const HostVertex &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
      const auto d_from = Host::distance(plane, from.vertex), d_to = Host::distance(plane, to.vertex);
      if (d_from >= 0) result.push_back(from);
      if (d_from >= 0 && d_to < 0) result.push_back(cut_in<Host>(from, to, d_from, d_to));
      if (d_from < 0 && d_to >= 0) result.push_back(cut_in<Host>(to, from, d_to, d_from));
    }
    polygon = std::move(result);
  }
  if (polygon.size() < 3) polygon.clear();
  return polygon;
}

template <class Host>
std::optional<std::pair<HostVertex, HostVertex>> clip_line_in(const ClipPlanes& planes, HostVertex a, HostVertex b) {
  for (const ClipPlane& plane : planes) {
    const auto d_a = Host::distance(plane, a.vertex), d_b = Host::distance(plane, b.vertex);
    if (d_a < 0 && d_b < 0) return std::nullopt;
    if (d_a < 0) a = cut_in<Host>(b, a, d_b, d_a);
    if (d_b < 0) b = cut_in<Host>(a, b, d_a, d_b);
  }
  return std::pair(a, b);
}

template <class Host>
HostPosition window_in(Vertex v, const HostView& view) {
  HostPosition position;
  position.had_no_w = !(v.w > 0);
  if (position.had_no_w) v.w = Host::smallest_w();
  position.at = Host::window(v, view);
  position.at.x = std::clamp(position.at.x, -view.limit, view.limit);
  position.at.y = std::clamp(position.at.y, -view.limit, view.limit);
  position.w = v.w;
  return position;
}

/// A state in the form needed in the window.
State in_window(const State& state, int width, int height) {
  State made = state;
  if (state.scissor || state.viewport) made.scissor = raster_rect(state, width, height);
  made.space = Space::window;
  made.viewport.reset();
  made.pixel_center = PixelCenter::half;
  made.origin = Origin::top_left;
  return made;
}

/// Converts a scene to window space, draw by draw.
class HostProjector {
 public:
  HostProjector(Scene scene, const HostGeometry& host, int subpixel_bits, HostCounts& counts)
      : given_(std::move(scene)),
        made_(given_),
        host_(host),
        subpixel_bits_(subpixel_bits),
        counts_(counts),
        place_(given_.vertices.size(), kNone) {
    made_.indices.clear();
  }

  Scene run() {
    for (Command& command : made_.commands)
      if (auto* draw = std::get_if<Draw>(&command)) project(*draw);
    if (!made_.normals.empty()) made_.normals.resize(made_.vertices.size());
    return std::move(made_);
  }

 private:
  static constexpr std::uint32_t kNone = ~0U;

  [[nodiscard]] HostVertex given(std::uint32_t index) const {
    return host_.rounded({given_.vertices[index], given_.normal(index)});
  }

  [[nodiscard]] bool stays(const Draw& draw) const {
    const State& state = given_.states[draw.state];
    if (draw.outside != 0 || state.space == Space::window) return true;
    if (primitive_type(draw.topology) != PrimitiveType::triangle || state.polygon_mode == PolygonMode::fill)
      return false;
    for (std::size_t i = draw.first; i < draw.first + draw.count; ++i)
      if (given_.indices[i] != kRestart && host_.outcode(given(given_.indices[i]).vertex) != 0) return true;
    return false;
  }

  void project(Draw& draw) {
    const Draw from = draw;
    draw.first = made_.indices.size();
    if (stays(from)) {
      const auto first = given_.indices.begin() + static_cast<std::ptrdiff_t>(from.first);
      made_.indices.insert(made_.indices.end(), first, first + static_cast<std::ptrdiff_t>(from.count));
      return;
    }
    const State& state = given_.states[from.state];
    switch (primitive_type(from.topology)) {
      case PrimitiveType::triangle:
        draw.topology = Topology::triangles;
        for_each_triangle(given_, from, state.provoking, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
          add_triangle({a, b, c});
        });
        break;
      case PrimitiveType::line:
        draw.topology = Topology::lines;
        for_each_line(given_, from, [&](std::uint32_t a, std::uint32_t b) { add_line(a, b); });
        break;
      case PrimitiveType::point:
        for_each_point(given_, from, [&](std::uint32_t index) {
          if (host_.outcode(given(index).vertex) == 0) made_.indices.push_back(whole(index));
        });
    }
    draw.count = made_.indices.size() - draw.first;
    draw.state = window_state(from.state);
  }

  void add_triangle(const std::array<std::uint32_t, 3>& index) {
    std::array<HostVertex, 3> corner;
    unsigned any = 0, all = ~0U;
    for (std::size_t i = 0; i < 3; ++i) {
      corner[i] = given(index[i]);
      const unsigned code = host_.outcode(corner[i].vertex);
      any |= code;
      all &= code;
    }
    if (any == 0) {
      for (const std::uint32_t i : index) made_.indices.push_back(whole(i));
      return;
    }
    const std::vector<HostVertex> polygon =
        all != 0 ? std::vector<HostVertex>() : host_.clip(corner[0], corner[1], corner[2]);
    if (polygon.empty()) {
      ++counts_.outside;
      const std::uint32_t nowhere = corner_without_area();
      made_.indices.insert(made_.indices.end(), 3, nowhere);
      return;
    }
    ++counts_.cut;
    add_pieces(polygon);
  }

  /// The pipeline's fan of a clipped polygon (docs/spec.md): rounding can dent the polygon, and then the fan starts at
  /// a corner from which no piece is reversed, or reversed pieces are left out.
  void add_pieces(const std::vector<HostVertex>& polygon) {
    struct Corner {
      std::int64_t x, y;  ///< subpixels
      std::uint32_t place;
    };
    std::vector<Corner> corner;
    for (const HostVertex& v : polygon) {
      const std::uint32_t place = add(v);
      const double scale = std::ldexp(1.0, subpixel_bits_);
      corner.push_back({snap(made_.vertices[place].x, scale), snap(made_.vertices[place].y, scale), place});
    }
    const std::size_t size = corner.size();
    const auto at = [&](std::size_t i) -> const Corner& { return corner[i % size]; };
    const auto area = [&](std::size_t start, std::size_t i) {
      const Corner &a = at(start), &b = at(start + i), &c = at(start + i + 1);
      return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    std::int64_t whole = 0;
    for (std::size_t i = 1; i + 1 < size; ++i) whole += area(0, i);
    const auto is_turned = [whole](std::int64_t of_piece) { return of_piece != 0 && (of_piece > 0) != (whole > 0); };
    std::optional<std::size_t> best, smallest;
    for (std::size_t start = 0; start < size; ++start) {
      const auto is_before = [&](std::optional<std::size_t> other) {
        return !other || std::pair(at(start).y, at(start).x) < std::pair(at(*other).y, at(*other).x);
      };
      bool has_turned = false;
      for (std::size_t i = 1; i + 1 < size; ++i) has_turned |= is_turned(area(start, i));
      if (!has_turned && is_before(best)) best = start;
      if (is_before(smallest)) smallest = start;
    }
    const std::size_t start = best.value_or(*smallest);
    std::size_t pieces = 0;
    for (std::size_t i = 1; i + 1 < size; ++i) {
      const std::int64_t of_piece = area(start, i);
      if (whole == 0 || of_piece == 0 || is_turned(of_piece)) continue;
      made_.indices.insert(made_.indices.end(), {at(start).place, at(start + i).place, at(start + i + 1).place});
      ++pieces;
    }
    if (pieces == 0) made_.indices.insert(made_.indices.end(), 3, corner_without_area());
  }

  void add_line(std::uint32_t from, std::uint32_t to) {
    const HostVertex a = given(from), b = given(to);
    if ((host_.outcode(a.vertex) | host_.outcode(b.vertex)) == 0) {
      for (const std::uint32_t index : {from, to}) made_.indices.push_back(whole(index));
      return;
    }
    const auto line = host_.clip(a, b);
    ++(line ? counts_.cut : counts_.outside);
    if (!line) return;
    for (const HostVertex& end : {line->first, line->second}) made_.indices.push_back(add(end));
  }

  /// A vertex that needs no cut, converted once for all its users.
  std::uint32_t whole(std::uint32_t index) {
    if (place_[index] == kNone) {
      HostVertex v = given(index);
      // Values that are not computed are not rounded.
      v.vertex.rgba = given_.vertices[index].rgba;
      v.vertex.u = given_.vertices[index].u;
      v.vertex.v = given_.vertices[index].v;
      v.normal = given_.normal(index);
      place_[index] = add(v);
    }
    return place_[index];
  }

  std::uint32_t add(HostVertex v) {
    const HostPosition position = host_.window(v.vertex);
    counts_.had_no_w += position.had_no_w ? 1 : 0;
    v.vertex.x = position.at.x;
    v.vertex.y = position.at.y;
    v.vertex.z = position.at.z;
    v.vertex.w = position.w;
    const auto place = static_cast<std::uint32_t>(made_.vertices.size());
    made_.vertices.push_back(v.vertex);
    if (!made_.normals.empty()) {
      made_.normals.resize(place);
      made_.normals.push_back(v.normal);
    }
    return place;
  }

  std::uint32_t corner_without_area() {
    if (nowhere_ == kNone) {
      nowhere_ = static_cast<std::uint32_t>(made_.vertices.size());
      made_.vertices.push_back({0, 0, 0, 1});
    }
    return nowhere_;
  }

  std::uint32_t window_state(std::uint32_t state) {
    window_states_.resize(given_.states.size(), kNone);
    std::uint32_t& made = window_states_[state];
    if (made == kNone) {
      made = static_cast<std::uint32_t>(made_.states.size());
      made_.states.push_back(in_window(given_.states[state], given_.width, given_.height));
    }
    return made;
  }

  Scene given_, made_;
  const HostGeometry& host_;
  int subpixel_bits_;
  HostCounts& counts_;
  std::vector<std::uint32_t> place_;  ///< index of a vertex that needs no cut, once converted
  std::vector<std::uint32_t> window_states_;
  std::uint32_t nowhere_ = kNone;
};

}  // namespace

HostGeometry::HostGeometry(TransformNumbers numbers, const State& state, int width, int height, const Config& config)
    : numbers_(numbers),
      clip_z_(state.clip_z),
      depth_range_(state.depth_range),
      viewport_(effective_viewport(state, width, height)),
      limit_(numbers == TransformNumbers::s15_16 ? std::min(guard_band_limit(config), kLargestFixedPixel)
                                                 : guard_band_limit(config)),
      planes_(guard_band_planes(clip_z_, viewport_, limit_)) {
  if (numbers != TransformNumbers::s15_16) return;
  for (ClipPlane& plane : planes_)
    for (double* const part : {&plane.a, &plane.b, &plane.c, &plane.d})
      *part = std::ldexp(std::floor(std::ldexp(*part, 16) + 0.5), -16);
}

HostVertex HostGeometry::rounded(const HostVertex& v) const {
  return numbers_ == TransformNumbers::s15_16 ? rounded_in<FixedHost>(v) : rounded_in<SingleHost>(v);
}

unsigned HostGeometry::outcode(const Vertex& v) const {
  return numbers_ == TransformNumbers::s15_16 ? outcode_in<FixedHost>(planes_, v) : outcode_in<SingleHost>(planes_, v);
}

std::vector<HostVertex> HostGeometry::clip(const HostVertex& a, const HostVertex& b, const HostVertex& c) const {
  return numbers_ == TransformNumbers::s15_16 ? clip_triangle_in<FixedHost>(planes_, {a, b, c})
                                              : clip_triangle_in<SingleHost>(planes_, {a, b, c});
}

std::optional<std::pair<HostVertex, HostVertex>> HostGeometry::clip(const HostVertex& a, const HostVertex& b) const {
  return numbers_ == TransformNumbers::s15_16 ? clip_line_in<FixedHost>(planes_, a, b)
                                              : clip_line_in<SingleHost>(planes_, a, b);
}

HostPosition HostGeometry::window(const Vertex& v) const {
  const HostView view{clip_z_, depth_range_, viewport_, limit_};
  return numbers_ == TransformNumbers::s15_16 ? window_in<FixedHost>(v, view) : window_in<SingleHost>(v, view);
}

Scene in_host_numbers(Scene scene, TransformNumbers numbers, const Config& config, HostCounts* counts) {
  HostCounts own;
  const auto is_draw = [](const Command& command) { return std::holds_alternative<Draw>(command); };
  const auto first = std::ranges::find_if(scene.commands, is_draw);
  if (numbers == TransformNumbers::binary64 || first == scene.commands.end()) return scene;
  const State& state = scene.states[std::get<Draw>(*first).state];
  const HostGeometry host(numbers, state, scene.width, scene.height, config);
  return HostProjector(std::move(scene), host, config.subpixel_bits, counts != nullptr ? *counts : own).run();
}

}  // namespace halfplane
