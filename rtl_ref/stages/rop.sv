// ROP: packs the colour of one sample into the stored format. Combinational. The write masks are in depth_test.
//
// rgb565 keeps the nearest code: floor(c * 31 / 255 + 1/2) = (c * 249 + 1014) >> 11, for green (c * 253 + 505) >> 10,
// with the products as shifts and adds. Specification: model/stages/rop.hpp.
module rop (
    input  logic [raster_pkg::VERTEX_COLOR_BITS-1:0] rgba_i,  // 8 bits a channel, R lowest
    output logic [raster_pkg::STORED_COLOR_BITS-1:0] color_o
);

  generate
    if (raster_pkg::COLOR_FORMAT == 0) begin : gen_rgb565
      logic [15:0] r, g, b;
      logic [8:0] r_rest, g_rest, b_rest;  // 126 - c

      // c * 249 + 1014 = c * 257 + (126 - c) * 8 + 6, and c * 257 is c concatenated with c. Likewise with 4 for green.
      // In the smallest parts a carry chain cannot invert c: there 126 - c is the complement of c - 127.
      localparam bit SMALLEST = raster_pkg::SETUP_KIND != 0;
      assign r_rest = SMALLEST ? ~({1'b0, rgba_i[7:0]} - 9'd127) : 9'd126 - {1'b0, rgba_i[7:0]};
      assign g_rest = SMALLEST ? ~({1'b0, rgba_i[15:8]} - 9'd127) : 9'd126 - {1'b0, rgba_i[15:8]};
      assign b_rest = SMALLEST ? ~({1'b0, rgba_i[23:16]} - 9'd127) : 9'd126 - {1'b0, rgba_i[23:16]};
      assign r = {rgba_i[7:0], rgba_i[7:0]} + {{4{r_rest[8]}}, r_rest, 3'd6};
      assign g = {rgba_i[15:8], rgba_i[15:8]} + {{5{g_rest[8]}}, g_rest, 2'd1};
      assign b = {rgba_i[23:16], rgba_i[23:16]} + {{4{b_rest[8]}}, b_rest, 3'd6};
      assign color_o = {r[15:11], g[15:10], b[15:11]};
    end else begin : gen_rgba8888
      assign color_o = rgba_i;
    end
  endgenerate

endmodule
