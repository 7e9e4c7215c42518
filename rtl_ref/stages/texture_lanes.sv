// Texture lanes: the texels of four samples at a time, nearest or linear, on one level or between two.
//
//   groups -> [queue] -> passes of samples that agree -> texture_tags -> texels of 16 banks -> texture_filter, four -> texels
//                  '-> texture_rounds -^ (FILTER 2)                      texture_blend, four (FILTER 2) -^
//
// Texels lie in 16 banks, by the two lowest bits of their columns and rows; a bank gives one texel a clock, from any of
// up to four lines. Lines lie in four banks, by the lowest bits of their blocks' columns and rows. So along each axis a
// pass has one line for each lowest bit of a block, and for each two lowest bits of a texel one of these two lines.
// Samples agree where that holds along both axes; samples of a group that do not agree go in successive passes. A stamp
// at one texel per pixel, or magnified, agrees. With levels all samples of a pass agree on one level, and a group
// repeats on the upper levels: the sum of the lower level waits in the lane's blend. Specification: take_group() of
// model/stages/texture_unit.hpp; times: model/engines/cycle/texture_timing.hpp.
module texture_lanes #(
    parameter int FILTER = 0,                 // 0 nearest, 1 linear as well, 2 levels as well
    parameter int REFERENCE_BITS = 24,        // for FILTER 2
    parameter int SIDE_BITS = 12,             // log2 of the longest side, texels
    parameter int AHEAD = 16,                 // groups that wait
    parameter int LINES = 64,                 // a power of two, at least 16
    parameter int WAYS = 1,                   // 1 or 2
    parameter int PORT_BITS = 64,             // 16, 32 or 64
    parameter int IN_FLIGHT = 32,             // passes in the queue; a power of two
    parameter int TAIL = 1,                   // bits that go along with a group
    parameter int BORDER = 0,                 // 1: texels may be the border's
    parameter int PLACE = REFERENCE_BITS + 8  // derived; not to be set
) (
    input logic clk_i,
    input logic rst_ni,
    input logic power_on_ni,

    // Groups of samples, some of them live: texels, x lowest; at most AHEAD between here and pops_o
    input  logic                     valid_i,
    input  logic [3:0]               live_i,
    input  logic [4*2*SIDE_BITS-1:0] texel_i,
    input  logic [4*2*SIDE_BITS-1:0] next_i,
    input  logic [4*16-1:0]          part_i,
    input  logic [4*4-1:0]           border_i,
    input  logic [4*2*PLACE-1:0]     coordinate_i,
    input  logic [15:0]              level_i,
    input  logic [31:0]              level_part_i,
    input  logic [3:0]               is_linear_i,
    input  logic [3:0]               is_between_i,
    input  logic [TAIL-1:0]          tail_i,
    output logic                     pops_o,  // a group has left the queue

    // Constants of the texture: they stay while samples are upstream of the tags
    input logic        sets_state_i,
    input logic [7:0]  log2_size_i,
    input logic [5:0]  wrap_i,
    input logic [3:0]  row_i,
    input logic        shares_i,
    input logic [2:0]  format_i,
    input logic [25:0] base_i,
    input logic [1:0]  size_i,
    input logic [31:0] border_color_i,  // it stays while samples are under way

    input  logic drop_i,
    output logic tags_are_empty_o,

    // Passes: the samples that get texels, and whether they are the last of their group
    output logic            texel_valid_o,
    input  logic            texel_ready_i,
    output logic [3:0]      texel_lanes_o,
    output logic            texel_ends_o,
    output logic [127:0]    texel_o,
    output logic [TAIL-1:0] texel_tail_o,

    // Memory
    output logic                 request_valid_o,
    input  logic                 request_ready_i,
    output logic [31:0]          request_address_o,
    output logic [5:0]           request_beats_o,
    input  logic                 answer_valid_i,
    output logic                 answer_ready_o,
    input  logic [PORT_BITS-1:0] answer_data_i,

    output logic [2:0] sample_o,  // samples looked up, on all of their levels
    output logic [2:0] hit_o,     // samples of these whose lines were all there
    output logic       miss_o,    // a line has been requested
    output logic       idle_o
);

  localparam int LINE = $clog2(LINES);
  localparam int LINE_X = (LINE + 1) / 2;
  localparam int LINE_Y = LINE / 2;
  localparam int BANK_X = LINE_X - 1;
  localparam int BANK_Y = LINE_Y - 1;
  localparam int BLOCK = SIDE_BITS - 2;
  localparam int LEVELS = (FILTER == 2) ? 1 : 0;
  localparam int LINEAR = (FILTER != 0) ? 1 : 0;
  localparam int LEVEL_PARTS = 32 + 4 + 1;  // weights of the upper levels; there are two levels; this is the second
  localparam int PART = 16 + 4 * BORDER;  // weights of a sample, and which of its texels are the border's
  localparam int PARTS = (LEVELS != 0) ? 4 * PART + LEVEL_PARTS : (LINEAR != 0) ? 4 * PART :
                         (BORDER != 0) ? 4 : 1;  // bits of the filters' inputs
  localparam int ENDS = (LINEAR != 0) ? 2 : 1;    // texels of a sample along an axis
  localparam int TEXELS = 4 * ENDS * 2 * SIDE_BITS;

  // ----------------------------------------------------------------------------- groups wait, or rounds of them; which agree
  // Texel e of lane l along axis d: waiting[((l*ENDS + e)*2 + d)*SIDE_BITS+:SIDE_BITS].
  logic [TEXELS-1:0] waiting;
  logic [5:0]        agree_q;
  logic              found_valid, found_moves, found_ends, p_moves, p_ready, ends, rounds_are_empty;
  logic [3:0]        live, waits, done_q, left, joins;  // live samples whose upper level comes later
  logic [1:0]        lowest;
  logic [PARTS-1:0]  parts;
  logic [TAIL-1:0]   found_tail;
  logic [23:0]       offset;
  logic [3:0]        row;
  logic              is_odd;
  logic              found_has_room;
  genvar l, e;
  generate
    if (LEVELS != 0) begin : gen_rounds
      logic               group_valid, is_second;
      logic [8*PLACE-1:0] group_coordinate;
      logic [15:0]        group_level;
      logic [31:0]        group_part, level_part;
      logic [3:0]         group_is_linear, group_is_between, group_live, is_between;
      logic [TAIL-1:0]    group_tail;
      logic [63:0]        part;
      logic [15:0]        border;
      logic [4*PART-1:0]  part_and_border;
      for (l = 0; l < 4; l++) begin : gen_part
        assign part_and_border[PART*l+:PART] = PART'({border[4*l+:4], part[16*l+:16]});
      end
      fifo #(
          .WIDTH(8 * PLACE + 16 + 32 + 12 + TAIL),
          .DEPTH(AHEAD)
      ) u_groups (
          .clk_i,
          .rst_ni,
          .valid_i,
          .ready_o(found_has_room),
          .data_i ({coordinate_i, level_i, level_part_i, is_linear_i, is_between_i, live_i, tail_i}),
          .valid_o(group_valid),
          .ready_i(pops_o),
          .data_o ({group_coordinate, group_level, group_part, group_is_linear, group_is_between, group_live, group_tail})
      );
      texture_rounds #(
          .REFERENCE_BITS(REFERENCE_BITS),
          .SIDE_BITS     (SIDE_BITS),
          .TAIL          (TAIL),
          .BORDER        (BORDER)
      ) u_rounds (
          .clk_i,
          .rst_ni,
          .valid_i     (group_valid),
          .ready_o     (pops_o),
          .live_i      (group_live),
          .coordinate_i(group_coordinate),
          .level_i     (group_level),
          .part_i      (group_part),
          .is_linear_i (group_is_linear),
          .is_between_i(group_is_between),
          .tail_i      (group_tail),
          .sets_state_i,
          .log2_size_i,
          .wrap_i,
          .size_i,
          .valid_o     (found_valid),
          .ready_i     (found_moves),
          .live_o      (live),
          .waits_o     (waits),
          .ends_o      (found_ends),
          .is_second_o (is_second),
          .texel_o     (waiting),
          .part_o      (part),
          .border_o    (border),
          .agree_o     (agree_q),
          .level_part_o(level_part),
          .is_between_o(is_between),
          .tail_o      (found_tail),
          .first_i     (lowest),
          .offset_o    (offset),
          .row_o       (row),
          .is_odd_o    (is_odd),
          .is_empty_o  (rounds_are_empty)
      );
      assign parts = {level_part, is_between, is_second, part_and_border};
      logic unused;
      assign unused = &border_i;
    end else begin : gen_groups
      logic [TEXELS-1:0] entering;
      logic [5:0]        agree;
      logic [PARTS-1:0]  entering_parts;
      for (l = 0; l < 4; l++) begin : gen_entering
        assign entering[l*ENDS*2*SIDE_BITS+:2*SIDE_BITS] = texel_i[l*2*SIDE_BITS+:2*SIDE_BITS];
        if (LINEAR != 0) begin : gen_next
          assign entering[(l*ENDS+1)*2*SIDE_BITS+:2*SIDE_BITS] = next_i[l*2*SIDE_BITS+:2*SIDE_BITS];
        end
      end
      if (LINEAR != 0) begin : gen_parts
        for (l = 0; l < 4; l++) begin : gen_part
          assign entering_parts[PART*l+:PART] = PART'({border_i[4*l+:4], part_i[16*l+:16]});
        end
      end else if (BORDER != 0) begin : gen_border
        for (l = 0; l < 4; l++) begin : gen_part
          assign entering_parts[l] = border_i[4*l] || border_i[4*l+2];
        end
      end else begin : gen_no_parts
        assign entering_parts = '0;
      end
      texture_agree #(
          .ENDS     (ENDS),
          .SIDE_BITS(SIDE_BITS)
      ) u_agree (
          .texel_i(entering),
          .agree_o(agree)
      );
      fifo #(
          .WIDTH(TEXELS + PARTS + 6 + 4 + TAIL),
          .DEPTH(AHEAD)
      ) u_groups (
          .clk_i,
          .rst_ni,
          .valid_i,
          .ready_o(found_has_room),
          .data_i ({entering, entering_parts, agree, live_i, tail_i}),
          .valid_o(found_valid),
          .ready_i(pops_o),
          .data_o ({waiting, parts, agree_q, live, found_tail})
      );
      assign pops_o           = found_moves;
      assign waits            = '0;
      assign found_ends       = 1'b1;
      assign offset           = '0;
      assign row              = row_i;
      assign is_odd           = 1'b0;
      assign rounds_are_empty = 1'b1;
      logic unused;
      assign unused = &{lowest, border_i, 1'b0};
    end
  endgenerate

  // -------------------------------------------------------------------------------------------------------- the next pass
  // The first sample left takes with it, in order, each sample that agrees with all before.
  assign left     = live & ~done_q;
  assign lowest   = left[0] ? 2'd0 : left[1] ? 2'd1 : left[2] ? 2'd2 : 2'd3;
  always_comb begin
    joins = left;
    for (int second = 1; second < 4; second++)
      for (int first = 0; first < second; first++)
        joins[second] = joins[second] && (agree_q[second*(second-1)/2+first] || !joins[first]);
  end
  assign ends        = joins == left;
  assign p_moves     = found_valid && p_ready;
  assign found_moves = p_moves && ends;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) done_q <= '0;
    else if (p_moves) done_q <= ends ? '0 : done_q | joins;
  end

  // For each axis the even and the odd block, and which of them each column or row uses; for each bank whether a sample
  // has a texel there.
  logic [2*2*BLOCK-1:0] block;     // x lowest, its even one lowest
  logic [7:0]           odd;       // x lowest
  logic [3:0]           used;
  logic [4*4*ENDS-1:0]  low;       // the two lowest bits of each texel, in their order
  logic [4*2*ENDS-1:0]  odd_texel;  // whether each texel's block is odd
  logic [15:0]          uses;       // banks of lines used by each lane
  generate
    for (l = 0; l < 4; l++) begin : gen_bits
      for (e = 0; e < 2 * ENDS; e++) begin : gen_texel
        assign low[(l*ENDS*2+e)*2+:2] = waiting[(l*ENDS*2+e)*SIDE_BITS+:2];
        assign odd_texel[l*ENDS*2+e]  = waiting[(l*ENDS*2+e)*SIDE_BITS+2];
      end
      texture_uses #(
          .ENDS(ENDS)
      ) u_uses (
          .odd_i (odd_texel[l*ENDS*2+:2*ENDS]),
          .uses_o(uses[4*l+:4])
      );
    end
  endgenerate
  always_comb begin
    block = '0;
    odd   = '0;
    used  = '0;
    for (int lane = 0; lane < 4; lane++) begin
      used = used | (uses[4*lane+:4] & {4{joins[lane]}});
      for (int n = 0; n < 2 * ENDS; n++) begin
        for (int bank = 0; bank < 2; bank++)
          block[(2*(n%2)+bank)*BLOCK+:BLOCK] = block[(2*(n%2)+bank)*BLOCK+:BLOCK] |
              (waiting[(lane*ENDS*2+n)*SIDE_BITS+2+:BLOCK] &
               {BLOCK{joins[lane] && odd_texel[lane*ENDS*2+n] == 1'(bank)}});
        for (int at = 0; at < 4; at++)
          odd[4*(n%2)+at] = odd[4*(n%2)+at] || (joins[lane] && odd_texel[lane*ENDS*2+n] &&
                                                low[(lane*ENDS*2+n)*2+:2] == 2'(at));
      end
    end
  end

  logic                 p_valid_q, p_ends_q, tags_ready, tags_are_empty;
  logic [2*2*BLOCK-1:0] p_block_q;
  logic [7:0]           p_odd_q;
  logic [3:0]           p_used_q, p_joins_q;
  logic [4*4*ENDS-1:0]  p_low_q;
  logic [3:0]           p_waits_q;
  logic [PARTS-1:0]     p_parts_q;
  logic [TAIL-1:0]      p_tail_q;
  logic [23:0]          p_offset_q;
  logic [3:0]           p_row_q;
  logic                 p_is_odd_q;
  assign p_ready          = !p_valid_q || tags_ready;
  assign tags_are_empty_o = tags_are_empty && !p_valid_q && rounds_are_empty;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) p_valid_q <= 1'b0;
    else p_valid_q <= p_moves || (p_valid_q && !tags_ready);
  end
  always_ff @(posedge clk_i)
    if (p_moves) begin
      p_block_q <= block;
      p_odd_q   <= odd;
      p_used_q  <= used;
      p_joins_q <= joins;
      p_waits_q <= joins & waits;
      p_ends_q  <= ends && found_ends;
      p_low_q   <= low;
      p_parts_q <= parts;
      p_tail_q  <= found_tail;
      if (LEVELS != 0) begin
        p_offset_q <= offset;
        p_row_q    <= row;
        p_is_odd_q <= is_odd;
      end
    end

  // ----------------------------------------------------------------------------------------------------------------- tags
  localparam int WAY_AT = (LINE % 2 == 0 ? LINE : LINE_X) - 1;  // the way bit of a line's number: texture_tags.sv
  localparam logic [LINE-1:0] FIRST = ~(LINE'(WAYS - 1) << WAY_AT);
  localparam int PLACES = 2 * (BANK_X + BANK_Y);  // bits that give the lines' places in their banks
  localparam int SHAPE = 8 + 16 * ENDS + 4 + 4;   // odd, low, joins, waits
  localparam int REST = 1 + 3 + TAIL;
  localparam logic [BANK_Y-1:0] HALF = BANK_Y'(WAYS == 1) << (BANK_Y - 1);  // half of a bank, for odd levels
  logic               fills_word, tags_are_idle, looked_up, found, reads;
  logic [LINE-1:0]    fill_line;
  logic [1:0]         fill_size;
  logic [63:0]        fill_word;
  logic [2:0]         fill_place;  // place of the word in its line
  logic [3:0]         lacks;
  logic [PLACES-1:0]  p_places, places;
  logic [3:0]         found_ways;
  logic [7:0]         t_odd, odd_at;
  logic [16*ENDS-1:0] t_low, low_at;
  logic [3:0]         t_joins, joins_at, t_waits, waits_at;
  logic               ends_at;
  logic [2:0]         format;
  logic [PARTS-1:0]   parts_at;
  logic [TAIL-1:0]    tail;
  logic [PLACES-1:0]  t_places;
  logic [PARTS-1:0]   t_parts;
  logic [REST-1:0]    t_rest;
  logic               d_valid_q, d_ready, shares;
  assign shares   = LEVELS != 0 && shares_i;
  assign p_places = {({p_block_q[3*BLOCK+1+:BANK_Y], p_block_q[2*BLOCK+1+:BANK_Y]} & ~{2{HALF & {BANK_Y{shares}}}}) |
                     {2{HALF & {BANK_Y{shares && p_is_odd_q}}}}, p_block_q[BLOCK+1+:BANK_X], p_block_q[1+:BANK_X]};
  texture_tags #(
      .LINES    (LINES),
      .WAYS     (WAYS),
      .PORT_BITS(PORT_BITS),
      .IN_FLIGHT(IN_FLIGHT),
      .CARRIED  (PLACES + SHAPE + PARTS + REST),
      .SIDE_BITS(SIDE_BITS)
  ) u_tags (
      .clk_i,
      .rst_ni,
      .power_on_ni,
      .pass_valid_i       (p_valid_q),
      .pass_ready_o       (tags_ready),
      .used_i             (p_used_q),
      .block_x_i          (p_block_q[2*BLOCK-1:0]),
      .block_y_i          (p_block_q[4*BLOCK-1:2*BLOCK]),
      .carried_i          ({p_places, p_odd_q, p_low_q, p_joins_q, p_waits_q, p_parts_q, p_ends_q, format_i, p_tail_q}),
      .offset_i           (LEVELS != 0 ? p_offset_q : 24'd0),
      .row_i              (LEVELS != 0 ? p_row_q : row_i),
      .is_odd_i           (LEVELS != 0 && p_is_odd_q),
      .base_i,
      .size_i,
      .shares_i           (shares),
      .drop_i,
      .tags_are_empty_o   (tags_are_empty),
      .looked_up_o        (looked_up),
      .lacks_o            (lacks),
      .looked_up_carried_o({t_places, t_odd, t_low, t_joins, t_waits, t_parts, t_rest}),
      .miss_o,
      .found_valid_o      (found),
      .found_ready_i      (d_ready),
      .found_carried_o    ({places, odd_at, low_at, joins_at, waits_at, parts_at, ends_at, format, tail}),
      .found_ways_o       (found_ways),
      .word_valid_o       (fills_word),
      .word_o             (fill_word),
      .line_o             (fill_line),
      .size_o             (fill_size),
      .place_o            (fill_place),
      .request_valid_o,
      .request_ready_i,
      .request_address_o,
      .request_beats_o,
      .answer_valid_i,
      .answer_ready_o,
      .answer_data_i,
      .idle_o             (tags_are_idle)
  );
  assign reads = found && d_ready;

  // A sample has found all of its lines where no bank that it uses lacks one; between two levels, on both levels.
  logic [4*2*ENDS-1:0] t_odd_texel;
  logic [15:0]         t_uses;
  generate
    for (l = 0; l < 4; l++) begin : gen_looked_up
      for (e = 0; e < 2 * ENDS; e++) begin : gen_texel
        logic [3:0] t_odd_at;
        assign t_odd_at = t_odd[4*(e%2)+:4];
        assign t_odd_texel[l*ENDS*2+e] = t_odd_at[t_low[(l*ENDS*2+e)*2+:2]];
      end
      texture_uses #(
          .ENDS(ENDS)
      ) u_uses (
          .odd_i (t_odd_texel[l*ENDS*2+:2*ENDS]),
          .uses_o(t_uses[4*l+:4])
      );
    end
  endgenerate
  logic [3:0] finds, misses_first_q;
  logic       is_second_look;
  generate
    for (l = 0; l < 4; l++) begin : gen_finds
      assign finds[l] = (t_uses[4*l+:4] & lacks) == '0;
      if (LEVELS != 0) begin : gen_first
        always_ff @(posedge clk_i) if (looked_up && t_waits[l]) misses_first_q[l] <= !finds[l];
      end else begin : gen_only
        assign misses_first_q[l] = 1'b0;
      end
    end
    if (LEVELS != 0) begin : gen_second_look
      assign is_second_look = t_parts[4*PART];
    end else begin : gen_only_look
      assign is_second_look = 1'b0;
    end
  endgenerate
  always_comb begin
    sample_o = '0;
    hit_o    = '0;
    for (int lane = 0; lane < 4; lane++) begin
      sample_o = sample_o + 3'(looked_up && t_joins[lane] && !t_waits[lane]);
      hit_o    = hit_o + 3'(looked_up && t_joins[lane] && !t_waits[lane] && finds[lane] &&
                            !(is_second_look && misses_first_q[lane]));
    end
  end

  // --------------------------------------------------------------------------------------------------------------- texels
  logic [16*ENDS-1:0] d_low_q;
  logic [3:0]         d_joins_q, d_waits_q;
  logic               d_ends_q;
  logic [2:0]         d_format_q;
  logic [PARTS-1:0]   d_parts_q;
  logic [TAIL-1:0]    d_tail_q;
  logic [3:0]         filter_ready;
  assign d_ready = !d_valid_q || filter_ready[0];
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) d_valid_q <= 1'b0;
    else d_valid_q <= reads || (d_valid_q && !filter_ready[0]);
  end
  always_ff @(posedge clk_i)
    if (reads) begin
      d_low_q    <= low_at;
      d_joins_q  <= joins_at;
      d_waits_q  <= waits_at;
      d_ends_q   <= ends_at;
      d_format_q <= format;
      d_parts_q  <= parts_at;
      d_tail_q   <= tail;
    end

  logic [16*32-1:0] code;  // one texel per bank, row by row
  genvar x, y;
  generate
    for (y = 0; y < 4; y++) begin : gen_row
      for (x = 0; x < 4; x++) begin : gen_bank
        logic              is_there;
        logic [31:0]       data;
        logic [BANK_X-1:0] place_x;
        logic [BANK_Y-1:0] place_y;
        logic              way;
        // A word of 64 bits has two rows of bytes, a row of halves, or half a row.
        assign is_there = fill_size == 2'd0 ? fill_place[0] == 1'(y / 2) : fill_size == 2'd1 ? fill_place[1:0] == 2'(y) :
                          fill_place == 3'(2 * y + x / 2);
        assign data  = fill_size == 2'd0 ? {24'd0, fill_word[8*(4*(y%2)+x)+:8]} :
                       fill_size == 2'd1 ? {16'd0, fill_word[16*x+:16]} : fill_word[32*(x%2)+:32];
        assign place_x = odd_at[x] ? places[BANK_X+:BANK_X] : places[0+:BANK_X];
        assign place_y = odd_at[4+y] ? places[2*BANK_X+BANK_Y+:BANK_Y] : places[2*BANK_X+:BANK_Y];
        assign way     = found_ways[{odd_at[4+y], odd_at[x]}];
        sram #(
            .WIDTH    (32),
            .DEPTH    (LINES),
            .READS_OLD(0)
        ) u_data (
            .clk_i,
            .read_i         (reads),
            .read_address_i (({place_y, odd_at[4+y], place_x, odd_at[x]} & FIRST) | LINE'(way) << WAY_AT),
            .data_o         (code[32*(4*y+x)+:32]),
            .write_i        (fills_word && is_there),
            .write_address_i(fill_line),
            .data_i         (data)
        );
      end
    end
  endgenerate

  // For each lane the texels of its even and its odd column and row, then in their order. With one texel per sample,
  // that texel alone.
  localparam int ALONG = 4 + 1 + TAIL + ((LEVELS != 0) ? 4 + LEVEL_PARTS : 0);  // bits through the filters with lane 0
  logic [ALONG-1:0] along, filtered;
  logic [3:0]       sum_ready;
  logic [3:0]       sum_joins, sum_leaves, sum_is_between;  // samples whose upper level does not come later
  logic [31:0]      sum_level_part;
  logic             sum_is_second;
  logic [TAIL:0]    sum_rest;
  generate
    if (LEVELS != 0) begin : gen_along_levels
      assign along = {d_parts_q[4*PART+:LEVEL_PARTS], d_joins_q, d_joins_q & ~d_waits_q, d_ends_q, d_tail_q};
      assign {sum_level_part, sum_is_between, sum_is_second, sum_joins, sum_leaves, sum_rest} = filtered;
    end else begin : gen_along_level
      assign along = {d_joins_q, d_ends_q, d_tail_q};
      assign {sum_level_part, sum_is_between, sum_is_second, sum_joins, sum_leaves, sum_rest} = '0;
      logic unused;
      assign unused = &d_waits_q;
    end
    for (l = 0; l < 4; l++) begin : gen_lane
      logic [127:0] corner, banks;  // first row, second row; even row, odd row
      logic [3:0]   first, second;  // lowest bits of the first and of the next texel, x lowest
      logic [3:0]   high;           // the next bit, of the even and of the odd texel: of columns lowest
      assign first  = d_low_q[l*4*ENDS+:4];
      assign second = d_low_q[l*4*ENDS+4*(ENDS-1)+:4];
      assign high   = {first[2] ? first[3] : second[3], first[2] ? second[3] : first[3],
                       first[0] ? first[1] : second[1], first[0] ? second[1] : first[1]};
      for (y = 0; y < 2; y++) begin : gen_banks
        logic [255:0] rows;  // columns of two banks each, of rows y and y + 2
        assign rows = {code[32*4*(y+2)+:128], code[32*4*y+:128]};
        for (x = 0; x < 2; x++) begin : gen_bank
          logic [31:0] lower, upper;
          assign lower = high[x] ? rows[32*(x+2)+:32] : rows[32*x+:32];
          assign upper = high[x] ? rows[32*(x+6)+:32] : rows[32*(x+4)+:32];
          assign banks[32*(2*y+x)+:32] = high[2+y] ? upper : lower;
        end
      end
      for (e = 0; e < 4; e++) begin : gen_corner
        logic is_odd_x, is_odd_y;
        assign is_odd_x = (e % 2 == 0) ? first[0] : second[0];
        assign is_odd_y = (e / 2 == 0) ? first[2] : second[2];
        assign corner[32*e+:32] = is_odd_y ? (is_odd_x ? banks[96+:32] : banks[64+:32]) :
                                             (is_odd_x ? banks[32+:32] : banks[0+:32]);
      end
      if (LINEAR != 0) begin : gen_linear
        localparam int BESIDE = (l == 0) ? ALONG : 1;
        logic [BESIDE-1:0] beside, came;
        logic [95:0]       sum;
        logic [31:0]       sum_texel;
        logic              sum_valid;
        texture_filter #(
            .LEVELS(LEVELS),
            .TAIL  (BESIDE),
            .BORDER(BORDER)
        ) u_filter (
            .clk_i,
            .rst_ni,
            .valid_i (d_valid_q),
            .ready_o (filter_ready[l]),
            .code_i  (corner),
            .format_i(d_format_q),
            .part_i  (d_parts_q[PART*l+:PART]),
            .border_i(border_color_i),
            .tail_i  (beside),
            .valid_o (sum_valid),
            .ready_i (sum_ready[0]),
            .sum_o   (sum),
            .texel_o (sum_texel),
            .tail_o  (came)
        );
        if (l == 0) begin : gen_along
          assign beside   = along;
          assign filtered = came;
        end else begin : gen_beside
          assign beside = 1'b0;
          logic unused;
          assign unused = came[0];
        end
        if (LEVELS != 0) begin : gen_blend
          localparam int KEPT = (l == 0) ? 5 + TAIL : 1;
          logic [KEPT-1:0] kept, leaving;
          logic            texel_valid;
          texture_blend #(
              .TAIL(KEPT)
          ) u_blend (
              .clk_i,
              .rst_ni,
              .valid_i     (sum_valid),
              .ready_o     (sum_ready[l]),
              .takes_i     (sum_joins[l]),
              .sum_i       (sum),
              .is_between_i(sum_is_between[l]),
              .is_first_i  (sum_leaves == '0),
              .is_second_i (sum_is_second),
              .part_i      (sum_level_part[8*l+:8]),
              .tail_i      (kept),
              .valid_o     (texel_valid),
              .ready_i     (texel_ready_i),
              .texel_o     (texel_o[32*l+:32]),
              .tail_o      (leaving)
          );
          if (l == 0) begin : gen_kept
            assign kept          = {sum_leaves, sum_rest};
            assign texel_valid_o = texel_valid;
            assign {texel_lanes_o, texel_ends_o, texel_tail_o} = leaving;
          end else begin : gen_not_kept
            assign kept = 1'b0;
            logic unused;
            assign unused = leaving[0];
          end
        end else begin : gen_level
          assign texel_o[32*l+:32] = sum_texel;
          assign sum_ready[l]      = texel_ready_i;
          if (l == 0) begin : gen_texels
            assign texel_valid_o = sum_valid;
            assign {texel_lanes_o, texel_ends_o, texel_tail_o} = filtered;
          end
        end
      end else begin : gen_nearest
        logic [31:0] decoded;
        texture_decode u_decode (
            .code_i  (corner[31:0]),
            .format_i(d_format_q),
            .texel_o (decoded)
        );
        if (BORDER != 0) begin : gen_border
          assign texel_o[32*l+:32] = d_parts_q[l] ? border_color_i : decoded;
        end else begin : gen_image
          assign texel_o[32*l+:32] = decoded;
        end
        assign filter_ready[l] = texel_ready_i;
        assign sum_ready[l]    = texel_ready_i;
        logic unused;
        assign unused = &{corner, d_parts_q, border_color_i};
        if (l == 0) begin : gen_along
          assign filtered      = along;
          assign texel_valid_o = d_valid_q;
          assign texel_lanes_o = d_joins_q;
          assign texel_ends_o  = d_ends_q;
          assign texel_tail_o  = d_tail_q;
        end
      end
    end
  endgenerate

  assign idle_o = rounds_are_empty && !p_valid_q && tags_are_idle && !d_valid_q;

endmodule
