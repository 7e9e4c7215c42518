#include "raster_pkg.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <set>
#include <sstream>

#include "../packets/packet_words.hpp"
#include "../pipeline_graph.hpp"
#include "raster_taps.hpp"
#include "../packets/state_packets.hpp"
#include "../stages/surface.hpp"
#include "../stages/texture_packets.hpp"

namespace halfplane {

/// What becomes of a stored stencil, in the words of tokens: a field of no packet.
template <>
struct WireEnum<StencilOp> {
  static constexpr std::string_view name = "stencil_op";
  static constexpr Width Widths::*width = &Widths::depth_func;  // eight of either
  static constexpr Enumerator<StencilOp> all[] = {
      {StencilOp::keep, "keep"},           {StencilOp::zero, "zero"},          {StencilOp::replace, "replace"},
      {StencilOp::incr, "incr"},           {StencilOp::decr, "decr"},          {StencilOp::invert, "invert"},
      {StencilOp::incr_wrap, "incr_wrap"}, {StencilOp::decr_wrap, "decr_wrap"}};
};

namespace {

std::string constant_name(std::string_view name) {
  std::string upper;
  for (const char c : name)
    upper += c == ' ' || c == '.' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return upper;
}

void print_constant(std::ostream& out, const std::string& name, long long value, const std::string& why) {
  out << "  localparam int " << name << " = " << value << ";  // " << why << "\n";
}

/// The word for a member of AttributeWidths in the names of its tables: CODE_BITS_OF, CODE_AT, ALL_CODE_BITS.
struct PlaneTable {
  const char* word;
  Width AttributeWidths::*width;
  const char* what;
};
constexpr PlaneTable kPlaneTables[] = {{"CODE", &AttributeWidths::code, "codes"},
                                       {"RECIPROCAL", &AttributeWidths::reciprocal, "reciprocals of the area"},
                                       {"PLANE", &AttributeWidths::plane, "values and gradients"},
                                       {"LOCAL", &AttributeWidths::local, "values and gradients inside a tile"},
                                       {"STEP", &AttributeWidths::step, "gradients per pixel inside a tile"},
                                       {"FRAGMENT", &AttributeWidths::fragment, "values of a sample"},
                                       {"AFFINE_CODE", &AttributeWidths::affine_code, "codes that are clamped"},
                                       {"LINE", &AttributeWidths::line, "values along a line"}};

std::string all_bits(Width AttributeWidths::*width) {
  const auto* table = std::ranges::find(kPlaneTables, width, &PlaneTable::width);
  return "ALL_" + std::string(table->word) + "_BITS";
}

/// Of each plane the bits of a value and where it begins in an array over the planes, 32 bits an entry, plane 0 lowest;
/// the bits of the whole array, and those of its widest value.
void print_plane_table(std::ostream& out, const PlaneTable& table, const Widths& widths) {
  std::string bits, at;
  int sum = 0, most = 0;
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths.planes); ++p) {
    const int width = (widths.of_plane(p).*table.width).bits;
    const auto entry = [p](int value) { return "32'd" + std::to_string(value) + (p == 0 ? "" : ", "); };
    bits = entry(width) + bits;
    at = entry(sum) + at;
    sum += width;
    most = std::max(most, width);
  }
  const std::string word = table.word, type = "  localparam logic [32*PLANES-1:0] " + word;
  out << type << "_BITS_OF = {" << bits << "};  // " << table.what << "\n" << type << "_AT = {" << at << "};\n";
  print_constant(out, "ALL_" + word + "_BITS", sum, "of one for each plane");
  print_constant(out, "MAX_" + word + "_BITS", most, "of the widest");
}

/// msaa.pattern: the way from a pixel's centre to each of its samples.
void print_sample_places(std::ostream& out, const Widths& widths) {
  std::string x, y;
  for (int k = widths.pixel_samples - 1; k >= 0; --k) {
    const SampleOffset& o = widths.sample_offset[static_cast<std::size_t>(k)];
    const auto entry = [k](int way) {
      return (way < 0 ? "-32'sd" : "32'sd") + std::to_string(way < 0 ? -way : way) + (k == 0 ? "" : ", ");
    };
    x += entry(o.x);
    y += entry(o.y);
  }
  const std::string type = "  localparam logic [32*MSAA_SAMPLES-1:0] MSAA_";
  out << type << "X = {" << x << "};  // from a pixel's centre to its samples, subpixels right, sample 0 lowest\n"
      << type << "Y = {" << y << "};  // and down\n";
}

template <class Enum>
void print_enum(std::ostream& out, const Widths& widths) {
  using Wire = WireEnum<Enum>;
  const int bits = (widths.*Wire::width).bits;
  out << "\n  typedef enum logic [" << constant_name((widths.*Wire::width).name) << "_BITS-1:0] {";
  const char* separator = "\n";
  for (const Enumerator<Enum>& entry : Wire::all) {
    out << separator << "    " << constant_name(Wire::name) << "_" << constant_name(entry.name) << " = " << bits << "'d"
        << static_cast<int>(entry.value);
    separator = ",\n";
  }
  out << "\n  } " << Wire::name << "_t;\n";
}

template <class Packet, class Member, class Place>
void print_field(std::ostream& out, const Field<Packet, Member, Place>& field, const Widths& widths) {
  const auto logic = [&](bool is_signed, const std::string& bits) {
    out << "    logic " << (is_signed ? "signed " : "") << "[" << bits << "-1:0] " << field.name << ";\n";
  };
  if (element_count(field, widths) == 0) return;
  if constexpr (std::is_same_v<Place, Nested>) {
    if (packet_bits<Member>(widths) != 0) out << "    " << Member::name << "_t " << field.name << ";\n";
  } else if constexpr (std::is_enum_v<Member>) {
    out << "    " << WireEnum<Member>::name << "_t " << field.name << ";\n";
  } else if constexpr (std::is_same_v<Place, Width AttributeWidths::*>) {
    const std::size_t count = element_count(field, widths);
    logic(false, (count > 1 ? std::to_string(count) + "*" : "") + all_bits(field.width));
  } else {
    const Width& width = widths.*field.width;
    const std::string bits = constant_name(width.name) + "_BITS";
    if constexpr (kArraySize<Member> !=
                  0)  // flat, because Yosys reads no packed 2-D members: element i is [i*BITS +: BITS]
      logic(false, std::to_string(element_count(field, widths)) + "*" + bits);
    else
      logic(width.is_signed, bits);
  }
}

template <class Packet>
void print_struct(std::ostream& out, const Widths& widths) {
  if (packet_bits<Packet>(widths) == 0) return;
  out << "\n  typedef struct packed {\n";
  for_each_field<Packet>([&](const auto& field) { print_field(out, field, widths); });
  out << "  } " << Packet::name << "_t;\n";
}

template <class Packet>
void print_packet(std::ostream& out, const Widths& widths) {
  print_struct<Packet>(out, widths);
  print_constant(out, constant_name(Packet::name) + "_BITS", packet_bits<Packet>(widths), "of the struct above");
}

/// A value that has a name is its number there.
void print_setting(std::ostream& out, const Setting& setting, const std::string& value) {
  long long number = setting.is_number() ? std::stoll(value) : 0;
  std::string names;
  for (std::size_t i = 0; i < setting.names.size(); ++i) {
    if (setting.names[i] == value) number = static_cast<long long>(i);
    names += (i == 0 ? "" : ", ") + std::to_string(i) + " " + std::string(setting.names[i]);
  }
  print_constant(out, constant_name(setting.key), number,
                 names + (names.empty() ? "" : ": ") + std::string(setting.meaning));
}

}  // namespace

std::uint64_t config_id(const Config& config) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto feed = [&hash](std::string_view text) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  };
  for (const Setting& setting : settings()) {
    if (!setting.is_hardware()) continue;
    feed(setting.key);
    feed("=");
    feed(get(config, setting));
    feed("\n");
  }
  return hash;
}

std::string raster_pkg(const Config& config) {
  require_sampled_hardware(config, "the RTL");
  validate(config);
  const Widths widths = derive_widths(config);
  std::ostringstream out;
  const bool is_preset = config == preset(config.preset);
  out << "// Generated by `halfplane config --config " << label(config, " --set ") << " --sv`; do not edit."
      << (is_preset ? " A test holds it against the model.\n" : "\n")
      << "package raster_pkg;\n  /* verilator lint_off UNUSEDPARAM */  // a stage alone reads only some of them\n\n"
         "  // The configuration.\n";
  for (const Setting& setting : settings()) {
    if (!setting.is_hardware()) continue;
    if (setting.key == "msaa.pattern")
      print_sample_places(out, widths);
    else
      print_setting(out, setting, get(config, setting));
  }
  char id[17];
  std::snprintf(id, sizeof id, "%016llx", static_cast<unsigned long long>(config_id(config)));
  out << "  localparam logic [63:0] CONFIG_ID = 64'h" << id << ";  // hash of the above\n\n  // Derived constants.\n";
  print_constant(out, "GRID_BITS", widths.grid_bits, "s: fraction bits of a coordinate, at least 1");
  print_constant(out, "GUARD_BITS", widths.guard_bits, "G: fraction bits of a gradient per pixel");
  print_constant(out, "PLANE_FRACTION", widths.plane_fraction, "F = G + s");
  print_constant(out, "TILE_SHIFT", widths.tile_shift, "log2 of the tile size");
  print_constant(out, "LINE_GUARD_BITS", widths.line_guard_bits, "G': fraction bits of the planes along a line");
  print_constant(out, "STAMPS_PER_ROW", widths.stamps.stamps_per_row, "stamps along the side of a tile");
  print_constant(out, "PLANES", widths.planes, "that are interpolated: depth, the colours and what follows them");
  print_constant(out, "COLOR_PLANES", widths.color_planes, "of the stored colour: plane 1 and the next ones");
  print_constant(out, "AFFINE_PLANES", widths.affine_planes,
                 "linear in the window: depth and colours, which come first");
  print_constant(out, "COORDINATES", widths.coordinates, "of a texture, planes behind that of 1/w");
  print_constant(out, "PERSPECTIVE_GUARD_BITS", kPerspectiveGuardBits, "l: fraction bits of those inside a tile");
  print_constant(out, "COORDINATE_FRACTION", perspective_format(config).coordinate.fraction_bits,
                 "f: of a texture coordinate, texels");
  print_constant(out, "COLORS_OVER_W", widths.colors_over_w, "colour planes divided by w");
  print_constant(out, "COLOR_NARROW_BITS", kColorNarrowBits, "mantissa bits of the reciprocal of w, for colours");
  print_constant(out, "NORMALS", widths.normals, "planes of those, over w; instead of colours");
  print_constant(out, "STATE_WORD_BITS", state_word_bits(widths), "of a token: the codes of all planes but those");
  print_constant(out, "TEXTURE_STAMPS", texture_stamps(config), "between X and W, with a texture unit");
  print_constant(out, "TEXTURE_PORT_BITS", 8 * widths.texture_port_bytes, "data of a beat of texels");
  print_constant(out, "PIXELS", widths.pixels, "pixels of a stamp");
  print_constant(out, "SAMPLES", widths.samples, "samples of a stamp, those of a pixel beside each other");
  print_constant(out, "TILES_X", widths.tiles_x, "tiles along the top of the widest target");
  print_constant(out, "TILES_Y", widths.tiles_y, "tiles along the side of the highest target");
  print_constant(out, "HIZ_GROUP_BITS", widths.hiz_group_bits, "bounds of 2^this tiles of a row are cleared at once");
  print_constant(out, "LINE_X_BITS", widths.line_x_bits, "low bits of a tile's or block's x in a cache line's number");
  print_constant(out, "LINE_Y_BITS", widths.line_y_bits, "likewise of its y, above those");
  print_constant(out, "BLOCK_SIDE", widths.blocks.side, "stamps along the side of a block");
  print_constant(out, "BLOCKS_PER_ROW", widths.blocks.per_tile, "blocks along the side of a tile");
  print_constant(out, "FLAG_WORD", widths.blocks.flag_word,
                 "flags of cleared blocks in a word, those of a row of blocks");
  const MemoryGrid& memory = widths.memory;
  print_constant(out, "PORT_SHIFT", memory.port, "log2 of the bytes of a beat");
  print_constant(out, "DEPTH_SAMPLE_BYTES", 1 << memory.sample[0], "of a stored depth");
  print_constant(out, "COLOR_SAMPLE_BYTES", 1 << memory.sample[1], "of a stored colour");
  print_constant(out, "MEMORY_COLORS", widths.memory_colors, "of a stamp in memory: of its samples, or of its pixels");
  const int stamp_bytes = std::max(widths.samples << memory.sample[0], widths.memory_colors << memory.sample[1]);
  print_constant(out, "REQUEST_BYTES", std::max(stamp_bytes, widths.blocks.flag_word / 8),
                 "data of a request, as they lie in memory: a stamp of the larger plane, or a word of flags");
  print_constant(out, "PLANE_SHIFT", memory.plane, "log2 of the bytes of a plane of a tile");
  print_constant(out, "FLAG_ROW_SHIFT", memory.flag_row, "log2 of the bytes from one row of flags to the next");
  out << stall_constants() << "\n  // Derived widths, each with its bound.\n";
  for (const Width* width : widths.all())
    print_constant(out, constant_name(width->name) + "_BITS", width->bits, std::string(width->bound));
  out << "\n  // The planes: depth, then the colours. Each table has 32 bits for a plane, plane 0 lowest.\n";
  for (const PlaneTable& table : kPlaneTables) print_plane_table(out, table, widths);
  print_constant(out, "MAX_DELTA_BITS", widest(widths, &AttributeWidths::delta).bits, "of the widest plane");
  print_constant(out, "MAX_NUMERATOR_BITS", widest(widths, &AttributeWidths::numerator).bits, "likewise");
  out << "\n  // What a field can say.";
  print_enum<PrimitiveKind>(out, widths);
  print_enum<StateRegister>(out, widths);
  print_enum<DepthFunc>(out, widths);
  print_enum<StencilOp>(out, widths);
  print_enum<Cull>(out, widths);
  print_enum<HizUpdate>(out, widths);
  print_enum<TilePlane>(out, widths);
  print_enum<DepthSource>(out, widths);
  out << "\n  // Parts of packets. Array fields are flat, element 0 lowest; those over the planes have plane 0 lowest.";
  print_struct<PixelBox>(out, widths);
  print_struct<TileBox>(out, widths);
  print_struct<PrimitiveState>(out, widths);
  print_struct<TileKey>(out, widths);
  print_struct<TriangleVertices>(out, widths);
  print_struct<CodeRange>(out, widths);
  print_struct<CoordinateFrame>(out, widths);
  print_constant(out, "COORDINATE_FRAME_BITS", packet_bits<CoordinateFrame>(widths),
                 "of the struct above; none without a texture unit");
  print_struct<MemoryLayout>(out, widths);
  out << "\n  // Packets.";
  std::set<std::string_view> printed;
  for (std::size_t i = 0; i < kArrows; ++i)
    with_packet_type(static_cast<Arrow>(i), [&]<class Packet>(std::type_identity<Packet>) {
      if (printed.insert(Packet::name).second) print_packet<Packet>(out, widths);
    });
  print_packet<CounterPacket>(out, widths);
  out << "\nendpackage\n";
  return out.str();
}

}  // namespace halfplane
