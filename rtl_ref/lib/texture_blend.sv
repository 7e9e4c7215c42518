// Texture blend: the filtered sum of one level becomes a texel, or waits for the sum of the next level and both are
// blended. One register. A blended sum keeps 8 fraction bits and is rounded a second time, even if the weight of the
// other level is 0. Several lanes have one blend each, and all move together; a pass brings sums to some of them.
// Specification: blend_levels of model/stages/texture_filter.hpp.
module texture_blend #(
    parameter int TAIL = 1  // bits that go along
) (
    input logic clk_i,
    input logic rst_ni,

    input  logic            valid_i,
    output logic            ready_o,
    input  logic            takes_i,       // the pass brings a sum to this sample
    input  logic [95:0]     sum_i,         // 24 bits a channel, 16 of them fraction
    input  logic            is_between_i,  // the sample lies between two levels
    input  logic            is_first_i,    // first of two sums; with several lanes, of every lane that gets a sum
    input  logic            is_second_i,
    input  logic [7:0]      part_i,        // weight of the second level, in 256ths; 0 if there is none
    input  logic [TAIL-1:0] tail_i,

    output logic            valid_o,
    input  logic            ready_i,
    output logic [31:0]     texel_o,
    output logic [TAIL-1:0] tail_o
);

  logic            valid_q, is_first_q;
  logic [7:0]      part_q;
  logic [TAIL-1:0] tail_q;
  logic [95:0]     lower_q;  // the only one, or the first of two
  logic [63:0]     upper_q;  // 8 fraction bits
  assign ready_o = !valid_q || is_first_q || ready_i;
  assign valid_o = valid_q && !is_first_q;
  assign tail_o  = tail_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= 1'b0;
    else valid_q <= valid_i || (valid_q && !ready_o);
  end
  always_ff @(posedge clk_i)
    if (ready_o) begin
      is_first_q <= is_first_i;
      part_q     <= part_i;
      tail_q     <= tail_i;
    end

  genvar n;
  generate
    for (n = 0; n < 4; n++) begin : gen_channel
      logic [15:0]        rounded, lower, upper;
      logic signed [16:0] difference;
      logic signed [25:0] product;
      logic [23:0]        sum;
      assign rounded    = sum_i[24*n+8+:16] + 16'(sum_i[24*n+7]);
      always_ff @(posedge clk_i)
        if (valid_i && ready_o && takes_i) begin
          if (!is_second_i) lower_q[24*n+:24] <= is_between_i ? {rounded, 8'd0} : sum_i[24*n+:24];
          upper_q[16*n+:16] <= rounded;
        end
      assign lower           = lower_q[24*n+8+:16];
      assign upper           = upper_q[16*n+:16];
      assign difference      = $signed({1'b0, upper}) - $signed({1'b0, lower});
      assign product         = difference * $signed({1'b0, part_q});
      assign sum             = lower_q[24*n+:24] + product[23:0] + 24'h008000;
      assign texel_o[8*n+:8] = sum[23:16];
    end
  endgenerate

endmodule
