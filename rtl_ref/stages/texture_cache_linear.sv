// Texture cache for a linear filter: texture_cache.sv for the four texels around a sample's place.
//
// The four texels lie in one block of 4x4, or in two or four neighbouring blocks, whose lines texture_tags.sv looks up.
// Texels are in four banks as well, by the lowest bits of their own column and row: each bank gives one texel.
// Specification and times: those of texture_cache.sv.
module texture_cache_linear #(
    parameter int LINES = 64,      // a power of two, at least 16
    parameter int WAYS = 1,        // 1 or 2
    parameter int PORT_BITS = 64,  // 16, 32 or 64
    parameter int IN_FLIGHT = 32,  // samples in the queue; a power of two
    parameter int REQUESTS = 16,   // lines in flight; a power of two
    parameter int TAIL = 1,        // bits that go along with a sample
    parameter int SIDE_BITS = 12   // log2 of the longest side, texels
) (
    input logic clk_i,
    input logic rst_ni,
    input logic power_on_ni,

    // Samples: two columns and two rows, the first lowest
    input  logic                   sample_valid_i,
    output logic                   sample_ready_o,
    input  logic [2*SIDE_BITS-1:0] x_i,
    input  logic [2*SIDE_BITS-1:0] y_i,
    input  logic [TAIL-1:0]        tail_i,

    // Its level: address of the first line, 16 bytes, and log2 of the lines in a row
    input logic [23:0] offset_i,
    input logic [3:0]  row_i,
    input logic        is_odd_i,

    // Constants of the texture: they stay while samples are upstream of the tags
    input logic [2:0]  format_i,
    input logic [25:0] base_i,
    input logic [1:0]  size_i,
    input logic        shares_i,  // odd levels use one half of each bank, even levels the other

    input  logic drop_i,
    output logic tags_are_empty_o,

    // Four texels as stored: first row, second row
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

    output logic            looked_up_o,  // of a sample, or one of its passes
    output logic            hit_o,        // all its lines were present
    output logic [TAIL-1:0] looked_up_tail_o,
    output logic            miss_o,       // a line has been requested
    output logic idle_o
);

  localparam int LINE = $clog2(LINES);
  localparam int LINE_X = (LINE + 1) / 2;
  localparam int LINE_Y = LINE / 2;
  localparam int BLOCK = SIDE_BITS - 2;

  // ------------------------------------------------------------------------ which columns and rows are in which bank Of each
  // in each bank along one axis: is a block there, and which; is a texel there, and which.
  logic [1:0]             used_x, used_y;
  logic [2*BLOCK-1:0]     block_x, block_y;  // the even bank lowest
  logic [BLOCK-1:0]       first_x, first_y, second_x, second_y;
  assign first_x    = x_i[SIDE_BITS-1:2];
  assign second_x   = x_i[2*SIDE_BITS-1:SIDE_BITS+2];
  assign first_y    = y_i[SIDE_BITS-1:2];
  assign second_y   = y_i[2*SIDE_BITS-1:SIDE_BITS+2];
  assign used_x     = {first_x[0] || second_x[0], !first_x[0] || !second_x[0]};
  assign used_y     = {first_y[0] || second_y[0], !first_y[0] || !second_y[0]};
  assign block_x    = {first_x[0] ? first_x : second_x, first_x[0] ? second_x : first_x};
  assign block_y    = {first_y[0] ? first_y : second_y, first_y[0] ? second_y : first_y};

  localparam int WAY_AT = (LINE % 2 == 0 ? LINE : LINE_X) - 1;  // the way bit of a line's number: texture_tags.sv
  localparam logic [LINE-1:0] FIRST = ~(LINE'(WAYS - 1) << WAY_AT);

  // Read address of a texel's column or row: the line's part, and the bit above the bank's.
  localparam int WAY_X = LINE_X + 1;
  localparam int WAY_Y = LINE_Y + 1;
  localparam logic [WAY_Y-1:0] HALF_OF_WAY = WAY_Y'(WAYS == 1) << LINE_Y;  // the highest bit of a place along y
  logic [2*WAY_X-1:0] way_x;
  logic [2*WAY_Y-1:0] way_y;
  assign way_x = x_i[0] ? {x_i[1+:WAY_X], x_i[SIDE_BITS+1+:WAY_X]} : {x_i[SIDE_BITS+1+:WAY_X], x_i[1+:WAY_X]};
  assign way_y = ((y_i[0] ? {y_i[1+:WAY_Y], y_i[SIDE_BITS+1+:WAY_Y]} : {y_i[SIDE_BITS+1+:WAY_Y], y_i[1+:WAY_Y]}) &
                  ~{2{HALF_OF_WAY & {WAY_Y{shares_i}}}}) | {2{HALF_OF_WAY & {WAY_Y{shares_i && is_odd_i}}}};

  // ------------------------------------------------------------------------------------------------------- tags, then texels
  logic               fills_word, tags_are_idle;
  logic [LINE-1:0]    fill_line;
  logic [1:0]         fill_size;
  logic [63:0]        fill_word;
  logic [2:0]         fill_place;  // place of the word in its line
  logic [3:0]         lacks;
  logic               found_valid, reads;
  logic [2:0]         format;
  logic [TAIL-1:0]    tail;
  logic [2*WAY_X-1:0] at_x;
  logic [2*WAY_Y-1:0] at_y;
  logic [3:0]         parity, d_parity_q, found_ways;
  logic               d_valid_q;
  logic [1:0]         d_odd_x_q;  // the bit above the lowest, of the even and the odd column
  logic [2:0]         d_format_q;
  logic [TAIL-1:0]    d_tail_q;
  localparam int PLACES = 2 * WAY_X + 2 * WAY_Y + 4 + 3;
  logic [PLACES-1:0]  looked_up_places;
  texture_tags #(
      .LINES    (LINES),
      .WAYS     (WAYS),
      .PORT_BITS(PORT_BITS),
      .IN_FLIGHT(IN_FLIGHT),
      .REQUESTS (REQUESTS),
      .CARRIED  (PLACES + TAIL),
      .SIDE_BITS(SIDE_BITS)
  ) u_tags (
      .clk_i,
      .rst_ni,
      .power_on_ni,
      .pass_valid_i       (sample_valid_i),
      .pass_ready_o       (sample_ready_o),
      .used_i             ({{2{used_y[1]}} & used_x, {2{used_y[0]}} & used_x}),
      .block_x_i          (block_x),
      .block_y_i          (block_y),
      .carried_i          ({way_x, way_y, y_i[SIDE_BITS], y_i[0], x_i[SIDE_BITS], x_i[0], format_i, tail_i}),
      .offset_i,
      .row_i,
      .is_odd_i,
      .base_i,
      .size_i,
      .shares_i,
      .drop_i,
      .tags_are_empty_o,
      .looked_up_o,
      .lacks_o            (lacks),
      .looked_up_carried_o({looked_up_places, looked_up_tail_o}),
      .miss_o,
      .found_valid_o      (found_valid),
      .found_ready_i      (!d_valid_q || code_ready_i),
      .found_carried_o    ({at_x, at_y, parity, format, tail}),
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
  assign hit_o = looked_up_o && lacks == '0;
  assign reads = found_valid && (!d_valid_q || code_ready_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) d_valid_q <= 1'b0;
    else d_valid_q <= reads || (d_valid_q && !code_ready_i);
  end
  always_ff @(posedge clk_i)
    if (reads) begin
      d_odd_x_q  <= {at_x[WAY_X], at_x[0]};
      d_parity_q <= parity;
      d_format_q <= format;
      d_tail_q   <= tail;
    end

  logic [127:0] texel;  // one texel per bank
  genvar b;
  generate
    for (b = 0; b < 4; b++) begin : gen_texels
      localparam int X = b % 2;
      localparam int Y = b / 2;
      logic [31:0]     word, data;
      logic [15:0]     half;
      logic            is_row, row, pair;
      logic [LINE-1:0] line, place;
      logic            way;
      // A word of 64 bits has two rows of bytes, a row of halves, or half a row; every second of its texels belongs to
      // the bank.
      assign is_row = fill_size == 2'd0 || (fill_size == 2'd1 ? fill_place[0] : fill_place[1]) == 1'(Y);
      assign row    = fill_size == 2'd0 ? fill_place[0] : fill_size == 2'd1 ? fill_place[1] : fill_place[2];
      assign pair   = fill_size == 2'd2 && fill_place[0];
      assign data   = fill_size == 2'd0 ? {16'd0, fill_word[8*(4*Y+X+2)+:8], fill_word[8*(4*Y+X)+:8]} :
                      fill_size == 2'd1 ? {fill_word[16*(X+2)+:16], fill_word[16*X+:16]} : fill_word[32*X+:32];
      assign place  = {at_y[Y*WAY_Y+1+:LINE_Y], at_x[X*WAY_X+1+:LINE_X]};
      assign way    = found_ways[{at_y[Y*WAY_Y+1], at_x[X*WAY_X+1]}];
      assign line   = (place & FIRST) | LINE'(way) << WAY_AT;
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

  assign idle_o = tags_are_idle && !d_valid_q;

endmodule
