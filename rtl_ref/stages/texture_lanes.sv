// Texture lanes: the texels of four samples at a time, nearest or linear, on one level.
//
//   groups -> [queue] -> passes of samples that agree -> texture_tags -> texels of 16 banks -> texture_filter, four -> texels
//
// Texels lie in 16 banks, by the two lowest bits of their columns and rows; a bank gives one texel a clock, of whichever of the
// (up to four) lines. Lines lie in four, by the lowest bits of their blocks'. So of each axis a pass has one line for each lowest
// bit of a block, and each two lowest bits of a texel say which of the two. Samples agree where that holds along both axes; those
// of a group that do not go one pass behind the other. What a stamp shows at one texel a pixel, or larger, agrees.
// Specification: take_group() of model/stages/texture_unit.hpp; times: model/engines/cycle/texture_timing.hpp.
module texture_lanes #(
    parameter int LINEAR = 0,
    parameter int SIDE_BITS = 12,
    parameter int AHEAD = 16,      // groups
    parameter int LINES = 64,      // a power of two, at least 16
    parameter int WAYS = 1,        // 1 or 2
    parameter int PORT_BITS = 64,  // 16, 32 or 64
    parameter int IN_FLIGHT = 32,  // passes that wait; a power of two
    parameter int TAIL = 1         // bits that go along with a group
) (
    input logic clk_i,
    input logic rst_ni,
    input logic power_on_ni,

    // Groups of samples, of which some live: texels, x lowest; no more than AHEAD between here and pops_o
    input  logic                     valid_i,
    input  logic [3:0]               live_i,
    input  logic [4*2*SIDE_BITS-1:0] texel_i,
    /* verilator lint_off UNUSEDSIGNAL */  // LINEAR 0
    input  logic [4*2*SIDE_BITS-1:0] next_i,
    input  logic [4*16-1:0]          part_i,
    /* verilator lint_on UNUSEDSIGNAL */
    input  logic [TAIL-1:0]          tail_i,
    output logic                     pops_o,  // one has left the queue

    // The texture: stays while samples are in front of the tags
    input logic [2:0]  format_i,
    input logic [25:0] base_i,
    input logic [1:0]  size_i,
    input logic [3:0]  row_i,

    input  logic drop_i,
    output logic tags_are_empty_o,

    // Passes: of which samples there are texels, and whether they are the last of their group
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

    output logic [2:0] sample_o,  // so many have been looked up
    output logic [2:0] hit_o,     // and of so many all lines were there
    output logic       miss_o,    // a line has been asked for
    output logic       idle_o
);

  localparam int LINE = $clog2(LINES);
  localparam int LINE_X = (LINE + 1) / 2;
  localparam int LINE_Y = LINE / 2;
  localparam int BANK_X = LINE_X - 1;
  localparam int BANK_Y = LINE_Y - 1;
  localparam int BLOCK = SIDE_BITS - 2;
  localparam int PARTS = (LINEAR != 0) ? 64 : 1;  // bits of what a filter is told
  localparam int ENDS = (LINEAR != 0) ? 2 : 1;    // texels of a sample along an axis
  localparam int TEXELS = 4 * ENDS * 2 * SIDE_BITS;

  function automatic [0:0] agree(input [SIDE_BITS-1:0] a, input [SIDE_BITS-1:0] b);
    agree = a[SIDE_BITS-1:2] == b[SIDE_BITS-1:2] || (a[2] != b[2] && a[1:0] != b[1:0]);
  endfunction

  // ------------------------------------------------------------------------------------------- which agree, as they come
  // Texel e of lane l along axis d: entering[((l*ENDS + e)*2 + d)*SIDE_BITS+:SIDE_BITS].
  logic [TEXELS-1:0] entering, waiting;
  logic [5:0]        agrees, agree_q;  // 0 and 1, 0 and 2, 1 and 2, 0 and 3, 1 and 3, 2 and 3
  genvar l, m, e, f, d;
  generate
    for (l = 0; l < 4; l++) begin : gen_entering
      assign entering[l*ENDS*2*SIDE_BITS+:2*SIDE_BITS] = texel_i[l*2*SIDE_BITS+:2*SIDE_BITS];
      if (LINEAR != 0) begin : gen_next
        assign entering[(l*ENDS+1)*2*SIDE_BITS+:2*SIDE_BITS] = next_i[l*2*SIDE_BITS+:2*SIDE_BITS];
      end
    end
    for (m = 1; m < 4; m++) begin : gen_second
      for (l = 0; l < m; l++) begin : gen_first
        logic [2*ENDS*ENDS-1:0] agree_at;
        for (e = 0; e < ENDS; e++) begin : gen_end
          for (f = 0; f < ENDS; f++) begin : gen_other_end
            for (d = 0; d < 2; d++) begin : gen_axis
              assign agree_at[(e*ENDS+f)*2+d] = agree(entering[((l*ENDS+e)*2+d)*SIDE_BITS+:SIDE_BITS],
                                                      entering[((m*ENDS+f)*2+d)*SIDE_BITS+:SIDE_BITS]);
            end
          end
        end
        assign agrees[m*(m-1)/2+l] = &agree_at;
      end
    end
  endgenerate

  logic                         found_valid, p_moves, p_ready, ends;
  logic [3:0]                   live, done_q, left, joins;
  logic [PARTS-1:0]             parts, entering_parts;
  logic [TAIL-1:0]              found_tail;
  /* verilator lint_off UNUSEDSIGNAL */  // there is room: those ahead are counted
  logic                         found_has_room;
  /* verilator lint_on UNUSEDSIGNAL */
  generate
    if (LINEAR != 0) begin : gen_parts
      assign entering_parts = part_i;
    end else begin : gen_no_parts
      assign entering_parts = '0;
    end
  endgenerate
  fifo #(
      .WIDTH(TEXELS + PARTS + 6 + 4 + TAIL),
      .DEPTH(AHEAD)
  ) u_groups (
      .clk_i,
      .rst_ni,
      .valid_i,
      .ready_o(found_has_room),
      .data_i ({entering, entering_parts, agrees, live_i, tail_i}),
      .valid_o(found_valid),
      .ready_i(pops_o),
      .data_o ({waiting, parts, agree_q, live, found_tail})
  );

  // -------------------------------------------------------------------------------------------------------- the next pass
  // The first that is left takes with it, in order, each that agrees with all before.
  assign left     = live & ~done_q;
  always_comb begin
    joins = left;
    for (int second = 1; second < 4; second++)
      for (int first = 0; first < second; first++)
        joins[second] = joins[second] && (agree_q[second*(second-1)/2+first] || !joins[first]);
  end
  assign ends     = joins == left;
  assign p_moves  = found_valid && p_ready;
  assign pops_o   = p_moves && ends;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) done_q <= '0;
    else if (p_moves) done_q <= ends ? '0 : done_q | joins;
  end

  // Of each axis the even and the odd block, and of which each column or row is; of each bank whether a sample has a texel there.
  logic [2*2*BLOCK-1:0] block;     // of x lowest, of it the even one
  logic [7:0]           odd;       // of x lowest
  logic [3:0]           used;
  logic [4*4*ENDS-1:0]  low;       // the two lowest bits of each texel, in their order
  logic [4*2*ENDS-1:0]  odd_texel;  // of each texel, whether its block is odd
  logic [15:0]          uses;       // of each lane which banks of lines
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
  logic [PARTS-1:0] p_parts_q;
  logic [TAIL-1:0]      p_tail_q;
  assign p_ready          = !p_valid_q || tags_ready;
  assign tags_are_empty_o = tags_are_empty && !p_valid_q;
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
      p_ends_q  <= ends;
      p_low_q   <= low;
      p_parts_q <= parts;
      p_tail_q  <= found_tail;
    end

  // ----------------------------------------------------------------------------------------------------------------- tags
  localparam int WAY_AT = (LINE % 2 == 0 ? LINE : LINE_X) - 1;  // of a line's number the bit that is the way: texture_tags.sv
  localparam logic [LINE-1:0] FIRST = ~(LINE'(WAYS - 1) << WAY_AT);
  localparam int PLACES = 2 * (BANK_X + BANK_Y);  // of the lines, what says where in their bank they lie
  localparam int SHAPE = 8 + 16 * ENDS + 4;     // odd, low, joins
  localparam int REST = 1 + 3 + PARTS + TAIL;
  logic               fills_word, tags_are_idle, looked_up, found, reads;
  logic [LINE-1:0]    fill_line;
  logic [1:0]         fill_size;
  logic [63:0]        fill_word;
  logic [2:0]         fill_place;  // of the word in its line
  logic [3:0]         lacks;
  logic [PLACES-1:0]  p_places, places;
  logic [3:0]         found_ways;
  logic [7:0]         t_odd, odd_at;
  logic [16*ENDS-1:0] t_low, low_at;
  logic [3:0]         t_joins, joins_at;
  logic               ends_at;
  logic [2:0]         format;
  logic [PARTS-1:0] parts_at;
  logic [TAIL-1:0]    tail;
  /* verilator lint_off UNUSEDSIGNAL */
  logic [PLACES-1:0]  t_places;
  logic [REST-1:0]    t_rest;
  /* verilator lint_on UNUSEDSIGNAL */
  logic               d_valid_q, d_ready;
  assign p_places = {p_block_q[3*BLOCK+1+:BANK_Y], p_block_q[2*BLOCK+1+:BANK_Y],
                     p_block_q[BLOCK+1+:BANK_X], p_block_q[1+:BANK_X]};
  texture_tags #(
      .LINES    (LINES),
      .WAYS     (WAYS),
      .PORT_BITS(PORT_BITS),
      .IN_FLIGHT(IN_FLIGHT),
      .CARRIED  (PLACES + SHAPE + REST),
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
      .carried_i          ({p_places, p_odd_q, p_low_q, p_joins_q, p_ends_q, format_i, p_parts_q, p_tail_q}),
      .offset_i           (24'd0),
      .row_i,
      .is_odd_i           (1'b0),
      .base_i,
      .size_i,
      .shares_i           (1'b0),
      .drop_i,
      .tags_are_empty_o   (tags_are_empty),
      .looked_up_o        (looked_up),
      .lacks_o            (lacks),
      .looked_up_carried_o({t_places, t_odd, t_low, t_joins, t_rest}),
      .miss_o,
      .found_valid_o      (found),
      .found_ready_i      (d_ready),
      .found_carried_o    ({places, odd_at, low_at, joins_at, ends_at, format, parts_at, tail}),
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

  // A sample has found all of its lines where none is lacking in a bank that it uses.
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
  always_comb begin
    sample_o = '0;
    hit_o    = '0;
    for (int lane = 0; lane < 4; lane++) begin
      sample_o = sample_o + 3'(looked_up && t_joins[lane]);
      hit_o    = hit_o + 3'(looked_up && t_joins[lane] && (t_uses[4*lane+:4] & lacks) == '0);
    end
  end

  // --------------------------------------------------------------------------------------------------------------- texels
  logic [16*ENDS-1:0] d_low_q;
  logic [3:0]         d_joins_q;
  logic               d_ends_q;
  logic [2:0]         d_format_q;
  logic [PARTS-1:0] d_parts_q;
  logic [TAIL-1:0]    d_tail_q;
  /* verilator lint_off UNUSEDSIGNAL */  // all four go together
  logic [3:0]         filter_ready;
  /* verilator lint_on UNUSEDSIGNAL */
  assign d_ready = !d_valid_q || filter_ready[0];
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) d_valid_q <= 1'b0;
    else d_valid_q <= reads || (d_valid_q && !filter_ready[0]);
  end
  always_ff @(posedge clk_i)
    if (reads) begin
      d_low_q    <= low_at;
      d_joins_q  <= joins_at;
      d_ends_q   <= ends_at;
      d_format_q <= format;
      d_parts_q  <= parts_at;
      d_tail_q   <= tail;
    end

  logic [16*32-1:0] code;  // of the banks, row by row
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

  // Of each lane the texels of its even and its odd column and row, then in their order. Of one texel a sample one alone.
  generate
    for (l = 0; l < 4; l++) begin : gen_lane
      logic [127:0] corner, banks;  // first row, second row; even row, odd row
      logic [3:0]   first, second;  // lowest bits of the first texel and of the next, x lowest
      logic [3:0]   high;           // of the even and of the odd texel the bit above: of columns lowest
      assign first  = d_low_q[l*4*ENDS+:4];
      assign second = d_low_q[l*4*ENDS+4*(ENDS-1)+:4];
      assign high   = {first[2] ? first[3] : second[3], first[2] ? second[3] : first[3],
                       first[0] ? first[1] : second[1], first[0] ? second[1] : first[1]};
      for (y = 0; y < 2; y++) begin : gen_banks
        logic [255:0] rows;  // two banks' columns each of rows y and y + 2
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
        localparam int ALONG = (l == 0) ? 5 + TAIL : 1;
        logic [ALONG-1:0] along, filtered;
        /* verilator lint_off UNUSEDSIGNAL */
        logic [95:0]      sum;
        logic             valid;
        /* verilator lint_on UNUSEDSIGNAL */
        texture_filter #(
            .LEVELS(0),
            .TAIL  (ALONG)
        ) u_filter (
            .clk_i,
            .rst_ni,
            .valid_i (d_valid_q),
            .ready_o (filter_ready[l]),
            .code_i  (corner),
            .format_i(d_format_q),
            .part_i  (d_parts_q[16*l+:16]),
            .tail_i  (along),
            .valid_o (valid),
            .ready_i (texel_ready_i),
            .sum_o   (sum),
            .texel_o (texel_o[32*l+:32]),
            .tail_o  (filtered)
        );
        if (l == 0) begin : gen_along
          assign along         = {d_joins_q, d_ends_q, d_tail_q};
          assign texel_valid_o = valid;
          assign {texel_lanes_o, texel_ends_o, texel_tail_o} = filtered;
        end else begin : gen_beside
          assign along = 1'b0;
          /* verilator lint_off UNUSEDSIGNAL */
          logic unused;
          assign unused = filtered[0];
          /* verilator lint_on UNUSEDSIGNAL */
        end
      end else begin : gen_nearest
        texture_decode u_decode (
            .code_i  (corner[31:0]),
            .format_i(d_format_q),
            .texel_o (texel_o[32*l+:32])
        );
        assign filter_ready[l] = texel_ready_i;
        /* verilator lint_off UNUSEDSIGNAL */
        logic unused;
        assign unused = &{corner, d_parts_q};
        /* verilator lint_on UNUSEDSIGNAL */
        if (l == 0) begin : gen_along
          assign texel_valid_o = d_valid_q;
          assign texel_lanes_o = d_joins_q;
          assign texel_ends_o  = d_ends_q;
          assign texel_tail_o  = d_tail_q;
        end
      end
    end
  endgenerate

  assign idle_o = !p_valid_q && tags_are_idle && !d_valid_q;

endmodule
