// FIFO (fifo.sv) whose item on offer stands in a register: long paths from the item begin there, not at an address of a
// RAM.
//
// Latency two cycles; the item in the register is one of the DEPTH. Ready does not depend on the consumer: a place is
// free in the cycle after its item leaves.
//
// The lowest STORED bits of wide items, from which no long paths start, may lie in an SRAM: its read is the register.
module registered_fifo #(
    parameter int WIDTH = 1,  // bits of an item
    parameter int DEPTH = 2,  // a power of two
    parameter int STORED = 0  // below WIDTH
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

    // A cycle before it is on offer: an item enters the register, and the bits of it above STORED
    output logic                    comes_o,
    output logic [WIDTH-STORED-1:0] coming_o,

    output logic is_empty_o  // no item is in the memory, the register or between them
);

  localparam int USED = $clog2(DEPTH + 1);

  logic                    waits, enters, leaves, is_free;  // an item waits for the register, which is or gets free
  logic [WIDTH-STORED-1:0] next, offered_q;
  logic [USED-1:0]         used_q;  // items inside

  assign ready_o    = used_q != USED'(DEPTH);
  assign is_empty_o = used_q == '0;
  assign enters     = valid_i && ready_o;
  assign leaves     = valid_o && ready_i;
  assign is_free    = !valid_o || ready_i;
  assign comes_o    = is_free && waits;
  assign coming_o   = next;

  logic waiting_ready;
  fifo #(
      .WIDTH(WIDTH - STORED),
      .DEPTH(DEPTH)
  ) u_waiting (
      .clk_i,
      .rst_ni,
      .valid_i(enters),
      .ready_o(waiting_ready),
      .data_i (data_i[WIDTH-1:STORED]),
      .valid_o(waits),
      .ready_i(is_free),
      .data_o (next)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      used_q  <= '0;
      valid_o <= 1'b0;
    end else begin
      used_q <= used_q + USED'(enters) - USED'(leaves);
      if (is_free) valid_o <= waits;
    end
  end

  always_ff @(posedge clk_i) if (is_free) offered_q <= next;
  assign data_o[WIDTH-1:STORED] = offered_q;

  generate
    if (STORED != 0) begin : gen_stored
      logic stored_ready, stored_waits;
      sram_fifo #(
          .WIDTH(STORED),
          .DEPTH(DEPTH)
      ) u_stored (
          .clk_i,
          .rst_ni,
          .valid_i(enters),
          .ready_o(stored_ready),
          .data_i (data_i[STORED-1:0]),
          .valid_o(stored_waits),
          .ready_i(is_free),
          .data_o (data_o[STORED-1:0])
      );
    end
  endgenerate

endmodule
