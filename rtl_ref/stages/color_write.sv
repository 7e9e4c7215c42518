// Color write: tested and shaded stamps are written to the colour RAM, a clock later; an evicted block's colours are
// read out of it, a stamp a clock, each before it is overwritten.
//
// Two evictions may be under way. The RAM is read for the stamp written in this clock, if its old colours are still to
// be read, else for the older eviction. So no stamp waits for a read, and an eviction waits only if two are before it.
// A third eviction could overtake only the second; so the colours of an eviction are in their slot DELAY clocks after
// its begin, whatever follows, and are reported present then.
//
// Without blending colours are read only for write-back, and a stamp takes a clock. With blending a stamp also reads
// the stored colours of its samples, from the RAM and, for samples missing there, from the clear value or an answer of
// memory; it takes a clock for each group of BLEND_LANES samples that are blended, one at least, and writes two clocks
// after the read, in order. Writes in flight to these samples are newer than the RAM and forwarded, so that the same
// stamp may come every clock; a stamp that reads waits until the reads of an eviction are complete, and an eviction
// waits for the writes in flight to its line and a clock more. Samples are packed here, rounded or dithered; with
// LOGIC_UNIT a logic operation then takes all samples of a stamp in a clock, beside the lanes.
// Specification: model/stages/block_cache.hpp, rop.hpp; the times are those of model/engines/cycle/block_timing.hpp.
module color_write #(
    parameter int STAMPS = raster_pkg::BLOCK_STAMPS,  // derived; not to be set
    parameter int STAMP = raster_pkg::BLOCK_STAMP_BITS,
    parameter int LINE = raster_pkg::CACHE_LINE_BITS,
    parameter int SLOT = raster_pkg::VICTIM_SLOT_BITS
) (
    input logic clk_i,
    input logic rst_ni,

    // From depth_cache, through the shading stages
    input  logic                                                         stamp_valid_i,
    output logic                                                         stamp_ready_o,
    input  raster_pkg::tested_stamp_t                                    tested_i,
    input  logic [raster_pkg::SAMPLES-1:0]                               opaque_i,  // samples that alpha keeps
    input  logic [raster_pkg::SAMPLES*raster_pkg::SHADED_COLOR_BITS-1:0] color_i,
    input  logic [raster_pkg::STORED_COLOR_BITS-1:0]                     clear_color_i,

    // From memory_answers: stored colours, for stamps that wait for them
    input logic                                                         answer_valid_i,
    input logic [raster_pkg::SAMPLES*raster_pkg::STORED_COLOR_BITS-1:0] answer_i,  // answer taken last, from next clock
    output logic                              answer_ready_o,

    // An evicted stamp, in a slot for victims; and all stamps of the next eviction are there
    output logic                                                        victim_valid_o,
    output raster_pkg::color_victim_t                                   victim_o,
    output logic                                                        victim_ready_o,

    output logic idle_o  // everything is in the RAM
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int COLOR = raster_pkg::STORED_COLOR_BITS;
  localparam int SHADED = raster_pkg::SHADED_COLOR_BITS;
  localparam int LANES = raster_pkg::BLEND_LANES;
  localparam int ADDRESS = LINE + STAMP;

  logic [SAMPLES-1:0] mask;  // samples whose colour is written
  assign mask = tested_i.mask & opaque_i;

  // The stamp at the head: its eviction begins, it goes on to the RAM.
  logic              writes_all;  // it writes all samples into the RAM, uncovered ones as absent
  logic              is_busy;     // a write to its line is in flight
  logic              waits;       // for the stored colours that it blends with
  logic              ends;        // leaves in this clock
  logic              goes, started_q, starts;
  logic              second_begun_q;  // two evictions are under way
  logic [STAMPS-1:0] own;         // the stamp that is about to be overwritten
  assign starts = stamp_valid_i && tested_i.evicts && !started_q && !second_begun_q && !is_busy;
  assign goes   = stamp_valid_i && (!tested_i.evicts || starts || started_q) && !waits;
  assign own    = goes && (mask != '0 || writes_all) ? STAMPS'(1) << tested_i.stamp : '0;
  assign stamp_ready_o = goes && ends;

  // The evictions under way: stamps still to be read, of the older one and of the next, which becomes the older one
  // when that is complete.
  logic [STAMPS-1:0] first_q, first_left, second_q, second, second_left, left, next;
  logic [LINE-1:0]   first_line_q, second_line_q, second_line;
  logic [SLOT-1:0] first_slot_q, second_slot_q, second_slot, next_slot_q;
  logic              first_fills_q, second_fills_q, second_fills;
  logic              hits_first, hits_second, hits, of_second, moves_up, reads;
  assign second      = starts ? tested_i.evicted : second_q;
  assign second_line = starts ? tested_i.line : second_line_q;
  assign second_slot = starts ? next_slot_q : second_slot_q;
  assign second_fills = starts ? tested_i.fills : second_fills_q;
  assign hits_first  = first_line_q == tested_i.line && (first_q & own) != '0;
  assign hits_second = second_line == tested_i.line && (second & own) != '0;
  assign hits        = hits_first || hits_second;
  assign of_second   = hits_second || (!hits_first && first_q == '0);
  assign left        = first_q != '0 ? first_q : second;  // the older eviction comes first
  assign next        = hits ? own : raster_pkg::lowest_stamp(left);
  assign reads       = left != '0;
  assign first_left  = of_second ? first_q : first_q & ~next;
  assign second_left = of_second ? second & ~next : second;
  assign moves_up    = first_left == '0;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      started_q      <= 1'b0;
      first_q        <= '0;
      second_q       <= '0;
      second_begun_q <= 1'b0;
      next_slot_q    <= '0;
    end else begin
      started_q      <= !stamp_ready_o && (started_q || starts);
      first_q        <= moves_up ? second_left : first_left;
      second_q       <= moves_up ? '0 : second_left;
      second_begun_q <= !moves_up && (starts || second_begun_q);
      next_slot_q    <= next_slot_q + SLOT'(starts);
    end
  end
  always_ff @(posedge clk_i) begin
    if (moves_up) begin
      first_line_q  <= second_line;
      first_slot_q  <= second_slot;
      first_fills_q <= second_fills;
    end
    second_line_q  <= second_line;
    second_slot_q  <= second_slot;
    second_fills_q <= second_fills;
  end

  // A stamp has been read. Stamps left to read when an eviction begins: at most those of the eviction before, its own,
  // and those that the next one reads first.
  localparam int DELAY = 3 * STAMPS;
  logic              valid_q, fills_q;
  logic [STAMP-1:0]  stamp_q;
  logic [SLOT-1:0] slot_q;
  logic [DELAY-1:0]  delay_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q <= 1'b0;
      delay_q <= '0;
    end else begin
      valid_q <= reads;
      delay_q <= {delay_q[DELAY-2:0], starts};
    end
  end
  always_ff @(posedge clk_i) begin
    stamp_q <= raster_pkg::stamp_number(next);
    slot_q  <= of_second ? second_slot : first_slot_q;
    fills_q <= of_second ? second_fills : first_fills_q;
  end
  assign victim_valid_o = valid_q;
  assign victim_o.slot  = slot_q;
  assign victim_o.stamp = stamp_q;
  assign victim_ready_o = delay_q[DELAY-1];

  // The colour RAM: for each sample its code, and whether only the chip holds it.
  logic                     looks;  // the stamp at the head reads the RAM
  logic [ADDRESS-1:0]       read_address, write_address;
  logic [SAMPLES-1:0]       dirty, writes, dirty_new;
  logic [SAMPLES*COLOR-1:0] code, code_new;
  assign read_address = looks ? {tested_i.line, tested_i.stamp} : {of_second ? second_line : first_line_q, raster_pkg::stamp_number(next)};
  genvar s;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_color
      sram #(
          .WIDTH    (COLOR + 1),
          .DEPTH    (1 << ADDRESS),
          .READS_OLD(0)
      ) u_color (
          .clk_i,
          .read_i         (reads || looks),
          .read_address_i (read_address),
          .data_o         ({dirty[s], code[s*COLOR+:COLOR]}),
          .write_i        (writes[s]),
          .write_address_i(write_address),
          .data_i         ({dirty_new[s], code_new[s*COLOR+:COLOR]})
      );
      assign victim_o.strobe[s] = fills_q || dirty[s];
      assign victim_o.color[s*COLOR+:COLOR] = dirty[s] ? code[s*COLOR+:COLOR] : clear_color_i & {COLOR{fills_q}};
    end
  endgenerate

  // The threshold of a sample, by the place of its pixel in a block of 4x4: Bayer's matrix.
  function automatic [3:0] threshold_of(input [1:0] x, input [1:0] y);
    threshold_of = ~{x[0] ^ y[0], y[0], x[1] ^ y[1], y[1]};
  endfunction

  generate
    if (LANES == 0) begin : gen_replaces
      assign writes_all    = tested_i.starts_color;
      assign waits         = 1'b0;
      assign ends          = 1'b1;
      assign looks         = 1'b0;
      assign answer_ready_o = 1'b0;
      // On the way to the RAM.
      logic                     writes_q;
      logic [LINE-1:0]          write_line_q;
      logic [STAMP-1:0]         write_stamp_q;
      logic [SAMPLES-1:0]       mask_q, write_mask_q;
      logic [SAMPLES*COLOR-1:0] packed_color, packed_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) writes_q <= 1'b0;
        else writes_q <= own != '0;
      end
      always_ff @(posedge clk_i) begin
        write_line_q  <= tested_i.line;
        write_stamp_q <= tested_i.stamp;
        mask_q        <= mask;
        write_mask_q  <= mask | {SAMPLES{tested_i.starts_color}};
        packed_q      <= packed_color;
      end
      assign is_busy       = writes_q && write_line_q == tested_i.line;
      assign write_address = {write_line_q, write_stamp_q};
      assign dirty_new     = mask_q;
      assign writes        = {SAMPLES{writes_q}} & write_mask_q;
      assign code_new      = packed_q;
      assign idle_o        = !writes_q;
      if (raster_pkg::DITHER_UNIT == 0) begin : gen_packed
        assign packed_color = color_i;
      end else begin : gen_dithered
        localparam int DITHERS = 26;  // the bit of an operations word that says so
        logic dithers_q;
        always_ff @(posedge clk_i or negedge rst_ni) begin
          if (!rst_ni) dithers_q <= 1'b0;
          else if (stamp_ready_o && tested_i.sets_state && tested_i.state_register == raster_pkg::STATE_REGISTER_COLOR_OPS)
            dithers_q <= tested_i.state[DITHERS];
        end
        for (s = 0; s < SAMPLES; s++) begin : gen_rop
          logic [1:0] x, y;
          sample_place #(
              .SAMPLE(s)
          ) u_place (
              .stamp_i(tested_i.stamp),
              .x_o(x),
              .y_o(y)
          );
          dithered_rop u_rop (
              .rgba_i     (color_i[s*SHADED+:SHADED]),
              .dithers_i  (dithers_q),
              .threshold_i(threshold_of(x, y)),
              .color_o    (packed_color[s*COLOR+:COLOR])
          );
        end
      end
    end else begin : gen_blends
      localparam int GROUP = LANES < SAMPLES ? LANES : SAMPLES;  // samples blended in one clock
      localparam int GROUPS = SAMPLES / GROUP;
      localparam int CHANNELS = raster_pkg::COLOR_FORMAT == 0 ? 3 : 4;  // stored channels

      // The registers: operations, from the lowest bit: four factors, two equations, channels to write, dithering,
      // blending. The first equation may be a logic operation, whose truth table is then in the first factor: bit 0 is
      // the result for ones, bit 1 for a new one on a stored zero, bit 2 for a new zero on a stored one.
      localparam int EQUATION = 16;
      localparam int WRITES = 22;
      localparam int DITHERS = 26;
      localparam int BLENDS = 27;
      logic [BLENDS:0] ops_q;
      logic [31:0]     constant_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          ops_q      <= {2'b00, 4'b1111, WRITES'(0)};
          constant_q <= '0;
        end else if (stamp_ready_o && tested_i.sets_state) begin
          if (tested_i.state_register == raster_pkg::STATE_REGISTER_COLOR_OPS) ops_q <= tested_i.state[BLENDS:0];
          if (tested_i.state_register == raster_pkg::STATE_REGISTER_BLEND_CONSTANT) constant_q <= tested_i.state;
        end
      end

      // 0: the stamp at the head, group by group.
      logic               is_here, is_fetched, is_first;
      logic [GROUPS-1:0]  wanted, done_q, group;  // groups with a sample to blend
      logic [SAMPLES-1:0] written;
      assign is_here    = tested_i.color_source == raster_pkg::DEPTH_SOURCE_CHIP;
      assign is_fetched = tested_i.color_source != raster_pkg::DEPTH_SOURCE_NONE && !is_here;
      assign writes_all = tested_i.starts_color || is_fetched;
      for (s = 0; s < GROUPS; s++) begin : gen_group
        assign wanted[s] = mask[s*GROUP+:GROUP] != '0 && !done_q[s];
        assign written[s*GROUP+:GROUP] = mask[s*GROUP+:GROUP] & {GROUP{group[s] || !ops_q[BLENDS]}};
      end
      assign group     = wanted & (~wanted + 1'b1);
      assign is_first  = done_q == '0;
      assign ends      = !ops_q[BLENDS] || wanted == group;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) done_q <= '0;
        else if (goes) done_q <= ends ? '0 : done_q | group;
      end

      // Stages 1 and 2 are in flight to the RAM: 1 has read it; 2 blends, packs and writes it. 3 holds the last write,
      // made while 1 read. An eviction also waits for 3.
      logic [2:0]           on_way_q;
      logic [LINE-1:0]      line_1_q, line_2_q, line_3_q;
      logic [STAMP-1:0]     stamp_1_q, stamp_2_q, stamp_3_q;
      logic [SAMPLES-1:0]   mask_1_q, mask_2_q;     // samples whose colour is written
      logic [SAMPLES-1:0]   writes_1_q, writes_2_q, writes_3_q;  // samples written into the RAM
      logic [SAMPLES-1:0]   blended_1_q, blended_2_q;  // samples blended in the lanes
      logic [SAMPLES-1:0]   dirty_2_q, dirty_3_q, held;  // held: newer than memory, as seen by stage 1
      logic [SAMPLES*SHADED-1:0] color_1_q, color_2_q;
      logic [SAMPLES*COLOR-1:0]  base, stored, stored_2_q, made, code_3_q;
      logic [GROUPS-1:0]    group_1_q, group_2_q;
      logic [23:0]          chooses, chooses_2_q;    // outputs of blend_setup
      logic [16*CHANNELS-1:0] fixed, fixed_2_q;
      logic [5:0]           equation, equation_2_q;
      logic [DITHERS:WRITES] out_2_q;
      logic                 starts_1_q, is_here_1_q, is_answered_1_q;
      logic [COLOR-1:0]     clear_color_1_q;
      logic [4:0]           out;  // the last two fields of the operations: channels written, dithering
      logic [2:0]           is_same_line;   // stages with the line of the head
      logic [1:0]           is_same_stamp;  // stages 2 and 3 hold the stamp of stage 1

      assign is_same_line = on_way_q & {line_3_q == tested_i.line && writes_3_q != '0, line_2_q == tested_i.line && writes_2_q != '0,
                                             line_1_q == tested_i.line && writes_1_q != '0};
      assign is_same_stamp = on_way_q[2:1] & {{line_3_q, stamp_3_q} == {line_1_q, stamp_1_q},
                                              {line_2_q, stamp_2_q} == {line_1_q, stamp_1_q}};
      assign is_busy  = is_same_line != '0;
      // A stamp that has any sample in the RAM is read.
      assign waits = (tested_i.color_source == raster_pkg::DEPTH_SOURCE_MEMORY && is_first && !answer_valid_i) ||
                     (tested_i.color_source != raster_pkg::DEPTH_SOURCE_NONE && !tested_i.starts_color && left != '0);
      assign looks = goes && tested_i.color_source != raster_pkg::DEPTH_SOURCE_NONE && !tested_i.starts_color;
      // The answer stays until the next one is taken.
      assign answer_ready_o = goes && is_first && tested_i.color_source == raster_pkg::DEPTH_SOURCE_MEMORY;
      assign idle_o = on_way_q == '0;

      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) on_way_q <= '0;
        else on_way_q <= {on_way_q[1:0], goes};
      end
      always_ff @(posedge clk_i) begin
        line_1_q    <= tested_i.line;
        stamp_1_q   <= tested_i.stamp;
        mask_1_q    <= written;
        writes_1_q  <= written | {SAMPLES{writes_all && is_first}};  // else a group would undo the result of another
        color_1_q   <= color_i;
        group_1_q   <= group;
        starts_1_q  <= tested_i.starts_color;
        is_here_1_q <= is_here;
        is_answered_1_q <= tested_i.color_source == raster_pkg::DEPTH_SOURCE_MEMORY;
        clear_color_1_q <= tested_i.color_source == raster_pkg::DEPTH_SOURCE_MEMORY ? '0 : clear_color_i;
        blended_1_q <= written & {SAMPLES{ops_q[BLENDS]}};
        line_2_q    <= line_1_q;
        stamp_2_q   <= stamp_1_q;
        mask_2_q    <= mask_1_q;
        writes_2_q  <= writes_1_q;
        blended_2_q <= blended_1_q;
        for (int i = 0; i < GROUPS; i++)  // only the group, in a blended stamp: the others have their turn
          if (ops_q[BLENDS] && !group_1_q[i]) color_2_q[i*GROUP*SHADED+:GROUP*SHADED] <= '0;
          else color_2_q[i*GROUP*SHADED+:GROUP*SHADED] <= color_1_q[i*GROUP*SHADED+:GROUP*SHADED];
        dirty_2_q   <= mask_1_q | held;
        stored_2_q  <= stored;
        group_2_q   <= group_1_q;
        chooses_2_q  <= chooses;
        fixed_2_q    <= fixed;
        equation_2_q <= equation;
        out_2_q      <= ops_q[DITHERS:WRITES];
        line_3_q    <= line_2_q;
        stamp_3_q   <= stamp_2_q;
        writes_3_q  <= writes_2_q;
        dirty_3_q   <= dirty_2_q;
        code_3_q    <= made;
      end

      // 1: the stored colour: the newest write in flight, else the RAM; where the RAM is not valid, the base. The five
      // sources are masked and ORed, so no choice waits for another.
      assign base = (answer_i & {SAMPLES*COLOR{is_answered_1_q}}) | {SAMPLES{clear_color_1_q}};
      for (s = 0; s < SAMPLES; s++) begin : gen_stored
        logic [1:0] is_newer;  // stages 2 and 3 hold a newer value
        logic       is_found;  // the stored colour is in the RAM or in flight
        logic [2:0] has_it;    // the source: 2, 3 or the RAM
        assign is_newer = is_same_stamp & {writes_3_q[s], writes_2_q[s]};
        assign has_it   = {is_newer == '0, is_newer[1] && !is_newer[0], is_newer[0]};
        assign held[s]  = (has_it & {dirty[s], dirty_3_q[s], dirty_2_q[s]}) != '0 && !starts_1_q;
        assign is_found = is_here_1_q || held[s];
        assign stored[s*COLOR+:COLOR] = (made[s*COLOR+:COLOR] & {COLOR{has_it[0] && is_found}}) |
                                        (code_3_q[s*COLOR+:COLOR] & {COLOR{has_it[1] && is_found}}) |
                                        (code[s*COLOR+:COLOR] & {COLOR{has_it[2] && is_found}}) |
                                        (base[s*COLOR+:COLOR] & {COLOR{!is_found}});
      end

      // The register values, for the lanes.
      blend_setup #(
          .CHANNELS(CHANNELS)
      ) u_setup (
          .blends_i  (ops_q[BLENDS]),
          .factors_i (ops_q[15:0]),
          .equation_i(ops_q[EQUATION+:6]),
          .constant_i(constant_q),
          .chooses_o (chooses),
          .fixed_o   (fixed),
          .equation_o(equation)
      );

      // 2: the samples of the group, 8 bits a channel, blended.
      logic [GROUP*8*CHANNELS-1:0] result;
      genvar l;
      for (l = 0; l < GROUP; l++) begin : gen_lane
        logic [COLOR-1:0]  stored_code;
        logic [SHADED-1:0] source;
        logic [31:0]       wide;
        always_comb begin
          stored_code = '0;
          source      = '0;
          for (int i = 0; i < GROUPS; i++) begin
            stored_code = stored_code | (stored_2_q[(i*GROUP+l)*COLOR+:COLOR] & {COLOR{group_2_q[i]}});
            source      = source | color_2_q[(i*GROUP+l)*SHADED+:SHADED];
          end
        end
        if (raster_pkg::COLOR_FORMAT == 0) begin : gen_rgb565
          assign wide = {8'hff, stored_code[4:0], stored_code[4:2], stored_code[10:5], stored_code[10:9],
                         stored_code[15:11], stored_code[15:13]};
        end else begin : gen_rgba8888
          assign wide = stored_code;
        end
        blend_lane #(
            .CHANNELS(CHANNELS)
        ) u_lane (
            .source_i  (source),
            .stored_i  (wide),
            .chooses_i (chooses_2_q),
            .equation_i(equation_2_q),
            .fixed_i   (fixed_2_q),
            .color_o   (result[l*8*CHANNELS+:8*CHANNELS])
        );
      end

      // The truth table of the logic operation, else that of the new code.
      logic [3:0] truth;
      if (raster_pkg::LOGIC_UNIT != 0) begin : gen_truth
        localparam logic [2:0] IS_LOGIC = 3'd5;
        logic [3:0] truth_2_q;
        always_ff @(posedge clk_i) truth_2_q <= ops_q[EQUATION+:3] == IS_LOGIC ? ops_q[3:0] : 4'b0011;
        assign truth = truth_2_q;
      end else begin : gen_no_truth
        logic unused;
        assign truth  = 4'b0011;
        assign unused = &truth;
      end

      // Packed: each channel new or stored.
      assign out           = out_2_q;
      assign write_address = {line_2_q, stamp_2_q};
      assign writes        = writes_2_q & {SAMPLES{on_way_q[1]}};
      assign dirty_new     = dirty_2_q;
      assign code_new      = made;
      for (s = 0; s < SAMPLES; s++) begin : gen_rop
        logic [SHADED-1:0] rgba;
        logic [COLOR-1:0]  rounded, packed_color, channels;
        always_comb begin
          rgba = color_2_q[s*SHADED+:SHADED];
          // With a lane for each sample, colours that are not blended pass through it as well.
          if (GROUPS == 1 || blended_2_q[s]) rgba[8*CHANNELS-1:0] = result[(s%GROUP)*8*CHANNELS+:8*CHANNELS];
        end
        if (raster_pkg::DITHER_UNIT == 0) begin : gen_rounded
          rop u_rop (
              .rgba_i (rgba),
              .color_o(rounded)
          );
        end else begin : gen_dithered
          logic [1:0] x, y;
          sample_place #(
              .SAMPLE(s)
          ) u_place (
              .stamp_i(stamp_2_q),
              .x_o(x),
              .y_o(y)
          );
          dithered_rop u_rop (
              .rgba_i     (rgba),
              .dithers_i  (out[4]),
              .threshold_i(threshold_of(x, y)),
              .color_o    (rounded)
          );
        end
        if (raster_pkg::LOGIC_UNIT != 0) begin : gen_logic
          logic [COLOR-1:0] old;
          assign old          = stored_2_q[s*COLOR+:COLOR];
          assign packed_color = (rounded & old & {COLOR{truth[0]}}) | (rounded & ~old & {COLOR{truth[1]}}) |
                                (~rounded & old & {COLOR{truth[2]}}) | (~rounded & ~old & {COLOR{truth[3]}});
        end else begin : gen_no_logic
          assign packed_color = rounded;
        end
        if (raster_pkg::COLOR_FORMAT == 0) begin : gen_rgb565
          assign channels = {{5{out[0]}}, {6{out[1]}}, {5{out[2]}}};
        end else begin : gen_rgba8888
          assign channels = {{8{out[3]}}, {8{out[2]}}, {8{out[1]}}, {8{out[0]}}};
        end
        assign made[s*COLOR+:COLOR] = (packed_color & channels & {COLOR{mask_2_q[s]}}) |
                                      (stored_2_q[s*COLOR+:COLOR] & ~(channels & {COLOR{mask_2_q[s]}}));
      end
    end
  endgenerate

endmodule
