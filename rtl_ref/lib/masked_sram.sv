// Masked SRAM: an SRAM (sram.sv) with a write enable for each bit of a word, as some block RAMs have. A word that is read
// while it is written is not to be looked at.
module masked_sram #(
    parameter int WIDTH = 1,
    parameter int DEPTH = 2,               // words, at least 2
    parameter bit EARLY = 0,               // 1: may_write_i comes earlier than write_i
    parameter int ADDRESS = $clog2(DEPTH)  // derived; not to be set
) (
    input logic clk_i,

    input  logic               read_i,
    input  logic [ADDRESS-1:0] read_address_i,
    output logic [WIDTH-1:0]   data_o,

    input logic               may_write_i,  // high where a bit of write_i is
    input logic [WIDTH-1:0]   write_i,
    input logic [ADDRESS-1:0] write_address_i,
    input logic [WIDTH-1:0]   data_i
);

  // Synthesis takes for the enable of a block RAM what any bit of it is enabled by. A bit that nobody reads is written with
  // may_write_i: then that alone is the enable.
  localparam int BITS = EARLY ? WIDTH + 1 : WIDTH;
  logic [BITS-1:0] write, data;
  assign write = BITS'({may_write_i, write_i});
  assign data  = BITS'({1'b1, data_i});

  (* no_rw_check *)
  logic [BITS-1:0] memory_q[0:DEPTH-1];
  logic [BITS-1:0] data_q;

  assign data_o = data_q[WIDTH-1:0];

  always_ff @(posedge clk_i) begin
    if (read_i) data_q <= memory_q[read_address_i];
    for (int i = 0; i < BITS; i++) if (write[i]) memory_q[write_address_i][i] <= data[i];
  end

endmodule
