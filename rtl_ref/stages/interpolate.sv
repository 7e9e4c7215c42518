// Interpolate: the codes of every plane at the samples of a stamp.
//
// In: a stamp packet, and the context of its slot from the context RAM. Out: a fragment packet. A sample's value is the
// closed form anchor + i step_x + j step_y (i, j pixels from pixel (T/2, T/2)), modulo the local width; its code is the
// bits above the fraction; at a covered sample the widths guarantee that it lies in the range of the vertices, so
// nothing clamps it. Planes after depth and colours, 1/w and planes over w, pass with their fractions; where triangles'
// constants are STORE_CONSTANTS_SEPARATELY (raster_top) the anchors of the tile go on instead (stored_fragment.sv).
// Latency 6 cycles, one stamp per cycle. Nothing waits on the way: a stamp enters when there is a place for its
// fragment in the FIFO at the end. A cycle each:
//   context  the context is read
//   x, y     from the anchor to the stamp's first sample
//   samples  from there to each sample
//   FIFO     where fragments wait
//   offer    a register, because long paths start from a fragment
// Specification: model/stages/interpolate.hpp.
module interpolate (
    input logic clk_i,
    input logic rst_ni,

    // From fine_raster
    input  logic                      stamp_valid_i,
    output logic                      stamp_ready_o,
    input  raster_pkg::stamp_packet_t stamp_i,

    // Context RAM: a read, and its answer in the next cycle, which stays until the next read
    output logic                             context_read_o,
    output logic [raster_pkg::SLOT_BITS-1:0] context_slot_o,
    input  raster_pkg::context_packet_t      context_i,
    output logic                             slot_free_o,  // the oldest slot will not be read again

    // To primitive_join
    output logic                         fragment_valid_o,
    input  logic                         fragment_ready_i,
    output raster_pkg::fragment_packet_t fragment_o
);

  localparam int STAMP = raster_pkg::STAMP_SIZE;
  localparam int STAMP_SHIFT = $clog2(STAMP);
  localparam int PIXELS = raster_pkg::PIXELS;  // pixels of a stamp
  localparam int N = raster_pkg::MSAA_SAMPLES;  // samples of a pixel
  localparam int S = raster_pkg::GRID_BITS;
  localparam int PLANES = raster_pkg::PLANES;
  localparam logic [32*PLANES-1:0] STEP_AT = raster_pkg::STEP_AT;
  localparam logic [32*PLANES-1:0] FRAGMENT_BITS_OF = raster_pkg::FRAGMENT_BITS_OF;
  localparam logic [32*PLANES-1:0] FRAGMENT_AT = raster_pkg::FRAGMENT_AT;
  localparam logic [32*PLANES-1:0] LOCAL_BITS_OF = raster_pkg::LOCAL_BITS_OF;
  localparam logic [32*PLANES-1:0] LOCAL_AT = raster_pkg::LOCAL_AT;
  localparam int CODES = raster_pkg::ALL_FRAGMENT_BITS;  // bits of a pixel
  localparam int PIXEL = raster_pkg::TILE_PIXEL_BITS;
  localparam int L = raster_pkg::PLANE_LOCAL_GUARD_BITS;
  localparam int PER_ROW_BITS = PIXEL - STAMP_SHIFT;
  localparam bit STORE_CONSTANTS_SEPARATELY = raster_pkg::STORE_CONSTANTS_SEPARATELY != 0;
  localparam int STORED = raster_pkg::STORED_FRAGMENT_BITS;

  raster_pkg::stamp_packet_t context_stamp_q, x_stamp_q, y_stamp_q, samples_stamp_q;
  raster_pkg::context_packet_t x_context_q, y_context_q, samples_context_q;
  logic context_valid_q, x_valid_q, y_valid_q, samples_valid_q;

  localparam int ROOM = 8;  // fragments on their way, in the FIFO and on offer: one a step, and two more
  localparam int USED = $clog2(ROOM + 1);
  logic [USED-1:0] used_q;
  logic            takes, leaves;
  logic            has_room_q;  // used_q is below ROOM: long paths start from it
  assign stamp_ready_o  = has_room_q;
  assign takes          = stamp_valid_i && stamp_ready_o;
  assign leaves         = fragment_valid_o && fragment_ready_i;
  assign context_read_o = takes;
  assign context_slot_o = stamp_i.slot;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      context_valid_q <= 1'b0;
      x_valid_q       <= 1'b0;
      y_valid_q       <= 1'b0;
      samples_valid_q <= 1'b0;
      slot_free_o     <= 1'b0;
      used_q          <= '0;
      has_room_q      <= 1'b1;
    end else begin
      context_valid_q <= takes;
      x_valid_q       <= context_valid_q;
      y_valid_q       <= x_valid_q;
      samples_valid_q <= y_valid_q;
      slot_free_o     <= context_valid_q && context_stamp_q.ends_primitive;
      used_q          <= used_q + USED'(takes) - USED'(leaves);
      has_room_q      <= leaves || (has_room_q && !(takes && used_q == USED'(ROOM - 1)));
    end
  end

  logic enters_context, enters_x, enters_y, enters_samples, enters_fifo;  // something moves into these steps
  register_gate #(
      .WIDTH(5)
  ) u_gate (
      .enable_i({takes, context_valid_q, x_valid_q, y_valid_q, samples_valid_q}),
      .enable_o({enters_context, enters_x, enters_y, enters_samples, enters_fifo})
  );

  always_ff @(posedge clk_i) begin
    if (enters_context) context_stamp_q <= stamp_i;
    if (enters_x) begin
      x_stamp_q   <= context_stamp_q;
      x_context_q <= context_i;
    end
    if (enters_y) begin
      y_stamp_q   <= x_stamp_q;
      y_context_q <= x_context_q;
    end
    if (enters_samples) begin
      samples_stamp_q   <= y_stamp_q;
      samples_context_q <= y_context_q;
    end
  end

  // Offset of the stamp's first sample from the centre, in stamps: -n/2 ... n/2 - 1 of n in a row, two's complement.
  logic [PIXEL-1:0] to_x, to_y;  // pixels
  generate
    if (PER_ROW_BITS > 0) begin : gen_offset
      logic [PER_ROW_BITS-1:0] column, row;
      assign column = context_stamp_q.stamp[0+:PER_ROW_BITS] ^ {1'b1, {(PER_ROW_BITS - 1) {1'b0}}};
      assign row    = x_stamp_q.stamp[PER_ROW_BITS+:PER_ROW_BITS] ^ {1'b1, {(PER_ROW_BITS - 1) {1'b0}}};
      assign to_x   = PIXEL'(column) << STAMP_SHIFT;
      assign to_y   = PIXEL'(row) << STAMP_SHIFT;
    end else begin : gen_whole_tile
      assign to_x = PIXEL'(STAMP / 2);
      assign to_y = PIXEL'(STAMP / 2);
    end
  endgenerate

  logic [PIXELS*CODES-1:0]      code;
  raster_pkg::fragment_packet_t made;

  // The shading point of each pixel, a bit per sample: its centre if covered or if no sample is, else the first covered
  // sample.
  logic [PIXELS*N-1:0] shaded_at;
  generate
    if (N > 1) begin : gen_shaded
      always_comb begin
        for (int i = 0; i < PIXELS; i++)
          shaded_at[i*N+:N] = y_stamp_q.centre[i] ? '0 : y_stamp_q.mask[i*N+:N] & (~y_stamp_q.mask[i*N+:N] + 1'b1);
      end
    end else begin : gen_centres
      assign shaded_at = '0;
    end
  endgenerate

  genvar p, s, k;
  generate
    for (p = 0; p < PLANES; p++) begin : gen_plane
      localparam int W = LOCAL_BITS_OF[32*p+:32];
      localparam int LOCAL = LOCAL_AT[32*p+:32];
      localparam int B = FRAGMENT_BITS_OF[32*p+:32];
      localparam int CODE = FRAGMENT_AT[32*p+:32];  // its place; planes with ranges come first
      localparam int STEP = STEP_AT[32*p+:32];
      logic signed [W-1:0] anchor, context_step_x, x_step_y, y_step_x, y_step_y;  // modulo 2^W signs do not matter
      logic signed [W-1:0] x_value_q, y_value_q;
      assign anchor         = context_stamp_q.anchor[LOCAL+:W];
      assign context_step_x = context_i.step_x[STEP+:W];
      assign x_step_y       = x_context_q.step_y[STEP+:W];
      assign y_step_x       = y_context_q.step_x[STEP+:W];
      assign y_step_y       = y_context_q.step_y[STEP+:W];

      // x, then y; the stamp may lie on either side of the centre.
      logic signed [W-1:0] x_value, y_value;
      plane_offset #(
          .WIDTH (W),
          .OFFSET(PIXEL),
          .LOWEST(STAMP_SHIFT)
      ) u_x (
          .value_i (anchor),
          .step_i  (context_step_x),
          .offset_i(to_x),
          .value_o (x_value)
      );
      plane_offset #(
          .WIDTH (W),
          .OFFSET(PIXEL),
          .LOWEST(STAMP_SHIFT)
      ) u_y (
          .value_i (x_value_q),
          .step_i  (x_step_y),
          .offset_i(to_y),
          .value_o (y_value)
      );
      always_ff @(posedge clk_i) begin
        if (enters_x) x_value_q <= x_value;
        if (enters_y) y_value_q <= y_value;
      end

      // With several samples per pixel, the plane's increment from the centre to each sample, rounded to the local
      // guard bits.
      logic [N*W-1:0] to_sample_q;
      if (N > 1) begin : gen_to_sample
        localparam int WIDE = W + S;  // bits of a step
        logic [N*WIDE-1:0] ways;
        sample_offsets #(
            .WIDTH(WIDE)
        ) u_ways (
            .value_i (WIDE'(1 << (S - 1))),
            .step_x_i(x_context_q.step_x[STEP+:WIDE]),
            .step_y_i(x_context_q.step_y[STEP+:WIDE]),
            .value_o (ways)
        );
        for (k = 0; k < N; k++) begin : gen_place
          always_ff @(posedge clk_i) if (enters_y) to_sample_q[k*W+:W] <= ways[k*WIDE+S+:W];
        end
      end else begin : gen_centre
        assign to_sample_q = '0;
      end

      for (s = 0; s < PIXELS; s++) begin : gen_pixel
        logic signed [W-1:0] value, way;
        logic [W-1:0]        value_q;
        edge_offset #(
            .WIDTH (W),
            .OFFSET(PIXEL)
        ) u_value (
            .value_i (y_value_q),
            .step_x_i(y_step_x),
            .step_y_i(y_step_y),
            .x_i     (PIXEL'(s % STAMP)),
            .y_i     (PIXEL'(s / STAMP)),
            .value_o (value)
        );
        // Depth is taken at the first sample, all other planes at the shading point.
        always_comb begin
          way = p == 0 ? to_sample_q[0+:W] : '0;
          for (int i = 0; i < N; i++) if (p != 0 && shaded_at[s*N+i]) way = way | to_sample_q[i*W+:W];
        end
        always_ff @(posedge clk_i) if (enters_samples) value_q <= value + way;

        // The code is offset by half its range: modulo 2^B that inverts its highest bit.
        if (p < raster_pkg::AFFINE_PLANES) begin : gen_code
          assign code[s*CODES+CODE+:B] = enters_fifo ? {!value_q[L+B-1], value_q[L+:B-1]} : '0;
        end else begin : gen_over_w
          assign code[s*CODES+CODE+:B] = !STORE_CONSTANTS_SEPARATELY ? value_q : s == 0 ? samples_stamp_q.anchor[LOCAL+:W] : '0;
        end
        if (p == 0) begin : gen_depth  // depths of the other samples
          for (k = 1; k < N; k++) begin : gen_further
            logic [W-1:0] further_q;
            always_ff @(posedge clk_i) if (enters_samples) further_q <= value + to_sample_q[k*W+:W];
            assign made.further_depth[(s*(N-1)+k-1)*B+:B] = {!further_q[L+B-1], further_q[L+:B-1]};
          end
        end
      end
    end
  endgenerate

  assign made.kind           = samples_stamp_q.kind;
  assign made.ends_visit     = samples_stamp_q.ends_visit;
  assign made.ends_primitive = samples_stamp_q.ends_primitive;
  assign made.key            = samples_stamp_q.key;
  assign made.stamp          = samples_stamp_q.stamp;
  assign made.state          = samples_context_q.state;
  assign made.code           = code;
  generate
    if (N > 1) begin : gen_masked  // samples that the state does not draw
      assign made.mask = samples_stamp_q.mask & ~{PIXELS{samples_context_q.state.masked_samples}};
    end else begin : gen_all
      assign made.mask = samples_stamp_q.mask;
    end
    if (raster_pkg::COORDINATES != 0) begin : gen_coordinates
      assign made.coordinates = samples_context_q.coordinates;
    end
    if (raster_pkg::COLORS_OVER_W != 0) begin : gen_color_range
      localparam int AT = raster_pkg::AFFINE_CODE_AT[32+:32];  // place of red
      assign made.least_color    = samples_context_q.range.low[AT+:8*raster_pkg::COLOR_PLANES];
      assign made.greatest_color = samples_context_q.range.high[AT+:8*raster_pkg::COLOR_PLANES];
    end
  endgenerate

  logic made_ready, is_empty;
  logic [STORED-1:0] made_bits, fragment_bits;
  stored_fragment u_stored (
      .fragment_i(made),
      .bits_o    (made_bits),
      .bits_i    (fragment_bits),
      .fragment_o
  );
  registered_fifo #(
      .WIDTH (STORED),
      .DEPTH (ROOM),
      .STORED(raster_pkg::QUEUE_BLOCK_RAM != 0 ? STORED - raster_pkg::FRAGMENT_HEADER_BITS : 0)
  ) u_fragments (
      .clk_i,
      .rst_ni,
      .valid_i   (samples_valid_q),
      .ready_o   (made_ready),
      .data_i    (made_bits),
      .valid_o   (fragment_valid_o),
      .ready_i   (fragment_ready_i),
      .data_o    (fragment_bits),
      .comes_o   (),
      .coming_o  (),
      .is_empty_o(is_empty)
  );

endmodule
