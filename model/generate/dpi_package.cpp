#include "dpi_package.hpp"

#include <algorithm>
#include <sstream>

#include "../packets/packets.hpp"
#include "../vectors/stages.hpp"

namespace halfplane::vectors {
namespace {

std::string type_of(Arrow arrow) {
  return with_packet_type(arrow,
                          []<class Packet>(std::type_identity<Packet>) { return std::string(Packet::name) + "_t"; });
}

bool is_there(const JudgedStage& stage, const Config& config) {
  if (!stage.can_run()) return false;
  try {
    require_stage(stage, config);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// The widest packet: SystemVerilog gives an imported function one type.
int widest(const Widths& widths) {
  int bits = 0;
  for (const JudgedStage& stage : judged_stages())
    for (const auto* ports : {&stage.in, &stage.out})
      for (const Port& port : *ports) bits = std::max(bits, bits_of(port.like, widths));
  return bits;
}

constexpr std::string_view kImports = R"(
  import "DPI-C" function int halfplane_abi();
  import "DPI-C" function string halfplane_last_error();
  import "DPI-C" function chandle halfplane_config_new(input string preset);
  import "DPI-C" function int halfplane_config_set(input chandle config_i, input string key, input string value);
  import "DPI-C" function longint unsigned halfplane_config_id(input chandle config_i);
  import "DPI-C" function void halfplane_config_free(input chandle config_i);
  import "DPI-C" function chandle halfplane_stage_new(input chandle config_i, input string name);
  import "DPI-C" function int halfplane_stage_put(input chandle stage, input int port, input bit [PACKET_BITS-1:0] words);
  import "DPI-C" function int halfplane_stage_get(input chandle stage, input int port, output bit [PACKET_BITS-1:0] words);
  import "DPI-C" function void halfplane_stage_free(input chandle stage);
  import "DPI-C" function chandle halfplane_pipeline_new(input chandle config_i, input longint unsigned id, input int outputs);
  import "DPI-C" function int halfplane_pipeline_put_primitive(input chandle pipeline, input bit [PACKET_BITS-1:0] words);
  import "DPI-C" function int halfplane_pipeline_put_line(input chandle pipeline, input bit [PACKET_BITS-1:0] words);
  import "DPI-C" function int halfplane_pipeline_get_event(input chandle pipeline, output bit [287:0] words);
  import "DPI-C" function int halfplane_pipeline_get_beat(input chandle pipeline, output bit [PACKET_BITS-1:0] words);
  import "DPI-C" function int halfplane_pipeline_layout(input chandle pipeline, output bit [159:0] bytes);
  import "DPI-C" function int halfplane_pipeline_set_layout(input chandle pipeline, input bit [159:0] bytes);
  import "DPI-C" function longint halfplane_pipeline_memory_size(input chandle pipeline);
  import "DPI-C" function int halfplane_pipeline_memory(input chandle pipeline, input int unsigned address,
                                                        output bit [MEMORY_PORT_BITS-1:0] bytes, input longint unsigned count);
  import "DPI-C" function int halfplane_pipeline_textures(input chandle pipeline, input chandle scene);
  import "DPI-C" function void halfplane_pipeline_free(input chandle pipeline);
  import "DPI-C" function chandle halfplane_scene_open(input string path);
  import "DPI-C" function void halfplane_scene_free(input chandle scene);
  import "DPI-C" function chandle halfplane_host_new(input chandle scene, input chandle config_i);
  import "DPI-C" function int halfplane_host_next(input chandle host, output bit [PACKET_BITS-1:0] primitive_words,
                                                  output bit [PACKET_BITS-1:0] line_words);
  import "DPI-C" function void halfplane_host_free(input chandle host);
)";

constexpr std::string_view kHelpers = R"(
  // A stage from reset; halfplane_stage_free() gives it back. An error ends the simulation with its one line.
  function automatic chandle new_stage(string name);
    chandle made;
    chandle settings = new_config();
    made = halfplane_stage_new(settings, name);
    halfplane_config_free(settings);
    if (made == null) $fatal(1, "%s", halfplane_last_error());
    return made;
  endfunction

  function automatic void put(chandle stage, int port, bit [PACKET_BITS-1:0] words);
    if (halfplane_stage_put(stage, port, words) != 0) $fatal(1, "%s", halfplane_last_error());
  endfunction

  function automatic bit get(chandle stage, int port, output bit [PACKET_BITS-1:0] words);
    int got = halfplane_stage_get(stage, port, words);
    if (got < 0) $fatal(1, "%s", halfplane_last_error());
    return got == 1;
  endfunction
)";

constexpr std::string_view kPipeline = R"(
  // The whole pipeline with its memory, from reset: the packets of raster_top's inputs go in, and what they do comes out.
  // get_... are 0 when nothing comes before the next input; halfplane_pipeline_free() gives it back.
  localparam int WRITES = 1, RETIRED = 2, BEATS = 4;  // outputs: a sum of these
  localparam int DEPTH = 1, COLOR = 2;                // parts: a sum of these
  typedef struct packed {
    bit [31:0] color, stencil, depth;  // codes; 0 of a part that is not written
    bit [31:0] parts;
    bit [31:0] sample, y, x;           // of the pixel; pixels
    bit [31:0] primitive_number;       // all that were put, from 0
    bit [31:0] kind;                   // WRITES: a sample is written; RETIRED: the primitive is through
  } pipeline_event_t;

  function automatic chandle new_pipeline(int outputs);
    chandle made;
    chandle settings = new_config();
    made = halfplane_pipeline_new(settings, CONFIG_ID, outputs);
    halfplane_config_free(settings);
    if (made == null) $fatal(1, "%s", halfplane_last_error());
    return made;
  endfunction
  function automatic void put_primitive(chandle pipeline, primitive_packet_t packet);
    if (halfplane_pipeline_put_primitive(pipeline, PACKET_BITS'(packet)) != 0) $fatal(1, "%s", halfplane_last_error());
  endfunction
  function automatic void put_line(chandle pipeline, line_setup_t packet);
    if (halfplane_pipeline_put_line(pipeline, PACKET_BITS'(packet)) != 0) $fatal(1, "%s", halfplane_last_error());
  endfunction
  function automatic bit get_event(chandle pipeline, output pipeline_event_t happened);
    bit [287:0] words;
    int got = halfplane_pipeline_get_event(pipeline, words);
    if (got < 0) $fatal(1, "%s", halfplane_last_error());
    happened = pipeline_event_t'(words);
    return got == 1;
  endfunction
  function automatic bit get_beat(chandle pipeline, output memory_beat_t beat);
    bit [PACKET_BITS-1:0] words;
    int got = halfplane_pipeline_get_beat(pipeline, words);
    if (got < 0) $fatal(1, "%s", halfplane_last_error());
    beat = memory_beat_t'(words[$bits(memory_beat_t)-1:0]);
    return got == 1;
  endfunction
  function automatic memory_layout_t get_layout(chandle pipeline);
    bit [159:0] bytes;
    memory_layout_t layout;
    if (halfplane_pipeline_layout(pipeline, bytes) != 0) $fatal(1, "%s", halfplane_last_error());
    layout.depth_base = ADDRESS_BITS'(bytes[0+:32]);
    layout.color_base = ADDRESS_BITS'(bytes[32+:32]);
    layout.depth_flags_base = ADDRESS_BITS'(bytes[64+:32]);
    layout.color_flags_base = ADDRESS_BITS'(bytes[96+:32]);
    layout.row_stride = ROW_STRIDE_BITS'(bytes[128+:32]);
    return layout;
  endfunction
  // Before the first primitive: the buffers lie where layout_i of raster_top says.
  function automatic void set_layout(chandle pipeline, memory_layout_t layout);
    bit [159:0] bytes = {32'(layout.row_stride), 32'(layout.color_flags_base), 32'(layout.depth_flags_base),
                         32'(layout.color_base), 32'(layout.depth_base)};
    if (halfplane_pipeline_set_layout(pipeline, bytes) != 0) $fatal(1, "%s", halfplane_last_error());
  endfunction
  // A beat's bytes of memory, as the hardware leaves them.
  function automatic bit [MEMORY_PORT_BITS-1:0] memory_word(chandle pipeline, int unsigned address);
    bit [MEMORY_PORT_BITS-1:0] bytes;
    if (halfplane_pipeline_memory(pipeline, address, bytes, MEMORY_PORT_BITS / 8) != 0) $fatal(1, "%s", halfplane_last_error());
    return bytes;
  endfunction

  // The host of a capture: the packets that raster_top gets for it.
  function automatic chandle new_host(chandle scene);
    chandle made;
    chandle settings = new_config();
    made = halfplane_host_new(scene, settings);
    halfplane_config_free(settings);
    if (made == null) $fatal(1, "%s", halfplane_last_error());
    return made;
  endfunction
  // 1: a primitive; 2: and its line; 0: there is no more.
  function automatic int host_next(chandle host, output primitive_packet_t packet, output line_setup_t line);
    bit [PACKET_BITS-1:0] words, line_words;
    int got = halfplane_host_next(host, words, line_words);
    if (got < 0) $fatal(1, "%s", halfplane_last_error());
    packet = primitive_packet_t'(words[$bits(primitive_packet_t)-1:0]);
    line = line_setup_t'(line_words[$bits(line_setup_t)-1:0]);
    return got;
  endfunction
)";

void print_config(std::ostream& out, const Config& config) {
  const Config base = preset(config.preset);
  out << "\n  // The configuration of raster_pkg.\n  function automatic chandle new_config();\n"
         "    chandle made = halfplane_config_new(\""
      << config.preset
      << "\");\n    int failed = 0;\n"
         "    if (halfplane_abi() != 1) $fatal(1, \"libhalfplane_c has another ABI than this package\");\n"
         "    if (made == null) $fatal(1, \"%s\", halfplane_last_error());\n";
  for (const Setting& setting : settings())
    if (const std::string value = get(config, setting); value != get(base, setting))
      out << "    if (failed == 0) failed = halfplane_config_set(made, \"" << setting.key << "\", \"" << value
          << "\");\n";
  out << "    if (failed != 0) $fatal(1, \"%s\", halfplane_last_error());\n"
         "    if (halfplane_config_id(made) != CONFIG_ID)\n"
         "      $fatal(1, \"raster_pkg is of another configuration than halfplane_dpi and its library\");\n"
         "    return made;\n  endfunction\n";
}

void print_stage(std::ostream& out, const JudgedStage& stage) {
  const std::string name(info(stage.stage).name);
  out << "\n  // " << name << "\n  function automatic chandle new_" << name << "();\n    return new_stage(\"" << name
      << "\");\n  endfunction\n";
  for (std::size_t i = 0; i < stage.in.size(); ++i)
    out << "  function automatic void put_" << name << "_" << stage.in[i].name << "(chandle stage, "
        << type_of(stage.in[i].like) << " packet);\n    put(stage, " << i
        << ", PACKET_BITS'(packet));\n  endfunction\n";
  for (std::size_t i = 0; i < stage.out.size(); ++i) {
    const std::string type = type_of(stage.out[i].like);
    out << "  function automatic bit get_" << name << "_" << stage.out[i].name << "(chandle stage, output " << type
        << " packet);\n    bit [PACKET_BITS-1:0] words;\n    bit is_there = get(stage, " << i
        << ", words);\n    packet = " << type << "'(words[$bits(" << type
        << ")-1:0]);\n    return is_there;\n  endfunction\n";
  }
}

}  // namespace

std::string dpi_package(const Config& config) {
  validate(config);
  require_sampled_hardware(config, "the RTL");
  std::ostringstream out;
  out << "// Generated by `halfplane config --dpi`; do not edit. The whole pipeline, and every stage by itself, "
         "through "
         "DPI-C: link with\n"
         "// libhalfplane_c. put_STAGE_PACKET gives a stage its next packet; get_STAGE_PACKET is 1 if one has come "
         "out.\n"
         "package halfplane_dpi;\n  import raster_pkg::*;\n\n  localparam int PACKET_BITS = "
      << widest(derive_widths(config)) << ";  // the widest packet\n"
      << kImports;
  print_config(out, config);
  out << kHelpers << kPipeline;
  for (const JudgedStage& stage : judged_stages())
    if (is_there(stage, config)) print_stage(out, stage);
  out << "\nendpackage\n";
  return out.str();
}

}  // namespace halfplane::vectors
