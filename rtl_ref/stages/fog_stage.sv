// Fog stage: fog_unit in the stream of shaded stamps, downstream of the texture unit; fog_lookup has found their places
// in the fog table. Without the unit stamps pass unchanged. Specification: model/stages/fog_unit.hpp.
module fog_stage #(
    parameter int PIXELS = raster_pkg::PIXELS,  // derived; not to be set
    parameter int COLORS = raster_pkg::PIXELS * 8 * raster_pkg::COLOR_PLANES,
    parameter int PLACES = raster_pkg::FOG_PLACES_BITS,
    parameter int WORD = raster_pkg::FOG_WORD_BITS
) (
    input logic clk_i,
    input logic rst_ni,

    // From texture_stage
    input  logic                      stamp_valid_i,
    output logic                      stamp_ready_o,
    input  raster_pkg::tested_stamp_t stamp_i,
    input  logic [WORD-1:0]           fog_i,   // from fog_lookup
    input  logic [PIXELS-1:0]         mask_i,
    input  logic [COLORS-1:0]         rgba_i,

    // To color_write
    output logic                      stamp_valid_o,
    input  logic                      stamp_ready_i,
    output raster_pkg::tested_stamp_t stamp_o,
    output logic [PIXELS-1:0]         mask_o,
    output logic [COLORS-1:0]         rgba_o
);

  generate
    if (raster_pkg::FOG_UNIT == 0) begin : gen_clear
      assign stamp_valid_o = stamp_valid_i;
      assign stamp_ready_o = stamp_ready_i;
      assign stamp_o       = stamp_i;
      assign mask_o        = mask_i;
      assign rgba_o        = rgba_i;
    end else begin : gen_fogged
      fog_unit #(
          .SAMPLES (PIXELS),
          .CHANNELS(raster_pkg::COLOR_PLANES),
          .PAYLOAD (raster_pkg::TESTED_STAMP_BITS + PIXELS),
          .WORD    (PLACES)
      ) u_fog (
          .clk_i,
          .rst_ni,
          .stamp_valid_i,
          .stamp_ready_o,
          .payload_i    ({stamp_i, mask_i}),
          .color_i      (rgba_i),
          .is_fogged_i  (fog_i[PLACES]),
          .sets_color_i (fog_i[PLACES+1]),
          .sets_line_i  (fog_i[PLACES+2]),
          .word_i       (fog_i[PLACES-1:0]),
          .stamp_valid_o,
          .stamp_ready_i,
          .payload_o    ({stamp_o, mask_o}),
          .color_o      (rgba_o)
      );
    end
  endgenerate

endmodule
