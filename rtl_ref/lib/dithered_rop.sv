// ROP with ordered dithering: packs the colour of one sample into the stored format, rounded or with a threshold.
// Combinational.
//
// rgb565 keeps floor(c * 31 / 255 + (threshold + 1/2) / 16) = (c * 249 + threshold * 128 + 64) >> 11, for green (c *
// 253 + threshold * 64 + 32) >> 10; rounded as in rop.sv. Specification: pack_rgb565_dithered of
// model/stages/color_ops.hpp.
module dithered_rop (
    input  logic [raster_pkg::VERTEX_COLOR_BITS-1:0] rgba_i,  // 8 bits a channel, R lowest
    input  logic                                     dithers_i,
    input  logic [3:0]                               threshold_i,
    output logic [raster_pkg::STORED_COLOR_BITS-1:0] color_o
);

  generate
    if (raster_pkg::COLOR_FORMAT == 0) begin : gen_rgb565
      logic [15:0] r, g, b;
      logic [8:0] offset, r_rest, g_rest, b_rest;  // offset - c
      logic [2:0] below;                           // the low bits of the offset

      // c * 249 + offset * 8 + below = c * 257 + (offset - c) * 8 + below, and c * 257 is c concatenated with c.
      // Likewise with 4 for green.
      assign offset = dithers_i ? {1'b0, threshold_i, 4'd8} : 9'd126;
      assign below  = dithers_i ? 3'd0 : 3'd6;
      assign r_rest = offset - {1'b0, rgba_i[7:0]};
      assign g_rest = offset - {1'b0, rgba_i[15:8]};
      assign b_rest = offset - {1'b0, rgba_i[23:16]};
      assign r = {rgba_i[7:0], rgba_i[7:0]} + {{4{r_rest[8]}}, r_rest, below};
      assign g = {rgba_i[15:8], rgba_i[15:8]} + {{5{g_rest[8]}}, g_rest, 1'b0, !dithers_i};
      assign b = {rgba_i[23:16], rgba_i[23:16]} + {{4{b_rest[8]}}, b_rest, below};
      assign color_o = {r[15:11], g[15:10], b[15:11]};
    end else begin : gen_rgba8888
      assign color_o = rgba_i;
    end
  endgenerate

endmodule
