// Stored fragment: a fragment as queues hold it. Where the triangle's constants are STORE_CONSTANTS_SEPARATELY, in a
// RAM by the triangle's number, the first pixel holds the tile anchors of the planes over w, and the number takes the
// lowest bits of the texture constants. Otherwise the fragment is unchanged. Bits that are not stored come back as 0;
// whole_fragment.sv restores them.
module stored_fragment #(
    parameter bit STORE_CONSTANTS_SEPARATELY = raster_pkg::STORE_CONSTANTS_SEPARATELY != 0,  // derived; not to be set
    parameter int NUMBER = raster_pkg::TRIANGLE_BITS,
    parameter int WIDTH = raster_pkg::STORED_FRAGMENT_BITS
) (
    input  raster_pkg::fragment_packet_t fragment_i,
    output logic [WIDTH-1:0]             bits_o,

    input  logic [WIDTH-1:0]             bits_i,
    output raster_pkg::fragment_packet_t fragment_o
);

  localparam int FRAGMENT = raster_pkg::FRAGMENT_PACKET_BITS;
  localparam int CODES = raster_pkg::ALL_FRAGMENT_BITS;  // bits of a pixel
  localparam int AFFINE = raster_pkg::ALL_AFFINE_CODE_BITS;
  localparam int PIXELS = raster_pkg::PIXELS;
  localparam int FRAME = raster_pkg::COORDINATE_FRAME_BITS;
  localparam int FRAME_AT = PIXELS * CODES + (raster_pkg::COLORS_OVER_W != 0 ? 2 * raster_pkg::VERTEX_COLOR_BITS : 0);
  localparam int HEADER = raster_pkg::FRAGMENT_HEADER_BITS;
  localparam int FIRST = CODES - AFFINE;                      // anchors over w, in the first pixel
  localparam int RANGE = FRAME_AT - PIXELS * CODES;
  localparam int RANGE_AT = PIXELS * AFFINE + FIRST;          // position in the fragment; the codes are below it

  genvar s;
  generate
    if (STORE_CONSTANTS_SEPARATELY) begin : gen_separate
      logic [FRAGMENT-1:0] entering;
      logic [FRAGMENT-1:0] leaving;
      assign entering   = fragment_i;
      assign fragment_o = leaving;
      for (s = 0; s < PIXELS; s++) begin : gen_pixel
        assign bits_o[s*AFFINE+:AFFINE] = entering[s*CODES+:AFFINE];
        assign leaving[s*CODES+:CODES]  = CODES'(bits_i[s*AFFINE+:AFFINE]) |
                                          (s == 0 ? CODES'(bits_i[PIXELS*AFFINE+:FIRST]) << AFFINE : '0);
      end
      assign bits_o[PIXELS*AFFINE+:FIRST] = entering[AFFINE+:FIRST];
      if (RANGE != 0) begin : gen_range
        assign bits_o[RANGE_AT+:RANGE]        = entering[PIXELS*CODES+:RANGE];
        assign leaving[PIXELS*CODES+:RANGE]   = bits_i[RANGE_AT+:RANGE];
      end
      assign bits_o[RANGE_AT+RANGE+:NUMBER] = entering[FRAME_AT+:NUMBER];
      assign leaving[FRAME_AT+:FRAME]       = FRAME'(bits_i[RANGE_AT+RANGE+:NUMBER]);
      assign bits_o[WIDTH-1-:HEADER]        = entering[FRAGMENT-1-:HEADER];
      assign leaving[FRAGMENT-1-:HEADER]    = bits_i[WIDTH-1-:HEADER];
    end else begin : gen_whole
      assign bits_o     = fragment_i;
      assign fragment_o = bits_i;
    end
  endgenerate

endmodule
