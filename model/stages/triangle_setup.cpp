#include "triangle_setup.hpp"

#include <algorithm>
#include <tuple>

#include "cull.hpp"
#include "perspective.hpp"

namespace halfplane {
namespace {

/// Product: holds numerator * reciprocal.
template <class Product>
PlaneValue gradient(std::int64_t numerator, const Reciprocal& reciprocal, int fraction) {
  const Product product = static_cast<Product>(numerator) * static_cast<Product>(reciprocal.value);
  return static_cast<PlaneValue>(round_shift(product, reciprocal.shift - fraction));  // modulo 2^64
}

template <class Product>
Plane plane_of(std::int64_t base, std::int64_t next, std::int64_t last, const PlaneFrame& f, const Reciprocal& r,
               int bits) {
  const std::int64_t ac = next - base, bc = last - base;
  const auto wrap = [bits](std::uint64_t value) { return wrap_signed(static_cast<std::int64_t>(value), bits); };
  Plane plane;
  plane.step_x = wrap(static_cast<std::uint64_t>(gradient<Product>(ac * f.by - bc * f.ay, r, f.fraction)));
  plane.step_y = wrap(static_cast<std::uint64_t>(gradient<Product>(f.ax * bc - f.bx * ac, r, f.fraction)));
  // Unsigned arithmetic: the products wrap modulo 2^64, and the plane is their residue.
  plane.value = wrap((static_cast<std::uint64_t>(base) << f.fraction) +
                     static_cast<std::uint64_t>(plane.step_x) * static_cast<std::uint64_t>(f.dx) +
                     static_cast<std::uint64_t>(plane.step_y) * static_cast<std::uint64_t>(f.dy));
  return plane;
}

}  // namespace

PlaneFrame plane_frame(const SnappedVertex& base, const SnappedVertex& next, const SnappedVertex& last, int first_x,
                       int first_y, int tile_size, const Widths& widths) {
  const int s = widths.grid_bits;
  const auto anchor = [&](int first) {  // centre of pixel first + T/2, subpixels
    return (std::int64_t{first + tile_size / 2} << s) + (std::int64_t{1} << (s - 1));
  };
  return {std::int64_t{next.x} - base.x, std::int64_t{next.y} - base.y, std::int64_t{last.x} - base.x,
          std::int64_t{last.y} - base.y, anchor(first_x) - base.x,      anchor(first_y) - base.y,
          widths.plane_fraction};
}

Plane setup_plane(std::int64_t base, std::int64_t next, std::int64_t last, const PlaneFrame& f, const Reciprocal& r,
                  int bits) {
  return plane_of<int128>(base, next, last, f, r, bits);
}

namespace {

/// The code of a plane at a vertex as a number.
std::int64_t code_value(const SnappedVertex& v, std::size_t p, const Widths& widths) {
  const Width& code = widths.of_plane(p).code;
  return code.is_signed ? wrap_signed(v.code[p], code.bits) : std::int64_t{v.code[p]};
}

/// The planes of a triangle with these vertices in canonical order and that area: plane(p, Plane) for each.
template <class Put>
void for_each_plane(const std::array<SnappedVertex, 3>& v, std::int64_t area, int first_x, int first_y,
                    const Config& config, const Widths& widths, Put&& plane) {
  const int significant_bits = widths.reciprocal_bits();
  const AreaQuotient quotient = area_quotient(area, significant_bits);
  const auto made = [&](std::size_t p, std::int64_t from, std::int64_t next, std::int64_t last,
                        const PlaneFrame& frame) {
    const AttributeWidths& attribute = widths.of_plane(p);
    const Reciprocal scale = reciprocal(quotient, significant_bits - attribute.reciprocal_bits());
    const bool is_short = attribute.product.bits <= 64 && widths.area.bits + attribute.reciprocal.bits <= 64;
    plane(p, is_short ? plane_of<std::int64_t>(from, next, last, frame, scale, attribute.plane.bits)
                      : plane_of<int128>(from, next, last, frame, scale, attribute.plane.bits));
  };
  const PlaneFrame frame = plane_frame(v[0], v[1], v[2], first_x, first_y, config.tile_size, widths);
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p)
    made(p, v[0].code[p], v[1].code[p], v[2].code[p], frame);
  if (widths.coordinates == 0) return;
  const std::size_t q = widths.q_plane, base = base_vertex({v[0].code[q], v[1].code[q], v[2].code[q]});
  const SnappedVertex &from = v[base], &next = v[(base + 1) % 3], &last = v[(base + 2) % 3];
  const PlaneFrame over_w = plane_frame(from, next, last, first_x, first_y, config.tile_size, widths);
  for (std::size_t p = q; p < static_cast<std::size_t>(widths.planes); ++p)
    made(p, code_value(from, p, widths), code_value(next, p, widths), code_value(last, p, widths), over_w);
}

/// The ranges of a triangle's affine codes.
void set_range(CodeRange& range, const std::array<SnappedVertex, 3>& v, const Widths& widths) {
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.affine_planes); ++p)
    std::tie(range.low[p], range.high[p]) = range_of(v[0].code[p], v[1].code[p], v[2].code[p]);
}

/// All constants that follow from the vertices in canonical order, their area and the box.
void finish_setup(TriangleSetup& setup, const std::array<SnappedVertex, 3>& v, const Config& config,
                  const Widths& widths) {
  const int s = widths.grid_bits;
  const int first_x = setup.left >> widths.tile_shift << widths.tile_shift;  // first pixel of the first tile
  const int first_y = setup.top >> widths.tile_shift << widths.tile_shift;

  for (std::size_t i = 0; i < 3; ++i) {
    const SnappedVertex &from = v[i], &to = v[(i + 1) % 3];
    setup.edge[i] = {to.x - from.x, to.y - from.y, edge_function(from, to, first_x, first_y, s)};
    if (widths.has_samples != 0) setup.edge[i].low = static_cast<std::uint16_t>(edge_low(from, to, s));
  }
  for_each_plane(v, setup.area, first_x, first_y, config, widths,
                 [&](std::size_t p, const Plane& plane) { setup.plane[p] = plane; });
  set_range(setup.range, v, widths);
}

/// The constants of a primitive with one code per plane and no edges.
void finish_flat_setup(TriangleSetup& setup, const SnappedVertex& v, const Widths& widths) {
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p) {
    const auto value = static_cast<std::uint64_t>(code_value(v, p, widths)) << widths.plane_fraction;
    setup.plane[p] = {wrap_signed(static_cast<std::int64_t>(value), widths.of_plane(p).plane.bits), 0, 0};
  }
  setup.range.low = setup.range.high = v.code;
}

}  // namespace

AreaQuotient area_quotient(std::int64_t area, int significant_bits) {
  if (area <= 0) return {};
  const int shift = floor_log2(static_cast<uint128>(area)) + significant_bits;
  const auto divisor = static_cast<std::uint64_t>(area);
  return {
      shift < 63 ? (std::uint64_t{2} << shift) / divisor : static_cast<std::uint64_t>((uint128{2} << shift) / divisor),
      shift};
}

Reciprocal reciprocal(std::int64_t area, int significant_bits) {
  return reciprocal(area_quotient(area, significant_bits), 0);
}

TriangleSetup setup_outline(const Triangle& triangle, const Widths& widths, const Rect& rect) {
  TriangleSetup setup;
  setup.primitive = triangle.primitive;
  const std::int64_t area = signed_area(triangle.v[0], triangle.v[1], triangle.v[2]);
  if (area == 0) return setup;
  const auto v = canonical(triangle.v, area);
  setup.area = area < 0 ? -area : area;
  const PixelBounds limit{rect.x, rect.y, rect.x + rect.width - 1, rect.y + rect.height - 1};
  const PixelBounds box = sample_bounds(v, limit, widths.grid_bits, widths.pixel_samples);
  setup.left = box.left;
  setup.top = box.top;
  setup.right = box.right;
  setup.bottom = box.bottom;
  set_range(setup.range, v, widths);
  return setup;
}

TriangleSetup setup_triangle(const Triangle& triangle, const Config& config, const Widths& widths, const Rect& rect) {
  TriangleSetup setup = setup_outline(triangle, widths, rect);
  if (setup.area != 0)
    finish_setup(setup, canonical(triangle.v, signed_area(triangle.v[0], triangle.v[1], triangle.v[2])), config,
                 widths);
  return setup;
}

TriangleSetup setup_triangle(const Triangle& triangle, const Config& config, const Widths& widths) {
  return setup_triangle(triangle, config, widths,
                        {-config.guard_band, -config.guard_band, 2 * config.guard_band, 2 * config.guard_band});
}

std::uint64_t plane_bias(const AttributeWidths& attribute, const Widths& widths) {
  const auto bit = [](int n) { return std::uint64_t{1} << n; };
  const int fraction = widths.plane_fraction;
  const std::uint64_t half = bit(fraction - attribute.guard_bits() - 1);  // F - l is at least 2
  if (attribute.affine_code.bits == 0) return half;
  return half + bit(fraction - 1) + bit(fraction + attribute.code.bits - 1);  // l is at least 1
}

namespace {

void set_plane(SetupPacket& packet, std::size_t p, const Plane& plane, const Widths& widths) {
  const AttributeWidths& attribute = widths.of_plane(p);
  const std::uint64_t biased = static_cast<std::uint64_t>(plane.value) + plane_bias(attribute, widths);
  packet.value[p] = wrap_signed(static_cast<std::int64_t>(biased), attribute.plane.bits);
  packet.step_x[p] = plane.step_x;
  packet.step_y[p] = plane.step_y;
}

}  // namespace

SetupPacket to_setup_packet(const TriangleSetup& setup, const Widths& widths) {
  SetupPacket packet;
  packet.box = to_box({setup.left, setup.top, setup.right, setup.bottom});
  packet.primitive_id = static_cast<std::uint32_t>(wrap_unsigned(setup.primitive, widths.primitive_id.bits));
  for (std::size_t i = 0; i < 3; ++i) {
    packet.dx[i] = setup.edge[i].dx;
    packet.dy[i] = setup.edge[i].dy;
    packet.edge_value[i] = setup.edge[i].value;
    packet.edge_low[i] = setup.edge[i].low;
  }
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p)
    set_plane(packet, p, setup.plane[p], widths);
  packet.range = setup.range;
  return packet;
}

TriangleSetup setup_primitive(const TrianglePacket& primitive, const Config& config, const Widths& widths) {
  TriangleSetup setup;
  setup.primitive = primitive.primitive_id;
  setup.left = primitive.box.left;
  setup.top = primitive.box.top;
  setup.right = primitive.box.right;
  setup.bottom = primitive.box.bottom;
  const auto v = to_snapped(primitive.vertex);
  if (primitive.kind == PrimitiveKind::triangle) {
    setup.area = static_cast<std::int64_t>(primitive.area);
    finish_setup(setup, v, config, widths);
  } else {
    finish_flat_setup(setup, v[primitive.kind == PrimitiveKind::state ? 2 : 0], widths);
  }
  return setup;
}

[[gnu::flatten]] void setup_packet(const TrianglePacket& primitive, const Config& config, const Widths& widths,
                                   SetupPacket& packet) {
  if (primitive.kind == PrimitiveKind::triangle) {
    const auto v = to_snapped(primitive.vertex);
    packet.box = primitive.box;
    packet.primitive_id = static_cast<std::uint32_t>(wrap_unsigned(primitive.primitive_id, widths.primitive_id.bits));
    for (std::size_t i = 0; i < 3; ++i) {
      const SnappedVertex &from = v[i], &to = v[(i + 1) % 3];
      packet.dx[i] = to.x - from.x;
      packet.dy[i] = to.y - from.y;
      packet.edge_value[i] = primitive.edge_value[i];
      packet.edge_low[i] = primitive.edge_low[i];
    }
    for_each_plane(v, static_cast<std::int64_t>(primitive.area),
                   primitive.box.left >> widths.tile_shift << widths.tile_shift,
                   primitive.box.top >> widths.tile_shift << widths.tile_shift, config, widths,
                   [&](std::size_t p, const Plane& plane) { set_plane(packet, p, plane, widths); });
    set_range(packet.range, v, widths);
  } else {
    packet = to_setup_packet(setup_primitive(primitive, config, widths), widths);
  }
  packet.state = primitive.state;
  packet.kind = primitive.kind;
  packet.coordinates = primitive.coordinates;
}

SetupPacket setup_packet(const TrianglePacket& primitive, const Config& config, const Widths& widths) {
  SetupPacket packet;
  setup_packet(primitive, config, widths, packet);
  return packet;
}

}  // namespace halfplane
