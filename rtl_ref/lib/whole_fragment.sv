// Whole fragment: restores a fragment that a queue held (stored_fragment.sv) from its triangle's context: the texture
// constants, and the values over w, from the tile's anchors to the stamp's first pixel and from there to each pixel, as
// interpolate does for the other planes.
module whole_fragment #(
    parameter bit STORE_CONSTANTS_SEPARATELY = raster_pkg::STORE_CONSTANTS_SEPARATELY != 0  // derived; else the fragment is whole
) (
    input  raster_pkg::fragment_packet_t fragment_i,
    input  raster_pkg::context_packet_t  context_i,
    output raster_pkg::fragment_packet_t fragment_o
);

  localparam int CODES = raster_pkg::ALL_FRAGMENT_BITS;  // bits of a pixel
  localparam int AFFINE = raster_pkg::AFFINE_PLANES;
  localparam int AFFINE_BITS = raster_pkg::ALL_AFFINE_CODE_BITS;
  localparam int PIXELS = raster_pkg::PIXELS;
  localparam int STAMP = raster_pkg::STAMP_SIZE;
  localparam int PIXEL = raster_pkg::TILE_PIXEL_BITS;
  localparam int PLANES = raster_pkg::PLANES;
  localparam logic [32*PLANES-1:0] BITS_OF = raster_pkg::LOCAL_BITS_OF;  // bits of a value over w, and of its steps
  localparam logic [32*PLANES-1:0] STEP_AT = raster_pkg::STEP_AT;
  localparam logic [32*PLANES-1:0] FRAGMENT_AT = raster_pkg::FRAGMENT_AT;
  localparam int STAMP_SHIFT = $clog2(STAMP);
  localparam int PER_ROW_BITS = PIXEL - STAMP_SHIFT;

  genvar p, s;
  generate
    if (STORE_CONSTANTS_SEPARATELY) begin : gen_separate
      // The stamp's first pixel from the centre of the tile, in two's complement (interpolate.sv).
      logic [PIXEL-1:0] to_x, to_y;
      if (PER_ROW_BITS > 0) begin : gen_offset
        localparam logic [PER_ROW_BITS-1:0] HALF = {1'b1, {(PER_ROW_BITS - 1) {1'b0}}};
        logic [PER_ROW_BITS-1:0] column, row;
        assign column = fragment_i.stamp[0+:PER_ROW_BITS] ^ HALF;
        assign row    = fragment_i.stamp[PER_ROW_BITS+:PER_ROW_BITS] ^ HALF;
        assign to_x   = PIXEL'(column) << STAMP_SHIFT;
        assign to_y   = PIXEL'(row) << STAMP_SHIFT;
      end else begin : gen_whole_tile
        assign to_x = PIXEL'(STAMP / 2);
        assign to_y = PIXEL'(STAMP / 2);
      end
      logic [PIXELS*CODES-1:0] code;
      for (s = 0; s < PIXELS; s++) begin : gen_pixel
        assign code[s*CODES+:AFFINE_BITS] = fragment_i.code[s*CODES+:AFFINE_BITS];
      end
      for (p = AFFINE; p < PLANES; p++) begin : gen_plane
        localparam int W = BITS_OF[32*p+:32];
        localparam int STEP = STEP_AT[32*p+:32];
        localparam int AT = FRAGMENT_AT[32*p+:32];
        logic [W-1:0] in_column, first;
        plane_offset #(
            .WIDTH (W),
            .OFFSET(PIXEL),
            .LOWEST(STAMP_SHIFT)
        ) u_x (
            .value_i (fragment_i.code[AT+:W]),
            .step_i  (context_i.step_x[STEP+:W]),
            .offset_i(to_x),
            .value_o (in_column)
        );
        plane_offset #(
            .WIDTH (W),
            .OFFSET(PIXEL),
            .LOWEST(STAMP_SHIFT)
        ) u_y (
            .value_i (in_column),
            .step_i  (context_i.step_y[STEP+:W]),
            .offset_i(to_y),
            .value_o (first)
        );
        for (s = 0; s < PIXELS; s++) begin : gen_pixel_value
          edge_offset #(
              .WIDTH (W),
              .OFFSET(PIXEL)
          ) u_value (
              .value_i (first),
              .step_x_i(context_i.step_x[STEP+:W]),
              .step_y_i(context_i.step_y[STEP+:W]),
              .x_i     (PIXEL'(s % STAMP)),
              .y_i     (PIXEL'(s / STAMP)),
              .value_o (code[s*CODES+AT+:W])
          );
        end
      end
      always_comb begin
        fragment_o             = fragment_i;
        fragment_o.coordinates = context_i.coordinates;
        fragment_o.code        = code;
      end
    end else begin : gen_whole
      assign fragment_o = fragment_i;
    end
  endgenerate

endmodule
