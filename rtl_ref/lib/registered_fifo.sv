// FIFO whose item on offer stands in a register: who looks far at it begins there, and not at an address of a RAM.
//
// Latency two cycles; the item in the register is one of the DEPTH. Ready says nothing of the consumer: a place is free in
// the cycle behind the one in which an item leaves.
module registered_fifo #(
    parameter int WIDTH = 1,
    parameter int DEPTH = 2  // a power of two
) (
    input logic clk_i,
    input logic rst_ni,

    // From the producer
    input  logic             valid_i,
    output logic             ready_o,
    input  logic [WIDTH-1:0] data_i,

    // To the consumer
    output logic             valid_o,
    input  logic             ready_i,
    output logic [WIDTH-1:0] data_o,

    output logic is_empty_o  // nothing is here, nor on its way to the register
);

  localparam int INDEX = $clog2(DEPTH);

  logic [WIDTH-1:0] memory_q[0:DEPTH-1];
  logic [INDEX-1:0] head_q, tail_q;  // of the next to go into the register, of the next to enter
  logic [INDEX:0]   used_q, waiting_q;  // items here; and those that are not in the register
  logic             enters, moves, leaves;

  assign ready_o    = used_q != (INDEX + 1)'(DEPTH);
  assign is_empty_o = used_q == '0;
  assign enters     = valid_i && ready_o;
  assign leaves     = valid_o && ready_i;
  assign moves      = waiting_q != '0 && (!valid_o || ready_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      head_q    <= '0;
      tail_q    <= '0;
      used_q    <= '0;
      waiting_q <= '0;
      valid_o   <= 1'b0;
    end else begin
      head_q    <= head_q + INDEX'(moves);
      tail_q    <= tail_q + INDEX'(enters);
      used_q    <= used_q + (INDEX + 1)'(enters) - (INDEX + 1)'(leaves);
      waiting_q <= waiting_q + (INDEX + 1)'(enters) - (INDEX + 1)'(moves);
      valid_o   <= moves || (valid_o && !ready_i);
    end
  end

  always_ff @(posedge clk_i) begin
    if (enters) memory_q[tail_q] <= data_i;
    if (!valid_o || ready_i) data_o <= memory_q[head_q];
  end

endmodule
