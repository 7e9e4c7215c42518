// FIFO of beats that gives a burst only when all of it has entered. A burst that will not be completed is dropped.
//
// The memory at the other end then never waits for the pipeline in the middle of a burst: a memory with one port for
// reads and writes could otherwise hold back the very read that the rest of the burst needs.
module burst_fifo #(
    parameter int WIDTH = 1,  // bits of a beat
    parameter int DEPTH = 2   // beats, a power of two; no burst is longer
) (
    input logic clk_i,
    input logic rst_ni,

    input logic drops_i,  // the beats of the incomplete burst leave; nothing enters in this cycle

    // From the producer
    input  logic             valid_i,
    output logic             ready_o,
    input  logic             last_i,  // the beat completes its burst
    input  logic [WIDTH-1:0] data_i,

    // To the consumer
    output logic             valid_o,
    input  logic             ready_i,
    output logic [WIDTH-1:0] data_o,

    output logic is_whole_o  // no incomplete burst is inside
);

  localparam int INDEX = $clog2(DEPTH);

  logic [WIDTH-1:0] memory_q[0:DEPTH-1];
  // numbers of the beat on offer, of the beat after the last whole burst, of the next beat to enter
  logic [INDEX:0]   head_q, whole_q, tail_q;
  logic             enters, leaves;

  assign ready_o    = head_q != (tail_q ^ {1'b1, {INDEX{1'b0}}});
  assign valid_o    = head_q != whole_q;
  assign is_whole_o = whole_q == tail_q;
  assign data_o     = memory_q[head_q[INDEX-1:0]];
  assign enters     = valid_i && ready_o;
  assign leaves     = valid_o && ready_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      head_q  <= '0;
      whole_q <= '0;
      tail_q  <= '0;
    end else begin
      head_q <= head_q + (INDEX + 1)'(leaves);
      tail_q <= drops_i ? whole_q : tail_q + (INDEX + 1)'(enters);
      if (enters && last_i) whole_q <= tail_q + 1'b1;
    end
  end

  always_ff @(posedge clk_i) if (enters) memory_q[tail_q[INDEX-1:0]] <= data_i;

endmodule
