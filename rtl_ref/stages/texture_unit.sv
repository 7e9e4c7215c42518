// Texture unit: the texels of one texture for the samples of stamps, one live sample per clock, or 2x2 of them (LANES),
// combined with their colours; it also divides colours over w.
//
//   stamp --> coordinates -> [split] -> texture_coordinates -> addresses -> texture_cache -> [texel] -.
//         |                        '--> colors_over_w -------------------------> divided -------------|
//         '-> stamps -------------------------------------------------------------------> [combine] -> stamp
//
// A stamp's payload waits in `stamps`, its coordinates in `coordinates`; stamps without texture store no coordinates
// and pass, in order, one per clock. The sender counts the stamps inside, so that none waits at the entry. With four
// lanes the samples of a stamp are renumbered inside in the order they go: square by square, row by row in each. A
// state travels as a stamp. At the entry it says whether later stamps are textured and how they are combined; it sets
// the address once no sample is left upstream of the cache's data. A sample here is a pixel's shading point: one per
// pixel, however many samples coverage has. Specification: model/stages/texture_unit.hpp; the times are those of
// model/engines/cycle/texture_timing.hpp.
module texture_unit #(
    parameter int SAMPLES = 4,          // samples of a stamp; a power of two
    parameter int LANES = 1,            // samples that go together: 1 or 4
    parameter int Q_BITS = 27,          // bits of q in a tile, unsigned; at most 32
    parameter int P_BITS = 28,          // bits of u and v over w in a tile, signed
    parameter int MANTISSA = 18,        // k
    parameter int NARROW = 17,          // k_P
    parameter int FRACTION = 8,         // f
    parameter int SHIFT_BITS = 6,       // bits of c, signed
    parameter int REACH_BITS = 5,       // bits of x
    parameter int REFERENCE_BITS = 24,  // bits of u_ref, signed
    parameter int CHANNELS = 4,         // channels of a colour
    parameter int FILTER = 0,           // 0 nearest, 1 linear as well, 2 levels as well
    parameter int RECIPROCAL = 0,       // 0 from a table, 1 by division
    parameter int PAYLOAD = 1,          // bits that a stamp carries along
    parameter int QUEUE = 16,           // stamps inside; a power of two
    parameter int IN_FLIGHT = 32,       // samples between address and texel; a power of two
    parameter int LINES = 64,           // of the cache; a power of two
    parameter int WAYS = 1,             // ways of the cache: 1 or 2; 1 with one nearest texel
    parameter int PORT_BITS = 64,       // bits of a beat
    parameter int WORD = 46,            // bits of a state: 70 or 104 with lines of a level, else 46 + CONSTANT, or 49
    parameter int PIXEL = 12,           // bits of a pixel's column and row
    parameter int OVER_W = 0,           // 1: the unit divides colours as well
    parameter int COLOR_P_BITS = 24,    // bits of colours over w in a tile, signed
    parameter int COLOR_NARROW = 13,    // k_P of colours
    parameter int COLOR_SHIFT_BITS = 6, // bits of c of colours, signed
    parameter int COLOR_REACH_BITS = 4, // bits of x of colours
    parameter int CONSTANT = 0,         // 1: texels blend to a constant colour
    parameter int BORDER = 0            // 1: beyond its image a texture may have a border
) (
    input logic clk_i,
    input logic rst_ni,
    input logic power_on_ni,

    // Stamps; at most QUEUE between here and the output
    input logic                               stamp_valid_i,
    input logic [PAYLOAD-1:0]                 payload_i,
    input logic [SAMPLES-1:0]                 mask_i,         // live samples
    input logic [8*CHANNELS*SAMPLES-1:0]      color_i,        // of the primitive, R lowest
    input logic                               is_triangle_i,  // else the stamp has no texture
    input logic [SAMPLES*Q_BITS-1:0]          q_i,
    input logic [SAMPLES*P_BITS-1:0]          u_i,
    input logic [SAMPLES*P_BITS-1:0]          v_i,
    input logic [2*SHIFT_BITS-1:0]            shift_i,        // c = 1 + x - sp - k_P; of u lowest
    input logic [2*REACH_BITS-1:0]            reach_i,
    input logic [2*REFERENCE_BITS-1:0]        reference_i,
    input logic                               sets_state_i,   // for later stamps; without a mask
    input logic                               sets_levels_i,
    input logic                               sets_constant_i,  // with CONSTANT: the colour, of 24 bits, in state_i
    input logic                               sets_border_i,  // with BORDER: the colour, of 32 bits, in state_i
    input logic                               moves_in_i,     // a part of a triangle's lines arrives
    input logic [PIXEL-1:0]                   x_i,            // column of the stamp's first sample
    input logic [PIXEL-1:0]                   y_i,
    input logic [WORD-1:0]                    state_i,        // TextureState::pack, TextureLevels::pack, line_part

    // With OVER_W: the triangle's colours lie over w, and color_i is ignored
    input logic                                     divides_colors_i,
    input logic [SAMPLES*CHANNELS*COLOR_P_BITS-1:0] color_p_i,  // red lowest
    input logic [CHANNELS*COLOR_SHIFT_BITS-1:0]     color_shift_i,
    input logic [CHANNELS*COLOR_REACH_BITS-1:0]     color_reach_i,
    input logic [8*CHANNELS-1:0]                    least_color_i,  // minimum of the vertices' colours
    input logic [8*CHANNELS-1:0]                    greatest_color_i,

    // The same stamp with its colours
    output logic                          stamp_valid_o,
    input  logic                          stamp_ready_i,
    output logic [PAYLOAD-1:0]            payload_o,
    output logic [SAMPLES-1:0]            mask_o,
    output logic [8*CHANNELS*SAMPLES-1:0] color_o,  // colours of live samples

    // Memory: lines are read, beats come in their order
    output logic                 request_valid_o,
    input  logic                 request_ready_i,
    output logic [31:0]          request_address_o,  // bytes
    output logic [5:0]           request_beats_o,
    input  logic                 answer_valid_i,
    output logic                 answer_ready_o,
    input  logic [PORT_BITS-1:0] answer_data_i,

    output logic [$clog2(LANES+1)-1:0] sample_o,  // samples looked up in the cache
    output logic [$clog2(LANES+1)-1:0] hit_o,     // samples of these whose lines were all there
    output logic miss_o,  // a line has been requested
    output logic idle_o  // nothing is under way
);

  localparam int SIDE_BITS = 12;
  localparam int GROUPS = SAMPLES / LANES;
  localparam int GROUP = (GROUPS == 1) ? 1 : $clog2(GROUPS);
  localparam int TAIL = GROUP + 1;  // bits of a group's tail: its number, and whether it is the last of its stamp
  localparam int AHEAD_TAIL = TAIL + ((LANES != 1) ? LANES : 0);  // the tail, and with several lanes the live samples
  localparam int INDEX = $clog2(QUEUE);
  localparam int COLOR = 8 * CHANNELS;
  localparam int COLOR_P = CHANNELS * COLOR_P_BITS;
  localparam int PLACE = Q_BITS + 2 * P_BITS + ((OVER_W != 0) ? COLOR_P : 0);
  localparam int COORDINATES = SAMPLES * PLACE;
  localparam int GROUP_PLACE = LANES * PLACE;
  localparam int AHEAD = 16;  // groups between split and tags
  localparam int CLOCKS = (FILTER == 2) ? 10 : 8;  // latency of texture_coordinates, or of level_of_detail
  localparam int TOKEN = ((FILTER == 2) ? 3 : 1) + BORDER;  // bits of a state's kind
  localparam int PIXELS = COORDINATES + 2 * PIXEL;
  localparam int PLACED = (FILTER != 2) ? COORDINATES : (PIXELS > WORD) ? PIXELS : WORD + 1;
  localparam int WAITING = PLACED + ((OVER_W != 0) ? 2 : 0);  // with two flags: textured, divides colours

  // ---------------------------------------------------------------------------------------------------------------- the door
  logic       is_shaded, is_textured, divides, enters, door_enable_q;
  logic [2:0] door_format_q;
  localparam int COMBINE = 2 + CONSTANT;  // bits of a mode
  logic [COMBINE-1:0] door_combine, door_combine_q;
  assign is_shaded   = stamp_valid_i && !sets_state_i && is_triangle_i && mask_i != '0;
  assign is_textured = is_shaded && door_enable_q;
  assign divides     = OVER_W != 0 && is_shaded && divides_colors_i;
  assign enters      = is_textured || divides;  // sample by sample
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) door_enable_q <= 1'b0;
    else if (stamp_valid_i && sets_state_i) door_enable_q <= state_i[0];
  end
  always_ff @(posedge clk_i)
    if (stamp_valid_i && sets_state_i) begin
      door_format_q  <= state_i[4:2];
      door_combine_q <= door_combine;
    end
  generate
    if (CONSTANT != 0) begin : gen_combine_bits
      assign door_combine = {state_i[46], state_i[6:5]};
    end else begin : gen_combine_bits
      assign door_combine = state_i[6:5];
    end
  endgenerate

  // Coordinates packed by sample, and the order in which samples enter.
  localparam int SIDE = $clog2(SAMPLES) / 2;  // log2 of the samples along a stamp's side
  logic [COORDINATES-1:0]   places;
  logic [SAMPLES-1:0]       door_mask;
  logic [SAMPLES*COLOR-1:0] door_color, entering_color, color_q;
  logic [SAMPLES-1:0]       mask_q;
  genvar s;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_place
      // Squares of 2x2 in rows, each in two rows.
      localparam int AT = (LANES == 1 || SAMPLES == 4) ? s :
                          ((2 * ((s / 4) / (1 << (SIDE - 1))) + (s / 2) % 2) << SIDE) + 2 * ((s / 4) % (1 << (SIDE - 1))) + s % 2;
      assign places[s*PLACE+:Q_BITS+2*P_BITS] = {v_i[AT*P_BITS+:P_BITS], u_i[AT*P_BITS+:P_BITS], q_i[AT*Q_BITS+:Q_BITS]};
      if (OVER_W != 0) begin : gen_color
        assign places[s*PLACE+Q_BITS+2*P_BITS+:COLOR_P] = color_p_i[AT*COLOR_P+:COLOR_P];
      end
      assign door_mask[s]                = mask_i[AT];
      assign door_color[s*COLOR+:COLOR]  = color_i[AT*COLOR+:COLOR];
      assign mask_o[AT]                  = mask_q[s];
      assign color_o[AT*COLOR+:COLOR]    = color_q[s*COLOR+:COLOR];
    end
  endgenerate

  logic                   waits, is_token, is_state, takes;
  logic [TOKEN-1:0]       token, waiting_token;
  logic [SAMPLES-1:0]     waiting_mask;
  logic [WAITING-1:0]     entering, waiting;
  logic [INDEX-1:0]       entered_q, split_q;  // number of the next such stamp at the entry, and at the split
  logic                   passes_door, has_alpha, stamp_waits, stamp_is_textured, stamp_has_alpha, stamp_leaves;
  logic                   waiting_divides;
  logic                   waiting_is_textured, stamp_divides;
  logic [COMBINE-1:0]     stamp_combine;
  logic [PAYLOAD-1:0]     stamp_payload;
  logic [SAMPLES-1:0]     stamp_mask;
  logic [SAMPLES*COLOR-1:0] stamp_color;
  logic                   waiting_ready, stamps_ready;
  assign passes_door = enters || (stamp_valid_i && token != '0);
  assign has_alpha   = door_format_q != 3'd0 && door_format_q != 3'd2;
  // Flags of a stamp: it is textured; with OVER_W: its colours are divided; with CONSTANT: it sets the constant, which
  // it has in the place of its colours, where it leaves.
  localparam int DIVIDES = (OVER_W != 0) ? 1 : 0;
  localparam int FLAGS = 1 + DIVIDES + CONSTANT;
  logic [FLAGS-1:0]  door_flags, stamp_flags;
  logic [PLACED-1:0] placed;
  assign stamp_is_textured = stamp_flags[0];
  assign stamp_divides     = stamp_flags[DIVIDES] && OVER_W != 0;
  logic [23:0] constant;  // constant of the samples that are combined
  logic passes;  // a stamp leaves as it came
  generate
    if (CONSTANT != 0) begin : gen_constant
      logic [23:0]      constant_q;
      logic [DIVIDES:0] shades;
      assign shades         = (DIVIDES + 1)'({divides, is_textured});
      assign door_flags     = {sets_constant_i, shades};
      assign entering_color = sets_constant_i ? (SAMPLES * COLOR)'(state_i[23:0]) : door_color;
      assign constant       = constant_q;
      always_ff @(posedge clk_i) if (passes && stamp_flags[FLAGS-1]) constant_q <= stamp_color[23:0];
    end else begin : gen_no_constant
      logic unused;
      assign unused         = sets_constant_i;
      assign door_flags     = FLAGS'({divides, is_textured});
      assign entering_color = door_color;
      assign constant       = '0;
    end
    if (OVER_W != 0) begin : gen_flags
      assign entering            = {divides, is_textured, placed};
      assign waiting_is_textured = waiting[PLACED];
      assign waiting_divides     = waiting[PLACED+1];
    end else begin : gen_textured  // every waiting stamp that is not a token
      assign entering            = placed;
      assign waiting_is_textured = 1'b1;
      assign waiting_divides     = 1'b0;
    end
    if (FILTER == 2) begin : gen_pixels
      assign token    = TOKEN'({sets_border_i, moves_in_i, sets_levels_i, sets_state_i});
      assign placed   = PLACED'({y_i, x_i, places});
      assign is_state = waiting_token[1:0] != '0;
    end else begin : gen_places
      assign token    = TOKEN'({sets_border_i, sets_state_i});
      assign placed   = places;
      assign is_state = waiting_token[0];
    end
  endgenerate
  assign is_token = waiting_token != '0;
  fifo #(
      .WIDTH(TOKEN + SAMPLES + WAITING),
      .DEPTH(QUEUE)
  ) u_coordinates (
      .clk_i,
      .rst_ni,
      .valid_i(passes_door),
      .ready_o(waiting_ready),
      .data_i ({token, door_mask, entering[WAITING-1:WORD], token != '0 ? state_i : entering[WORD-1:0]}),
      .valid_o(waits),
      .ready_i(takes),
      .data_o ({waiting_token, waiting_mask, waiting})
  );
  localparam int SHADES = SAMPLES * COLOR + FLAGS + COMBINE + 1;  // bits of a stamp that long paths start from
  logic [SHADES-1:0] next_stamp;
  fifo #(
      .WIDTH(PAYLOAD + SAMPLES + SHADES),
      .DEPTH(QUEUE),
      .AHEAD(SHADES),
      .NEXT (SHADES)
  ) u_stamps (
      .clk_i,
      .rst_ni,
      .valid_i(stamp_valid_i),
      .ready_o(stamps_ready),
      .data_i ({payload_i, door_mask, entering_color, door_flags, door_combine_q, has_alpha}),
      .valid_o(stamp_waits),
      .ready_i(stamp_leaves),
      .data_o ({next_stamp, stamp_payload, stamp_mask, stamp_color, stamp_flags, stamp_combine, stamp_has_alpha})
  );

  // --------------------------------------------------------------------------------------------------------------- the split
  function automatic [GROUP-1:0] lowest(input [GROUPS-1:0] mask);
    lowest = '0;
    for (int i = GROUPS - 1; i >= 0; i--) if (mask[i]) lowest = GROUP'(i);
  endfunction
  function automatic [GROUP_PLACE-1:0] place_of(input [COORDINATES-1:0] all, input [GROUP-1:0] of_group);
    logic [COORDINATES-1:0] left;
    left = all;
    for (int bits = $clog2(GROUPS) - 1; bits >= 0; bits--) left = of_group[bits] ? left >> (GROUP_PLACE << bits) : left;
    place_of = left[GROUP_PLACE-1:0];
  endfunction

  logic               splits, comes, can_set, sets_state, sets_border, moves_in, is_last, leaves_queue, tags_are_empty;
  logic [GROUPS-1:0]  done_q, left;  // groups of the stamp that are complete; groups left
  logic [GROUP-1:0]   group;
  logic [4:0]         ahead_q;
  generate
    for (s = 0; s < GROUPS; s++) begin : gen_left
      assign left[s] = waiting_mask[s*LANES+:LANES] != '0 && !done_q[s];
    end
  endgenerate
  assign group      = lowest(left);
  assign is_last    = (left & (left - 1'b1)) == '0;
  assign splits     = waits && !is_token && ahead_q != 5'(AHEAD);  // 0 after a state that disables the texture
  assign comes      = splits && waiting_is_textured;
  assign can_set    = waits && is_state && ahead_q == '0 && tags_are_empty;
  assign sets_state = can_set && waiting_token[0];
  assign takes      = can_set || sets_border || moves_in || (splits && is_last);

  logic [GROUP_PLACE-1:0] place_q;  // the samples of the group
  logic [INDEX-1:0] place_index_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      done_q    <= '0;
      ahead_q   <= '0;
      entered_q <= '0;
      split_q   <= '0;
    end else begin
      if (splits) done_q <= is_last ? '0 : done_q | GROUPS'(1) << group;
      ahead_q   <= leaves_queue ? ahead_q - 5'(!comes) : ahead_q + 5'(comes);  // two sums: leaves_queue comes late
      entered_q <= entered_q + INDEX'(enters);
      split_q   <= split_q + INDEX'(splits && is_last);
    end
  end
  always_ff @(posedge clk_i) begin
    place_q       <= place_of(waiting[COORDINATES-1:0], group);
    place_index_q <= split_q;
  end

  // The active state.
  logic [2:0]             format_q;
  logic [5:0]             wrap_q;
  logic [2*SIDE_BITS-1:0] last_q;   // number of the last texel of each side
  logic                   is_linear_q;
  logic [1:0]             size_q;   // log2 of a line's bytes, less 4
  logic [3:0]             row_q;    // log2 of the lines in a row
  logic [25:0]            base_q;   // unit 64 bytes
  logic [3:0]             log2_width;
  logic [1:0]             size;
  logic [5:0]             wrap;
  assign log2_width = waiting[14:11];
  generate
    if (BORDER != 0) begin : gen_wrap_bits
      assign wrap = {waiting[48], waiting[10:9], waiting[47], waiting[8:7]};
    end else begin : gen_wrap_bits
      assign wrap = {1'b0, waiting[10:9], 1'b0, waiting[8:7]};
    end
  endgenerate
  assign size       = waiting[4:2] == 3'd0 ? 2'd0 : waiting[4:2] == 3'd5 ? 2'd2 : 2'd1;
  always_ff @(posedge clk_i)
    if (sets_state) begin
      format_q    <= waiting[4:2];
      wrap_q      <= wrap;
      last_q      <= {~(12'hfff << waiting[18:15]), ~(12'hfff << log2_width)};
      size_q      <= size;
      row_q       <= 4'(size) + (log2_width[3:1] == '0 ? 4'd0 : log2_width - 4'd2);
      base_q      <= waiting[44:19];
      is_linear_q <= FILTER != 0 && waiting[45];
    end

  // ------------------------------------------------------------------------------------------------------------ the address
  logic [CLOCKS:0]            valid_q;  // the last clock's lowest
  logic [AHEAD_TAIL*(CLOCKS+1)-1:0] tail_q;
  logic [LANES*2*SIDE_BITS-1:0] texel;
  logic [LANES*2*SIDE_BITS-1:0] next;
  logic [LANES*16-1:0]        part;
  logic [LANES*4-1:0]         border;
  logic [LANES*(2*REFERENCE_BITS+16)-1:0] place;  // with levels, until the level is known
  logic [LANES*(2*REFERENCE_BITS+16)-1:0] coordinate;
  logic [LANES*5-1:0]         exponent;
  logic [LANES*(MANTISSA-1)-1:0] reciprocal;
  logic [LANES*8-1:0]         below;
  logic [LANES*8-1:0]         level_part;
  logic [LANES*4-1:0]         level;
  logic [LANES-1:0]           level_is_linear, level_is_between;
  logic                       shares;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= {valid_q[CLOCKS-1:0], comes};
  end
  generate
    if (LANES != 1) begin : gen_tails
      logic [LANES-1:0] live;
      always_comb begin
        live = '0;
        for (int i = 0; i < GROUPS; i++) live = live | (waiting_mask[i*LANES+:LANES] & {LANES{group == GROUP'(i)}});
      end
      always_ff @(posedge clk_i) tail_q <= {tail_q[AHEAD_TAIL*CLOCKS-1:0], live, is_last, group};
    end else begin : gen_tail
      always_ff @(posedge clk_i) tail_q <= {tail_q[AHEAD_TAIL*CLOCKS-1:0], is_last, group};
    end
  endgenerate

  logic [LANES*Q_BITS-1:0]  q_lanes;
  logic [LANES*P_BITS-1:0]  u_lanes, v_lanes;
  logic [LANES*COLOR_P-1:0] color_p_lanes;
  generate
    for (s = 0; s < LANES; s++) begin : gen_lane
      assign q_lanes[s*Q_BITS+:Q_BITS] = place_q[s*PLACE+:Q_BITS];
      assign u_lanes[s*P_BITS+:P_BITS] = place_q[s*PLACE+Q_BITS+:P_BITS];
      assign v_lanes[s*P_BITS+:P_BITS] = place_q[s*PLACE+Q_BITS+P_BITS+:P_BITS];
      if (OVER_W != 0) begin : gen_color
        assign color_p_lanes[s*COLOR_P+:COLOR_P] = place_q[s*PLACE+Q_BITS+2*P_BITS+:COLOR_P];
      end else begin : gen_no_color
        assign color_p_lanes[s*COLOR_P+:COLOR_P] = '0;
      end
    end
  endgenerate
  texture_coordinates #(
      .LANES         (LANES),
      .Q_BITS        (Q_BITS),
      .P_BITS        (P_BITS),
      .MANTISSA      (MANTISSA),
      .NARROW        (NARROW),
      .FRACTION      (FRACTION),
      .SHIFT_BITS    (SHIFT_BITS),
      .REACH_BITS    (REACH_BITS),
      .REFERENCE_BITS(REFERENCE_BITS),
      .QUEUE         (QUEUE),
      .SIDE_BITS     (SIDE_BITS),
      .LINEAR        (FILTER),
      .RECIPROCAL    (RECIPROCAL),
      .BORDER        (BORDER)
  ) u_texture_coordinates (
      .clk_i,
      .frame_valid_i(stamp_valid_i),  // known early: a stamp that does not enter leaves its constants where the next one's go
      .frame_index_i(entered_q),
      .shift_i,
      .reach_i,
      .reference_i,
      .index_i      (place_index_q),
      .q_i          (q_lanes),
      .u_i          (u_lanes),
      .v_i          (v_lanes),
      .last_i       (last_q),
      .wrap_i       (wrap_q),
      .is_linear_i  (is_linear_q),
      .texel_o      (texel),
      .next_o       (next),
      .part_o       (part),
      .border_o     (border),
      .coordinate_o (place),
      .exponent_o   (exponent),
      .below_o      (below),
      .reciprocal_o (reciprocal)
  );

  generate
    if (FILTER == 2) begin : gen_level_of_detail
      localparam int ROW = (LANES == 1) ? SIDE : SIDE - 1;  // log2 of the groups in a row of the stamp
      logic [PIXEL-1:0]             x_q, y_q;
      logic [LANES*(2*REFERENCE_BITS+16)-1:0] place_1_q, place_2_q;
      assign moves_in = waits && waiting_token[2];
      always_ff @(posedge clk_i) begin
        x_q       <= waiting[COORDINATES+:PIXEL] | (PIXEL'(group) & PIXEL'((1 << ROW) - 1)) << (SIDE - ROW);
        y_q       <= waiting[COORDINATES+PIXEL+:PIXEL] | (PIXEL'(group) >> ROW) << (SIDE - ROW);
        place_1_q <= place;
        place_2_q <= place_1_q;
      end
      assign coordinate = place_2_q;
      level_of_detail #(
          .PART (WORD),
          .PIXEL(PIXEL),
          .LANES(LANES)
      ) u_level_of_detail (
          .clk_i,
          .moves_in_i     (moves_in),
          .line_part_i    (waiting[WORD-1:0]),
          .sets_levels_i  (can_set && waiting_token[1]),
          .levels_i       (waiting[30:0]),
          .x_i            (x_q),
          .y_i            (y_q),
          .exponent_i     (exponent),
          .below_i        (below),
          .is_mag_linear_i(is_linear_q),
          .level_o        (level),
          .part_o         (level_part),
          .is_linear_o    (level_is_linear),
          .is_between_o   (level_is_between),
          .shares_o       (shares)
      );
    end else begin : gen_level_0
      assign moves_in         = 1'b0;
      assign coordinate       = '0;
      assign level            = '0;
      assign level_part       = '0;
      assign level_is_linear  = '0;
      assign level_is_between = '0;
      assign shares           = 1'b0;
    end
  endgenerate

  logic            drops, cache_is_idle;
  logic            texel_valid, texel_ready;
  logic [LANES*32-1:0] texel_color, e_texel_q;
  logic [TAIL-1:0]     texel_tail;
  logic [LANES-1:0]    texel_lanes;  // samples whose texels have come
  logic                texel_ends;   // these samples are the last of their group
  assign drops = sets_state && waiting[1];

  // The border's colour, where the filter looks at it. It waits until no sample is left upstream of `combine`.
  logic [31:0] border_color;
  generate
    if (BORDER != 0) begin : gen_border
      localparam int INSIDE = $clog2(AHEAD + IN_FLIGHT + 16);  // of a count of groups, with a few in registers
      logic              leaves;
      logic [INSIDE-1:0] inside_q;  // groups between the split and combine
      logic [31:0]       border_q;
      assign sets_border  = waits && waiting_token[TOKEN-1] && inside_q == '0;
      assign border_color = border_q;
      assign leaves       = texel_valid && texel_ready && texel_ends;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) inside_q <= '0;
        else inside_q <= inside_q + INSIDE'(comes) - INSIDE'(leaves);
      end
      always_ff @(posedge clk_i) if (sets_border) border_q <= waiting[31:0];
    end else begin : gen_no_border
      assign sets_border  = 1'b0;
      assign border_color = '0;
      logic unused;
      assign unused = sets_border_i;
    end
  endgenerate

  generate
    if (LANES != 1) begin : gen_lanes
      texture_lanes #(
          .FILTER        (FILTER),
          .REFERENCE_BITS(REFERENCE_BITS),
          .SIDE_BITS     (SIDE_BITS),
          .AHEAD         (AHEAD),
          .LINES         (LINES),
          .WAYS          (WAYS),
          .PORT_BITS     (PORT_BITS),
          .IN_FLIGHT     (IN_FLIGHT),
          .TAIL          (TAIL),
          .BORDER        (BORDER)
      ) u_texture_lanes (
          .clk_i,
          .rst_ni,
          .power_on_ni,
          .valid_i         (valid_q[CLOCKS]),
          .live_i          (tail_q[AHEAD_TAIL*CLOCKS+TAIL+:LANES]),
          .texel_i         (texel),
          .next_i          (next),
          .part_i          (part),
          .border_i        (border),
          .coordinate_i    (coordinate),
          .level_i         (level),
          .level_part_i    (level_part),
          .is_linear_i     (level_is_linear),
          .is_between_i    (level_is_between),
          .tail_i          (tail_q[AHEAD_TAIL*CLOCKS+:TAIL]),
          .pops_o          (leaves_queue),
          .sets_state_i    (sets_state),
          .log2_size_i     (waiting[18:11]),
          .wrap_i          (wrap_q),
          .row_i           (row_q),
          .shares_i        (shares),
          .format_i        (format_q),
          .base_i          (base_q),
          .size_i          (size_q),
          .border_color_i  (border_color),
          .drop_i          (drops),
          .tags_are_empty_o(tags_are_empty),
          .texel_valid_o   (texel_valid),
          .texel_ready_i   (texel_ready),
          .texel_lanes_o   (texel_lanes),
          .texel_ends_o    (texel_ends),
          .texel_o         (texel_color),
          .texel_tail_o    (texel_tail),
          .request_valid_o,
          .request_ready_i,
          .request_address_o,
          .request_beats_o,
          .answer_valid_i,
          .answer_ready_o,
          .answer_data_i,
          .sample_o,
          .hit_o,
          .miss_o,
          .idle_o          (cache_is_idle)
      );
    end else if (FILTER == 0) begin : gen_nearest
      assign texel_lanes = 1'b1;
      assign texel_ends  = 1'b1;
      texture_nearest #(
          .SIDE_BITS(SIDE_BITS),
          .AHEAD    (AHEAD),
          .LINES    (LINES),
          .PORT_BITS(PORT_BITS),
          .IN_FLIGHT(IN_FLIGHT),
          .TAIL     (TAIL),
          .BORDER   (BORDER)
      ) u_texture_nearest (
          .clk_i,
          .rst_ni,
          .power_on_ni,
          .valid_i         (valid_q[CLOCKS]),
          .texel_i         (texel),
          .border_i        (border != '0),
          .tail_i          (tail_q[AHEAD_TAIL*CLOCKS+:TAIL]),
          .pops_o          (leaves_queue),
          .format_i        (format_q),
          .base_i          (base_q),
          .size_i          (size_q),
          .row_i           (row_q),
          .border_color_i  (border_color),
          .drop_i          (drops),
          .tags_are_empty_o(tags_are_empty),
          .texel_valid_o   (texel_valid),
          .texel_ready_i   (texel_ready),
          .texel_o         (texel_color),
          .texel_tail_o    (texel_tail),
          .request_valid_o,
          .request_ready_i,
          .request_address_o,
          .request_beats_o,
          .answer_valid_i,
          .answer_ready_o,
          .answer_data_i,
          .sample_o,
          .hit_o,
          .miss_o,
          .idle_o          (cache_is_idle)
      );
    end else begin : gen_linear
      assign texel_lanes = 1'b1;
      assign texel_ends  = 1'b1;
      texture_linear #(
          .LEVELS        (FILTER - 1),
          .REFERENCE_BITS(REFERENCE_BITS),
          .SIDE_BITS     (SIDE_BITS),
          .AHEAD         (AHEAD),
          .LINES         (LINES),
          .WAYS          (WAYS),
          .PORT_BITS     (PORT_BITS),
          .IN_FLIGHT     (IN_FLIGHT),
          .TAIL          (TAIL),
          .BORDER        (BORDER)
      ) u_texture_linear (
          .clk_i,
          .rst_ni,
          .power_on_ni,
          .valid_i         (valid_q[CLOCKS]),
          .texel_i         (texel),
          .next_i          (next),
          .part_i          (part),
          .border_i        (border),
          .coordinate_i    (coordinate),
          .level_i         (level),
          .level_part_i    (level_part),
          .is_linear_i     (level_is_linear),
          .is_between_i    (level_is_between),
          .tail_i          (tail_q[AHEAD_TAIL*CLOCKS+:TAIL]),
          .pops_o          (leaves_queue),
          .sets_state_i    (sets_state),
          .log2_size_i     (waiting[18:11]),
          .wrap_i          (wrap_q),
          .format_i        (format_q),
          .base_i          (base_q),
          .size_i          (size_q),
          .row_i           (row_q),
          .shares_i        (shares),
          .border_color_i  (border_color),
          .drop_i          (drops),
          .tags_are_empty_o(tags_are_empty),
          .texel_valid_o   (texel_valid),
          .texel_ready_i   (texel_ready),
          .texel_o         (texel_color),
          .texel_tail_o    (texel_tail),
          .request_valid_o,
          .request_ready_i,
          .request_address_o,
          .request_beats_o,
          .answer_valid_i,
          .answer_ready_o,
          .answer_data_i,
          .sample_o,
          .hit_o,
          .miss_o,
          .idle_o          (cache_is_idle)
      );
    end
  endgenerate

  // ------------------------------------------------------------------------------------------------- colours over w, divided
  // The queue has a place for each sample of the stamps inside, so that no sample waits for a place.
  logic              takes_divided;
  logic              divided_valid, divided_last;
  logic [GROUP-1:0]  divided_group;
  logic [LANES*COLOR-1:0] divided;
  generate
    if (OVER_W != 0) begin : gen_colors_over_w
      localparam int COLOR_CLOCKS = 8;  // latency of colors_over_w
      logic [COLOR_CLOCKS:0] divides_q;  // the last clock's lowest
      logic [LANES*COLOR-1:0] color;
      logic                  divided_ready;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) divides_q <= '0;
        else divides_q <= {divides_q[COLOR_CLOCKS-1:0], splits && waiting_divides};
      end
      for (s = 0; s < LANES; s++) begin : gen_divided
        colors_over_w #(
            .CHANNELS  (CHANNELS),
            .P_BITS    (COLOR_P_BITS),
            .MANTISSA  (MANTISSA),
            .NARROW    (COLOR_NARROW),
            .SHIFT_BITS(COLOR_SHIFT_BITS),
            .REACH_BITS(COLOR_REACH_BITS),
            .QUEUE     (QUEUE)
        ) u_colors_over_w (
            .clk_i,
            .frame_valid_i(stamp_valid_i),
            .frame_index_i(entered_q),
            .shift_i      (color_shift_i),
            .reach_i      (color_reach_i),
            .least_i      (least_color_i),
            .greatest_i   (greatest_color_i),
            .index_i      (place_index_q),
            .p_i          (color_p_lanes[s*COLOR_P+:COLOR_P]),
            .exponent_i   (exponent[s*5+:5]),
            .reciprocal_i (reciprocal[s*(MANTISSA-1)+:MANTISSA-1]),
            .color_o      (color[s*COLOR+:COLOR])
        );
      end
      fifo #(
          .WIDTH(TAIL + LANES * COLOR),
          .DEPTH(QUEUE * GROUPS)
      ) u_divided (
          .clk_i,
          .rst_ni,
          .valid_i(divides_q[COLOR_CLOCKS]),
          .ready_o(divided_ready),
          .data_i ({tail_q[AHEAD_TAIL*COLOR_CLOCKS+:TAIL], color}),
          .valid_o(divided_valid),
          .ready_i(takes_divided),
          .data_o ({divided_last, divided_group, divided})
      );
    end else begin : gen_affine
      assign divided_valid = 1'b0;
      assign divided_last  = 1'b0;
      assign divided_group = '0;
      assign divided       = '0;
    end
  endgenerate

  // ------------------------------------------------------------------------------------- combine, and the stamp on its way out
  logic                     e_valid_q, e_last_q, e_moves, is_free, out_valid_q;
  logic [GROUP-1:0]         e_group_q, coming_group;
  logic [LANES-1:0]         e_lanes_q;
  logic                     e_ends_q;
  logic [LANES*COLOR-1:0]   e_color, own_color_q, combined;
  logic [PAYLOAD-1:0]       payload_q;

  function automatic [LANES*COLOR-1:0] color_of(input [SAMPLES*COLOR-1:0] all, input [GROUP-1:0] of_group);
    logic [SAMPLES*COLOR-1:0] rest;
    rest = all;
    for (int bits = $clog2(GROUPS) - 1; bits >= 0; bits--)
      rest = of_group[bits] ? rest >> ((LANES * COLOR) << bits) : rest;
    color_of = rest[LANES*COLOR-1:0];
  endfunction

  // A sample's own colour is divided before its texel comes: the division takes fewer clocks.
  logic d_moves;  // a sample without texture whose colour is divided
  assign e_color = stamp_divides ? divided : own_color_q;
  // The primitive's colours of the samples in `e`, chosen as they come and as a stamp leaves: long paths start here.
  assign coming_group = e_valid_q && !stamp_is_textured ? e_group_q : texel_tail[GROUP-1:0];
  always_ff @(posedge clk_i)
    if (texel_ready || stamp_leaves)
      own_color_q <= stamp_leaves ? color_of(next_stamp[SHADES-1-:SAMPLES*COLOR], coming_group) :
                                    color_of(stamp_color, coming_group);
  generate
    for (s = 0; s < LANES; s++) begin : gen_combine
      texture_combine #(
          .CHANNELS(CHANNELS),
          .CONSTANT(CONSTANT)
      ) u_combine (
          .texel_i    (e_texel_q[s*32+:32]),
          .color_i    (e_color[s*COLOR+:COLOR]),
          .combine_i  (3'(stamp_combine)),
          .constant_i (constant),
          .has_alpha_i(stamp_has_alpha),
          .color_o    (combined[s*COLOR+:COLOR])
      );
    end
  endgenerate

  assign is_free       = !out_valid_q || stamp_ready_i;
  assign passes        = stamp_waits && !stamp_is_textured && !stamp_divides && is_free;
  assign d_moves       = stamp_waits && !stamp_is_textured && stamp_divides && divided_valid && is_free;
  assign e_moves       = e_valid_q && stamp_is_textured && is_free;  // the first textured stamp is this sample's
  assign stamp_leaves  = passes || (e_moves && e_last_q && e_ends_q) || (d_moves && divided_last);
  assign texel_ready   = !e_valid_q || e_moves;
  assign takes_divided = d_moves || (e_moves && stamp_divides && e_ends_q);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      e_valid_q   <= 1'b0;
      out_valid_q <= 1'b0;
    end else begin
      e_valid_q   <= texel_valid || (e_valid_q && !e_moves);
      out_valid_q <= stamp_leaves || (out_valid_q && !stamp_ready_i);
    end
  end
  always_ff @(posedge clk_i) begin
    if (texel_ready) begin
      e_texel_q             <= texel_color;
      {e_last_q, e_group_q} <= texel_tail;
      e_lanes_q             <= texel_lanes;
      e_ends_q              <= texel_ends;
    end
    if (stamp_leaves) begin
      payload_q <= stamp_payload;
      mask_q    <= stamp_mask;
    end
    for (int i = 0; i < SAMPLES; i++)
      if (passes || (e_moves && e_group_q == GROUP'(i / LANES) && e_lanes_q[i%LANES]) ||
          (d_moves && divided_group == GROUP'(i / LANES)))
        color_q[i*COLOR+:COLOR] <= stamp_is_textured ? combined[i%LANES*COLOR+:COLOR] :
                                   stamp_divides ? divided[i%LANES*COLOR+:COLOR] : stamp_color[i*COLOR+:COLOR];
  end

  assign stamp_valid_o = out_valid_q;
  assign payload_o     = payload_q;
  assign idle_o        = !waits && !stamp_waits && !out_valid_q && cache_is_idle;

endmodule
