#include "raster_pkg.hpp"

#include <algorithm>
#include <cstdio>
#include <set>
#include <sstream>

#include "../packets/packet_words.hpp"
#include "../packets/state_packets.hpp"
#include "../pipeline_graph.hpp"
#include "../stages/fog.hpp"
#include "../stages/surface.hpp"
#include "../stages/texture_levels.hpp"
#include "../stages/texture_packets.hpp"
#include "constants.hpp"
#include "raster_taps.hpp"

namespace halfplane {

/// The update of a stored stencil, in the words of tokens: no field of a packet.
template <>
struct WireEnum<StencilOp> {
  static constexpr std::string_view name = "stencil_op";
  static constexpr Width Widths::*width = &Widths::depth_func;  // eight on either side
};

namespace {

void print_constant(std::ostream& out, const std::string& name, long long value, const std::string& why) {
  out << "  localparam int " << name << " = " << value << ";  // " << why << "\n";
}

std::string all_bits(Width AttributeWidths::*width) {
  const auto* table = std::ranges::find(kPlaneTables, width, &PlaneTable::width);
  return "ALL_" + std::string(table->word) + "_BITS";
}

/// For each plane the bits of a value and its start in an array over the planes, 32 bits per entry, plane 0 lowest; the
/// bits of the whole array, and of its widest value.
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
  print_constant(out, "ALL_" + word + "_BITS", sum, "of all planes together");
  print_constant(out, "MAX_" + word + "_BITS", most, "of the widest plane");
}

/// msaa.pattern: the offset of each sample from a pixel's centre.
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
  for (const Enumerator<Enum>& entry : kEnumerators<Enum>) {
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
  print_constant(out, constant_name(Packet::name) + "_BITS", packet_bits<Packet>(widths), "bits of the struct above");
}

/// A member of a struct that exists only in the RTL.
struct Member {
  std::string_view type;  ///< a name of the package, or bits as an expression of its constants
  std::string_view name;
  std::string_view what;
  bool is_there = true;  ///< in this configuration
};

/// The struct, and its bits.
void print_members(std::ostream& out, const std::string& name, std::initializer_list<Member> members) {
  std::string bits;
  out << "\n  typedef struct packed {\n";
  for (const Member& member : members) {
    if (!member.is_there) continue;
    const bool is_type = member.type.ends_with("_t");
    out << "    " << (is_type ? std::string(member.type) : "logic [" + std::string(member.type) + "-1:0]") << " "
        << member.name << ";  // " << member.what << "\n";
    const std::string of_type = constant_name(member.type.substr(0, member.type.size() - 2)) + "_BITS";
    bits.append(bits.empty() ? "" : " + ").append(is_type ? of_type : std::string(member.type));
  }
  out << "  } " << name << "_t;\n  localparam int " << constant_name(name) << "_BITS = " << bits
      << ";  // bits of the struct above\n";
}

/// The parts of the framebuffer of blocks, and the signals between them: no arrow of the graph.
void print_blocks(std::ostream& out, const Config& config) {
  const bool blends = config.blend_lanes != 0, has_stencil = config.stencil_bits != 0;
  const bool tests_alpha_late = config.alpha_units != 0 && has_texture_planes(config);
  const bool has_color_states = blends || tests_alpha_late || config.dither_units != 0;
  const auto constant = [&](const char* name, const char* value, const char* what) {
    out << "  localparam int " << name << " = " << value << ";  // " << what << "\n";
  };
  out << "\n  // The framebuffer of blocks.\n";
  constant("BLOCK_STAMPS", "BLOCK_SIDE * BLOCK_SIDE", "stamps of a block");
  constant("BLOCK_STAMP_BITS", "BLOCK_STAMPS == 1 ? 1 : $clog2(BLOCK_STAMPS)", "a stamp's number in its block");
  constant("BLOCK_X_BITS", "TILE_X_BITS + $clog2(BLOCKS_PER_ROW)", "a block's column in the target");
  constant("BLOCK_Y_BITS", "TILE_Y_BITS + $clog2(BLOCKS_PER_ROW)", "its row");
  constant("CACHE_LINE_BITS", "CACHE_LINES == 1 ? 1 : LINE_X_BITS + LINE_Y_BITS", "a line's number");
  constant("TAG_X_BITS", "BLOCK_X_BITS > LINE_X_BITS ? BLOCK_X_BITS - LINE_X_BITS : 1", "tag of a block's column");
  constant("TAG_Y_BITS", "BLOCK_Y_BITS > LINE_Y_BITS ? BLOCK_Y_BITS - LINE_Y_BITS : 1", "tag of a block's row");
  constant("FLAG_WORD_X_BITS", "BLOCK_X_BITS > $clog2(FLAG_WORD) ? BLOCK_X_BITS - $clog2(FLAG_WORD) : 1",
           "a word's number in its row of flags");
  constant("SAMPLE_COUNT_BITS", "$clog2(SAMPLES + 1)", "samples of a stamp, counted");
  constant("VICTIM_SLOT_BITS", "$clog2(CACHE_VICTIMS)", "a slot for an evicted block");
  constant("VICTIM_COUNT_BITS", "$clog2(CACHE_VICTIMS + 1)", "number of evicted blocks");
  constant("SHADED_STAMPS", "COORDINATES == 0 ? 2 : TEXTURE_STAMPS", "stamps between depth and colour, at most");
  constant("STORE_CONSTANTS_SEPARATELY", "COORDINATES != 0 && MSAA_SAMPLES == 1 ? 1 : 0",
           "1: texture constants lie in a RAM, by the triangle's number");
  constant("TRIANGLE_BITS", "$clog2(CONTEXT_SLOTS + CACHE_QUEUE + 16)",
           "bits of that number: one for each triangle between setup and depth test");
  constant("FRAGMENT_HEADER_BITS",
           "FRAGMENT_PACKET_BITS - PIXELS * ALL_FRAGMENT_BITS - (COLORS_OVER_W != 0 ? 2 * VERTEX_COLOR_BITS : 0) - "
           "COORDINATE_FRAME_BITS",
           "a fragment from its kind to its state: what is above colours and constants");
  constant("STORED_FRAGMENT_BITS",
           "FRAGMENT_PACKET_BITS - (STORE_CONSTANTS_SEPARATELY != 0 ? COORDINATE_FRAME_BITS - TRIANGLE_BITS + (PIXELS "
           "- 1) * "
           "(ALL_FRAGMENT_BITS - "
           "ALL_AFFINE_CODE_BITS) : 0)",
           "a fragment as it waits for memory");
  print_constant(out, "UNIT_WORD_BITS", kLevelsWordBit,
                 "a token's value for light or fog; two bits above it say which");
  print_constant(out, "CONSTANT_WORD_BIT", kConstantWordBit, "bit of a token of levels: it is the texture's constant");
  print_constant(out, "BORDER_WORD_BIT", kBorderWordBit, "likewise: the texture's border");
  print_constant(out, "FOG_PLACE_BITS", kFogPlaceBits + kFogOctaves, "where in the table of a fog a pixel lies");
  constant("FOG_PLACES_BITS", "FOG_PLACE_BITS * PIXELS > UNIT_WORD_BITS ? FOG_PLACE_BITS * PIXELS : UNIT_WORD_BITS",
           "the places of a stamp's pixels, or a token's value");
  constant("FOG_WORD_BITS", "FOG_UNIT == 0 ? 1 : FOG_PLACES_BITS + 3",
           "the places, and three flags: fog, a token of its colour, a token of its table");
  constant("LATE_ALPHA", "ALPHA_UNIT != 0 && COORDINATES != 0 ? 1 : 0", "1: alpha is tested downstream of the texture");
  print_members(out, "tag_result",
                {{"CACHE_LINE_BITS", "line", "where the fragment's block lies"},
                 {"BLOCK_STAMP_BITS", "stamp", "its stamp there"},
                 {"depth_source_t", "source", "place of the stored depths"},
                 {"depth_source_t", "color_source", "place of the stored colours, which operations read", blends},
                 {"FLAG_BITS", "starts_color", "no colour of the stamp is on the chip"},
                 {"FLAG_BITS", "evicts", "another block leaves the line"},
                 {"TAG_X_BITS", "tag_x", "tag of that block's column"},
                 {"TAG_Y_BITS", "tag_y", "tag of its row"},
                 {"BLOCK_STAMPS", "depth", "stamps of it whose depths may have been written"},
                 {"BLOCK_STAMPS", "color", "likewise colours"},
                 {"2", "fills", "colour, depth: memory holds garbage"}});
  print_members(out, "block_order",
                {{"FLAG_BITS", "reads_color", "after that, a stamp of colours is read", blends},
                 {"VICTIM_COUNT_BITS", "writes", "number of evicted blocks that go to memory first"},
                 {"FLAG_BITS", "reads", "then a stamp of depths is read"},
                 {"TILE_X_BITS", "tile_x", "the stamp's tile, its column"},
                 {"TILE_Y_BITS", "tile_y", "its tile's row"},
                 {"STAMP_INDEX_BITS", "stamp", "its number in the tile"}});
  print_members(out, "victim",
                {{"BLOCK_X_BITS", "x", "the block's column in the target"},
                 {"BLOCK_Y_BITS", "y", "its row"},
                 {"BLOCK_STAMPS", "depth", "stamps whose depths come into its slot"},
                 {"BLOCK_STAMPS", "color", "likewise colours"}});
  print_members(out, "eviction",
                {{"VICTIM_SLOT_BITS", "slot", "slot of the block"},
                 {"2", "fills", "colour, depth: memory holds garbage"},
                 {"victim_t", "block", "its place, and the stamps that enter the slot"}});
  print_members(out, "depth_victim",
                {{"FLAG_BITS", "last", "last stamp of its block"},
                 {"VICTIM_SLOT_BITS", "slot", "slot of its block"},
                 {"BLOCK_STAMP_BITS", "stamp", "its number in the block"},
                 {"SAMPLE_MASK_BITS", "strobe", "samples that memory does not have"},
                 {"SAMPLES*STORED_DEPTH_BITS", "depth", "words of all"}});
  print_members(out, "color_victim",
                {{"VICTIM_SLOT_BITS", "slot", "slot of its block"},
                 {"BLOCK_STAMP_BITS", "stamp", "its number in the block"},
                 {"SAMPLE_MASK_BITS", "strobe", "samples that memory does not have"},
                 {"SAMPLES*STORED_COLOR_BITS", "color", "colours of all samples"}});
  print_members(out, "pixel_word",
                {{"FLAG_BITS", "reads", "a word of the bits of blocks with one colour a pixel is read"},
                 {"FLAG_BITS", "writes", "or written"},
                 {"FLAG_WORD_X_BITS", "x", "its number in the row"},
                 {"BLOCK_Y_BITS", "y", "the row of blocks"},
                 {"FLAG_WORD", "word", "the word written"}});
  print_members(
      out, "tested_stamp",
      {{"depth_source_t", "color_source", "place of the stored colours", blends},
       {"SAMPLE_MASK_BITS", "changes", "samples whose stencil or depth changes", tests_alpha_late && has_stencil},
       {"FLAG_BITS", "is_late", "its depths are written when alpha has been tested", tests_alpha_late},
       {"FLAG_BITS", "on_chip", "its depths were on the chip", tests_alpha_late},
       {"FLAG_BITS", "is_counted", "a sample of a triangle, point or line", tests_alpha_late},
       {"FLAG_BITS", "writes", "depth or colour", tests_alpha_late},
       {"SAMPLE_MASK_BITS", "passed", "samples that passed depth and stencil test", tests_alpha_late},
       {"SAMPLES*STORED_DEPTH_BITS", "word", "words of these samples from now on", tests_alpha_late},
       {"SAMPLES*STORED_DEPTH_BITS", "stored", "words of these samples before", tests_alpha_late},
       {"FLAG_BITS", "sets_state", "a token", has_color_states},
       {"DEPTH_FUNC_BITS", "state_register", "number of the register that a token sets", has_color_states},
       {"32", "state", "its value", has_color_states},
       {"CACHE_LINE_BITS", "line", "where its block lies"},
       {"BLOCK_STAMP_BITS", "stamp", "its number in the block"},
       {"FLAG_BITS", "starts_color", "no colour of the stamp is on the chip"},
       {"SAMPLE_MASK_BITS", "mask", "samples whose colour is written"},
       {"FLAG_BITS", "evicts", "another block leaves the line"},
       {"FLAG_BITS", "fills", "memory holds garbage of its colours"},
       {"BLOCK_STAMPS", "evicted", "stamps of it whose colours leave"}});
  out << "\n  // In a set of stamps of a block: the lowest stamp alone, its number; the number of samples in a mask.\n"
         "  function automatic [BLOCK_STAMPS-1:0] lowest_stamp(input [BLOCK_STAMPS-1:0] set);\n"
         "    lowest_stamp = set & (~set + 1'b1);\n"
         "  endfunction\n"
         "  function automatic [BLOCK_STAMP_BITS-1:0] stamp_number(input [BLOCK_STAMPS-1:0] one);\n"
         "    stamp_number = '0;\n"
         "    for (int i = 0; i < BLOCK_STAMPS; i++) if (one[i]) stamp_number = stamp_number | BLOCK_STAMP_BITS'(i);\n"
         "  endfunction\n"
         "  function automatic [SAMPLE_COUNT_BITS-1:0] count_samples(input [SAMPLES-1:0] mask);\n"
         "    count_samples = '0;\n"
         "    for (int i = 0; i < SAMPLES; i++) count_samples = count_samples + SAMPLE_COUNT_BITS'(mask[i]);\n"
         "  endfunction\n";
}

void print_setting(std::ostream& out, const Setting& setting, const std::string& value) {
  std::string names;
  for (std::size_t i = 0; i < setting.names.size(); ++i)
    names += (i == 0 ? "" : ", ") + std::to_string(i) + " " + std::string(setting.names[i]);
  print_constant(out, constant_name(setting.key), number_of(setting, value),
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
    const std::string value = get(config, setting);
    if (setting.is_unnamed_at_0 && value == "0") continue;
    feed(setting.key);
    feed("=");
    feed(value);
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
      << "package raster_pkg;\n\n  // The configuration.\n";
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
  for (const DerivedConstant& constant : derived_constants(config, widths))
    print_constant(out, constant.name, constant.value, constant.why);
  out << stall_constants() << "\n  // Derived widths, each with its bound.\n";
  for (const Width* width : widths.all())
    print_constant(out, constant_name(width->name) + "_BITS", width->bits, std::string(width->bound));
  out << "\n  // The planes: depth, then the colours. Each table has 32 bits for a plane, plane 0 lowest.\n";
  for (const PlaneTable& table : kPlaneTables) print_plane_table(out, table, widths);
  print_constant(out, "MAX_DELTA_BITS", widest(widths, &AttributeWidths::delta).bits, "of the widest plane");
  print_constant(out, "MAX_NUMERATOR_BITS", widest(widths, &AttributeWidths::numerator).bits, "likewise");
  out << "\n  // Values of fields.";
  print_enum<PrimitiveKind>(out, widths);
  print_enum<StateRegister>(out, widths);
  print_enum<DepthFunc>(out, widths);
  print_enum<StencilOp>(out, widths);
  print_enum<Cull>(out, widths);
  print_enum<HizUpdate>(out, widths);
  print_enum<TilePlane>(out, widths);
  print_enum<DepthSource>(out, widths);
  out << "\n  // Parts of packets. Array fields are flat, element 0 lowest; arrays over the planes have plane 0 "
         "lowest.";
  print_struct<PixelBox>(out, widths);
  print_struct<TileBox>(out, widths);
  print_struct<PrimitiveState>(out, widths);
  print_struct<TileKey>(out, widths);
  print_struct<TriangleVertices>(out, widths);
  print_struct<CodeRange>(out, widths);
  print_struct<CoordinateFrame>(out, widths);
  print_constant(out, "COORDINATE_FRAME_BITS", packet_bits<CoordinateFrame>(widths),
                 "bits of the struct above; none without a texture unit");
  print_struct<MemoryLayout>(out, widths);
  out << "\n  // Packets.";
  std::set<std::string_view> printed;
  for (std::size_t i = 0; i < kArrows; ++i)
    with_packet_type(static_cast<Arrow>(i), [&]<class Packet>(std::type_identity<Packet>) {
      if (printed.insert(Packet::name).second) print_packet<Packet>(out, widths);
    });
  print_packet<CounterPacket>(out, widths);
  print_blocks(out, config);
  out << "\nendpackage\n";
  return out.str();
}

}  // namespace halfplane
