// Texture cache: lines of 4x4 texels, direct mapped, non-blocking: on a miss only the sample that missed waits.
//
//   sample -> [tags] -> waiting samples -> [data RAM] -> code
//                '-> request .. memory .. answers -^
//
// A sample looks its line up and then waits in a queue, after a hit as well as a miss, so that the answers to misses
// have time to come (Igehy, Eldridge, Proudfoot 1998). Answers are written as they come, and always can be: each
// requested line takes the place of a line with no reader left. So a miss waits until the last sample that was found in
// the line's place has been read. The tags hold the number of that sample, counted in groups and modulo a power of two:
// a line that was last read long ago may appear to have a reader left, which costs a wait, and only if samples are
// still in the queue.
//
// Reset: as in texture_answers.sv. Specification: TextureCache of model/stages/texture_unit.hpp; times:
// model/engines/cycle/texture_timing.hpp.
module texture_cache #(
    parameter int LINES = 64,      // a power of two, at least 2
    parameter int PORT_BITS = 64,  // 16 to 128
    parameter int IN_FLIGHT = 32,  // samples in the queue; a power of two
    parameter int TAIL = 1,        // bits that go along with a sample
    parameter int LINE = $clog2(LINES)  // derived; not to be set
) (
    input logic clk_i,
    input logic rst_ni,
    input logic power_on_ni,

    // Samples
    input  logic            sample_valid_i,
    output logic            sample_ready_o,
    input  logic [27:0]     address_i,  // address of the line, 16 bytes
    input  logic [LINE-1:0] line_i,
    input  logic [3:0]      texel_i,    // place inside the line
    input  logic [2:0]      format_i,
    input  logic [TAIL-1:0] tail_i,

    input  logic drop_i,          // drops all lines; in a cycle in which no sample is in the tags or upstream of them
    output logic tags_are_empty_o,

    // Texels as they are stored, in order
    output logic            code_valid_o,
    input  logic            code_ready_i,
    output logic [31:0]     code_o,
    output logic [2:0]      code_format_o,
    output logic [TAIL-1:0] code_tail_o,

    // Memory: lines are read, beats come in their order
    output logic                 request_valid_o,
    input  logic                 request_ready_i,
    output logic [31:0]          request_address_o,
    output logic [5:0]           request_beats_o,
    input  logic                 answer_valid_i,
    output logic                 answer_ready_o,
    input  logic [PORT_BITS-1:0] answer_data_i,

    output logic hit_o,  // the sample that was looked up hit
    output logic miss_o,
    output logic idle_o
);

  localparam int NUMBER = 7;  // bits of a group's number, as many as fit next to a tag into a block RAM
  localparam int GROUP = 3;   // log2 of the samples in a group
  localparam int COUNT = NUMBER + GROUP;
  localparam int WORD_BITS = (PORT_BITS < 32) ? 32 : PORT_BITS;  // width of the RAM
  localparam int WORD = $clog2(WORD_BITS / 8);   // log2 of the bytes of a word
  localparam int WORDS = 6 - WORD;               // log2 of the words of a line of 64 bytes

  function automatic [1:0] size_of(input [2:0] format);  // log2 of the bytes of a texel
    size_of = (format == 3'd0) ? 2'd0 : (format == 3'd5) ? 2'd2 : 2'd1;
  endfunction

  // -------------------------------------------------------------------------------------------------------------------- tags
  logic              t_valid_q, t_enters, t_goes, is_occupied, may_take_any, may_take, is_below, is_above;
  logic              same_place_q, same_line_q;  // same place or line as the sample before
  logic [27:0]       t_address_q, tag;
  logic [LINE-1:0]   t_line_q;
  logic [3:0]        t_texel_q;
  logic [2:0]        t_format_q;
  logic [TAIL-1:0]   t_tail_q;
  logic [NUMBER-1:0] tag_group, last_group, group, oldest_group;
  logic              tag_valid, tag_fits, is_known;
  logic              sweeps_q;
  logic [LINE-1:0]   sweep_q;
  logic [LINE-1:0]   tag_write_line;
  logic [NUMBER+28:0] tag_new;
  logic [COUNT-1:0]  issued_q, read_q;  // samples that have left the tags; samples among them that have been read
  logic [COUNT-1:0]  last;              // number of the last sample that has left
  logic              waiting_ready, waiting_valid, reads;
  logic              may_ask, answers_are_idle;

  assign sample_ready_o   = (!t_valid_q || t_goes) && !sweeps_q;
  assign t_enters         = sample_valid_i && sample_ready_o;
  assign tags_are_empty_o = !t_valid_q;

  sram #(
      .WIDTH    (1 + 28 + NUMBER),
      .DEPTH    (LINES),
      .READS_OLD(0)
  ) u_tags (
      .clk_i,
      .read_i         (t_enters),
      .read_address_i (line_i),
      .data_o         ({tag_valid, tag, tag_group}),
      .write_i        (t_goes || sweeps_q),
      .write_address_i(tag_write_line),
      .data_i         (tag_new)
  );

  assign tag_write_line = sweeps_q ? sweep_q : t_line_q;
  assign tag_new        = {!sweeps_q, t_address_q, sweeps_q ? last_group : group};

  assign last         = issued_q - 1'b1;
  assign last_group   = last[COUNT-1:GROUP];
  assign group        = issued_q[COUNT-1:GROUP];
  assign oldest_group = read_q[COUNT-1:GROUP];
  assign is_occupied  = issued_q != read_q;
  assign is_known     = same_place_q ? same_line_q : tag_fits;
  same_word #(
      .WIDTH(29)
  ) u_tag_fits (
      .a_i   ({tag_valid, tag}),
      .b_i   ({1'b1, t_address_q}),
      .same_o(tag_fits)
  );
  // A miss may take the place: no sample in the queue was found in it. In numbers that wrap that is a number outside the oldest
  // one's to this one's, by two comparisons at once behind the RAM; where it is known without them, a bit above their operands
  // decides. The sample before is in the queue unless the queue is empty.
  assign may_take_any = may_ask && !is_occupied;
  assign is_below     = {!may_ask, tag_group} < {may_take_any, oldest_group};
  assign is_above     = {may_take_any, tag_group} > {!may_ask, group};
  assign may_take     = oldest_group > group ? is_below && is_above : is_below || is_above;
  assign t_goes       = t_valid_q && waiting_ready && (same_place_q ? same_line_q || may_take_any : tag_fits || may_take);
  assign hit_o        = t_goes && is_known;
  assign miss_o       = t_goes && !is_known;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      t_valid_q <= 1'b0;
      sweeps_q  <= 1'b1;
      sweep_q   <= '0;
      issued_q  <= '0;
      read_q    <= '0;
    end else begin
      t_valid_q <= t_enters || (t_valid_q && !t_goes);
      sweeps_q  <= drop_i || (sweeps_q && sweep_q != '1);
      sweep_q   <= drop_i ? '0 : sweep_q + LINE'(sweeps_q);
      if (t_goes) issued_q <= issued_q + 1'b1;
      if (reads) read_q <= read_q + 1'b1;
    end
  end
  always_ff @(posedge clk_i)
    if (t_enters) begin
      t_address_q  <= address_i;
      t_line_q     <= line_i;
      t_texel_q    <= texel_i;
      t_format_q   <= format_i;
      t_tail_q     <= tail_i;
      same_place_q <= t_goes && line_i == t_line_q;  // too late for the RAM
      same_line_q  <= address_i == t_address_q;
    end

  // -------------------------------------------------------------------------------------------------- requests and answers
  logic                 fills_word, ends_line, has_come;
  logic [LINE-1:0]      fill_line;
  logic [WORD_BITS-1:0] fill_word;
  logic [WORDS-1:0]     fill_place;
  logic [1:0]           fill_size;
  texture_answers #(
      .LINE     (LINE),
      .PORT_BITS(PORT_BITS),
      .WORD_BITS(WORD_BITS),
      .LINES    (IN_FLIGHT)  // each has a sample in the queue
  ) u_answers (
      .clk_i,
      .rst_ni,
      .power_on_ni,
      .room_o      (may_ask),
      .asks_i      (miss_o),
      .address_i   (t_address_q),
      .size_i      (size_of(t_format_q)),
      .line_i      (t_line_q),
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

  // Lines that have come, and whose sample has not been read.
  logic [$clog2(IN_FLIGHT):0] come_q;
  logic                       reads_miss;
  assign has_come = come_q != '0;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      come_q <= '0;
    end else begin
      come_q <= come_q + ($clog2(IN_FLIGHT) + 1)'(ends_line) - ($clog2(IN_FLIGHT) + 1)'(reads_miss);
    end
  end

  // --------------------------------------------------------------------------------------------------- samples that wait, data
  logic                 is_miss;
  logic [LINE-1:0]      line;
  logic [3:0]           texel;
  logic [2:0]           format;
  logic [TAIL-1:0]      tail;
  logic [5:0]           offset;  // in bytes
  logic [LINE+WORDS-1:0] data_read_address, data_write_address;
  logic [WORD_BITS-1:0] word;
  logic                 d_valid_q, d_ready;
  logic [WORD-1:0]      d_offset_q;
  logic [2:0]           d_format_q;
  logic [TAIL-1:0]      d_tail_q;
  fifo #(
      .WIDTH(1 + LINE + 4 + 3 + TAIL),
      .DEPTH(IN_FLIGHT)
  ) u_waiting (
      .clk_i,
      .rst_ni,
      .valid_i(t_goes),
      .ready_o(waiting_ready),
      .data_i ({!is_known, t_line_q, t_texel_q, t_format_q, t_tail_q}),
      .valid_o(waiting_valid),
      .ready_i(reads),
      .data_o ({is_miss, line, texel, format, tail})
  );
  assign d_ready    = !d_valid_q || code_ready_i;
  assign reads      = waiting_valid && d_ready && (!is_miss || has_come);
  assign reads_miss = reads && is_miss;
  assign offset     = 6'(texel) << size_of(format);
  assign data_read_address  = {line, offset[5:WORD]};
  assign data_write_address = {fill_line, fill_place};

  sram #(
      .WIDTH    (WORD_BITS),
      .DEPTH    (LINES << WORDS),
      .READS_OLD(0)
  ) u_data (
      .clk_i,
      .read_i         (reads),
      .read_address_i (data_read_address),
      .data_o         (word),
      .write_i        (fills_word),
      .write_address_i(data_write_address),
      .data_i         (fill_word)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) d_valid_q <= 1'b0;
    else d_valid_q <= reads || (d_valid_q && !code_ready_i);
  end
  always_ff @(posedge clk_i)
    if (reads) begin
      d_offset_q <= offset[WORD-1:0];
      d_format_q <= format;
      d_tail_q   <= tail;
    end

  // The texel in the word: a texel of 2 bytes begins at an even one, one of 4 at a multiple of 4.
  logic [31:0] whole;
  logic [15:0] half;
  generate
    if (WORD > 2) begin : gen_wholes
      assign whole = word[32*d_offset_q[WORD-1:2]+:32];
    end else begin : gen_whole
      assign whole = word;
    end
  endgenerate
  assign half          = d_offset_q[1] ? whole[31:16] : whole[15:0];
  assign code_o        = {whole[31:16], half[15:8], d_offset_q[0] ? half[15:8] : half[7:0]};
  assign code_valid_o  = d_valid_q;
  assign code_format_o = d_format_q;
  assign code_tail_o   = d_tail_q;

  assign idle_o = !t_valid_q && !waiting_valid && !d_valid_q && !sweeps_q && answers_are_idle;

endmodule
