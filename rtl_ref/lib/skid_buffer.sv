// Skid buffer: an elastic element that cuts a ready chain. Two items deep, ready is registered, no bubbles.
//
// Item n enters no earlier than one cycle after item n-2 left; latency 1 cycle. An item that is offered stays offered
// unchanged until it is taken.
module skid_buffer #(
    parameter int WIDTH = 1  // bits of an item; costs two registers of them
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

  logic             head_valid_q;  // the item on offer
  logic [WIDTH-1:0] head_q;
  logic             tail_valid_q;  // the item after it; while it is there no item enters
  logic [WIDTH-1:0] tail_q;

  logic enters, leaves;

  assign ready_o = !tail_valid_q;
  assign valid_o = head_valid_q;
  assign data_o  = head_q;
  assign enters  = valid_i && ready_o;
  assign leaves  = head_valid_q && ready_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      head_valid_q <= 1'b0;
      tail_valid_q <= 1'b0;
    end else begin
      head_valid_q <= enters || tail_valid_q || (head_valid_q && !ready_i);
      tail_valid_q <= (tail_valid_q || enters) && head_valid_q && !ready_i;
    end
  end

  always_ff @(posedge clk_i) begin
    if (leaves || !head_valid_q) head_q <= tail_valid_q ? tail_q : data_i;
    if (enters) tail_q <= data_i;
  end

endmodule
