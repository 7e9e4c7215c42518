// Command reader: fetches words of the command stream from a ring in memory.
//
// The ring has a power of two of words, 256 at least, at base, which is a multiple of its size in bytes; last_word_i is
// its words less one. The processor writes words and then tail_i; head_i counts the words that were taken. Both count
// modulo 2^20 from reset, so full and empty differ.
//
// An entry is a beat, or the beats that a word takes. Bursts are of up to 8 entries, at most two are under way, and
// they
// end where a block of 8 entries does. Whole entries are fetched ahead; one that the tail is in is fetched alone, when
// all before it have been taken, and again when more of it is there. A burst is asked for only with room for all of it.
//
// clear_i forgets the stream at any time; answers still to come are dropped, and only then new requests go; head_i is 0
// then.
module command_reader #(
    parameter int PORT = raster_pkg::MEMORY_PORT_BITS  // data of a beat
) (
    input logic clk_i,
    input logic rst_ni,   // synchronised: memory drops outstanding answers
    input logic clear_i,

    // Registers
    input  logic [31:10] base_i,
    input  logic [18:8]  last_word_i,
    input  logic [19:0]  tail_i,
    input  logic [19:0]  head_i,  // words taken
    output logic         is_empty_o,

    // Words
    output logic        word_valid_o,
    input  logic        word_ready_i,
    output logic [31:0] word_o,
    output logic        word_error_o,

    // Reads
    output logic            ring_arvalid,
    input  logic            ring_arready,
    output logic [31:0]     ring_araddr,
    output logic [7:0]      ring_arlen,
    input  logic            ring_rvalid,
    output logic            ring_rready,
    input  logic [PORT-1:0] ring_rdata,
    input  logic            ring_rerror,

    output logic idle_o  // memory has answered everything
);

  localparam int WORDS = (PORT > 32) ? PORT / 32 : 1;  // of an entry
  localparam int BEATS = (PORT < 32) ? 32 / PORT : 1;
  localparam int ENTRY = 32 * WORDS;
  localparam int WORD = $clog2(WORDS);
  localparam int PART = (BEATS > 1) ? $clog2(BEATS) : 1;

  logic        reset_nq;          // reset of the stream: low from clear_i until no answer is outstanding
  logic        asks_q, partial_q; // the entry of the tail is under way or in the queue: nothing else is
  logic [3:0]  length_q;          // entries of the burst on offer
  logic [4:0]  owed_q;            // entries without an answer
  logic [19:0] fetch_q;           // words
  logic        asks, answers, ends_entry, takes, pops;
  logic [3:0]  fetched;           // whole entries of the burst on offer

  // --------------------------------------------------------------------------------------------------- addresses of fetches
  logic [19:WORD] whole;  // entries before the tail
  logic [4:0]     used;   // places of the queue, taken or promised
  logic [3:0]     to_end, length;
  logic           none_whole, is_partial, is_alone, can_ask, has_room;
  assign whole      = tail_i[19:WORD] - fetch_q[19:WORD];
  assign none_whole = whole == '0;
  assign used       = fetch_q[WORD+:5] - head_i[WORD+:5];
  assign has_room   = !used[4] && (!used[3] || used[2:0] == '0);  // for 8
  assign to_end     = 4'd8 - {1'b0, fetch_q[WORD+:3]};
  assign length     = none_whole ? 4'd1 :
                      whole[19:WORD+3] == '0 && {1'b0, whole[WORD+:3]} < to_end ? {1'b0, whole[WORD+:3]} : to_end;
  assign can_ask    = reset_nq && !clear_i && !asks_q && !partial_q &&
                      (is_partial ? is_alone : !none_whole && has_room);

  // The address: the ring's base above its size, the index below.
  always_comb begin
    ring_araddr = {base_i, 10'd0};
    for (int i = WORD + 2; i < 10; i++) ring_araddr[i] = fetch_q[i-2];
    for (int i = 10; i < 21; i++) if (last_word_i[i-2]) ring_araddr[i] = fetch_q[i-2];
  end
  assign ring_arvalid = asks_q;
  assign ring_arlen   = 8'(length_q) * 8'(BEATS) - 8'd1;
  assign asks         = asks_q && ring_arready;

  // --------------------------------------------------------------------------------------------------------- answers
  logic [PART-1:0]  part_q;
  logic [ENTRY-1:0] entry;
  logic             error;
  assign ring_rready = 1'b1;
  assign answers     = ring_rvalid;
  assign ends_entry  = answers && (BEATS == 1 || part_q == PART'(BEATS - 1));
  generate
    if (BEATS > 1) begin : gen_gathered
      logic [ENTRY-PORT-1:0] kept_q;
      logic                  error_q;
      assign entry = {ring_rdata, kept_q};
      assign error = ring_rerror || error_q;
      always_ff @(posedge clk_i) begin
        if (answers) begin
          kept_q  <= (ENTRY - PORT)'({ring_rdata, kept_q} >> PORT);
          error_q <= !ends_entry && error;
        end
        if (!reset_nq) error_q <= 1'b0;
      end
    end else begin : gen_beat
      assign entry = ring_rdata;
      assign error = ring_rerror;
    end
  endgenerate

  logic             queue_ready;  // always 1: `used` counts
  logic [ENTRY-1:0] offered;
  fifo #(
      .WIDTH(ENTRY + 1),
      .DEPTH(16)
  ) u_queue (
      .clk_i,
      .rst_ni (reset_nq),
      .valid_i(ends_entry),
      .ready_o(queue_ready),
      .data_i ({error, entry}),
      .valid_o(word_valid_o),
      .ready_i(pops),
      .data_o ({word_error_o, offered})
  );
  assign takes = word_valid_o && word_ready_i;
  generate
    if (WORDS > 1) begin : gen_words
      logic [WORD-1:0] next;  // of the word on offer
      assign next       = head_i[WORD-1:0] + 1'b1;
      assign word_o     = offered[32*head_i[WORD-1:0]+:32];
      assign pops       = takes && (partial_q ? next == fetch_q[WORD-1:0] : next == '0);
      assign is_partial = none_whole && tail_i[WORD-1:0] != fetch_q[WORD-1:0];
      assign is_alone   = used == '0 && head_i[WORD-1:0] == fetch_q[WORD-1:0];
      logic [WORD-1:0] part_words_q;  // words of the burst on offer up to the tail; 0 if the tail is not in it
      always_ff @(posedge clk_i) if (can_ask) part_words_q <= is_partial ? tail_i[WORD-1:0] : '0;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) partial_q <= 1'b0;
        else if (asks) partial_q <= part_words_q != '0;
        else if (pops || !reset_nq) partial_q <= 1'b0;
      end
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) fetch_q[WORD-1:0] <= '0;
        else if (asks) fetch_q[WORD-1:0] <= part_words_q;
        else if (!reset_nq && !asks_q) fetch_q[WORD-1:0] <= '0;
      end
      assign fetched = part_words_q != '0 ? 4'd0 : length_q;
    end else begin : gen_word
      assign word_o     = offered;
      assign pops       = takes;
      assign is_partial = 1'b0;
      assign is_alone   = 1'b0;
      assign partial_q  = 1'b0;
      assign fetched    = length_q;
    end
  endgenerate

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      reset_nq         <= 1'b0;
      asks_q           <= 1'b0;
      owed_q           <= '0;
      part_q           <= '0;
      fetch_q[19:WORD] <= '0;
    end else begin
      reset_nq <= !clear_i && (reset_nq || (owed_q == '0 && !asks_q));
      asks_q   <= can_ask || (asks_q && !ring_arready);
      owed_q   <= owed_q + (asks ? 5'(length_q) : 5'd0) - 5'(ends_entry);
      if (BEATS > 1 && answers) part_q <= ends_entry ? '0 : part_q + 1'b1;
      if (asks) fetch_q[19:WORD] <= fetch_q[19:WORD] + (20 - WORD)'(fetched);
      if (!reset_nq && !asks_q) fetch_q[19:WORD] <= '0;
    end
  end
  always_ff @(posedge clk_i) if (can_ask) length_q <= length;

  assign is_empty_o = head_i == tail_i;
  assign idle_o     = owed_q == '0 && !asks_q;

endmodule
