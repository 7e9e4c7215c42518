// FIFO in an SRAM: a fifo (fifo.sv) of wide items that are read only after they are taken. data_o is the item taken
// last, from the next cycle on.
module sram_fifo #(
    parameter int WIDTH = 1,  // bits of an item
    parameter int DEPTH = 2,  // a power of two
    parameter bit BLOCK = 1   // in block RAM even if that is mostly empty
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

  // An item that is read has been written in an earlier cycle.
  sram #(
      .WIDTH    (WIDTH),
      .DEPTH    (DEPTH),
      .READS_OLD(0),
      .BLOCK    (BLOCK)
  ) u_items (
      .clk_i,
      .read_i         (leaves),
      .read_address_i (head_q[INDEX-1:0]),
      .data_o,
      .write_i        (enters),
      .write_address_i(tail_q[INDEX-1:0]),
      .data_i
  );

endmodule
