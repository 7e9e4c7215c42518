// Cuts a read of consecutive beats into AXI bursts of at most 16 beats.
//
// A burst ends where an aligned window of 16 beats ends, and so never crosses 4 KB (a beat has at most 256 bytes). A
// request waits a cycle in a register; the next one enters in the cycle in which its last burst leaves.
module burst_split #(
    parameter int SHIFT = 3,   // log2 of the bytes of a beat, at most 8
    parameter int BEATS = 6,   // bits of a request's number of beats
    parameter int LONGEST = 32 // beats of a request, at most; 1: nothing is cut, beats_i is ignored
) (
    input logic clk_i,
    input logic rst_ni,

    input  logic             valid_i,
    output logic             ready_o,
    input  logic [31:0]      address_i,  // of the first byte; the bits below a beat are ignored
    input  logic [BEATS-1:0] beats_i,    // 1 at least

    output logic        valid_o,
    input  logic        ready_i,
    output logic [31:0] address_o,
    output logic [7:0]  length_o  // beats less 1, as AXI counts
);

  logic             valid_q, is_last;
  logic [31:SHIFT]  address_q;

  assign ready_o   = !valid_q || (ready_i && is_last);
  assign valid_o   = valid_q;
  assign address_o = {address_q, SHIFT'(0)};

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= 1'b0;
    else valid_q <= (valid_i && ready_o) || (valid_q && !(ready_i && is_last));
  end

  generate
    if (LONGEST == 1) begin : gen_single
      assign is_last  = 1'b1;
      assign length_o = '0;
      always_ff @(posedge clk_i) if (valid_i && ready_o) address_q <= address_i[31:SHIFT];
    end else begin : gen_several
      localparam int LEFT = (BEATS < 5) ? 5 : BEATS;
      logic [LEFT-1:0] more_q;   // beats left, less 1
      logic [3:0]      in_window;  // beats after the first, up to the end of the window
      assign in_window = ~address_q[SHIFT+:4];
      assign is_last   = more_q <= LEFT'(in_window);
      assign length_o  = is_last ? 8'(more_q[3:0]) : 8'(in_window);
      always_ff @(posedge clk_i) begin
        if (valid_i && ready_o) begin
          address_q <= address_i[31:SHIFT];
          more_q    <= LEFT'(beats_i) - 1'b1;
        end else if (valid_q && ready_i) begin
          address_q <= {address_q[31:SHIFT+4] + 1'b1, 4'd0};
          more_q    <= more_q - LEFT'(in_window) - 1'b1;
        end
      end
    end
  endgenerate

endmodule
