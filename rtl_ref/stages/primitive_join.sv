// Primitive join: inserts the pixels of lines among the stamps in program order.
//
// In: fragments from interpolate, pixels from line_raster. Out: fragments. A fragment of kind line waits for the pixels
// of one line and becomes one fragment each; every other fragment passes. Combinational: no latency, one fragment per
// cycle. Which stream is read next follows from the fragment on offer, never from which of the two streams is valid.
// Specification: model/stages/primitive_join.hpp.
module primitive_join (
    // From interpolate
    input  logic                         fragment_valid_i,
    output logic                         fragment_ready_o,
    input  raster_pkg::fragment_packet_t fragment_i,

    // From line_raster
    input  logic                    pixel_valid_i,
    output logic                    pixel_ready_o,
    input  raster_pkg::line_pixel_t pixel_i,

    // To depth_test
    output logic                         fragment_valid_o,
    input  logic                         fragment_ready_i,
    output raster_pkg::fragment_packet_t fragment_o
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int N = raster_pkg::MSAA_SAMPLES;  // samples of a pixel
  localparam int TS = raster_pkg::TILE_SHIFT;
  localparam int SIZE = raster_pkg::STAMP_SIZE;
  localparam int SS = $clog2(SIZE);
  localparam int STAMP = raster_pkg::STAMP_INDEX_BITS;
  localparam int TX = raster_pkg::TILE_X_BITS;
  localparam int TY = raster_pkg::TILE_Y_BITS;
  localparam int CODES = raster_pkg::ALL_FRAGMENT_BITS;  // bits of a pixel
  // A line's pixel has no planes beyond the colours; where triangles' constants are stored separately they are not read.
  localparam int JOINED = raster_pkg::STORE_CONSTANTS_SEPARATELY != 0 ? raster_pkg::ALL_AFFINE_CODE_BITS : CODES;

  logic is_line;
  assign is_line          = fragment_i.kind == raster_pkg::PRIMITIVE_KIND_LINE;
  assign fragment_valid_o = fragment_valid_i && (!is_line || pixel_valid_i);
  assign fragment_ready_o = fragment_ready_i && (!is_line || (pixel_valid_i && pixel_i.is_last));
  assign pixel_ready_o    = fragment_ready_i && fragment_valid_i && is_line;

  logic [TS-1:0]      x, y;              // position in the tile
  logic [TS-1:0]      inner_x, inner_y;  // position in the stamp
  logic [STAMP-1:0]   stamp;
  logic [SAMPLES-1:0] mask;
  assign x       = TS'(pixel_i.x);
  assign y       = TS'(pixel_i.y);
  assign inner_x = x & TS'(SIZE - 1);
  assign inner_y = y & TS'(SIZE - 1);
  assign stamp   = STAMP'((({{TS{1'b0}}, y} >> SS) << (TS - SS)) | ({{TS{1'b0}}, x} >> SS));
  genvar s;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_sample
      logic is_drawn;
      if (N > 1) begin : gen_masked
        assign is_drawn = !fragment_i.state.masked_samples[s%N];
      end else begin : gen_all
        assign is_drawn = 1'b1;
      end
      assign mask[s] = inner_x == TS'(s / N % SIZE) && inner_y == TS'(s / N / SIZE) && is_drawn;
    end
  endgenerate

  raster_pkg::fragment_packet_t joined;
  always_comb begin
    joined = fragment_i;
    if (is_line) begin
      joined.ends_visit     = 1'b0;
      joined.ends_primitive = pixel_i.is_last;
      joined.key.tile_x     = TX'(pixel_i.x >> TS);
      joined.key.tile_y     = TY'(pixel_i.y >> TS);
      joined.stamp          = stamp;
      joined.mask           = mask;
      for (int i = 0; i < raster_pkg::PIXELS; i++) joined.code[i*CODES+:JOINED] = JOINED'(pixel_i.code);
    end
  end
  generate
    if (N > 1) begin : gen_further
      always_comb begin
        fragment_o = joined;
        if (is_line)
          fragment_o.further_depth = {(SAMPLES - raster_pkg::PIXELS) {pixel_i.code[0+:raster_pkg::DEPTH_CODE_BITS]}};
      end
    end else begin : gen_one
      assign fragment_o = joined;
    end
  endgenerate

endmodule
