// Linear filter: four texels, weighted by the fractions along x and y. Two registers; without rounding between them,
// (sum + 2^15) >> 16 at the end, or the raw sum where it is blended with that of another level. Specification:
// linear_sums and filter_linear of model/stages/texture_filter.hpp.
module texture_filter #(
    parameter int LEVELS = 0,               // 1: sum_o is the output
    parameter int TAIL = 1,                 // bits that go along
    parameter int BORDER = 0,               // 1: texels may be the border's
    parameter int PART = 16 + 4 * BORDER    // derived; not to be set
) (
    input logic clk_i,
    input logic rst_ni,

    input  logic            valid_i,
    output logic            ready_o,
    input  logic [127:0]    code_i,    // first row, second row
    input  logic [2:0]      format_i,
    input  logic [PART-1:0] part_i,    // weight of the second column and row, in 256ths; the column's lowest. With
                                       // BORDER above them: whether the first column, the second one, the first
                                       // row, the second one are the border's
    input  logic [31:0]     border_i,  // its colour, R lowest
    input  logic [TAIL-1:0] tail_i,

    output logic            valid_o,
    input  logic            ready_i,
    output logic [95:0]     sum_o,  // 24 bits a channel; includes 2^15 without LEVELS
    output logic [31:0]     texel_o,
    output logic [TAIL-1:0] tail_o
);

  logic            valid_1_q, valid_2_q, ready_2;
  logic [127:0]    texel, texel_q;
  logic [15:0]     part_q;
  logic [7:0]      part_y_q;
  logic [TAIL-1:0] tail_1_q, tail_2_q;
  logic [127:0]    row, row_q;  // 16 bits a channel, of the first row and of the second
  assign ready_2 = !valid_2_q || ready_i;
  assign ready_o = !valid_1_q || ready_2;
  assign valid_o = valid_2_q;
  assign tail_o  = tail_2_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_1_q <= 1'b0;
      valid_2_q <= 1'b0;
    end else begin
      valid_1_q <= valid_i || (valid_1_q && !ready_2);
      valid_2_q <= valid_1_q || (valid_2_q && !ready_i);
    end
  end
  always_ff @(posedge clk_i) begin
    if (ready_o) begin
      texel_q  <= texel;
      part_q   <= part_i[15:0];
      tail_1_q <= tail_i;
    end
    if (ready_2) begin
      row_q    <= row;
      part_y_q <= part_q[15:8];
      tail_2_q <= tail_1_q;
    end
  end

  // a + (b - a) part / 256, with 8 bits more than a and b.
  genvar n;
  generate
    for (n = 0; n < 4; n++) begin : gen_decode
      logic [31:0] decoded;
      texture_decode u_decode (
          .code_i  (code_i[32*n+:32]),
          .format_i(format_i),
          .texel_o (decoded)
      );
      if (BORDER != 0) begin : gen_border
        assign texel[32*n+:32] = part_i[16+n%2] || part_i[18+n/2] ? border_i : decoded;
      end else begin : gen_image
        assign texel[32*n+:32] = decoded;
      end
    end
    if (BORDER == 0) begin : gen_no_border
      logic unused;
      assign unused = &border_i;
    end
    for (n = 0; n < 8; n++) begin : gen_row
      localparam int ROW = n / 4;
      localparam int CHANNEL = n % 4;
      logic [7:0]         first, second;
      logic signed [8:0]  difference;
      logic signed [17:0] product;
      assign first          = texel_q[64*ROW+8*CHANNEL+:8];
      assign second         = texel_q[64*ROW+32+8*CHANNEL+:8];
      assign difference     = $signed({1'b0, second}) - $signed({1'b0, first});
      assign product        = difference * $signed({1'b0, part_q[7:0]});
      assign row[16*n+:16]  = {first, 8'd0} + product[15:0];
    end
    for (n = 0; n < 4; n++) begin : gen_channel
      logic [15:0]        first, second;
      logic signed [16:0] difference;
      logic signed [25:0] product;
      logic [23:0]        sum;
      assign first           = row_q[16*n+:16];
      assign second          = row_q[64+16*n+:16];
      assign difference      = $signed({1'b0, second}) - $signed({1'b0, first});
      assign product         = difference * $signed({1'b0, part_y_q});
      assign sum             = {first, 8'd0} + product[23:0] + (LEVELS != 0 ? 24'd0 : 24'h008000);
      assign texel_o[8*n+:8] = sum[23:16];
      assign sum_o[24*n+:24] = sum;
    end
  endgenerate

endmodule
