// Colored stamps: fragments between depth test and colour write, with the colours that are written: through the texture unit, where
// there is one, light in front of it, fog and rop behind it; else as they are, two of them at most.
//
// A stamp never waits on its way in: X counts those inside, at most PLACES.
module colored_stamps #(
    parameter int CARRIED = 8,  // bits that go along
    parameter int PLACES  = 2
) (
    input logic clk_i,
    /* verilator lint_off UNUSEDSIGNAL */  // without a texture unit
    input logic power_on_ni,
    /* verilator lint_on UNUSEDSIGNAL */
    input logic rst_ni,

    // From X and depth_test
    input logic               stamp_valid_i,
    input logic [CARRIED-1:0] carried_i,
    /* verilator lint_off UNUSEDSIGNAL */  // likewise; most of the fragment goes along by itself
    input logic [raster_pkg::SAMPLES-1:0]                                writes_i,  // samples whose colour is written
    input raster_pkg::fragment_packet_t                                  fragment_i,
    input logic [raster_pkg::SAMPLES*raster_pkg::WRITTEN_COLOR_BITS-1:0] color_i,  // the same at all samples of a pixel
    /* verilator lint_on UNUSEDSIGNAL */

    // To W
    output logic                                                        stamp_valid_o,
    input  logic                                                        stamp_ready_i,
    output logic [CARRIED-1:0]                                          carried_o,
    output logic [raster_pkg::SAMPLES*raster_pkg::SHADED_COLOR_BITS-1:0] color_o,
    output logic [raster_pkg::PIXELS*8-1:0]                             alpha_o,  // with a texture unit; else known before

    // To and from the memory of textures
    output logic                         texture_valid_o,
    output raster_pkg::texture_request_t texture_o,
    output logic                         texel_ready_o,
    /* verilator lint_off UNUSEDSIGNAL */
    input  logic                         texture_ready_i,
    input  logic                         texel_valid_i,
    input  raster_pkg::texel_beat_t      texel_i,
    /* verilator lint_on UNUSEDSIGNAL */

    // What W takes, for the co-simulation
    output logic                      packet_valid_o,
    output raster_pkg::color_packet_t packet_o,

    output logic [6:0] texture_use_o,  // so many samples were looked up, of so many all was there, a line was asked for; lowest first
    output logic       texture_is_idle_o  // behind a reset it may wait for answers of before
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int PIXELS = raster_pkg::PIXELS;
  localparam int N = raster_pkg::MSAA_SAMPLES;  // of a pixel, which has one colour, whatever samples it is written to
  localparam int COLOR = raster_pkg::SHADED_COLOR_BITS;  // as W takes it: as it is stored, unless it packs

  genvar s;
  /* verilator lint_off UNUSEDSIGNAL */  // most of the fragment goes along by itself
  raster_pkg::fragment_packet_t door_fragment;  // at the door of the texture unit; here, because Yosys knows no structs in blocks
  /* verilator lint_on UNUSEDSIGNAL */
  generate
    if (raster_pkg::COORDINATES == 0) begin : gen_colored
      /* verilator lint_off UNUSEDSIGNAL */  // there is room: X counts
      logic w_ready;
      /* verilator lint_on UNUSEDSIGNAL */
      logic [PIXELS*COLOR-1:0] of_pixels, w_color;
      for (s = 0; s < SAMPLES; s++) begin : gen_sample
        if (s % N == 0) begin : gen_first
          assign of_pixels[s/N*COLOR+:COLOR] = color_i[s*COLOR+:COLOR];
        end
        assign color_o[s*COLOR+:COLOR] = w_color[s/N*COLOR+:COLOR];
      end
      skid_buffer #(
          .WIDTH(CARRIED + PIXELS * COLOR)
      ) u_colored (
          .clk_i,
          .rst_ni,
          .valid_i(stamp_valid_i),
          .ready_o(w_ready),
          .data_i ({carried_i, of_pixels}),
          .valid_o(stamp_valid_o),
          .ready_i(stamp_ready_i),
          .data_o ({carried_o, w_color})
      );
      assign door_fragment     = fragment_i;
      assign alpha_o           = '0;
      assign texture_is_idle_o = 1'b1;
      assign texture_use_o     = '0;
      assign texture_valid_o   = 1'b0;
      assign texture_o         = '0;
      assign texel_ready_o     = 1'b0;
      assign packet_valid_o    = 1'b0;
      assign packet_o          = '0;
    end else begin : gen_textured
      localparam int FRAGMENT = raster_pkg::ALL_FRAGMENT_BITS;  // of a pixel
      localparam int AFFINE = raster_pkg::AFFINE_PLANES;
      localparam int Q = raster_pkg::FRAGMENT_BITS_OF[32*AFFINE+:32];
      localparam int P = raster_pkg::FRAGMENT_BITS_OF[32*(AFFINE+1)+:32];
      localparam int Q_AT = raster_pkg::FRAGMENT_AT[32*AFFINE+:32];
      localparam int CHANNELS = raster_pkg::COLOR_PLANES;
      localparam int L = raster_pkg::PERSPECTIVE_GUARD_BITS;
      localparam int AFFINE_BITS = raster_pkg::ALL_AFFINE_CODE_BITS;
      localparam int NARROW = raster_pkg::PERSPECTIVE_MANTISSA_BITS - 1;  // k_P
      // A sample that is not written has colour 0, in the packet always, to W where that looks at more than its mask.
      localparam bit CLEANS = N > 1 || raster_pkg::BLEND_LANES != 0;
      localparam int WORD = raster_pkg::TEXTURE_UNIT != 3 ? 46 : raster_pkg::STATE_WORD_BITS >= 104 ? 104 : 70;
      localparam int PIXEL = 12;
      localparam int TOKEN = 43;  // of tokens of fog and of light
      localparam int PLACES_BITS = 19 * PIXELS > TOKEN ? 19 * PIXELS : TOKEN;
      localparam int FOG = raster_pkg::FOG_UNIT == 0 ? 0 : 3 + PLACES_BITS;  // that fog carries along
      logic [CARRIED+FOG-1:0] entering, unit_carried;
      logic [$clog2(raster_pkg::TEXTURE_LANES+1)-1:0] samples, hits;
      assign texture_use_o[5:0] = {3'(hits), 3'(samples)};
      // Pixels with a sample that gets a colour, and their own.
      logic [PIXELS-1:0]                                 writes;
      logic [PIXELS*raster_pkg::WRITTEN_COLOR_BITS-1:0]  color;
      for (s = 0; s < PIXELS; s++) begin : gen_shaded
        assign writes[s] = writes_i[s*N+:N] != '0;
        assign color[s*raster_pkg::WRITTEN_COLOR_BITS+:raster_pkg::WRITTEN_COLOR_BITS] =
            color_i[s*N*raster_pkg::WRITTEN_COLOR_BITS+:raster_pkg::WRITTEN_COLOR_BITS];
      end
      // At the door of the texture unit.
      logic                                              door_valid;
      logic [CARRIED-1:0]                                door_carried;
      logic [PIXELS-1:0]                                door_writes;
      logic [PIXELS*raster_pkg::WRITTEN_COLOR_BITS-1:0] door_color;
      localparam int TILE = raster_pkg::TILE_SHIFT;
      localparam int STAMP = $clog2(raster_pkg::STAMP_SIZE);
      localparam int ROW = $clog2(raster_pkg::STAMPS_PER_ROW);
      /* verilator lint_off UNUSEDSIGNAL */  // longer than a state
      logic [raster_pkg::STATE_WORD_BITS-1:0] word;  // of a token: its codes
      logic [PIXEL-1:0] stamp_x, stamp_y;          // its first pixel, as levels want it
      /* verilator lint_on UNUSEDSIGNAL */
      logic [PIXELS*Q-1:0]          q;
      logic [PIXELS*P-1:0]          u, v;
      logic [PIXELS*8*CHANNELS-1:0] rgba;
      logic [PIXELS-1:0]            mask;
      logic is_token, is_triangle, is_levels, unit_valid, unit_ready, sets_light, sets_fog, sets_fog_line;
      logic [PIXELS-1:0]            unit_mask;
      logic [PIXELS*8*CHANNELS-1:0] unit_rgba;
      // Light: of the fragment goes along what is not of the normals.
      if (raster_pkg::NORMALS == 0) begin : gen_unlit
        assign door_valid    = stamp_valid_i;
        assign door_carried  = carried_i;
        assign door_writes   = writes;
        assign door_fragment = fragment_i;
        assign door_color    = color;
      end else begin : gen_lit
        localparam int NORMALS_AT = raster_pkg::FRAGMENT_AT[32*(AFFINE+3*(raster_pkg::NORMALS!=0 ? 1 : 0))+:32];
        localparam int NORMAL = (FRAGMENT - NORMALS_AT) / 3;
        localparam int HEADER_AT = PIXELS * FRAGMENT + PIXELS * (N - 1) * raster_pkg::DEPTH_CODE_BITS;  // depths end at the test
        localparam int HEADER = raster_pkg::FRAGMENT_PACKET_BITS - HEADER_AT;
        logic [PIXELS*NORMALS_AT-1:0] others, door_others;
        logic [3*NORMAL*PIXELS-1:0]   normals;
        logic [HEADER-1:0]             header, door_header;
        logic [PIXELS*FRAGMENT-1:0]   door_code;
        /* verilator lint_off UNUSEDSIGNAL */
        logic [raster_pkg::STATE_WORD_BITS-1:0] arriving;
        /* verilator lint_on UNUSEDSIGNAL */
        assign header   = fragment_i[raster_pkg::FRAGMENT_PACKET_BITS-1:HEADER_AT];
        assign arriving = {fragment_i.code[Q_AT+Q+P+L+:P-L-1], fragment_i.code[Q_AT+Q+L+:P-L-1], fragment_i.code[Q_AT+L+:Q-L-1],
                           fragment_i.code[0+:AFFINE_BITS]};  // as word below
        for (s = 0; s < PIXELS; s++) begin : gen_pixel
          assign others[s*NORMALS_AT+:NORMALS_AT] = fragment_i.code[s*FRAGMENT+:NORMALS_AT];
          assign normals[s*3*NORMAL+:3*NORMAL]    = fragment_i.code[s*FRAGMENT+NORMALS_AT+:3*NORMAL];
          assign door_code[s*FRAGMENT+:FRAGMENT]  = {{(3*NORMAL) {1'b0}}, door_others[s*NORMALS_AT+:NORMALS_AT]};
        end
        assign door_fragment = (raster_pkg::FRAGMENT_PACKET_BITS'(door_header) << HEADER_AT) |
                               raster_pkg::FRAGMENT_PACKET_BITS'(door_code);
        light_unit #(
            .SAMPLES (PIXELS),
            .CHANNELS(CHANNELS),
            .P_BITS  (NORMAL),
            .PAYLOAD (CARRIED + PIXELS + HEADER + PIXELS * NORMALS_AT),
            .WORD    (TOKEN),
            .PLACES  (PLACES)
        ) u_light (
            .clk_i,
            .rst_ni,
            .stamp_valid_i(stamp_valid_i),
            .payload_i    ({carried_i, writes, header, others}),
            .color_i      (color),
            .is_triangle_i(fragment_i.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE),
            .mask_i       (writes),
            .p_i          (normals),
            .sets_i       (fragment_i.kind == raster_pkg::PRIMITIVE_KIND_STATE &&
                           fragment_i.state.depth_test == raster_pkg::STATE_REGISTER_TEXTURE_LEVELS &&
                           arriving[TOKEN+:2] == 2'd3),
            .word_i       (arriving[TOKEN-1:0]),
            .stamp_valid_o(door_valid),
            .payload_o    ({door_carried, door_writes, door_header, door_others}),
            .color_o      (door_color)
        );
      end

      // Colours over w, where there are some.
      localparam int OVER_W = raster_pkg::COLORS_OVER_W != 0 ? 1 : 0;
      localparam int COLOR_P = OVER_W != 0 ? raster_pkg::LOCAL_BITS_OF[32*(AFFINE+3*OVER_W)+:32] : 24;
      logic                                  divides_colors;
      logic [PIXELS*CHANNELS*COLOR_P-1:0]   color_p;
      logic [CHANNELS*raster_pkg::COLOR_SHIFT_BITS-1:0] color_shift;
      logic [CHANNELS*raster_pkg::COLOR_REACH_BITS-1:0] color_reach;
      logic [CHANNELS*8-1:0]                 least_color, greatest_color;
      if (OVER_W != 0) begin : gen_over_w
        assign divides_colors = door_fragment.coordinates.divides_colors;
        assign color_shift    = door_fragment.coordinates.color_shift;
        assign color_reach    = door_fragment.coordinates.color_reach;
        assign least_color    = door_fragment.least_color;
        assign greatest_color = door_fragment.greatest_color;
        for (s = 0; s < PIXELS; s++) begin : gen_color
          assign color_p[s*CHANNELS*COLOR_P+:CHANNELS*COLOR_P] =
              door_fragment.code[s*FRAGMENT+Q_AT+Q+2*P+:CHANNELS*COLOR_P];
        end
      end else begin : gen_affine
        assign divides_colors = 1'b0;
        assign color_p        = '0;
        assign color_shift    = '0;
        assign color_reach    = '0;
        assign least_color    = '0;
        assign greatest_color = '0;
      end
      assign stamp_x = (PIXEL'(door_fragment.key.tile_x) << TILE) |
                       ((PIXEL'(door_fragment.stamp) & PIXEL'((1 << ROW) - 1)) << STAMP);
      assign stamp_y = (PIXEL'(door_fragment.key.tile_y) << TILE) | ((PIXEL'(door_fragment.stamp) >> ROW) << STAMP);
      assign word = {door_fragment.code[Q_AT+Q+P+L+:P-L-1], door_fragment.code[Q_AT+Q+L+:P-L-1], door_fragment.code[Q_AT+L+:Q-L-1],
                     door_fragment.code[0+:AFFINE_BITS]};
      assign is_token = door_fragment.kind == raster_pkg::PRIMITIVE_KIND_STATE;
      assign is_triangle = door_fragment.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
      assign is_levels = is_token && door_fragment.state.depth_test == raster_pkg::STATE_REGISTER_TEXTURE_LEVELS;
      assign sets_light = raster_pkg::NORMALS != 0 && is_levels && word[TOKEN+:2] == 2'd3;
      assign entering[CARRIED-1:0] = door_carried;
      for (s = 0; s < PIXELS; s++) begin : gen_pixel
        assign q[s*Q+:Q] = door_fragment.code[s*FRAGMENT+Q_AT+:Q];
        assign u[s*P+:P] = door_fragment.code[s*FRAGMENT+Q_AT+Q+:P];
        assign v[s*P+:P] = door_fragment.code[s*FRAGMENT+Q_AT+Q+P+:P];
        logic [COLOR-1:0] packed_color;
        if (raster_pkg::BLEND_LANES != 0 || raster_pkg::DITHER_UNIT != 0) begin : gen_whole
          assign packed_color = rgba[s*8*CHANNELS+:8*CHANNELS];
        end else begin : gen_rop
          rop u_rop (
              .rgba_i (rgba[s*8*CHANNELS+:8*CHANNELS]),
              .color_o(packed_color)
          );
        end
        assign alpha_o[s*8+:8] = rgba[(s+1)*8*CHANNELS-1-:8];
        assign color_o[s*N*COLOR+:N*COLOR]  = {N{packed_color & {COLOR{mask[s] || !CLEANS}}}};
        assign packet_o.color[s*N*COLOR+:N*COLOR] = {N{packed_color & {COLOR{mask[s]}}}};
        assign packet_o.mask[s*N+:N]        = {N{mask[s]}};
      end

      texture_unit #(
          .SAMPLES       (PIXELS),
          .LANES         (raster_pkg::TEXTURE_LANES),
          .Q_BITS        (Q),
          .P_BITS        (P),
          .MANTISSA      (raster_pkg::PERSPECTIVE_MANTISSA_BITS),
          .NARROW        (NARROW),
          .FRACTION      (raster_pkg::COORDINATE_FRACTION),
          .SHIFT_BITS    (raster_pkg::COORDINATE_SHIFT_BITS),
          .REACH_BITS    (raster_pkg::COORDINATE_REACH_BITS),
          .REFERENCE_BITS(raster_pkg::COORDINATE_REFERENCE_BITS),
          .CHANNELS      (CHANNELS),
          .FILTER        (raster_pkg::TEXTURE_UNIT - 1),
          .RECIPROCAL    (raster_pkg::RECIPROCAL_KIND),
          .PAYLOAD       (CARRIED + FOG),
          .QUEUE         (PLACES),
          .IN_FLIGHT     (raster_pkg::TEXTURE_QUEUE),
          .LINES         (16 * raster_pkg::TEXTURE_CACHE_KB),
          .WAYS          (raster_pkg::TEXTURE_WAYS),
          .PORT_BITS     (raster_pkg::TEXTURE_PORT_BITS),
          .WORD          (WORD),
          .PIXEL         (PIXEL),
          .OVER_W          (OVER_W),
          .COLOR_P_BITS    (COLOR_P),
          .COLOR_NARROW    (raster_pkg::COLOR_NARROW_BITS),
          .COLOR_SHIFT_BITS(raster_pkg::COLOR_SHIFT_BITS),
          .COLOR_REACH_BITS(raster_pkg::COLOR_REACH_BITS)
      ) u_texture (
          .clk_i,
          .power_on_ni,
          .rst_ni,
          .stamp_valid_i  (door_valid),
          .payload_i      (entering),
          .mask_i         (door_writes),
          .color_i        (door_color),
          .is_triangle_i  (is_triangle),
          .q_i            (q),
          .u_i            (u),
          .v_i            (v),
          .shift_i        (door_fragment.coordinates.shift),
          .reach_i        (door_fragment.coordinates.reach),
          .reference_i    (door_fragment.coordinates.origin),
          .sets_state_i   (is_token && door_fragment.state.depth_test == raster_pkg::STATE_REGISTER_TEXTURE),
          .sets_levels_i  (is_levels && !sets_light && !sets_fog && !sets_fog_line),
          .moves_in_i     (is_token && door_fragment.state.depth_test == raster_pkg::STATE_REGISTER_TEXTURE_LINES),
          .x_i            (stamp_x),
          .y_i            (stamp_y),
          .state_i        (word[WORD-1:0]),
          .divides_colors_i(divides_colors),
          .color_p_i       (color_p),
          .color_shift_i   (color_shift),
          .color_reach_i   (color_reach),
          .least_color_i   (least_color),
          .greatest_color_i(greatest_color),
          .stamp_valid_o  (unit_valid),
          .stamp_ready_i  (unit_ready),
          .payload_o      (unit_carried),
          .mask_o         (unit_mask),
          .color_o        (unit_rgba),
          .request_valid_o(texture_valid_o),
          .request_ready_i(texture_ready_i),
          .request_address_o(texture_o.address),
          .request_beats_o(texture_o.beats),
          .answer_valid_i (texel_valid_i),
          .answer_ready_o (texel_ready_o),
          .answer_data_i  (texel_i.data),
          .sample_o       (samples),
          .hit_o          (hits),
          .miss_o         (texture_use_o[6]),
          .idle_o         (texture_is_idle_o)
      );

      // Fog: where the samples of triangles lie in its table they know at the door, by what has been set there.
      if (raster_pkg::FOG_UNIT == 0) begin : gen_clear
        assign sets_fog      = 1'b0;
        assign sets_fog_line = 1'b0;
        assign stamp_valid_o = unit_valid;
        assign unit_ready    = stamp_ready_i;
        assign carried_o     = unit_carried;
        assign mask          = unit_mask;
        assign rgba          = unit_rgba;
      end else begin : gen_fogged
        localparam int COLOR_BITS = 24;
        logic       enable_q;   // there is fog
        logic [2:0] octaves_q;  // of its table
        logic [PLACES_BITS-1:0] places;
        assign sets_fog      = is_levels && word[TOKEN+:2] == 2'd1;
        assign sets_fog_line = is_levels && word[TOKEN+:2] == 2'd2;
        always_ff @(posedge clk_i or negedge rst_ni) begin
          if (!rst_ni) enable_q <= 1'b0;
          else if (door_valid && sets_fog) enable_q <= word[COLOR_BITS+3];
        end
        always_ff @(posedge clk_i) if (door_valid && sets_fog) octaves_q <= word[COLOR_BITS+:3];
        for (s = 0; s < PIXELS; s++) begin : gen_place
          fog_place #(
              .Q_BITS(Q)
          ) u_place (
              .q_i      (q[s*Q+:Q]),
              .octave_i (door_fragment.coordinates.fog_octave),
              .octaves_i(octaves_q),
              .place_o  (places[19*s+:19])
          );
        end
        if (PLACES_BITS > 19 * PIXELS) begin : gen_rest
          assign places[PLACES_BITS-1:19*PIXELS] = '0;
        end
        assign entering[CARRIED+:PLACES_BITS] = is_token ? PLACES_BITS'(word[TOKEN-1:0]) : places;
        assign entering[CARRIED+PLACES_BITS+:3] = {sets_fog_line, sets_fog,
            enable_q && is_triangle};

        fog_unit #(
            .SAMPLES (PIXELS),
            .CHANNELS(CHANNELS),
            .PAYLOAD (CARRIED + PIXELS),
            .WORD    (PLACES_BITS)
        ) u_fog (
            .clk_i,
            .rst_ni,
            .stamp_valid_i(unit_valid),
            .stamp_ready_o(unit_ready),
            .payload_i    ({unit_carried[CARRIED-1:0], unit_mask}),
            .color_i      (unit_rgba),
            .is_fogged_i  (unit_carried[CARRIED+PLACES_BITS]),
            .sets_color_i (unit_carried[CARRIED+PLACES_BITS+1]),
            .sets_line_i  (unit_carried[CARRIED+PLACES_BITS+2]),
            .word_i       (unit_carried[CARRIED+:PLACES_BITS]),
            .stamp_valid_o(stamp_valid_o),
            .stamp_ready_i(stamp_ready_i),
            .payload_o    ({carried_o, mask}),
            .color_o      (rgba)
        );
      end
      assign packet_valid_o = stamp_valid_o && mask != '0;
    end
  endgenerate

endmodule
