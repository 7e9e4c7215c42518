// Masked SRAM: an SRAM (sram.sv) with a write enable for each bit of a word, as some block RAMs have. A word that is read
// while it is written is not to be looked at.
module masked_sram #(
    parameter int WIDTH = 1,
    parameter int DEPTH = 2,               // words, at least 2
    parameter int ADDRESS = $clog2(DEPTH)  // derived; not to be set
) (
    input logic clk_i,

    input  logic               read_i,
    input  logic [ADDRESS-1:0] read_address_i,
    output logic [WIDTH-1:0]   data_o,

    input logic [WIDTH-1:0]   write_i,
    input logic [ADDRESS-1:0] write_address_i,
    input logic [WIDTH-1:0]   data_i
);

  (* no_rw_check *)
  logic [WIDTH-1:0] memory_q[0:DEPTH-1];
  logic [WIDTH-1:0] data_q;

  assign data_o = data_q;

  always_ff @(posedge clk_i) begin
    if (read_i) data_q <= memory_q[read_address_i];
    for (int i = 0; i < WIDTH; i++) if (write_i[i]) memory_q[write_address_i][i] <= data_i[i];
  end

endmodule
