// Texture tags: the lines present in a cache with four banks, and the lines requested from memory.
//
//   lines of a pass -> [tags] -> waiting passes -> pass, with all its lines present
//                         '-> request .. memory .. answers -> words of lines
//
// A pass is the unit of lookup: a sample, a sample on one of two levels, or samples that agree. Tags are in four banks,
// by the lowest bits of a block's column and row, so each bank looks up at most one line of a pass. A pass whose lines
// are all present takes a clock, one with n misses n clocks; misses are requested bank by bank, and the pass waits in
// the queue until all have come. Which line may be replaced, and the effect of a reset: as in texture_cache.sv.
//
// With two ways a block may lie in two places: the highest bit of a place's row, or of its column where that has more
// bits, is the way instead of a block bit. A miss replaces the way that was looked up longer ago, in the order of
// passes; so the way follows from the data alone. Levels then need no halves of their own. Specification: look_up() of
// model/stages/texture_unit.hpp; times: model/engines/cycle/texture_timing.hpp.
module texture_tags #(
    parameter int LINES = 64,            // a power of two, at least 16
    parameter int WAYS = 1,              // 1 or 2
    parameter int PORT_BITS = 64,        // 16, 32 or 64
    parameter int IN_FLIGHT = 32,        // passes in the queue; a power of two
    parameter int REQUESTS = 16,         // lines in flight; a power of two
    parameter int CARRIED = 1,           // bits that go along with a pass
    parameter int SIDE_BITS = 12,        // log2 of the longest side, texels
    parameter int LINE = $clog2(LINES),  // derived; not to be set, like BLOCK
    parameter int BLOCK = SIDE_BITS - 2  // derived: bits of a block's column and row
) (
    input logic clk_i,
    input logic rst_ni,
    input logic power_on_ni,

    // Passes: which banks they use, column and row lowest first; column and row of the even and the odd block
    input  logic               pass_valid_i,
    output logic               pass_ready_o,
    input  logic [3:0]         used_i,
    input  logic [2*BLOCK-1:0] block_x_i,
    input  logic [2*BLOCK-1:0] block_y_i,
    input  logic [CARRIED-1:0] carried_i,

    // Their level: address of the first line, 16 bytes, and log2 of the lines in a row
    input logic [23:0] offset_i,
    input logic [3:0]  row_i,
    input logic        is_odd_i,

    // Constants of the texture: they stay while passes are in the tags or upstream of them
    input logic [25:0] base_i,
    input logic [1:0]  size_i,
    input logic        shares_i,  // odd levels use one half of each bank, even levels the other

    input  logic drop_i,
    output logic tags_are_empty_o,

    // The pass that leaves the tags in this cycle: which of its lines were missing
    output logic               looked_up_o,
    output logic [3:0]         lacks_o,
    output logic [CARRIED-1:0] looked_up_carried_o,
    output logic               miss_o,  // a line has been requested

    // Passes whose lines are present
    output logic               found_valid_o,
    input  logic               found_ready_i,
    output logic [CARRIED-1:0] found_carried_o,
    output logic [3:0]         found_ways_o,  // way of each bank's line; 0 with one way

    // A word of a line has come: size of the line (log2 of its bytes, less 4), line and place in it
    output logic            word_valid_o,
    output logic [63:0]     word_o,
    output logic [LINE-1:0] line_o,
    output logic [1:0]      size_o,
    output logic [2:0]      place_o,

    // Memory
    output logic                 request_valid_o,
    input  logic                 request_ready_i,
    output logic [31:0]          request_address_o,
    output logic [5:0]           request_beats_o,
    input  logic                 answer_valid_i,
    output logic                 answer_ready_o,
    input  logic [PORT_BITS-1:0] answer_data_i,

    output logic idle_o
);

  localparam int LINE_X = (LINE + 1) / 2;
  localparam int LINE_Y = LINE / 2;
  localparam int BANK_X = LINE_X - 1;     // bits of a line's number in its bank
  localparam int BANK_Y = LINE_Y - 1;
  localparam int BANK = BANK_X + BANK_Y;
  localparam int WAY_AT = (LINE % 2 == 0 ? BANK : BANK_X) - 1;  // the way bit of a place in its bank
  localparam int SET = BANK - WAYS + 1;
  localparam int SETS = LINES / 4 / WAYS;
  localparam int NUMBER = 7;
  localparam int GROUP = 3;
  localparam int COUNT = NUMBER + GROUP;
  localparam int COME = $clog2(4 * (IN_FLIGHT + 1) + 1);
  localparam logic [BANK_Y-1:0] HALF_OF_BANK = BANK_Y'(WAYS == 1) << (BANK_Y - 1);
  localparam logic [BANK-1:0] FIRST = ~(BANK'(WAYS - 1) << WAY_AT);  // mask of a place's bits without the way

  function automatic [SET-1:0] set_of(input [BANK-1:0] place);
    set_of = WAYS == 1 ? SET'(place) : SET'(place >> (WAY_AT + 1) << WAY_AT) | SET'(place & BANK'((1 << WAY_AT) - 1));
  endfunction

  // -------------------------------------------------------------------------------------------------------------------- tags
  logic               t_valid_q, t_enters, t_goes;
  logic [CARRIED-1:0] t_carried_q;
  logic [3:0]         t_used_q, known, referenced, missing, asks, asked_q, way;
  logic [4*28-1:0]    t_address_q;
  logic [4*BANK-1:0]  t_place_q;
  logic               sweeps_q, is_occupied, blocked, any_asks;
  logic [SET-1:0]     sweep_q;
  logic [COUNT-1:0]   issued_q, read_q;
  logic [COUNT-1:0]   last;
  logic [NUMBER-1:0]  last_group, group, oldest_group;
  logic               waiting_ready, waiting_valid, reads, may_ask, answers_are_idle;

  assign pass_ready_o     = (!t_valid_q || t_goes) && !sweeps_q;
  assign t_enters         = pass_valid_i && pass_ready_o;
  assign tags_are_empty_o = !t_valid_q;
  assign last             = issued_q - 1'b1;
  assign last_group       = last[COUNT-1:GROUP];
  assign group            = issued_q[COUNT-1:GROUP];
  assign oldest_group     = read_q[COUNT-1:GROUP];
  assign is_occupied      = issued_q != read_q;

  genvar b, w;
  generate
    for (b = 0; b < 4; b++) begin : gen_tags
      localparam int X = b % 2;
      localparam int Y = b / 2;
      logic                   same_place_q, same_line_q, writes, recent_way;  // the way of the previous line
      logic [WAYS-1:0]        is_there;
      logic [WAYS*NUMBER-1:0] groups;
      logic [27:0]            address;
      logic [BANK-1:0]        place;
      logic [SET-1:0]         set, write_set;
      assign address = {base_i, 2'd0} + (28'(block_y_i[Y*BLOCK+:BLOCK]) << row_i |
                                         28'(block_x_i[X*BLOCK+:BLOCK]) << size_i | 28'(offset_i));
      assign place   = {(block_y_i[Y*BLOCK+1+:BANK_Y] & ~(HALF_OF_BANK & {BANK_Y{shares_i}})) |
                        (HALF_OF_BANK & {BANK_Y{shares_i && is_odd_i}}), block_x_i[X*BLOCK+1+:BANK_X]} & FIRST;
      assign set       = set_of(place);
      assign writes    = (t_goes && t_used_q[b]) || sweeps_q;
      assign write_set = sweeps_q ? sweep_q : set_of(t_place_q[b*BANK+:BANK]);
      for (w = 0; w < WAYS; w++) begin : gen_ways
        logic              tag_valid, is_written, is_recent;  // state written in the cycle of the read
        logic [27:0]       tag;
        logic [NUMBER-1:0] tag_group;
        logic [NUMBER+28:0] tag_new;
        assign is_written = sweeps_q || way[b] == 1'(w);
        assign tag_new    = {!sweeps_q, t_address_q[b*28+:28], sweeps_q ? last_group : group};
        sram #(
            .WIDTH    (1 + 28 + NUMBER),
            .DEPTH    (SETS),
            .READS_OLD(0)
        ) u_tags (
            .clk_i,
            .read_i         (t_enters),
            .read_address_i (set),
            .data_o         ({tag_valid, tag, tag_group}),
            .write_i        (writes && is_written),
            .write_address_i(write_set),
            .data_i         (tag_new)
        );
        assign is_recent   = same_place_q && recent_way == 1'(w);
        assign is_there[w] = is_recent ? same_line_q : tag_valid && tag == t_address_q[b*28+:28];
        assign groups[w*NUMBER+:NUMBER] = is_recent ? last_group : tag_group;
      end
      if (WAYS == 1) begin : gen_one_way
        assign recent_way = 1'b0;
        assign way[b]     = 1'b0;
      end else begin : gen_two_ways
        logic recent_way_q, newer;  // the way of a set that was looked up last
        sram #(
            .WIDTH    (1),
            .DEPTH    (SETS),
            .READS_OLD(0)
        ) u_newer (
            .clk_i,
            .read_i         (t_enters),
            .read_address_i (set),
            .data_o         (newer),
            .write_i        (writes),
            .write_address_i(write_set),
            .data_i         (way[b] && !sweeps_q)
        );
        assign recent_way = recent_way_q;
        assign way[b]     = known[b] ? is_there[1] : same_place_q ? !recent_way_q : !newer;
        always_ff @(posedge clk_i) if (t_enters) recent_way_q <= way[b];
      end
      assign known[b]      = is_there != '0;
      assign referenced[b] = is_occupied && NUMBER'(group - groups[way[b]*NUMBER+:NUMBER]) <= NUMBER'(group - oldest_group);
      always_ff @(posedge clk_i)
        if (t_enters) begin
          t_address_q[b*28+:28]     <= address;
          t_place_q[b*BANK+:BANK]   <= place;
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
  assign looked_up_o         = t_goes;
  assign looked_up_carried_o = t_carried_q;
  assign lacks_o             = t_used_q & ~known;
  assign miss_o              = any_asks;
  always_comb begin
    misses = '0;
    for (int i = 0; i < 4; i++) misses = misses + 3'(lacks_o[i]);
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
      sweep_q   <= drop_i ? '0 : sweep_q + SET'(sweeps_q);
      issued_q  <= issued_q + COUNT'(t_goes);
      read_q    <= read_q + COUNT'(reads);
    end
  end
  always_ff @(posedge clk_i)
    if (t_enters) begin
      t_used_q    <= used_i;
      t_carried_q <= carried_i;
    end

  // -------------------------------------------------------------------------------------------------- requests and answers
  logic [27:0]     asked_address;
  logic [BANK-1:0] asked_place;
  logic [LINE-1:0] asked_line;
  always_comb begin
    asked_address = '0;
    asked_place   = '0;
    for (int i = 0; i < 4; i++)
      if (asks[i]) begin
        asked_address = t_address_q[i*28+:28];
        asked_place   = t_place_q[i*BANK+:BANK] | BANK'(way[i]) << WAY_AT;
      end
  end
  assign asked_line = {asked_place[BANK-1:BANK_X], |asks[3:2], asked_place[BANK_X-1:0], asks[3] || asks[1]};

  logic            ends_line;
  logic [COME-1:0] come_q;  // lines that have come, and whose pass has not been read
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
      .size_i,
      .line_i      (asked_line),
      .request_valid_o,
      .request_ready_i,
      .request_address_o,
      .request_beats_o,
      .answer_valid_i,
      .answer_ready_o,
      .answer_data_i,
      .word_valid_o,
      .word_o,
      .line_o,
      .size_o,
      .place_o,
      .ends_line_o (ends_line),
      .idle_o      (answers_are_idle)
  );

  // ---------------------------------------------------------------------------------------------------- passes that wait
  localparam int CARRIES_WAYS = (WAYS == 1) ? 0 : 4;
  localparam int WAITING = CARRIES_WAYS + 3 + CARRIED;
  logic [2:0]         waits_for;
  logic [WAITING-1:0] found;
  fifo #(
      .WIDTH(WAITING),
      .DEPTH(IN_FLIGHT)
  ) u_waiting (
      .clk_i,
      .rst_ni,
      .valid_i(t_goes),
      .ready_o(waiting_ready),
      .data_i (WAITING'({way, misses, t_carried_q})),
      .valid_o(waiting_valid),
      .ready_i(reads),
      .data_o (found)
  );
  assign {waits_for, found_carried_o} = found[3+CARRIED-1:0];
  assign found_ways_o = 4'(found >> (3 + CARRIED));
  assign found_valid_o = waiting_valid && come_q >= COME'(waits_for);
  assign reads         = found_valid_o && found_ready_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) come_q <= '0;
    else come_q <= come_q + COME'(ends_line) - (reads ? COME'(waits_for) : '0);
  end

  assign idle_o = !t_valid_q && !waiting_valid && !sweeps_q && answers_are_idle;

endmodule
