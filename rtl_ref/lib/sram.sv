// SRAM: one read port, one write port, the shape of a block RAM. Contents are undefined until written.
//
// A read takes one cycle, and its result stays until the next read. It sees the writes of earlier cycles. Of a word
// that is written in the same cycle it gives the old value, which some block RAMs need extra logic for: a user who
// never looks at such a result sets READS_OLD to 0.
module sram #(
    parameter int WIDTH = 1,
    parameter int DEPTH = 2,               // words, at least 2
    /* verilator lint_off UNUSEDPARAM */   // for synthesis only
    parameter bit READS_OLD = 1,
    parameter bit BLOCK = 0,               // 1: in block RAM even where it fills little of it
    /* verilator lint_on UNUSEDPARAM */
    parameter int ADDRESS = $clog2(DEPTH)  // derived; not to be set
) (
    input logic clk_i,

    input  logic               read_i,
    input  logic [ADDRESS-1:0] read_address_i,
    output logic [WIDTH-1:0]   data_o,

    input logic               write_i,
    input logic [ADDRESS-1:0] write_address_i,
    input logic [WIDTH-1:0]   data_i
);

  (* no_rw_check = !READS_OLD, ram_style = BLOCK ? "block" : "auto" *)
  logic [WIDTH-1:0] memory_q[0:DEPTH-1];
  logic [WIDTH-1:0] data_q;

  assign data_o = data_q;

  always_ff @(posedge clk_i) begin
    if (read_i) data_q <= memory_q[read_address_i];
    if (write_i) memory_q[write_address_i] <= data_i;
  end

endmodule
