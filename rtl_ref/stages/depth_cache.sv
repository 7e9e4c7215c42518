// Depth cache: the depths of the blocks on the chip, and the inputs and outputs of the depth test.
//
//   cache_tags -> queue -> [depth RAM, clear value or answer] -> depth_test -> [the word is written] -> shading
//                                      '-- stamps of evicted blocks -> write_back
//
// Fragments wait for memory in the queue, in order. The fragment at the head is tested in the next cycle against its
// stored depths: from the RAM, the clear value, or the answer, which enters the RAM with the written depths. A stamp
// may come every cycle: the writes of the one before are forwarded. Of an evicted block, the stamps that may have been
// written are read, one a cycle, first the one that is about to be overwritten.
//
// With a late alpha test (LATE_ALPHA) late_test writes the depths of samples that alpha may still drop. A fragment
// waits for such stamps in its place, an eviction for those in its line, and a fragment that is not late for all of
// them. Specification: model/stages/block_cache.hpp; the times are those of model/engines/cycle/block_timing.hpp.
module depth_cache #(
    parameter int SAMPLES = raster_pkg::SAMPLES,  // derived; not to be set
    parameter int CODE = raster_pkg::STORED_DEPTH_BITS,  // a depth, the stencil above it, if there is one
    parameter int STAMP = raster_pkg::BLOCK_STAMP_BITS,
    parameter int SLOT = raster_pkg::VICTIM_SLOT_BITS
) (
    input logic clk_i,
    input logic rst_ni,

    // From cache_tags
    input  logic                         made_valid_i,
    output logic                         made_ready_o,
    input  raster_pkg::fragment_packet_t made_i,
    input  raster_pkg::tag_result_t      made_result_i,
    input  logic [CODE-1:0]              clear_depth_i,

    // From memory_answers: the stored depths for fragments that wait for them, in order; valid in the cycle after the
    // take
    input  logic                    answer_valid_i,
    output logic                    takes_answer_o,
    input  logic [SAMPLES*CODE-1:0] answer_i,

    // To context_ram: in the next cycle a fragment is at the head of the queue; its triangle's number
    output logic                                 comes_o,
    output logic [raster_pkg::TRIANGLE_BITS-1:0] coming_number_o,

    // To depth_test, which never waits; the stored depths follow in the next cycle, from the RAM, or held here
    output logic                         tested_valid_o,
    output raster_pkg::fragment_packet_t tested_o,
    output logic [SAMPLES*CODE-1:0]      stored_depth_o,
    output logic [SAMPLES-1:0]           is_held_o,
    output logic [SAMPLES*CODE-1:0]      held_depth_o,

    // From depth_test: the write of the fragment of the cycle before, and the new stored words of its samples that
    // are written or held
    input logic                      write_valid_i,
    input raster_pkg::write_packet_t write_i,
    input logic [SAMPLES*CODE-1:0]   word_i,

    // To shading: the tested stamp; at most SHADED_STAMPS are inside
    output logic                         stamp_valid_o,
    output raster_pkg::tested_stamp_t    stamp_o,
    output raster_pkg::fragment_packet_t stamp_fragment_o,
    output logic [SAMPLES-1:0]           stamp_writes_o,  // samples that get a colour, or whose alpha is tested
    input  logic                         stamp_leaves_i,  // color_write takes a stamp

    // From late_test, in that cycle: depths that it writes, if any are late
    input logic                        late_valid_i,
    input raster_pkg::tested_stamp_t   late_i,
    input logic [SAMPLES-1:0]          late_writes_i,
    input logic [SAMPLES*(CODE+1)-1:0] late_word_i,  // for each sample whether only the chip holds it, and the word

    // To write_back: an evicted block gets a slot, and its depths follow
    output logic                    evicts_o,
    output raster_pkg::eviction_t     eviction_o,
    output logic                      victim_valid_o,  // a stamp
    output raster_pkg::depth_victim_t victim_o,
    input  logic                    slot_free_i,     // the oldest block is in memory

    output logic idle_o  // the queue is empty, and nothing is between here and color_write
);

  localparam int PIXELS = raster_pkg::PIXELS;
  localparam int CODES = raster_pkg::ALL_FRAGMENT_BITS;  // bits of a pixel of a fragment; the lowest code is its depth
  localparam int Z = raster_pkg::DEPTH_CODE_BITS;
  localparam int STORED = raster_pkg::STORED_FRAGMENT_BITS;
  localparam int STAMPS = raster_pkg::BLOCK_STAMPS;
  localparam int LINE = raster_pkg::CACHE_LINE_BITS;
  localparam int LINE_X = raster_pkg::LINE_X_BITS;
  localparam int LINE_Y = raster_pkg::LINE_Y_BITS;
  localparam int BLOCK_X = raster_pkg::BLOCK_X_BITS;
  localparam int BLOCK_Y = raster_pkg::BLOCK_Y_BITS;
  localparam int VICTIMS = raster_pkg::CACHE_VICTIMS;
  localparam int PLACES = raster_pkg::SHADED_STAMPS;
  localparam int BEHIND = $clog2(PLACES + 1);
  localparam bit HAS_STENCIL = raster_pkg::STENCIL_BITS != 0;
  localparam bit BLENDS = raster_pkg::BLEND_LANES != 0;
  localparam bit LATE = raster_pkg::LATE_ALPHA != 0;
  localparam bit HAS_STATE = BLENDS || LATE || raster_pkg::DITHER_UNIT != 0;  // colours have operations that tokens set
  // Fragments wait with packed colours, where no other stage reads the colours.
  localparam bit PACKS = raster_pkg::COORDINATES == 0 && raster_pkg::BLEND_LANES == 0 && raster_pkg::DITHER_UNIT == 0 &&
                         raster_pkg::ALPHA_UNIT == 0;

  genvar s;

  // ------------------------------------------------------------------------------------------------------------- the queue
  raster_pkg::fragment_packet_t made_packed, item;
  raster_pkg::tag_result_t      found;  // result of the tag lookup, of the item at the head
  logic [STORED-1:0]            made_stored, item_stored;
  logic                         item_valid, goes, items_are_done;
  generate
    if (PACKS) begin : gen_packed
      localparam int COLOR = raster_pkg::STORED_COLOR_BITS;
      localparam int COLORS = raster_pkg::VERTEX_COLOR_BITS;
      logic [PIXELS*COLOR-1:0] made_colors;
      logic                    packs_now;
      register_gate u_gate (
          .enable_i(made_valid_i),
          .enable_o(packs_now)
      );
      for (s = 0; s < PIXELS; s++) begin : gen_rop
        logic [COLOR-1:0] color;
        rop u_rop (
            .rgba_i (made_i.code[s*CODES+Z+:COLORS]),
            .color_o(color)
        );
        assign made_colors[s*COLOR+:COLOR] = packs_now ? color : '0;
      end
      always_comb begin
        made_packed = made_i;
        for (int i = 0; i < PIXELS; i++)
          if (i != 0 || !HAS_STENCIL || made_i.kind != raster_pkg::PRIMITIVE_KIND_STATE)  // its word is in pixel 0
            made_packed.code[i*CODES+Z+:COLORS] = COLORS'(made_colors[i*COLOR+:COLOR]);
      end
    end else begin : gen_whole
      assign made_packed = made_i;
    end
  endgenerate
  stored_fragment u_stored (
      .fragment_i(made_packed),
      .bits_o    (made_stored),
      .bits_i    (item_stored),
      .fragment_o(item)
  );
  // Depths and colours are not read before the test, and with several samples per pixel are most of an item.
  localparam int FURTHER = PIXELS * (raster_pkg::MSAA_SAMPLES - 1) * Z;
  localparam int NUMBER = raster_pkg::STORE_CONSTANTS_SEPARATELY != 0 ? raster_pkg::TRIANGLE_BITS : 0;
  localparam int NUMBER_AT = STORED - raster_pkg::FRAGMENT_HEADER_BITS - NUMBER;
  localparam int IN_BLOCK_RAM = raster_pkg::QUEUE_BLOCK_RAM != 0 ? NUMBER_AT :
                                FURTHER != 0 ? FURTHER + PIXELS * CODES : 0;
  logic [raster_pkg::TAG_RESULT_BITS+STORED-IN_BLOCK_RAM-1:0] coming;
  registered_fifo #(
      .WIDTH (raster_pkg::TAG_RESULT_BITS + STORED),
      .DEPTH (raster_pkg::CACHE_QUEUE),
      .STORED(IN_BLOCK_RAM)
  ) u_items (
      .clk_i,
      .rst_ni,
      .valid_i   (made_valid_i),
      .ready_o   (made_ready_o),
      .data_i    ({made_result_i, made_stored}),
      .valid_o   (item_valid),
      .ready_i   (goes),
      .data_o    ({found, item_stored}),
      .comes_o,
      .coming_o  (coming),
      .is_empty_o(items_are_done)
  );
  generate
    if (raster_pkg::STORE_CONSTANTS_SEPARATELY != 0) begin : gen_number
      assign coming_number_o = coming[NUMBER_AT-IN_BLOCK_RAM+:NUMBER];
    end else begin : gen_no_number
      logic unused;
      assign unused          = ^coming;
      assign coming_number_o = '0;
    end
  endgenerate

  // ----------------------------------------------------------------------------------------- the item that goes to the test
  logic              on_chip, in_memory, reads_victim, slot_free, is_again, leaves_line;
  logic [STAMPS-1:0] left_q, left, next, item_bit;  // stamps of the last eviction that are still to be read
  logic [LINE-1:0]   left_line_q;
  logic [SLOT:0]     taken_q;         // slots assigned so far
  logic [BEHIND-1:0] behind_q;        // stamps between here and color_write
  logic              waits_for_late;  // depths of late_test must come first
  logic              writes_word;     // the item may change a depth, or the stencil above it
  logic              tests_alpha, x1_late;  // by the register of the alpha test; the item in the test is late

  logic                    x1_valid_q, x1_writes_q;  // in the test; it may write the RAM
  raster_pkg::tag_result_t x1_q;
  logic                    x1_on_chip;

  assign slot_free    = taken_q != (SLOT + 1)'(VICTIMS);
  assign item_bit     = STAMPS'(1) << found.stamp;
  assign on_chip      = found.source == raster_pkg::DEPTH_SOURCE_CHIP;
  assign in_memory    = found.source == raster_pkg::DEPTH_SOURCE_MEMORY;
  assign is_again     = x1_valid_q && on_chip && x1_q.line == found.line && x1_q.stamp == found.stamp;  // same stamp
  assign leaves_line  = x1_valid_q && x1_q.line == found.line && x1_writes_q;
  assign goes         = item_valid && !waits_for_late && (!found.evicts || (left_q == '0 && slot_free && !leaves_line)) &&
                        (!on_chip || left_q == '0) && (!in_memory || answer_valid_i) &&
                        (behind_q != BEHIND'(PLACES) || (stamp_leaves_i && raster_pkg::COORDINATES == 0));
  assign left         = evicts_o ? found.depth : left_q;
  assign next         = goes && (found.evicts || left_line_q == found.line) && (left & item_bit) != '0 ? item_bit : raster_pkg::lowest_stamp(left);
  assign reads_victim = left != '0;
  assign takes_answer_o  = goes && in_memory;
  assign tested_valid_o  = goes;
  assign tested_o        = item;
  assign idle_o          = items_are_done && behind_q == '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      left_q     <= '0;
      x1_valid_q <= 1'b0;
      taken_q    <= '0;
      behind_q   <= '0;
    end else begin
      left_q     <= left & ~next;
      x1_valid_q <= goes;
      taken_q    <= taken_q + (SLOT + 1)'(evicts_o) - (SLOT + 1)'(slot_free_i);
      behind_q   <= behind_q + BEHIND'(goes) - BEHIND'(stamp_leaves_i);
    end
  end

  always_ff @(posedge clk_i) begin
    if (evicts_o) left_line_q <= found.line;
    x1_q        <= found;
    x1_writes_q <= item.mask != '0 && !(tests_alpha && writes_word) &&
                   (writes_word || (!on_chip && found.source != raster_pkg::DEPTH_SOURCE_NONE));
  end
  generate
    if (HAS_STENCIL) begin : gen_writes_word
      assign writes_word = item.state.depth_write || item.state.writes_stencil;
    end else begin : gen_writes_depth
      assign writes_word = item.state.depth_write;
    end
  endgenerate

  // An evicted block.
  logic            v_valid_q, v_last_q, v_fills_q, fills_q;  // a stamp of it has been read
  logic [STAMP-1:0] v_stamp_q;
  logic [SLOT-1:0] v_slot_q, slot_q;  // slot of the next block
  logic [LINE+STAMP-1:0] depth_read_address;
  logic [LINE-1:0] line_above_x;
  assign depth_read_address = {left_q != '0 ? left_line_q : found.line, reads_victim ? raster_pkg::stamp_number(next) : found.stamp};
  assign line_above_x         = found.line >> LINE_X;
  assign evicts_o             = goes && found.evicts;
  assign eviction_o.slot       = slot_q;
  assign eviction_o.fills      = found.fills;
  assign eviction_o.block.x     = (BLOCK_X'(found.tag_x) << LINE_X) | (BLOCK_X'(found.line) & BLOCK_X'((1 << LINE_X) - 1));
  assign eviction_o.block.y     = (BLOCK_Y'(found.tag_y) << LINE_Y) | BLOCK_Y'(line_above_x);
  assign eviction_o.block.depth = found.depth;
  assign eviction_o.block.color = found.color;
  assign victim_valid_o       = v_valid_q;
  assign victim_o.last         = v_last_q;
  assign victim_o.slot         = v_slot_q;
  assign victim_o.stamp        = v_stamp_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      v_valid_q <= 1'b0;
      slot_q    <= '0;
    end else begin
      v_valid_q <= reads_victim;
      slot_q    <= slot_q + SLOT'(evicts_o);
    end
  end
  always_ff @(posedge clk_i) begin
    if (evicts_o) fills_q <= found.fills[0];
    v_fills_q <= evicts_o ? found.fills[0] : fills_q;
    v_stamp_q <= raster_pkg::stamp_number(next);
    v_slot_q  <= evicts_o ? slot_q : slot_q - 1'b1;
    v_last_q  <= left == next;
  end

  // The depth RAM: for each sample its code, and whether only the chip holds it. The stored depths of a stamp come from
  // there, from the answer, or stand in a register as it enters the test: the clear value, or the write made while the
  // RAM is read.
  assign x1_on_chip = x1_q.source == raster_pkg::DEPTH_SOURCE_CHIP;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_depth
      logic [CODE-1:0] code, held_q;
      logic            dirty, writes, is_forwarded, in_ram_q;
      logic [CODE:0]   word;
      assign is_forwarded = is_again && writes;  // not from a late fragment: no later fragment of its place passes it
      always_ff @(posedge clk_i) begin
        in_ram_q <= on_chip && !is_forwarded;
        held_q   <= is_again ? word_i[s*CODE+:CODE] : clear_depth_i;
      end
      assign writes = write_i.write_depth[s] || (!x1_on_chip && x1_q.source != raster_pkg::DEPTH_SOURCE_NONE);
      assign word = late_valid_i ? late_word_i[s*(CODE+1)+:CODE+1] : {write_i.write_depth[s], word_i[s*CODE+:CODE]};
      assign is_held_o[s]                 = !in_ram_q;
      assign stored_depth_o[s*CODE+:CODE] = code;
      assign held_depth_o[s*CODE+:CODE]   = x1_q.source == raster_pkg::DEPTH_SOURCE_MEMORY ? answer_i[s*CODE+:CODE] : held_q;
      sram #(
          .WIDTH    (CODE + 1),
          .DEPTH    (1 << (LINE + STAMP)),
          .READS_OLD(0)
      ) u_depth (
          .clk_i,
          .read_i         (reads_victim || goes),
          .read_address_i (depth_read_address),
          .data_o         ({dirty, code}),
          .write_i        (late_valid_i ? late_writes_i[s] : write_valid_i && writes && !x1_late),
          .write_address_i(late_valid_i ? {late_i.line, late_i.stamp} : {x1_q.line, x1_q.stamp}),
          .data_i         (word)
      );
      assign victim_o.strobe[s] = v_fills_q || dirty;
      assign victim_o.depth[s*CODE+:CODE] = code;
    end
  endgenerate

  // ------------------------------------------------------------------------------------- after the test, towards shading
  raster_pkg::fragment_packet_t x1_item_q;
  always_ff @(posedge clk_i) x1_item_q <= item;
  assign stamp_valid_o        = x1_valid_q;
  assign stamp_fragment_o     = x1_item_q;
  assign stamp_o.line         = x1_q.line;
  assign stamp_o.stamp        = x1_q.stamp;
  assign stamp_o.starts_color = x1_q.starts_color;
  assign stamp_o.mask         = write_i.write_color & {SAMPLES{write_valid_i}};
  assign stamp_o.evicts       = x1_q.evicts;
  assign stamp_o.fills        = x1_q.fills[1];
  assign stamp_o.evicted      = x1_q.color;
  generate
    if (HAS_STATE) begin : gen_state
      assign stamp_o.sets_state     = x1_valid_q && x1_item_q.kind == raster_pkg::PRIMITIVE_KIND_STATE;
      assign stamp_o.state_register = x1_item_q.state.depth_test;
      assign stamp_o.state          = x1_item_q.code[31:0];
    end
    if (BLENDS) begin : gen_color_source
      assign stamp_o.color_source = x1_q.color_source;
    end
  endgenerate

  // Late writes.
  logic [SAMPLES-1:0] looked_at;  // samples that the alpha test may keep from being written
  assign stamp_writes_o = {SAMPLES{write_valid_i}} & (tests_alpha ? looked_at : write_i.write_color);
  generate
    if (HAS_STENCIL) begin : gen_marked
      assign looked_at = write_i.passed | write_i.write_depth;
    end else begin : gen_passed
      assign looked_at = write_i.passed;
    end
    if (LATE) begin : gen_late
      // Stamps in flight, told apart by the lowest bits of their line.
      localparam int NEAR = LINE < 4 ? LINE : 4;
      localparam int PLACED = 1 << (NEAR + STAMP);
      logic [PLACED-1:0] pending_q, sets, clears;
      logic [STAMPS-1:0] pending_here;  // late stamps in the item's line
      logic [BEHIND-1:0] late_behind_q;
      logic              tests_alpha_q, is_late, enters, x1_writes_word;
      assign is_late        = tests_alpha_q && writes_word && item.mask != '0;
      assign pending_here   = pending_q[{found.line[NEAR-1:0], {STAMP{1'b0}}}+:STAMPS];
      assign waits_for_late = (item.mask != '0 && (is_late ? (pending_here & item_bit) != '0 : late_behind_q != '0)) ||
                              (found.evicts && pending_here != '0);
      assign enters = goes && is_late;
      assign sets   = enters ? PLACED'(1) << {found.line[NEAR-1:0], found.stamp} : '0;
      assign clears = late_valid_i ? PLACED'(1) << {late_i.line[NEAR-1:0], late_i.stamp} : '0;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          pending_q     <= '0;
          late_behind_q <= '0;
          tests_alpha_q <= 1'b0;
        end else begin
          pending_q     <= (pending_q & ~clears) | sets;
          late_behind_q <= late_behind_q + BEHIND'(enters) - BEHIND'(late_valid_i);
          if (goes && item.kind == raster_pkg::PRIMITIVE_KIND_STATE &&
              item.state.depth_test == raster_pkg::STATE_REGISTER_ALPHA_TEST)
            tests_alpha_q <= item.code[2:0] != raster_pkg::DEPTH_FUNC_ALWAYS || (raster_pkg::MSAA_SAMPLES > 1 && item.code[11]);
        end
      end
      assign tests_alpha = tests_alpha_q;
      assign x1_late     = tests_alpha_q && x1_writes_word;
      if (HAS_STENCIL) begin : gen_changes
        assign stamp_o.changes = write_i.write_depth;
        assign x1_writes_word  = x1_item_q.state.depth_write || x1_item_q.state.writes_stencil;
      end else begin : gen_depths
        assign x1_writes_word = x1_item_q.state.depth_write;
      end
      assign stamp_o.is_late    = write_valid_i && x1_late;
      assign stamp_o.on_chip    = x1_on_chip;
      assign stamp_o.is_counted = write_valid_i && (x1_item_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE || x1_item_q.kind[2]);
      assign stamp_o.writes     = x1_item_q.state.depth_write || x1_item_q.state.color_write;
      assign stamp_o.passed     = write_i.passed;
      assign stamp_o.word       = word_i;
      for (s = 0; s < SAMPLES; s++) begin : gen_stored
        assign stamp_o.stored[s*CODE+:CODE] = is_held_o[s] ? held_depth_o[s*CODE+:CODE] : stored_depth_o[s*CODE+:CODE];
      end
    end else begin : gen_early
      assign waits_for_late = 1'b0;
      assign tests_alpha    = 1'b0;
      assign x1_late        = 1'b0;
    end
  endgenerate

endmodule
