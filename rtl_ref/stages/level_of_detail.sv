// Level of detail: from a sample's pixel and q to the levels of the texture that the sample reads, one sample a clock,
// or 2x2 of them (LANES), ten clocks.
//
//   0, 1  lines    N_x and N_y of u and v: two along y, two along x
//   2     their magnitudes
//   3, 4  lengths of (N_xu, N_xv) and (N_yu, N_yv), by an octagon
//   5     the longer one
//   8     clamped to the draw's minimum and maximum
//   8     held between the draw's least and largest
//   9     which levels, and which filter
// The samples of 2x2 share N_y along a row and N_x along a column; the odd ones are one step further. The lines come in
// parts, each shifted in after the earlier parts, and hold for later samples; the levels of a draw stay while samples are
// under way. A fixed pipeline without enables. Specification: level_of_detail of model/stages/level_of_detail.hpp,
// filter_of of texture_sample.hpp, TextureLevels and TextureLines of texture_levels.hpp.
module level_of_detail #(
    parameter int PART = 104,  // bits of a part of the lines
    parameter int PIXEL = 12,  // bits of a pixel's column and row
    parameter int LANES = 1    // 1 or 4
) (
    input logic clk_i,

    input logic            moves_in_i,
    input logic [PART-1:0] line_part_i,
    input logic            sets_levels_i,
    input logic [30:0]     levels_i,

    // The sample, or the first of several: column and row are even
    input logic [PIXEL-1:0]   x_i,
    input logic [PIXEL-1:0]   y_i,
    input logic [5*LANES-1:0] exponent_i,  // a clock later: floor(log2 q), and the bits of q after its highest
    input logic [8*LANES-1:0] below_i,
    input logic               is_mag_linear_i,  // of the draw

    // For the sample of ten clocks ago
    output logic [4*LANES-1:0] level_o,  // the only level, or the lower one
    output logic [8*LANES-1:0] part_o,   // weight of the upper level, in 256ths; 0: it is not read
    output logic [LANES-1:0]   is_linear_o,
    output logic [LANES-1:0]   is_between_o,  // between two levels, even if one has the whole weight

    output logic       shares_o  // the draw looks at two levels
);

  localparam int LINES = (PART * 2 >= 208) ? PART * 2 : PART * 3;
  localparam int LOD = 18;  // unit 2^-8 levels, signed
  localparam int SIDE = (LANES == 1) ? 1 : 2;  // samples along a side

  logic [LINES-1:0] lines_q;
  logic        is_min_linear_q;
  logic [1:0]  min_levels_q;  // 0 none, 1 the nearest, 2 two
  logic [3:0]  last_q;
  logic [11:0] least_q, largest_q;
  always_ff @(posedge clk_i) begin
    if (moves_in_i) lines_q <= {line_part_i, lines_q[LINES-1:PART]};
    if (sets_levels_i) {largest_q, least_q, last_q, min_levels_q, is_min_linear_q} <= levels_i;
  end
  assign shares_o = min_levels_q[1];

  // ---------------------------------------------------------------------------------------------- clocks 0 to 2: the lines
  logic [127:0]      product_q;  // along y of u and v, then along x
  logic [128*SIDE-1:0] zero_q, value_q, magnitude_q;  // the same for each row and each column
  logic [15:0]       offset_q;
  genvar n, k;
  generate
    for (n = 0; n < 4; n++) begin : gen_line
      logic [31:0] step;
      assign step = lines_q[128+32*(n%2)+:32];
      always_ff @(posedge clk_i) product_q[32*n+:32] <= step * (n < 2 ? 32'(y_i) : 32'(x_i));
      for (k = 0; k < SIDE; k++) begin : gen_side
        localparam int AT = 128 * k + 32 * n;
        logic sign;
        assign sign = value_q[AT+31];
        always_ff @(posedge clk_i) begin
          zero_q[AT+:32]      <= lines_q[32*n+:32] + (k == 0 ? 32'd0 : step);
          value_q[AT+:32]     <= zero_q[AT+:32] + product_q[32*n+:32];
          magnitude_q[AT+:32] <= (value_q[AT+:32] ^ {32{sign}}) + 32'(sign);
        end
      end
    end
  endgenerate
  always_ff @(posedge clk_i) offset_q <= lines_q[192+:16];

  // --------------------------------------------------------------------------------------------- clocks 3 to 5: the lengths
  logic [64*SIDE-1:0] high_q, length_q;  // along y of each row, then along x of each column
  logic [62*SIDE-1:0] half_q;            // half of the shorter side
  generate
    for (n = 0; n < 2; n++) begin : gen_length
      for (k = 0; k < SIDE; k++) begin : gen_side
        localparam int AT = n * SIDE + k;
        logic [31:0] of_u, of_v, high;
        logic [32:0] more;  // added to the longer side, for the slopes 7/8 and 1/2: nothing if negative
        assign of_u = magnitude_q[128*k+64*n+:32];
        assign of_v = magnitude_q[128*k+64*n+32+:32];
        assign high = high_q[32*AT+:32];
        assign more = 33'(half_q[31*AT+:31]) - 33'(high[31:3]);
        always_ff @(posedge clk_i) begin
          high_q[32*AT+:32]   <= of_u > of_v ? of_u : of_v;
          half_q[31*AT+:31]   <= of_u > of_v ? of_v[31:1] : of_u[31:1];
          length_q[32*AT+:32] <= high + (more[31:0] & {32{!more[32]}});
        end
      end
    end
  endgenerate

  function automatic [12:0] normalised(input [31:0] value);  // floor(log2), 8 bits after the highest
    logic [31:0] left;
    logic [4:0]  zeros;
    left = value;
    for (int bits = 4; bits >= 0; bits--) begin
      zeros[bits] = (left >> (32 - (1 << bits))) == '0;
      left        = zeros[bits] ? left << (1 << bits) : left;
    end
    normalised = {~zeros, left[30:23]};
  endfunction
  function automatic [3:0] held(input [4:0] level, input [3:0] last);
    held = level > {1'b0, last} ? last : level[3:0];
  endfunction

  generate
    for (k = 0; k < LANES; k++) begin : gen_lane
      logic [31:0] length_y, length_x, longest_q;
      assign length_y = length_q[32*(k/2)+:32];
      assign length_x = length_q[32*(SIDE+k%2)+:32];
      always_ff @(posedge clk_i) longest_q <= length_y > length_x ? length_y : length_x;

      // ------------------------------------------------------------------------------------------------ clocks 6, 7: lambda
      logic [7:0]      below, q_below;
      logic [12:0]     normalised_q;
      logic [LOD-1:0]  rest, lambda_q;
      logic [6*LOD-1:0] rest_q;  // addend, the last clock's lowest
      log2_below u_log2 (
          .below_i(normalised_q[7:0]),
          .log2_o (below)
      );
      log2_below u_log2_q (
          .below_i(below_i[8*k+:8]),
          .log2_o (q_below)
      );
      assign rest = LOD'($signed(offset_q)) - LOD'({exponent_i[5*k+:5], q_below, 1'b0});
      always_ff @(posedge clk_i) begin
        rest_q       <= {rest_q[5*LOD-1:0], rest};
        normalised_q <= normalised(longest_q);
        lambda_q     <= LOD'({normalised_q[12:8], below}) + rest_q[5*LOD+:LOD];
      end

      // -------------------------------------------------------------------------------------------- clocks 8, 9: the levels
      logic [11:0] level_q;
      logic        is_low, is_high, is_magnified, has_upper;
      logic [3:0]  whole, nearest;
      logic [12:0] to_nearest;
      assign is_low  = $signed(lambda_q) < $signed(LOD'(least_q));
      assign is_high = $signed(lambda_q) > $signed(LOD'(largest_q));
      always_ff @(posedge clk_i) level_q <= is_low ? least_q : is_high ? largest_q : lambda_q[11:0];

      assign is_magnified = level_q <= (is_mag_linear_i && !is_min_linear_q && min_levels_q != 2'd0 ? 12'd128 : 12'd0);
      assign to_nearest   = {1'b0, level_q} + 13'd127;
      assign nearest      = held(to_nearest[12:8], last_q);
      assign whole        = held({1'b0, level_q[11:8]}, last_q);
      assign has_upper    = level_q[11:8] < last_q;
      always_ff @(posedge clk_i) begin
        level_o[4*k+:4] <= is_magnified || min_levels_q == 2'd0 ? 4'd0 : min_levels_q[1] ? whole : nearest;
        is_between_o[k] <= !is_magnified && min_levels_q[1];
        part_o[8*k+:8]  <= !is_magnified && min_levels_q[1] && has_upper ? level_q[7:0] : 8'd0;
        is_linear_o[k]  <= is_magnified ? is_mag_linear_i : is_min_linear_q;
      end
    end
  endgenerate

endmodule
