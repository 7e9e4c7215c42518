// Texture cache for a linear filter: what texture_cache.sv is for one texel a sample, for the four around its place.
//
// These lie in one block of 4x4, or in two or four beside each other. So tags are in four banks, by the lowest bits of the
// block's column and row: each bank looks up at most one line. Texels are in four banks as well, by the lowest bits of their
// own column and row: each gives one texel. A sample whose lines are all there takes a clock, one with n misses n clocks; they
// are asked for bank by bank, and the sample waits in the queue until all have come.
// Specification and times: those of texture_cache.sv.
module texture_cache_linear #(
    parameter int LINES = 64,      // a power of two, at least 16
    parameter int PORT_BITS = 64,  // 16, 32 or 64
    parameter int IN_FLIGHT = 32,  // samples that wait; a power of two
    parameter int REQUESTS = 16,   // lines that are not answered; a power of two
    parameter int TAIL = 1,        // bits that go along with a sample
    parameter int SIDE_BITS = 12
) (
    input logic clk_i,
    /* verilator lint_off SYNCASYNCNET */
    input logic rst_ni,
    /* verilator lint_on SYNCASYNCNET */
    input logic power_on_ni,

    // Samples: two columns and two rows, the first lowest
    input  logic                   sample_valid_i,
    output logic                   sample_ready_o,
    input  logic [2*SIDE_BITS-1:0] x_i,
    input  logic [2*SIDE_BITS-1:0] y_i,
    input  logic [TAIL-1:0]        tail_i,

    // Its level: where that begins, in lines of 16 bytes, and a row of its lines, log2
    input logic [23:0] offset_i,
    input logic [3:0]  row_i,
    input logic        is_odd_i,

    // The texture: stays while samples are in front of the tags
    input logic [2:0]  format_i,
    input logic [25:0] base_i,
    input logic [1:0]  size_i,
    input logic        shares_i,  // odd levels have one half of each bank, even ones the other

    input  logic drop_i,
    output logic tags_are_empty_o,

    // Four texels as they are stored: first row, second row
    output logic            code_valid_o,
    input  logic            code_ready_i,
    output logic [127:0]    code_o,
    output logic [2:0]      code_format_o,
    output logic [TAIL-1:0] code_tail_o,

    // Memory
    output logic                 request_valid_o,
    input  logic                 request_ready_i,
    output logic [31:0]          request_address_o,
    output logic [5:0]           request_beats_o,
    input  logic                 answer_valid_i,
    output logic                 answer_ready_o,
    input  logic [PORT_BITS-1:0] answer_data_i,

    output logic            looked_up_o,  // a sample, or a pass of one
    output logic            hit_o,        // and all of it was there
    output logic [TAIL-1:0] looked_up_tail_o,
    output logic            miss_o,       // a line has been asked for
    output logic idle_o
);

  localparam int LINE = $clog2(LINES);
  localparam int LINE_X = (LINE + 1) / 2;
  localparam int LINE_Y = LINE / 2;
  localparam int BANK_X = LINE_X - 1;     // of a line's number in its bank
  localparam int BANK_Y = LINE_Y - 1;
  localparam int BANK = BANK_X + BANK_Y;
  localparam int BLOCK = SIDE_BITS - 2;
  localparam int NUMBER = 7;
  localparam int GROUP = 3;
  localparam int COUNT = NUMBER + GROUP;
  localparam int COME = $clog2(4 * (IN_FLIGHT + 1) + 1);

  // ----------------------------------------------------------------------------------- which columns and rows are in which bank
  // Of each bank along one axis: is there a block in it, which; is there a texel, which.
  logic [1:0]             used_x, used_y;
  logic [2*BLOCK-1:0]     block_x, block_y;  // of the even bank lowest
  logic [BLOCK-1:0]       first_x, first_y, second_x, second_y;
  assign first_x    = x_i[SIDE_BITS-1:2];
  assign second_x   = x_i[2*SIDE_BITS-1:SIDE_BITS+2];
  assign first_y    = y_i[SIDE_BITS-1:2];
  assign second_y   = y_i[2*SIDE_BITS-1:SIDE_BITS+2];
  assign used_x     = {first_x[0] || second_x[0], !first_x[0] || !second_x[0]};
  assign used_y     = {first_y[0] || second_y[0], !first_y[0] || !second_y[0]};
  assign block_x    = {first_x[0] ? first_x : second_x, first_x[0] ? second_x : first_x};
  assign block_y    = {first_y[0] ? first_y : second_y, first_y[0] ? second_y : first_y};

  // What a texel needs of a column or row to be read: the line's part, and the bit above the bank's.
  localparam int WAY_X = LINE_X + 1;
  localparam int WAY_Y = LINE_Y + 1;
  localparam logic [WAY_Y-1:0] HALF_OF_WAY = WAY_Y'(1) << LINE_Y;  // its highest bit, that of a place along y likewise
  localparam logic [BANK_Y-1:0] HALF_OF_BANK = BANK_Y'(1) << (BANK_Y - 1);
  logic [2*WAY_X-1:0] way_x;
  logic [2*WAY_Y-1:0] way_y;
  assign way_x = x_i[0] ? {x_i[1+:WAY_X], x_i[SIDE_BITS+1+:WAY_X]} : {x_i[SIDE_BITS+1+:WAY_X], x_i[1+:WAY_X]};
  assign way_y = ((y_i[0] ? {y_i[1+:WAY_Y], y_i[SIDE_BITS+1+:WAY_Y]} : {y_i[SIDE_BITS+1+:WAY_Y], y_i[1+:WAY_Y]}) &
                  ~{2{HALF_OF_WAY & {WAY_Y{shares_i}}}}) | {2{HALF_OF_WAY & {WAY_Y{shares_i && is_odd_i}}}};

  // -------------------------------------------------------------------------------------------------------------------- tags
  logic             t_valid_q, t_enters, t_goes;
  logic [2:0]       t_format_q;
  logic [1:0]       t_size_q;
  logic [TAIL-1:0]  t_tail_q;
  logic [2*WAY_X-1:0] t_way_x_q;
  logic [2*WAY_Y-1:0] t_way_y_q;
  logic [3:0]       t_parity_q;
  logic [3:0]       t_used_q, known, referenced, missing, asks, asked_q;
  logic [4*28-1:0]  t_address_q;
  logic [4*BANK-1:0] t_place_q;
  logic             sweeps_q, is_occupied, blocked, any_asks;
  logic [BANK-1:0]  sweep_q;
  logic [COUNT-1:0] issued_q, read_q;
  /* verilator lint_off UNUSEDSIGNAL */
  logic [COUNT-1:0] last;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [NUMBER-1:0] last_group, group, oldest_group;
  logic             waiting_ready, waiting_valid, reads, may_ask, answers_are_idle;

  assign sample_ready_o   = (!t_valid_q || t_goes) && !sweeps_q;
  assign t_enters         = sample_valid_i && sample_ready_o;
  assign tags_are_empty_o = !t_valid_q;
  assign last             = issued_q - 1'b1;
  assign last_group       = last[COUNT-1:GROUP];
  assign group            = issued_q[COUNT-1:GROUP];
  assign oldest_group     = read_q[COUNT-1:GROUP];
  assign is_occupied      = issued_q != read_q;

  genvar b;
  generate
    for (b = 0; b < 4; b++) begin : gen_tags
      localparam int X = b % 2;
      localparam int Y = b / 2;
      logic              tag_valid, same_place_q, same_line_q;
      logic [27:0]       tag, address;
      logic [NUMBER-1:0] tag_group;
      logic [BANK-1:0]   place;
      assign address = {base_i, 2'd0} + (28'(block_y[Y*BLOCK+:BLOCK]) << row_i |
                                         28'(block_x[X*BLOCK+:BLOCK]) << size_i | 28'(offset_i));
      assign place   = {(block_y[Y*BLOCK+1+:BANK_Y] & ~(HALF_OF_BANK & {BANK_Y{shares_i}})) |
                        (HALF_OF_BANK & {BANK_Y{shares_i && is_odd_i}}), block_x[X*BLOCK+1+:BANK_X]};
      sram #(
          .WIDTH    (1 + 28 + NUMBER),
          .DEPTH    (LINES / 4),
          .READS_OLD(0)
      ) u_tags (
          .clk_i,
          .read_i         (t_enters),
          .read_address_i (place),
          .data_o         ({tag_valid, tag, tag_group}),
          .write_i        ((t_goes && t_used_q[b]) || sweeps_q),
          .write_address_i(sweeps_q ? sweep_q : t_place_q[b*BANK+:BANK]),
          .data_i         ({!sweeps_q, t_address_q[b*28+:28], sweeps_q ? last_group : group})
      );
      assign known[b] = same_place_q ? same_line_q : tag_valid && tag == t_address_q[b*28+:28];
      assign referenced[b] = is_occupied && NUMBER'(group - (same_place_q ? last_group : tag_group)) <=
                                            NUMBER'(group - oldest_group);
      always_ff @(posedge clk_i)
        if (t_enters) begin
          t_address_q[b*28+:28]     <= address;
          t_place_q[b*BANK+:BANK]   <= place;
          t_used_q[b]               <= used_x[X] && used_y[Y];
          same_place_q              <= t_goes && t_used_q[b] && place == t_place_q[b*BANK+:BANK];
          same_line_q               <= address == t_address_q[b*28+:28];
        end
    end
  endgenerate

  logic [2:0] misses;
  assign missing  = t_used_q & ~known & ~asked_q;
  assign asks     = missing & (~missing + 1'b1);
  assign blocked  = (asks & referenced) != '0 || !may_ask;
  assign any_asks = t_valid_q && missing != '0 && !blocked;
  assign t_goes   = t_valid_q && waiting_ready && (missing == '0 || (!blocked && missing == asks));
  assign looked_up_o      = t_goes;
  assign looked_up_tail_o = t_tail_q;
  assign hit_o    = t_goes && (t_used_q & ~known) == '0;
  assign miss_o   = any_asks;
  always_comb begin
    misses = '0;
    for (int i = 0; i < 4; i++) misses = misses + 3'(t_used_q[i] && !known[i]);
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      t_valid_q <= 1'b0;
      asked_q   <= '0;
      sweeps_q  <= 1'b1;
      sweep_q   <= '0;
      issued_q  <= '0;
      read_q    <= '0;
    end else begin
      t_valid_q <= t_enters || (t_valid_q && !t_goes);
      asked_q   <= t_goes ? '0 : asked_q | (asks & {4{any_asks}});
      sweeps_q  <= drop_i || (sweeps_q && sweep_q != '1);
      sweep_q   <= drop_i ? '0 : sweep_q + BANK'(sweeps_q);
      issued_q  <= issued_q + COUNT'(t_goes);
      read_q    <= read_q + COUNT'(reads);
    end
  end
  always_ff @(posedge clk_i)
    if (t_enters) begin
      t_format_q <= format_i;
      t_size_q   <= size_i;
      t_tail_q   <= tail_i;
      t_way_x_q  <= way_x;
      t_way_y_q  <= way_y;
      t_parity_q <= {y_i[SIDE_BITS], y_i[0], x_i[SIDE_BITS], x_i[0]};
    end

  // -------------------------------------------------------------------------------------------------- requests and answers
  logic [27:0]      asked_address;
  logic [BANK-1:0]  asked_place;
  logic [LINE-1:0]  asked_line;
  always_comb begin
    asked_address = '0;
    asked_place   = '0;
    for (int i = 0; i < 4; i++)
      if (asks[i]) begin
        asked_address = t_address_q[i*28+:28];
        asked_place   = t_place_q[i*BANK+:BANK];
      end
  end
  assign asked_line = {asked_place[BANK-1:BANK_X], |asks[3:2], asked_place[BANK_X-1:0], asks[3] || asks[1]};

  logic             fills_word, ends_line;
  logic [LINE-1:0]  fill_line;
  logic [1:0]       fill_size;
  logic [63:0]      fill_word;
  logic [2:0]       fill_place;  // of the word in its line
  logic [COME-1:0]  come_q;      // lines that have come, and whose sample has not been read
  texture_answers #(
      .LINE     (LINE),
      .PORT_BITS(PORT_BITS),
      .WORD_BITS(64),
      .LINES    (REQUESTS)
  ) u_answers (
      .clk_i,
      .rst_ni,
      .power_on_ni,
      .room_o      (may_ask),
      .asks_i      (any_asks),
      .address_i   (asked_address),
      .size_i      (t_size_q),
      .line_i      (asked_line),
      .request_valid_o,
      .request_ready_i,
      .request_address_o,
      .request_beats_o,
      .answer_valid_i,
      .answer_ready_o,
      .answer_data_i,
      .word_valid_o(fills_word),
      .word_o      (fill_word),
      .line_o      (fill_line),
      .size_o      (fill_size),
      .place_o     (fill_place),
      .ends_line_o (ends_line),
      .idle_o      (answers_are_idle)
  );

  // ------------------------------------------------------------------------------------------------ samples that wait, texels
  logic [2:0]         waits_for;
  logic [2:0]         format;
  logic [TAIL-1:0]    tail;
  logic [2*WAY_X-1:0] at_x;
  logic [2*WAY_Y-1:0] at_y;
  logic [3:0]         parity, d_parity_q;
  logic               d_valid_q;
  logic [1:0]         d_odd_x_q;  // of the even and the odd column, the bit above the lowest
  logic [2:0]         d_format_q;
  logic [TAIL-1:0]    d_tail_q;
  fifo #(
      .WIDTH(3 + 2 * WAY_X + 2 * WAY_Y + 4 + 3 + TAIL),
      .DEPTH(IN_FLIGHT)
  ) u_waiting (
      .clk_i,
      .rst_ni,
      .valid_i(t_goes),
      .ready_o(waiting_ready),
      .data_i ({misses, t_way_x_q, t_way_y_q, t_parity_q, t_format_q, t_tail_q}),
      .valid_o(waiting_valid),
      .ready_i(reads),
      .data_o ({waits_for, at_x, at_y, parity, format, tail})
  );
  assign reads = waiting_valid && (!d_valid_q || code_ready_i) && come_q >= COME'(waits_for);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      come_q    <= '0;
      d_valid_q <= 1'b0;
    end else begin
      come_q    <= come_q + COME'(ends_line) - (reads ? COME'(waits_for) : '0);
      d_valid_q <= reads || (d_valid_q && !code_ready_i);
    end
  end
  always_ff @(posedge clk_i)
    if (reads) begin
      d_odd_x_q  <= {at_x[WAY_X], at_x[0]};
      d_parity_q <= parity;
      d_format_q <= format;
      d_tail_q   <= tail;
    end

  logic [127:0] texel;  // of the banks
  generate
    for (b = 0; b < 4; b++) begin : gen_texels
      localparam int X = b % 2;
      localparam int Y = b / 2;
      logic [31:0]     word, data;
      logic [15:0]     half;
      logic            is_row, row, pair;
      logic [LINE-1:0] line;
      // A word of 64 bits has two rows of bytes, a row of halves, or half a row; of its texels every second is the bank's.
      assign is_row = fill_size == 2'd0 || (fill_size == 2'd1 ? fill_place[0] : fill_place[1]) == 1'(Y);
      assign row    = fill_size == 2'd0 ? fill_place[0] : fill_size == 2'd1 ? fill_place[1] : fill_place[2];
      assign pair   = fill_size == 2'd2 && fill_place[0];
      assign data   = fill_size == 2'd0 ? {16'd0, fill_word[8*(4*Y+X+2)+:8], fill_word[8*(4*Y+X)+:8]} :
                      fill_size == 2'd1 ? {fill_word[16*(X+2)+:16], fill_word[16*X+:16]} : fill_word[32*X+:32];
      assign line   = {at_y[Y*WAY_Y+1+:LINE_Y], at_x[X*WAY_X+1+:LINE_X]};
      sram #(
          .WIDTH    (32),
          .DEPTH    (4 * LINES),
          .READS_OLD(0)
      ) u_data (
          .clk_i,
          .read_i         (reads),
          .read_address_i ({line, at_y[Y*WAY_Y], format == 3'd5 && at_x[X*WAY_X]}),
          .data_o         (word),
          .write_i        (fills_word && is_row),
          .write_address_i({fill_line, row, pair}),
          .data_i         (data)
      );
      assign half = d_format_q != 3'd0 && d_format_q != 3'd5 && d_odd_x_q[X] ? word[31:16] : word[15:0];
      assign texel[32*b+:32] = {word[31:16], half[15:8], d_format_q == 3'd0 && d_odd_x_q[X] ? half[15:8] : half[7:0]};
    end
    for (b = 0; b < 4; b++) begin : gen_corners
      logic [1:0] bank;
      assign bank = {d_parity_q[2+b/2], d_parity_q[b%2]};
      assign code_o[32*b+:32] = texel[32*bank+:32];
    end
  endgenerate
  assign code_valid_o  = d_valid_q;
  assign code_format_o = d_format_q;
  assign code_tail_o   = d_tail_q;

  assign idle_o = !t_valid_q && !waiting_valid && !d_valid_q && !sweeps_q && answers_are_idle;

endmodule
