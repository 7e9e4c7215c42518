// Memory side of a texture cache: one request on offer, the beats that have not come, and the cache line of each.
//
// Lines are answered in the order of the requests, beat by beat, and every beat is taken as it comes.
//
// Reset: power_on_ni resets the request and the count of beats, rst_ni everything else at any time. A request on offer
// stays on offer until it is taken; beats requested before rst_ni are dropped; until the last of them has come no
// request is made. Times: TexturePort and recovered() of model/engines/cycle/texture_timing.hpp.
module texture_answers #(
    parameter int LINE = 6,        // bits of a line's place in the cache
    parameter int PORT_BITS = 64,  // bits of a beat: 16 to 128
    parameter int WORD_BITS = 64,  // bits of a word of the cache, at least PORT_BITS, a power of two
    parameter int LINES = 16,      // lines in flight; a power of two
    parameter int WORDS = 9 - $clog2(WORD_BITS)  // derived: words of a line of 64 bytes, log2
) (
    input logic clk_i,
    input logic rst_ni,
    input logic power_on_ni,

    // A line is requested, in a cycle in which there is room for it
    output logic            room_o,
    input  logic            asks_i,
    input  logic [27:0]     address_i,  // unit 16 bytes
    input  logic [1:0]      size_i,     // log2 of the line's bytes, less 4
    input  logic [LINE-1:0] line_i,

    // Memory
    output logic                 request_valid_o,
    input  logic                 request_ready_i,
    output logic [31:0]          request_address_o,  // in bytes
    output logic [5:0]           request_beats_o,
    input  logic                 answer_valid_i,
    output logic                 answer_ready_o,
    input  logic [PORT_BITS-1:0] answer_data_i,

    // A word has come: its line, its place in the line, and whether it is the line's last
    output logic                 word_valid_o,
    output logic [WORD_BITS-1:0] word_o,
    output logic [LINE-1:0]      line_o,
    output logic [1:0]           size_o,
    output logic [WORDS-1:0]     place_o,
    output logic                 ends_line_o,

    output logic idle_o  // no request is on offer, and no beat is to come
);

  localparam int BYTES = $clog2(PORT_BITS / 8);  // log2 of the bytes of a beat
  localparam int BEATS = 6 - BYTES;              // log2 of the beats of a line of 64 bytes
  localparam int UNANSWERED = $clog2(LINES + 1) + BEATS + 1;

  logic                  request_valid_q, recovers_q, discards, is_done, fills_ready, takes;
  logic [27:0]           request_address_q;
  logic [1:0]            request_size_q;
  logic [UNANSWERED-1:0] unanswered_q, left;
  logic [BEATS-1:0]      beat_q, last_beat;
  logic                  fills_valid;

  assign room_o            = fills_ready && !recovers_q && (!request_valid_q || request_ready_i);
  assign request_valid_o   = request_valid_q;
  assign request_address_o = {request_address_q, 4'd0};
  assign request_beats_o   = 6'(6'd1 << request_size_q) << (4 - BYTES);
  assign answer_ready_o    = 1'b1;
  assign discards          = recovers_q || !rst_ni;
  assign left              = unanswered_q - UNANSWERED'(answer_valid_i);
  assign is_done           = !request_valid_q && unanswered_q == '0;
  assign idle_o            = !discards && is_done;

  always_ff @(posedge clk_i or negedge power_on_ni) begin
    if (!power_on_ni) begin
      request_valid_q <= 1'b0;
      unanswered_q    <= '0;
      recovers_q      <= 1'b0;
    end else begin
      request_valid_q <= asks_i || (request_valid_q && !request_ready_i);
      unanswered_q    <= asks_i ? left + (UNANSWERED'(1) << (3'(size_i) + 3'(4 - BYTES))) : left;  // asks_i comes late
      recovers_q      <= !rst_ni || (recovers_q && !is_done);
    end
  end
  always_ff @(posedge clk_i)
    if (asks_i) begin
      request_address_q <= address_i;
      request_size_q    <= size_i;
    end

  fifo #(
      .WIDTH(LINE + 2),
      .DEPTH(LINES)
  ) u_fills (
      .clk_i,
      .rst_ni,
      .valid_i(asks_i),
      .ready_o(fills_ready),
      .data_i ({line_i, size_i}),
      .valid_o(fills_valid),
      .ready_i(ends_line_o),
      .data_o ({line_o, size_o})
  );
  assign takes       = answer_valid_i && !discards;
  assign last_beat   = BEATS'((7'(PORT_BITS <= 128) << (3'(size_o) + 3'(4 - BYTES))) - 7'd1);
  assign ends_line_o = takes && beat_q == last_beat;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) beat_q <= '0;
    else beat_q <= ends_line_o ? '0 : beat_q + BEATS'(takes);
  end

  generate
    if (PORT_BITS < WORD_BITS) begin : gen_parts
      localparam int PARTS = $clog2(WORD_BITS / PORT_BITS);
      logic [WORD_BITS-PORT_BITS-1:0] parts_q;
      always_ff @(posedge clk_i) if (takes) parts_q <= word_o[WORD_BITS-1:PORT_BITS];
      assign word_o       = {answer_data_i, parts_q};
      assign word_valid_o = takes && beat_q[PARTS-1:0] == '1;
    end else begin : gen_whole
      assign word_o       = answer_data_i;
      assign word_valid_o = takes;
    end
  endgenerate
  assign place_o = beat_q[BEATS-1-:WORDS];

endmodule
