// FIFO: DEPTH items, a power of two. An item that enters is on offer from the next cycle on; the place of an item that
// leaves is free from the next cycle on. The memory is read without a clock, as LUT RAM is.
module fifo #(
    parameter int WIDTH = 1,  // bits of an item
    parameter int DEPTH = 2,  // items; a power of two
    parameter int AHEAD = 0,  // the lowest so many bits of the item on offer stand in a register: long paths start there
    parameter int NEXT = 0    // so many of these, the lowest, are given of the item after it as well; at most AHEAD
) (
    input logic clk_i,
    input logic rst_ni,

    // From the producer
    input  logic             valid_i,
    output logic             ready_o,
    input  logic [WIDTH-1:0] data_i,

    // To the consumer
    output logic                  valid_o,
    input  logic                  ready_i,
    output logic [WIDTH+NEXT-1:0] data_o  // above the item what NEXT gives: undefined unless that item is stored
);

  localparam int INDEX = $clog2(DEPTH);

  logic [WIDTH-1:0] memory_q[0:DEPTH-1];
  logic [INDEX:0]   head_q, tail_q;  // places of the item on offer and the next; one bit more tells full from empty
  logic             enters, leaves;

  assign ready_o = head_q != (tail_q ^ {1'b1, {INDEX{1'b0}}});
  assign valid_o = head_q != tail_q;
  assign enters  = valid_i && ready_o;
  assign leaves  = valid_o && ready_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      head_q <= '0;
      tail_q <= '0;
    end else begin
      if (leaves) head_q <= head_q + 1'b1;
      if (enters) tail_q <= tail_q + 1'b1;
    end
  end

  // While there is room, data_i is written to the next item's place in every cycle; tail_q says whether it has entered. So
  // valid_i, which comes late, enables no RAM.
  logic writes;
  register_gate u_gate (
      .enable_i(valid_i),
      .enable_o(writes)
  );
  always_ff @(posedge clk_i) if (ready_o && writes) memory_q[tail_q[INDEX-1:0]] <= data_i;

  logic [WIDTH-1:0] item;
  assign item = memory_q[head_q[INDEX-1:0]];
  generate
    if (AHEAD == 0) begin : gen_memory
      assign data_o = item;
    end else begin : gen_ahead
      logic [INDEX:0]   next;     // place of the item after the one on offer
      logic [AHEAD-1:0] waiting, offered_q;  // of that item, of the one on offer
      assign next    = head_q + 1'b1;
      assign waiting = memory_q[next[INDEX-1:0]][AHEAD-1:0];
      always_ff @(posedge clk_i)
        if (!valid_o || ready_i) offered_q <= !valid_o || tail_q == next ? data_i[AHEAD-1:0] : waiting;
      always_comb begin
        data_o            = (WIDTH + NEXT)'({waiting, item});
        data_o[AHEAD-1:0] = offered_q;
      end
    end
  endgenerate

endmodule
