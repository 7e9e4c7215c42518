#include "widths.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace halfplane {
namespace {

int bits_of(Interval range) {
  const auto magnitude_bits = [](int128 value) {  // bits without the sign
    const auto v = static_cast<uint128>(value < 0 ? ~value : value);
    return v == 0 ? 0 : floor_log2(v) + 1;
  };
  const int lo = magnitude_bits(range.lo), hi = magnitude_bits(range.hi);
  const int bits = (lo > hi ? lo : hi) + (range.lo < 0 ? 1 : 0);
  return bits == 0 ? 1 : bits;  // a wire of width 0 does not exist
}

Width exact(std::string name, std::string bound, Interval range) {
  return {std::move(name), std::move(bound), range, bits_of(range), range.lo < 0, false};
}

Width modular(std::string name, std::string bound, int bits) {
  const int128 half = int128{1} << (bits - 1);
  return {std::move(name), std::move(bound), {-half, half - 1}, bits, true, true};
}

/// A residue that is never negative.
Width residue(std::string name, std::string bound, int bits) {
  return {std::move(name), std::move(bound), {0, (int128{1} << bits) - 1}, bits, false, true};
}

/// "2^B - 1", "modulo 2^(B + 1 + F)": `symbol` stands for the bits of a code.
std::string with_symbol(std::string text, std::string_view symbol) { return text.replace(text.find('#'), 1, symbol); }

/// The planes of one attribute. The numerator is twice an area in a box of `side` subpixels by the range of the codes.
AttributeWidths derive_attribute(const Attribute& a, int128 side, const Widths& w, const Config& config) {
  if (a.is_clamped != (a.base == BaseVertex::canonical) || (a.is_clamped && a.guard_bits != config.local_guard_bits))
    throw std::logic_error("no stage interpolates an attribute like " + std::string(a.name) + " yet");
  const std::string name(a.name);
  const int128 max = (int128{1} << (a.bits - (a.is_signed ? 1 : 0))) - 1, range = a.is_signed ? 2 * max : max;
  const auto bound = [&a](const char* text) { return with_symbol(text, a.symbol); };
  AttributeWidths d;
  // "2^N_C - 1", "2^N_P - 1", "2^(N_N + 1) - 1": without the sign.
  const std::string largest = a.symbol == "N_C + 1"   ? "2^N_C - 1"
                              : a.symbol == "N_N + 2" ? "2^(N_N + 1) - 1"
                                                      : "2^N_P - 1";
  d.code = a.is_signed ? exact(name + " code", "+-(" + largest + ")", symmetric(max))
                       : exact(name + " code", bound("2^# - 1"), {0, max});
  d.delta = exact(name + " delta", "code - code", symmetric(range));
  d.numerator = exact(name + " numerator", a.is_signed ? "L * 2 (" + largest + ")" : bound("L * (2^# - 1)"),
                      symmetric(side * range));
  d.reciprocal = exact(name + " reciprocal",
                       a.is_clamped ? bound("2^(m+r) / A, r = # + extra") : std::string("2^(m+r) / A, r = N - 2"),
                       {0, int128{1} << a.reciprocal_bits});
  d.product = exact(name + " product", name + " numerator * reciprocal", d.numerator.range * d.reciprocal.range);
  d.plane = modular(name + " plane", bound("modulo 2^(# + 1 + F)"), a.bits + 1 + w.plane_fraction);
  d.local = modular("local " + name, bound("modulo 2^(# + 1 + l)"), a.bits + 1 + a.guard_bits);
  d.step = d.local;
  if (w.has_samples != 0)
    d.step = modular(name + " step", bound("modulo 2^(# + 1 + l + s)"), a.bits + 1 + a.guard_bits + w.grid_bits);
  d.fragment = a.is_clamped ? d.code : d.local;
  if (a.is_clamped) {
    d.line = residue("line " + name, bound("modulo 2^(# + G')"), a.bits + w.line_guard_bits);
    d.affine_code = d.code;
  }
  return d;
}

void derive_attributes(Widths& w, const Config& config, int128 side) {
  w.attributes = attributes_of(config);
  w.planes = plane_count(w.attributes);
  if (w.planes > kMaxPlanes) throw std::logic_error("more planes than kMaxPlanes");
  w.color_planes = color_planes(w.attributes);
  w.affine_planes = affine_planes(w.attributes);
  w.line_guard_bits = ceil_log2(static_cast<uint128>(int128{2} * config.guard_band)) + 2;
  int r = 0;
  for (const Attribute& a : w.attributes) r = std::max(r, a.reciprocal_bits);
  w.reciprocal = exact("reciprocal", "2^(m+r) / A, 2^m <= A < 2^(m+1), r of the widest", {0, int128{1} << r});
  w.reciprocal_shift =
      exact("reciprocal shift", "k = m + r, m <= 2 log2 L", {0, floor_log2(static_cast<uint128>(side * side)) + r});
  std::size_t plane = 0, index = 0;
  for (const Attribute& a : w.attributes) {
    w.attribute[index] = derive_attribute(a, side, w, config);
    for (int i = 0; i < a.planes; ++i, ++plane) {
      w.attribute_of[plane] = static_cast<std::uint8_t>(index);
      if (a.is_clamped) w.line_mask[plane] = ~0ULL >> (64 - w.attribute[index].line.bits);
      const bool is_code = static_cast<int>(plane) < w.affine_planes;
      const int bits = w.attribute[index].fragment.bits;
      w.code_place[plane] = {is_code ? w.attribute[index].guard_bits() : 0,
                             is_code ? std::uint32_t{1} << (bits - 1) : 0,
                             ~std::uint32_t{0} >> (32 - std::min(bits, 32))};
    }
    ++index;
  }
  w.attribute[0].plane.bound += ", F = G + s";
  w.attribute[0].local.bound += ", l local guard bits";
  w.attribute[0].line.bound += ", G' = log2(2 g) + 2";
}

void derive_line_widths(Widths& w, const Config& config) {
  const int128 side = w.delta.range.hi, pixel = int128{1} << w.grid_bits;
  // From the start's row, at the line's first column. o: offset from the start to its centre, -2^(s-1) <= o <= 2^s
  // subpixels.
  w.line_numerator = exact("line numerator", "f D + d o - 1, f < 2^s", {-pixel / 2 * side - 1, (2 * pixel - 1) * side});
  w.line_position = exact("line position", "(line numerator >> s) + d n, n columns: d n <= L^2 / 2^s",
                          (w.line_numerator.range >> w.grid_bits) + (Interval{0, side * side} >> w.grid_bits));
  const Width& longest = w.depth().delta.bits > w.color().delta.bits ? w.depth().delta : w.color().delta;
  w.line_product = exact("line product", longest.name + " * reciprocal", longest.range * w.reciprocal.range);
  w.line_stay = exact("line stay", "d, 0 <= d <= D <= L", {0, side});
  w.line_move = exact("line move", "d - D", {-side, 0});
  w.line_error = exact("line error", "d - D <= p < d", {-side, side - 1});
  w.line_count = exact("line count", "longer side of the target, less the first pixel",
                       {0, std::max(config.target_width, config.target_height) - 1});
}

/// Widths of a texture unit besides planes; without one a bit each, and no element of the arrays over coordinates.
void derive_texture(Widths& w, const Config& config) {
  const bool has_unit = has_texture_planes(config);
  w.coordinates = has_unit ? 2 : 0;
  w.q_plane = static_cast<std::size_t>(w.affine_planes);
  const int narrow_bits = config.perspective_mantissa_bits - 1;  // k_P
  w.coordinate_shift = exact("coordinate shift", "c = 1 + x - sp - k_P, 0 <= x - sp <= 1 + N_P",
                             {1 - narrow_bits, 2 + config.perspective_bits - narrow_bits});
  w.coordinate_reach = exact("coordinate reach", "x <= 20", {0, 20});
  w.coordinate_reference =
      exact("coordinate reference", "u_ref: +-2^22, beyond which no clamp can tell", symmetric(int128{1} << 22));
  for (const UnitValue& value : kUnitValues) {
    w.*value.count = config.*value.units;
    w.*value.width = exact(value.name, value.bound, value.range);
  }
  const bool has_colors = has_colors_over_w(config);
  const int color_bits = color_over_w_bits(config);  // N_C
  w.colors_over_w = has_colors ? w.color_planes : 0;
  w.has_colors_over_w = has_colors ? 1 : 0;
  w.normals = has_normals(config) ? 3 : 0;
  w.color_shift =
      exact("color shift", "c = 1 + x - sp - k_P, k_P = 13, N_C - N <= x - sp <= 1 + N_C",
            {1 + color_bits - config.perspective_bits - kColorNarrowBits, 2 + color_bits - kColorNarrowBits});
  w.color_reach = exact("color reach", "x <= 8", {0, 8});
  w.written_color = w.stored_color;
  if (has_unit || packs_at_write(config)) w.written_color = w.vertex_color;
  w.written_color.name = "written color";
  w.written_color.bound = "a stored colour, or in front of a unit that changes it the primitive's";
  w.shaded_color = packs_at_write(config) ? w.vertex_color : w.stored_color;
  w.shaded_color.name = "shaded color";
  w.shaded_color.bound = "a stored colour, or what is blended or dithered";
  w.alpha_counters = tests_alpha(config) ? 1 : 0;
  w.texture_counters = has_texture_planes(config) ? 1 : 0;
  w.texture_port_bytes = std::min(config.memory_port_bits, 64) / 8;
  w.texture_beats = exact("texture beats", "of a line of 4x4 texels of 4 bytes, of 16 bits at least", {0, 32});
  w.texture_byte = exact("texture byte", "8 bits", {0, 255});
}

/// Log2 of the bytes for `bits` bits of a sample: 1, 2 or 4.
int sample_bytes_log2(int bits) { return bits <= 8 ? 0 : bits <= 16 ? 1 : 2; }

void derive_memory(Widths& w, const Config& config) {
  const auto log2 = [](int n) { return ceil_log2(static_cast<uint128>(n)); };
  MemoryGrid& m = w.memory;
  w.port_bytes = config.memory_port_bits / 8;
  m.port = log2(w.port_bytes);
  m.sample = {sample_bytes_log2(w.stored_depth.bits), sample_bytes_log2(w.stored_color.bits)};
  m.stamp = {m.sample[0] + log2(w.samples), m.sample[1] + log2(w.memory_colors)};
  m.pixel_color = m.sample[1] + log2(w.pixels);
  m.flag_word = log2(w.blocks.flag_word) - 3;
  m.plane = std::max(std::max(m.stamp[0], m.stamp[1]) + log2(w.stamps.stamps()), m.port);
  const int words = (w.tiles_x * w.blocks.per_tile - 1) / w.blocks.flag_word + 1;
  m.flag_row = std::max(log2(words) + m.flag_word, m.port) + (config.compress_units != 0 ? 1 : 0);

  const int run = std::max(w.stamps.stamps(), words);
  w.run = exact("run", "stamps of a tile, words of a row of flags", {0, run});
  w.address = exact("address", "bytes", {0, (int128{1} << 32) - 1});
  w.row_stride = exact("row stride", "bytes from one row of tiles to the next, up to twice those of the widest target",
                       {0, (int128{2} << (w.tile_x.bits + m.tile())) - 1});
  const int largest = std::max({m.stamp[0], m.stamp[1], m.flag_word});
  w.burst_length = exact("burst length", "beats of a plane of a tile, of a row of flags",
                         {0, largest > m.port ? run << (largest - m.port) : run});
  w.port_strobe = exact("port strobe", "one bit a byte of memory.port_bits", {0, (int128{1} << w.port_bytes) - 1});
  w.port_byte = exact("port byte", "8 bits", {0, 255});
}

}  // namespace

Widths::Widths() = default;
Widths::Widths(const Widths&) = default;
Widths::Widths(Widths&&) noexcept = default;
Widths& Widths::operator=(const Widths&) = default;
Widths& Widths::operator=(Widths&&) noexcept = default;
Widths::~Widths() = default;

Widths derive_widths(const Config& config) {
  Widths w;
  w.grid_bits = coordinate_grid_bits(config);
  const int s = w.grid_bits;
  w.pixel_samples = config.msaa_samples;
  const SamplePattern pattern = resolved_pattern(config.msaa_pattern, config.msaa_samples);
  for (std::size_t k = 0; k < static_cast<std::size_t>(config.msaa_samples) && k < pattern.place.size(); ++k) {
    const auto on_grid = [s](int place) {  // exact: s has at least the bits of the pattern
      const int way = place - (1 << (kPatternFraction - 1));
      return s < kPatternFraction ? way / (1 << (kPatternFraction - s)) : way * (1 << (s - kPatternFraction));
    };
    w.sample_offset[k] = {on_grid(pattern.place[k].x), on_grid(pattern.place[k].y)};
  }
  const int128 band = config.guard_band;
  w.tile_shift = floor_log2(static_cast<uint128>(config.tile_size));
  // A span of W + H = 4 * band pixels: half an LSB of gradient error per pixel, 4 bits below that for the anchor. And
  // more than a tile keeps, even in the smallest band: narrowing to local guard bits is a shift right, and the bits
  // that a step of a whole tile does not change lie below them.
  w.guard_bits = std::max(ceil_log2(static_cast<uint128>(4 * band)) + 4, config.local_guard_bits + w.tile_shift);
  w.plane_fraction = w.guard_bits + s;
  w.stamps = {config.stamp_size, config.tile_size / config.stamp_size, config.msaa_samples};
  w.samples = w.stamps.samples();
  w.pixels = w.stamps.pixels();
  w.further_samples = w.samples - w.pixels;
  w.has_samples = config.msaa_samples > 1 ? 1 : 0;
  w.memory_colors = config.resolve_units != 0 ? w.pixels : w.samples;
  w.edge_lows = 3 * w.has_samples;
  w.tiles_x = (config.target_width + config.tile_size - 1) / config.tile_size;
  w.tiles_y = (config.target_height + config.tile_size - 1) / config.tile_size;
  const int line_bits = floor_log2(static_cast<uint128>(config.cache_lines));
  w.line_x_bits = (line_bits + 1) / 2;
  w.line_y_bits = line_bits / 2;

  // Coverage. A box of side L holds every vertex and pixel centre, so twice any triangle's area in it is at most L^2.
  const Interval coordinate{-(band << s), (band << s) - 1};
  const Interval delta = coordinate - coordinate;
  const int128 side = delta.hi;
  const Interval edge = symmetric(side * side);
  w.coordinate = exact("coordinate", "guard band g * 2^s", coordinate);
  w.delta = exact("delta", "X - X", delta);
  w.edge_product = exact("edge product", "delta * delta", delta * delta);
  w.area = exact("area", "L^2, L the side of the guard band", {0, edge.hi});
  w.edge_value = exact("edge value", "(+-L^2 - 1) >> s", (edge + Interval{-1, 0}) >> s);
  w.edge_step = exact("edge step", "delta: one pixel changes E >> s by dx or dy", delta);
  // |dx| + |dy| over T - 1 pixels, plus the increment to a sample (sample_edge_reach()).
  const int128 to_sample = w.has_samples != 0 ? side + 1 : 0, extent = 2 * side * (config.tile_size - 1) + to_sample;
  w.tile_edge = exact("tile edge",
                      w.has_samples != 0 ? "saturated beyond (T-1/2)(|dx|+|dy|) + 1 at the tile's first pixel"
                                         : "saturated beyond (T-1)(|dx|+|dy|) at the tile's first pixel",
                      {-extent - 1, extent});
  // All of its bits are used: saturating at a power of two only tests the high bits, where a clamp would subtract.
  w.tile_edge.range = {-(int128{1} << (w.tile_edge.bits - 1)), (int128{1} << (w.tile_edge.bits - 1)) - 1};
  w.sample_edge =
      exact("sample edge", w.has_samples != 0 ? "tile edge + (T-1/2)(|dx|+|dy|) + 1" : "tile edge + (T-1)(|dx|+|dy|)",
            w.tile_edge.range + symmetric(extent));

  derive_attributes(w, config, side);

  // Keys and positions.
  const auto count = [](const char* name, const char* bound, int128 n) { return exact(name, bound, {0, n - 1}); };
  const int tile = config.tile_size;
  w.primitive_id = count("primitive id", "modulo 2^key.primitive_bits", int128{1} << config.primitive_id_bits);
  w.slot = count("slot", "context.slots", config.context_slots);
  w.tile_x = count("tile x", "target width / T", w.tiles_x);
  w.hiz_group_bits = std::min(config.setup_kind == SetupKind::serial ? 1 : 3, w.tile_x.bits);
  w.tile_y = count("tile y", "target height / T", w.tiles_y);
  w.tile_pixel = count("tile pixel", "T", tile);
  w.stamp_index = count("stamp index", "(T / stamp)^2", w.stamps.stamps());
  const auto bits = [](const char* name, const char* bound, int n) {
    return exact(name, bound, {0, (int128{1} << n) - 1});
  };
  const int color_bits = config.color_format == ColorFormat::rgb565 ? 16 : 32;
  w.sample_mask = bits("sample mask", "one bit a sample", w.samples);
  w.pixel_mask = bits("pixel mask", "one bit a pixel of a stamp", w.pixels);
  w.masked_samples = bits("masked samples", "msaa.samples", config.msaa_samples);
  w.edge_low = bits("edge low", "s", s);
  w.further_depth = bits("further depth", "depth.bits", config.depth_bits);
  w.stored_color = bits("stored color", "color.format", color_bits);
  w.stencil_flags = config.stencil_bits != 0 ? 1 : 0;
  w.stored_depth = bits("stored depth", "a depth code, stencil.bits above it", config.depth_bits + config.stencil_bits);

  // State that travels with a primitive.
  w.kind = count("kind", "PrimitiveKind", 8);
  w.flag = count("flag", "yes or no", 2);
  w.depth_func = count("depth func", "DepthFunc", 8);
  w.cull_mode = count("cull mode", "Cull", 4);
  // At least one bit for the tile, for any target.
  w.pixel_x = count("pixel x", "target width, at least 2 T", std::max(config.target_width, 2 * tile));
  w.pixel_y = count("pixel y", "target height, at least 2 T", std::max(config.target_height, 2 * tile));
  w.vertex_color = bits("vertex color", "8 bits a stored channel", w.color().code.bits * w.color_planes);
  w.hiz_code = bits("hiz code", "hiz.bits, at most depth.bits, at least 1", std::max(1, hiz_code_bits(config)));
  w.hiz_update = count("hiz update", "HizUpdate", 3);
  w.counter = bits("counter", "counters.bits", config.counter_bits);
  w.tile_plane = count("tile plane", "TilePlane", 8);
  w.depth_source = count("depth source", "DepthSource", 4);
  w.memory_lane = bits("memory lane", "a stored depth or a stored colour", std::max(w.stored_depth.bits, color_bits));
  const int block = config.cache_kind == CacheKind::tiles ? config.tile_size : std::max(4, config.stamp_size);
  w.blocks.side = block / config.stamp_size;
  w.blocks.per_tile = config.tile_size / block;
  w.blocks.side_log2 = floor_log2(static_cast<uint128>(w.blocks.side));
  w.blocks.per_tile_log2 = floor_log2(static_cast<uint128>(w.blocks.per_tile));
  while (w.blocks.flag_word < 64 && 2 * w.blocks.flag_word <= w.samples * w.memory_lane.bits) w.blocks.flag_word *= 2;
  derive_line_widths(w, config);
  derive_memory(w, config);
  derive_texture(w, config);
  return w;
}

double depth_error_bound(const Config& config) {
  const double local = std::ldexp(1.0, -config.local_guard_bits - 1);  // one rounding to the local guard bits
  return 0.5                                                           // storage
         + std::ldexp(1.0, -config.reciprocal_extra_bits)              // the reciprocal, over the full depth range
         + (plane_roundings(config) + 1) * local                       // the steps, and the anchor
         + std::ldexp(1.0, -5);  // wide gradients over the guard band: ensured by guard_bits
}

double line_depth_error_bound(const Config& config) {
  const Widths widths = derive_widths(config);
  return 0.5                                               // storage
         + std::ldexp(1.0, -config.reciprocal_extra_bits)  // the reciprocal, over the full depth range
         // One rounding of the gradient over at most 2g pixels, and one of the first value.
         + (2.0 * config.guard_band + 1) * std::ldexp(1.0, -widths.line_guard_bits - 1);
}

HomogeneousWidths derive_homogeneous_widths(const Config& config) {
  HomogeneousWidths w;
  const int128 pixels = int128{config.target_width} + config.target_height;
  const int span = ceil_log2(static_cast<uint128>(pixels));
  // Three roundings by 1/2 move E by at most (W + H) / 2, and its slope is at least 2^(m-1).
  w.fraction = span + config.subpixel_bits + 1;
  const Interval coefficient = symmetric(int128{1} << w.fraction), offset = symmetric(pixels << w.fraction);
  w.coefficient = exact("homogeneous coefficient", "2^m, m = log2(W + H) + S + 1", coefficient);
  w.offset = exact("homogeneous offset", "saturated at (W + H) 2^m: the sign of E is fixed beyond", offset);
  w.edge_value = exact("homogeneous edge", "a x + b y + c - 1, x < W, y < H",
                       coefficient * Interval{0, pixels - 2} + offset + Interval{-1, 0});
  // 8 bits of colour, the roundings over W + H pixels, and 1/w down to 2^-20 of its largest value in the box.
  w.weight_scale = 8 + span + 20;
  const Interval weight = symmetric((int128{1} << w.weight_scale) + pixels);
  w.weight_step = exact("weight step", "2^P, P = 8 + log2(W + H) + 20", symmetric(int128{1} << w.weight_scale));
  w.weight = exact("weight", "2^P + W + H", weight);
  w.color_step = exact("color step", "255 * weight step", w.weight_step.range * Interval{0, 255});
  w.color_weight = exact("color weight", "255 * 2^P + W + H", symmetric((int128{255} << w.weight_scale) + pixels));
  return w;
}

double homogeneous_edge_bound(const Config& config) {
  const double pixels = config.target_width + config.target_height;
  return pixels / 2 / std::ldexp(1.0, derive_homogeneous_widths(config).fraction - 1);
}

std::vector<const Width*> HomogeneousWidths::all() const& {
  return {&coefficient, &offset, &edge_value, &weight_step, &weight, &color_step, &color_weight};
}

const Width& widest(const Widths& widths, Width AttributeWidths::*width) {
  const auto* first = widths.attribute.data();
  const auto shorter = [width](const auto& a, const auto& b) { return (a.*width).bits < (b.*width).bits; };
  return std::max_element(first, first + widths.attributes.attributes, shorter)->*width;
}

std::string_view Widths::plane_name(std::size_t p) const {
  std::size_t part = p;
  for (std::size_t a = 0; a < attribute_of[p]; ++a) part -= static_cast<std::size_t>(attributes.attribute[a].planes);
  return attributes.attribute[attribute_of[p]].part[part];
}

std::vector<const Width*> Widths::all() const& {
  std::vector<const Width*> list{&coordinate, &delta,     &edge_product, &area,
                                 &edge_value, &edge_step, &tile_edge,    &sample_edge};
  const auto add = [&list](std::initializer_list<const Width*> widths) { list.insert(list.end(), widths); };
  const auto add_of_attributes = [&](std::initializer_list<Width AttributeWidths::*> members) {
    for (int a = 0; a < attributes.attributes; ++a)
      for (const auto member : members) list.push_back(&(attribute[static_cast<std::size_t>(a)].*member));
  };
  using A = AttributeWidths;
  add_of_attributes({&A::code, &A::delta, &A::numerator});
  add({&reciprocal, &reciprocal_shift});
  for (const auto member : {&A::reciprocal, &A::product, &A::plane, &A::local}) add_of_attributes({member});
  add({&coordinate_shift, &coordinate_reach, &coordinate_reference});
  for (const UnitValue& value : kUnitValues) list.push_back(&(this->*value.width));
  add({&color_shift, &color_reach, &written_color, &shaded_color, &texture_byte, &texture_beats});
  add({&primitive_id,   &slot,          &tile_x,       &tile_y,     &tile_pixel,   &stamp_index,  &sample_mask,
       &stored_color,   &stored_depth,  &kind,         &flag,       &depth_func,   &cull_mode,    &pixel_x,
       &pixel_y,        &vertex_color,  &hiz_code,     &hiz_update, &tile_plane,   &depth_source, &memory_lane,
       &counter,        &run,           &address,      &row_stride, &burst_length, &port_strobe,  &port_byte,
       &line_numerator, &line_position, &line_product, &line_error, &line_stay,    &line_move,    &line_count});
  if (has_samples != 0) add_of_attributes({&A::step});
  if (has_samples != 0) add({&edge_low, &pixel_mask, &masked_samples, &further_depth});
  for (int a = 0; a < attributes.attributes; ++a)
    if (attributes.attribute[static_cast<std::size_t>(a)].is_clamped)
      list.push_back(&attribute[static_cast<std::size_t>(a)].line);
  return list;
}

}  // namespace halfplane
