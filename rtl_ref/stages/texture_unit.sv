// Texture unit: the texels of one texture for the samples of stamps, a live sample a clock, combined with their colours.
//
//   stamp --> coordinates -> [split] -> texture_coordinates -> addresses -> texture_cache -> [texel] -.
//         '-> stamps -------------------------------------------------------------------> [combine] -> stamp
//
// What a stamp carries along waits in `stamps`, its coordinates in `coordinates`; stamps without texture have nothing there and
// pass, in order, one a clock. The stamps inside are counted by who sends them, so that none waits at the door.
// A state is a stamp too. At the door it says whether the stamps behind it are textured and how they are combined; it sets
// the address once no sample is left in front of the cache's data.
// Specification: model/stages/texture_unit.hpp; the times are those of model/engines/cycle/texture_timing.hpp.
module texture_unit #(
    parameter int SAMPLES = 4,          // of a stamp; a power of two
    parameter int Q_BITS = 27,          // of q in a tile, without sign; at most 32
    parameter int P_BITS = 28,          // of u and v over w in a tile, with their signs
    parameter int MANTISSA = 18,        // k
    parameter int NARROW = 17,          // k_P
    parameter int FRACTION = 8,         // f
    parameter int SHIFT_BITS = 6,       // of c, with its sign
    parameter int REACH_BITS = 5,       // of x
    parameter int REFERENCE_BITS = 24,  // of u_ref, with its sign
    parameter int CHANNELS = 4,         // of a colour
    parameter int SOFT = 0,             // of these, so many are combined without a multiplier
    parameter int FILTER = 0,           // 0 nearest, 1 linear as well
    parameter int PAYLOAD = 1,          // bits that a stamp carries along
    parameter int QUEUE = 16,           // stamps inside; a power of two
    parameter int IN_FLIGHT = 32,       // samples between address and texel; a power of two
    parameter int LINES = 64,           // of the cache; a power of two
    parameter int PORT_BITS = 64,       // of a beat
    parameter int STATE = 46            // bits of a state; not to be set
) (
    input logic clk_i,
    input logic rst_ni,
    input logic power_on_ni,

    // Stamps; no more than QUEUE between here and the end
    input logic                               stamp_valid_i,
    input logic [PAYLOAD-1:0]                 payload_i,
    input logic [SAMPLES-1:0]                 mask_i,         // samples that live
    input logic [8*CHANNELS*SAMPLES-1:0]      color_i,        // of the primitive, R lowest
    input logic                               is_triangle_i,  // else it has no texture
    input logic [SAMPLES*Q_BITS-1:0]          q_i,
    input logic [SAMPLES*P_BITS-1:0]          u_i,
    input logic [SAMPLES*P_BITS-1:0]          v_i,
    input logic [2*SHIFT_BITS-1:0]            shift_i,        // c = 1 + x - sp - k_P; of u lowest
    input logic [2*REACH_BITS-1:0]            reach_i,
    input logic [2*REFERENCE_BITS-1:0]        reference_i,
    input logic                               sets_state_i,   // for the stamps behind it; without a mask
    input logic [STATE-1:0]                   state_i,        // TextureState::pack

    // The same with their colours
    output logic                          stamp_valid_o,
    input  logic                          stamp_ready_i,
    output logic [PAYLOAD-1:0]            payload_o,
    output logic [SAMPLES-1:0]            mask_o,
    output logic [8*CHANNELS*SAMPLES-1:0] color_o,  // of samples that live

    // Memory: lines are read, beats come in their order
    output logic                 request_valid_o,
    input  logic                 request_ready_i,
    output logic [31:0]          request_address_o,  // bytes
    output logic [5:0]           request_beats_o,
    input  logic                 answer_valid_i,
    output logic                 answer_ready_o,
    input  logic [PORT_BITS-1:0] answer_data_i,

    output logic hit_o,  // a sample has been looked up in the cache
    output logic miss_o,
    output logic idle_o  // nothing is under way
);

  localparam int SIDE_BITS = 12;
  localparam int LANE = (SAMPLES == 1) ? 1 : $clog2(SAMPLES);
  localparam int TAIL = LANE + 1;
  localparam int INDEX = $clog2(QUEUE);
  localparam int COLOR = 8 * CHANNELS;
  localparam int PLACE = Q_BITS + 2 * P_BITS;
  localparam int COORDINATES = SAMPLES * PLACE;
  localparam int LINE = $clog2(LINES);
  localparam int LINE_X = (LINE + 1) / 2;
  localparam int LINE_Y = LINE / 2;
  localparam int AHEAD = 16;  // samples between split and tags
  localparam int CLOCKS = 8;  // of texture_coordinates

  // ---------------------------------------------------------------------------------------------------------------- the door
  logic       is_textured, door_enable_q;
  logic [2:0] door_format_q;
  logic [1:0] door_combine_q;
  assign is_textured = stamp_valid_i && !sets_state_i && is_triangle_i && door_enable_q && mask_i != '0;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) door_enable_q <= 1'b0;
    else if (stamp_valid_i && sets_state_i) door_enable_q <= state_i[0];
  end
  always_ff @(posedge clk_i)
    if (stamp_valid_i && sets_state_i) begin
      door_format_q  <= state_i[4:2];
      door_combine_q <= state_i[6:5];
    end

  // Each sample's coordinates beside each other.
  logic [COORDINATES-1:0] places;
  genvar s;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_place
      assign places[s*PLACE+:PLACE] = {v_i[s*P_BITS+:P_BITS], u_i[s*P_BITS+:P_BITS], q_i[s*Q_BITS+:Q_BITS]};
    end
  endgenerate

  logic                   waits, is_state, takes;
  logic [SAMPLES-1:0]     waiting_mask;
  logic [COORDINATES-1:0] waiting;
  logic [INDEX-1:0]       entered_q, split_q;  // number of the next textured stamp at the door, and at the split
  logic                   passes_door, has_alpha, stamp_waits, stamp_is_textured, stamp_has_alpha, stamp_leaves;
  logic [1:0]             stamp_combine;
  logic [PAYLOAD-1:0]     stamp_payload;
  logic [SAMPLES-1:0]     stamp_mask;
  logic [SAMPLES*COLOR-1:0] stamp_color;
  /* verilator lint_off UNUSEDSIGNAL */  // there is room
  logic                   waiting_ready, stamps_ready;
  /* verilator lint_on UNUSEDSIGNAL */
  assign passes_door = is_textured || (stamp_valid_i && sets_state_i);
  assign has_alpha   = door_format_q != 3'd0 && door_format_q != 3'd2;
  fifo #(
      .WIDTH(1 + SAMPLES + COORDINATES),
      .DEPTH(QUEUE)
  ) u_coordinates (
      .clk_i,
      .rst_ni,
      .valid_i(passes_door),
      .ready_o(waiting_ready),
      .data_i ({sets_state_i, mask_i, places[COORDINATES-1:STATE], sets_state_i ? state_i : places[STATE-1:0]}),
      .valid_o(waits),
      .ready_i(takes),
      .data_o ({is_state, waiting_mask, waiting})
  );
  fifo #(
      .WIDTH(PAYLOAD + SAMPLES * (1 + COLOR) + 4),
      .DEPTH(QUEUE)
  ) u_stamps (
      .clk_i,
      .rst_ni,
      .valid_i(stamp_valid_i),
      .ready_o(stamps_ready),
      .data_i ({payload_i, mask_i, color_i, is_textured, door_combine_q, has_alpha}),
      .valid_o(stamp_waits),
      .ready_i(stamp_leaves),
      .data_o ({stamp_payload, stamp_mask, stamp_color, stamp_is_textured, stamp_combine, stamp_has_alpha})
  );

  // --------------------------------------------------------------------------------------------------------------- the split
  function automatic [LANE-1:0] lowest(input [SAMPLES-1:0] mask);
    lowest = '0;
    for (int i = SAMPLES - 1; i >= 0; i--) if (mask[i]) lowest = LANE'(i);
  endfunction
  function automatic [PLACE-1:0] place_of(input [COORDINATES-1:0] all, input [LANE-1:0] lane);
    logic [COORDINATES-1:0] left;
    left = all;
    for (int bits = $clog2(SAMPLES) - 1; bits >= 0; bits--) left = lane[bits] ? left >> (PLACE << bits) : left;
    place_of = left[PLACE-1:0];
  endfunction

  logic               splits, sets_state, is_last, leaves_queue, tags_are_empty;
  logic [SAMPLES-1:0] done_q, left;  // samples of the stamp that are through; that are not
  logic [LANE-1:0]    lane;
  logic [4:0]         ahead_q;
  assign left       = waiting_mask & ~done_q;
  assign lane       = lowest(left);
  assign is_last    = (left & (left - 1'b1)) == '0;
  assign splits     = waits && !is_state && ahead_q != 5'(AHEAD);
  assign sets_state = waits && is_state && ahead_q == '0 && tags_are_empty;
  assign takes      = sets_state || (splits && is_last);

  logic [PLACE-1:0] place_q;  // the sample
  logic [INDEX-1:0] place_index_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      done_q    <= '0;
      ahead_q   <= '0;
      entered_q <= '0;
      split_q   <= '0;
    end else begin
      if (splits) done_q <= is_last ? '0 : done_q | SAMPLES'(1) << lane;
      ahead_q   <= ahead_q + 5'(splits) - 5'(leaves_queue);
      entered_q <= entered_q + INDEX'(is_textured);
      split_q   <= split_q + INDEX'(splits && is_last);
    end
  end
  always_ff @(posedge clk_i) begin
    place_q       <= place_of(waiting, lane);
    place_index_q <= split_q;
  end

  // The state at work.
  logic [2:0]             format_q;
  logic [3:0]             wrap_q;
  logic [2*SIDE_BITS-1:0] last_q;   // of each side, the number of its last texel
  logic                   is_linear_q;
  logic [1:0]             size_q;   // log2 of a line's bytes, less 4
  logic [3:0]             row_q;    // that of a row of lines
  logic [25:0]            base_q;   // 64 bytes
  logic [3:0]             log2_width;
  logic [1:0]             size;
  assign log2_width = waiting[14:11];
  assign size       = waiting[4:2] == 3'd0 ? 2'd0 : waiting[4:2] == 3'd5 ? 2'd2 : 2'd1;
  always_ff @(posedge clk_i)
    if (sets_state) begin
      format_q    <= waiting[4:2];
      wrap_q      <= waiting[10:7];
      last_q      <= {~(12'hfff << waiting[18:15]), ~(12'hfff << log2_width)};
      size_q      <= size;
      row_q       <= 4'(size) + (log2_width[3:1] == '0 ? 4'd0 : log2_width - 4'd2);
      base_q      <= waiting[44:19];
      is_linear_q <= FILTER != 0 && waiting[45];
    end

  // ------------------------------------------------------------------------------------------------------------ the address
  logic [CLOCKS:0]            valid_q;  // of a clock ago lowest
  logic [TAIL*(CLOCKS+1)-1:0] tail_q;
  logic [2*SIDE_BITS-1:0]     texel;
  /* verilator lint_off UNUSEDSIGNAL */  // of a linear filter
  logic [2*SIDE_BITS-1:0]     next;
  logic [15:0]                part;
  /* verilator lint_on UNUSEDSIGNAL */
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= {valid_q[CLOCKS-1:0], splits};
  end
  always_ff @(posedge clk_i) tail_q <= {tail_q[TAIL*CLOCKS-1:0], is_last, lane};

  texture_coordinates #(
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
      .LINEAR        (FILTER)
  ) u_texture_coordinates (
      .clk_i,
      .frame_valid_i(is_textured),
      .frame_index_i(entered_q),
      .shift_i,
      .reach_i,
      .reference_i,
      .index_i      (place_index_q),
      .q_i          (place_q[Q_BITS-1:0]),
      .u_i          (place_q[Q_BITS+:P_BITS]),
      .v_i          (place_q[Q_BITS+P_BITS+:P_BITS]),
      .last_i       (last_q),
      .wrap_i       (wrap_q),
      .is_linear_i  (is_linear_q),
      .texel_o      (texel),
      .next_o       (next),
      .part_o       (part)
  );

  // The texels: nearest, with the address of each in front of the queue; or the four around a place.
  logic            found_valid, found_ready, drops, cache_is_idle;
  logic            texel_valid, texel_ready;
  logic [31:0]     texel_color, e_texel_q;
  logic [TAIL-1:0] texel_tail;
  /* verilator lint_off UNUSEDSIGNAL */  // there is room: those ahead are counted
  logic            found_has_room;
  /* verilator lint_on UNUSEDSIGNAL */
  assign drops        = sets_state && waiting[1];
  assign leaves_queue = found_valid && found_ready;
  generate
    if (FILTER == 0) begin : gen_nearest
      // Blocks of 4x4 texels in rows; which line, their lowest bits say.
      logic [9:0]      block_x, block_y;
      logic [21:0]     place;
      logic [27:0]     address, found_address;
      logic [LINE-1:0] line, found_line;
      logic [3:0]      found_texel;
      logic [TAIL-1:0] found_tail;
      logic [31:0]     code;
      logic [2:0]      code_format;
      assign block_x          = texel[11:2];
      assign block_y          = texel[23:14];
      assign place            = (22'(block_y) << row_q) | (22'(block_x) << size_q);
      assign address          = {base_q, 2'd0} + 28'(place);
      assign line[LINE_X-1:0] = block_x[LINE_X-1:0];
      if (LINE_Y > 0) begin : gen_line_y
        assign line[LINE-1:LINE_X] = block_y[LINE_Y-1:0];
      end

      fifo #(
          .WIDTH(28 + LINE + 4 + TAIL),
          .DEPTH(AHEAD)
      ) u_addresses (
          .clk_i,
          .rst_ni,
          .valid_i(valid_q[CLOCKS]),
          .ready_o(found_has_room),
          .data_i ({address, line, texel[13:12], texel[1:0], tail_q[TAIL*CLOCKS+:TAIL]}),
          .valid_o(found_valid),
          .ready_i(found_ready),
          .data_o ({found_address, found_line, found_texel, found_tail})
      );
      texture_cache #(
          .LINES    (LINES),
          .PORT_BITS(PORT_BITS),
          .IN_FLIGHT(IN_FLIGHT),
          .TAIL     (TAIL)
      ) u_cache (
          .clk_i,
          .rst_ni,
          .power_on_ni,
          .sample_valid_i  (found_valid),
          .sample_ready_o  (found_ready),
          .address_i       (found_address),
          .line_i          (found_line),
          .texel_i         (found_texel),
          .format_i        (format_q),
          .tail_i          (found_tail),
          .drop_i          (drops),
          .tags_are_empty_o(tags_are_empty),
          .code_valid_o    (texel_valid),
          .code_ready_i    (texel_ready),
          .code_o          (code),
          .code_format_o   (code_format),
          .code_tail_o     (texel_tail),
          .request_valid_o,
          .request_ready_i,
          .request_address_o,
          .request_beats_o,
          .answer_valid_i,
          .answer_ready_o,
          .answer_data_i,
          .hit_o,
          .miss_o,
          .idle_o          (cache_is_idle)
      );
      texture_decode u_decode (
          .code_i  (code),
          .format_i(code_format),
          .texel_o (texel_color)
      );
    end else begin : gen_linear
      logic [2*SIDE_BITS-1:0] found_texel, found_next;
      logic [15:0]            found_part, code_part;
      logic [TAIL-1:0]        found_tail, code_tail;
      logic                   code_valid, code_ready;
      logic [127:0]           code;
      logic [2:0]             code_format;
      fifo #(
          .WIDTH(4 * SIDE_BITS + 16 + TAIL),
          .DEPTH(AHEAD)
      ) u_places (
          .clk_i,
          .rst_ni,
          .valid_i(valid_q[CLOCKS]),
          .ready_o(found_has_room),
          .data_i ({texel, next, part, tail_q[TAIL*CLOCKS+:TAIL]}),
          .valid_o(found_valid),
          .ready_i(found_ready),
          .data_o ({found_texel, found_next, found_part, found_tail})
      );
      texture_cache_linear #(
          .LINES    (LINES),
          .PORT_BITS(PORT_BITS),
          .IN_FLIGHT(IN_FLIGHT),
          .TAIL     (16 + TAIL),
          .SIDE_BITS(SIDE_BITS)
      ) u_cache (
          .clk_i,
          .rst_ni,
          .power_on_ni,
          .sample_valid_i  (found_valid),
          .sample_ready_o  (found_ready),
          .x_i             ({found_next[SIDE_BITS-1:0], found_texel[SIDE_BITS-1:0]}),
          .y_i             ({found_next[2*SIDE_BITS-1:SIDE_BITS], found_texel[2*SIDE_BITS-1:SIDE_BITS]}),
          .tail_i          ({found_part, found_tail}),
          .format_i        (format_q),
          .base_i          (base_q),
          .size_i          (size_q),
          .row_i           (row_q),
          .drop_i          (drops),
          .tags_are_empty_o(tags_are_empty),
          .code_valid_o    (code_valid),
          .code_ready_i    (code_ready),
          .code_o          (code),
          .code_format_o   (code_format),
          .code_tail_o     ({code_part, code_tail}),
          .request_valid_o,
          .request_ready_i,
          .request_address_o,
          .request_beats_o,
          .answer_valid_i,
          .answer_ready_o,
          .answer_data_i,
          .hit_o,
          .miss_o,
          .idle_o          (cache_is_idle)
      );
      texture_filter #(
          .TAIL(TAIL)
      ) u_filter (
          .clk_i,
          .rst_ni,
          .valid_i (code_valid),
          .ready_o (code_ready),
          .code_i  (code),
          .format_i(code_format),
          .part_i  (code_part),
          .tail_i  (code_tail),
          .valid_o (texel_valid),
          .ready_i (texel_ready),
          .texel_o (texel_color),
          .tail_o  (texel_tail)
      );
    end
  endgenerate

  // ------------------------------------------------------------------------------------- combine, and the stamp on its way out
  logic                     e_valid_q, e_last_q, e_moves, passes, is_free, out_valid_q;
  logic [LANE-1:0]          e_lane_q;
  logic [COLOR-1:0]         e_color, combined;
  logic [PAYLOAD-1:0]       payload_q;
  logic [SAMPLES-1:0]       mask_q;
  logic [SAMPLES*COLOR-1:0] color_q;

  function automatic [COLOR-1:0] color_of(input [SAMPLES*COLOR-1:0] all, input [LANE-1:0] of_lane);
    logic [SAMPLES*COLOR-1:0] rest;
    rest = all;
    for (int bits = $clog2(SAMPLES) - 1; bits >= 0; bits--) rest = of_lane[bits] ? rest >> (COLOR << bits) : rest;
    color_of = rest[COLOR-1:0];
  endfunction

  assign e_color = color_of(stamp_color, e_lane_q);
  texture_combine #(
      .CHANNELS(CHANNELS),
      .SOFT    (SOFT)
  ) u_combine (
      .texel_i    (e_texel_q),
      .color_i    (e_color),
      .combine_i  (stamp_combine),
      .has_alpha_i(stamp_has_alpha),
      .color_o    (combined)
  );

  assign is_free      = !out_valid_q || stamp_ready_i;
  assign passes       = stamp_waits && !stamp_is_textured && is_free;
  assign e_moves      = e_valid_q && stamp_is_textured && is_free;  // the first that is textured is its own
  assign stamp_leaves = passes || (e_moves && e_last_q);
  assign texel_ready  = !e_valid_q || e_moves;

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
      e_texel_q            <= texel_color;
      {e_last_q, e_lane_q} <= texel_tail;
    end
    if (stamp_leaves) begin
      payload_q <= stamp_payload;
      mask_q    <= stamp_mask;
    end
    for (int i = 0; i < SAMPLES; i++)
      if (passes || (e_moves && e_lane_q == LANE'(i)))
        color_q[i*COLOR+:COLOR] <= stamp_is_textured ? combined : stamp_color[i*COLOR+:COLOR];
  end

  assign stamp_valid_o = out_valid_q;
  assign payload_o     = payload_q;
  assign mask_o        = mask_q;
  assign color_o       = color_q;
  assign idle_o        = !waits && !stamp_waits && !out_valid_q && cache_is_idle;

endmodule
