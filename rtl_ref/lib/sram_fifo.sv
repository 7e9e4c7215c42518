// FIFO in an SRAM: a fifo (fifo.sv) of wide items that are read only after they are taken. data_o is the item taken
// last, from the next cycle on.
module sram_fifo #(
    parameter int WIDTH = 1,  // bits of an item
    parameter int DEPTH = 2,  // a power of two
    parameter bit BLOCK = 1,  // in block RAM even if that is mostly empty
    parameter int AHEAD = 0   // 1: data_o is a register: a block RAM answers late, and long paths start there
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
    output logic [WIDTH-1:0] data_o
);

  localparam int INDEX = $clog2(DEPTH);

  logic [INDEX:0] head_q, tail_q;  // places of the item on offer and the next; one bit more tells full from empty
  logic           enters, leaves;

  assign ready_o = head_q != (tail_q ^ {1'b1, {INDEX{1'b0}}});
  assign valid_o = head_q != tail_q;
  assign enters  = valid_i && ready_o;
  assign leaves  = valid_o && ready_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      head_q <= '0;
      tail_q <= '0;
    end else begin
      head_q <= head_q + (INDEX + 1)'(leaves);
      tail_q <= tail_q + (INDEX + 1)'(enters);
    end
  end

  // The RAM is read as an item leaves: that item, or with AHEAD the one after it, which is on offer next.
  logic [INDEX-1:0] place;
  logic [WIDTH-1:0] item;
  generate
    if (AHEAD == 0) begin : gen_late
      assign place  = head_q[INDEX-1:0];
      assign data_o = item;
    end else begin : gen_ahead
      // An item that enters as the last one leaves, or an empty queue, passes the RAM.
      logic [INDEX:0]   next;
      logic             is_last, passes_q;
      logic [WIDTH-1:0] passed_q;
      assign next    = head_q + 1'b1;
      assign is_last = tail_q == next;
      assign place   = next[INDEX-1:0];
      always_ff @(posedge clk_i) begin
        if (!valid_o || ready_i) begin
          passes_q <= !valid_o || is_last;
          passed_q <= data_i;
        end
        if (leaves) data_o <= passes_q ? passed_q : item;
      end
    end
  endgenerate

  // An item that is used has been written in an earlier cycle than it was read.
  sram #(
      .WIDTH    (WIDTH),
      .DEPTH    (DEPTH),
      .READS_OLD(0),
      .BLOCK    (BLOCK)
  ) u_items (
      .clk_i,
      .read_i         (leaves),
      .read_address_i (place),
      .data_o         (item),
      .write_i        (enters),
      .write_address_i(tail_q[INDEX-1:0]),
      .data_i
  );

endmodule
