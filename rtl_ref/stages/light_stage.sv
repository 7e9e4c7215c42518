// Light stage: light_unit in the stream of tested stamps. The normals of a fragment end here; its other fields go
// along.
//
// A stamp never waits on its way in: depth_cache counts the stamps inside. Without normals stamps pass as they are.
// Specification: model/stages/light_unit.hpp, texture_stage.hpp.
module light_stage #(
    parameter int PIXELS = raster_pkg::PIXELS,  // derived; not to be set
    parameter int COLORS = raster_pkg::PIXELS * raster_pkg::WRITTEN_COLOR_BITS
) (
    input logic clk_i,
    input logic rst_ni,

    // From depth_cache
    input logic                         stamp_valid_i,
    input raster_pkg::tested_stamp_t    stamp_i,
    input raster_pkg::fragment_packet_t fragment_i,
    input logic [PIXELS-1:0]            writes_i,  // pixels with a sample that gets a colour
    input logic [COLORS-1:0]            color_i,   // colour of the primitive, one per pixel

    // To texture_stage
    output logic                         stamp_valid_o,
    output raster_pkg::tested_stamp_t    stamp_o,
    output raster_pkg::fragment_packet_t fragment_o,
    output logic [PIXELS-1:0]            writes_o,
    output logic [COLORS-1:0]            color_o
);

  genvar s;
  generate
    if (raster_pkg::NORMALS == 0) begin : gen_unlit
      assign stamp_valid_o = stamp_valid_i;
      assign stamp_o       = stamp_i;
      assign fragment_o    = fragment_i;
      assign writes_o      = writes_i;
      assign color_o       = color_i;
    end else begin : gen_lit
      localparam int FRAGMENT = raster_pkg::ALL_FRAGMENT_BITS;  // bits of a pixel
      localparam int NORMALS_AT = raster_pkg::FRAGMENT_AT[32*(raster_pkg::AFFINE_PLANES+3*(raster_pkg::NORMALS!=0 ? 1 : 0))+:32];
      localparam int NORMAL = (FRAGMENT - NORMALS_AT) / 3;
      // Depths of a pixel's other samples end at the test.
      localparam int HEADER_AT = PIXELS * FRAGMENT + PIXELS * (raster_pkg::MSAA_SAMPLES - 1) * raster_pkg::DEPTH_CODE_BITS;
      localparam int HEADER = raster_pkg::FRAGMENT_PACKET_BITS - HEADER_AT;
      localparam int TOKEN = raster_pkg::UNIT_WORD_BITS;
      logic [PIXELS*NORMALS_AT-1:0] others, lit_others;
      logic [3*NORMAL*PIXELS-1:0]   normals;
      logic [HEADER-1:0]            header, lit_header;
      logic [PIXELS*FRAGMENT-1:0]   code;
      logic                         is_token;
      logic [1:0]                   unit;
      logic [raster_pkg::STATE_WORD_BITS-1:0] word;
      state_token u_token (
          .fragment_i,
          .is_token_o(is_token),
          .register_o(),
          .word_o    (word),
          .unit_o    (unit)
      );
      assign header = fragment_i[raster_pkg::FRAGMENT_PACKET_BITS-1:HEADER_AT];
      for (s = 0; s < PIXELS; s++) begin : gen_pixel
        assign others[s*NORMALS_AT+:NORMALS_AT] = fragment_i.code[s*FRAGMENT+:NORMALS_AT];
        assign normals[s*3*NORMAL+:3*NORMAL]    = fragment_i.code[s*FRAGMENT+NORMALS_AT+:3*NORMAL];
        assign code[s*FRAGMENT+:FRAGMENT]       = {{(3*NORMAL) {1'b0}}, lit_others[s*NORMALS_AT+:NORMALS_AT]};
      end
      assign fragment_o = (raster_pkg::FRAGMENT_PACKET_BITS'(lit_header) << HEADER_AT) | raster_pkg::FRAGMENT_PACKET_BITS'(code);
      light_unit #(
          .SAMPLES (PIXELS),
          .CHANNELS(raster_pkg::COLOR_PLANES),
          .P_BITS  (NORMAL),
          .PAYLOAD (raster_pkg::TESTED_STAMP_BITS + PIXELS + HEADER + PIXELS * NORMALS_AT),
          .WORD    (TOKEN),
          .PLACES  (raster_pkg::SHADED_STAMPS)
      ) u_light (
          .clk_i,
          .rst_ni,
          .stamp_valid_i,
          .payload_i    ({stamp_i, writes_i, header, others}),
          .color_i,
          .is_triangle_i(fragment_i.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE),
          .mask_i       (writes_i),
          .p_i          (normals),
          .sets_i       (is_token && unit == 2'd3),
          .word_i       (word[TOKEN-1:0]),
          .stamp_valid_o,
          .payload_o    ({stamp_o, writes_o, lit_header, lit_others}),
          .color_o
      );
    end
  endgenerate

endmodule
