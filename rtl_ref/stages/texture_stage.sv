// Texture stage: texture_unit in the stream of tested stamps, and the fields of fragments and tokens that it uses.
//
// A stamp never waits on its way in: depth_cache counts the stamps inside, at most SHADED_STAMPS.
// Specification: model/stages/texture_stage.hpp.
module texture_stage #(
    parameter int PIXELS = raster_pkg::PIXELS,  // derived; not to be set
    parameter int CHANNELS = raster_pkg::COLOR_PLANES,
    parameter int COLORS = raster_pkg::PIXELS * raster_pkg::WRITTEN_COLOR_BITS,
    parameter int FOG = raster_pkg::FOG_WORD_BITS
) (
    input logic clk_i,
    input logic power_on_ni,
    input logic rst_ni,

    // From light_stage and fog_lookup
    input logic                         stamp_valid_i,
    input raster_pkg::tested_stamp_t    stamp_i,
    input raster_pkg::fragment_packet_t fragment_i,
    input logic [FOG-1:0]               fog_i,
    input logic [PIXELS-1:0]            writes_i,  // pixels that get a colour
    input logic [COLORS-1:0]            color_i,   // colour of the primitive

    // To fog_stage
    output logic                         stamp_valid_o,
    input  logic                         stamp_ready_i,
    output raster_pkg::tested_stamp_t    stamp_o,
    output logic [FOG-1:0]               fog_o,
    output logic [PIXELS-1:0]            mask_o,
    output logic [PIXELS*8*CHANNELS-1:0] rgba_o,

    // To and from the texture memory
    output logic                         texture_valid_o,
    input  logic                         texture_ready_i,
    output raster_pkg::texture_request_t texture_o,
    input  logic                         texel_valid_i,
    output logic                         texel_ready_o,
    input  raster_pkg::texel_beat_t      texel_i,

    output logic [6:0] use_o,  // samples looked up, samples that hit, a line requested; lowest first
    output logic       idle_o  // after a reset it may wait for earlier answers
);

  localparam int FRAGMENT = raster_pkg::ALL_FRAGMENT_BITS;  // bits of a pixel
  localparam int AFFINE = raster_pkg::AFFINE_PLANES;
  localparam int Q = raster_pkg::FRAGMENT_BITS_OF[32*AFFINE+:32];
  localparam int P = raster_pkg::FRAGMENT_BITS_OF[32*(AFFINE+1)+:32];
  localparam int Q_AT = raster_pkg::FRAGMENT_AT[32*AFFINE+:32];
  localparam int WORD = raster_pkg::TEXTURE_UNIT == 3 ? (raster_pkg::STATE_WORD_BITS >= 104 ? 104 : 70) :
                        raster_pkg::TEXTURE_BORDER != 0 ? 49 : 46 + raster_pkg::TEXTURE_CONSTANT;
  localparam int PIXEL = 12;
  localparam int PAYLOAD = raster_pkg::TESTED_STAMP_BITS + (raster_pkg::FOG_UNIT == 0 ? 0 : FOG);

  logic                                   is_token, is_levels, is_constant, is_border;
  logic [1:0]                             unit;
  logic [raster_pkg::DEPTH_FUNC_BITS-1:0] register;
  logic [raster_pkg::STATE_WORD_BITS-1:0] word;
  state_token u_token (
      .fragment_i,
      .is_token_o(is_token),
      .register_o(register),
      .word_o    (word),
      .unit_o    (unit)
  );
  assign is_levels   = is_token && register == raster_pkg::STATE_REGISTER_TEXTURE_LEVELS && unit == 2'd0;
  assign is_constant = raster_pkg::TEXTURE_CONSTANT != 0 && is_levels && word[raster_pkg::CONSTANT_WORD_BIT];
  assign is_border   = raster_pkg::TEXTURE_BORDER != 0 && is_levels && word[raster_pkg::BORDER_WORD_BIT];

  // Coordinates, and the stamp's first pixel, which levels need.
  localparam int TILE = raster_pkg::TILE_SHIFT;
  localparam int STAMP = $clog2(raster_pkg::STAMP_SIZE);
  localparam int ROW = $clog2(raster_pkg::STAMPS_PER_ROW);
  logic [PIXELS*Q-1:0] q;
  logic [PIXELS*P-1:0] u, v;
  logic [PIXEL-1:0]    stamp_x, stamp_y;
  assign stamp_x = (PIXEL'(fragment_i.key.tile_x) << TILE) | ((PIXEL'(fragment_i.stamp) & PIXEL'((1 << ROW) - 1)) << STAMP);
  assign stamp_y = (PIXEL'(fragment_i.key.tile_y) << TILE) | ((PIXEL'(fragment_i.stamp) >> ROW) << STAMP);

  // Colours over w, if configured.
  localparam int OVER_W = raster_pkg::COLORS_OVER_W != 0 ? 1 : 0;
  localparam int COLOR_P = OVER_W != 0 ? raster_pkg::LOCAL_BITS_OF[32*(AFFINE+3*OVER_W)+:32] : 24;
  logic                                             divides_colors;
  logic [PIXELS*CHANNELS*COLOR_P-1:0]               color_p;
  logic [CHANNELS*raster_pkg::COLOR_SHIFT_BITS-1:0] color_shift;
  logic [CHANNELS*raster_pkg::COLOR_REACH_BITS-1:0] color_reach;
  logic [CHANNELS*8-1:0]                            least_color, greatest_color;
  logic [PAYLOAD-1:0]                               entering, leaving;
  genvar s;
  generate
    for (s = 0; s < PIXELS; s++) begin : gen_pixel
      assign q[s*Q+:Q] = fragment_i.code[s*FRAGMENT+Q_AT+:Q];
      assign u[s*P+:P] = fragment_i.code[s*FRAGMENT+Q_AT+Q+:P];
      assign v[s*P+:P] = fragment_i.code[s*FRAGMENT+Q_AT+Q+P+:P];
    end
    if (OVER_W != 0) begin : gen_over_w
      assign divides_colors = fragment_i.coordinates.divides_colors;
      assign color_shift    = fragment_i.coordinates.color_shift;
      assign color_reach    = fragment_i.coordinates.color_reach;
      assign least_color    = fragment_i.least_color;
      assign greatest_color = fragment_i.greatest_color;
      for (s = 0; s < PIXELS; s++) begin : gen_color
        assign color_p[s*CHANNELS*COLOR_P+:CHANNELS*COLOR_P] = fragment_i.code[s*FRAGMENT+Q_AT+Q+2*P+:CHANNELS*COLOR_P];
      end
    end else begin : gen_affine
      assign divides_colors = 1'b0;
      assign color_p        = '0;
      assign color_shift    = '0;
      assign color_reach    = '0;
      assign least_color    = '0;
      assign greatest_color = '0;
    end
    if (raster_pkg::FOG_UNIT != 0) begin : gen_fogged
      assign entering         = {fog_i, stamp_i};
      assign {fog_o, stamp_o} = leaving;
    end else begin : gen_clear
      assign entering = stamp_i;
      assign stamp_o  = leaving;
      assign fog_o    = '0;
    end
  endgenerate

  logic [$clog2(raster_pkg::TEXTURE_LANES+1)-1:0] samples, hits;
  assign use_o[5:0] = {3'(hits), 3'(samples)};
  texture_unit #(
      .SAMPLES         (PIXELS),
      .LANES           (raster_pkg::TEXTURE_LANES),
      .Q_BITS          (Q),
      .P_BITS          (P),
      .MANTISSA        (raster_pkg::PERSPECTIVE_MANTISSA_BITS),
      .NARROW          (raster_pkg::PERSPECTIVE_MANTISSA_BITS - 1),
      .FRACTION        (raster_pkg::COORDINATE_FRACTION),
      .SHIFT_BITS      (raster_pkg::COORDINATE_SHIFT_BITS),
      .REACH_BITS      (raster_pkg::COORDINATE_REACH_BITS),
      .REFERENCE_BITS  (raster_pkg::COORDINATE_REFERENCE_BITS),
      .CHANNELS        (CHANNELS),
      .FILTER          (raster_pkg::TEXTURE_UNIT - 1),
      .RECIPROCAL      (raster_pkg::RECIPROCAL_KIND),
      .PAYLOAD         (PAYLOAD),
      .QUEUE           (raster_pkg::SHADED_STAMPS),
      .IN_FLIGHT       (raster_pkg::TEXTURE_QUEUE),
      .LINES           (16 * raster_pkg::TEXTURE_CACHE_KB),
      .WAYS            (raster_pkg::TEXTURE_WAYS),
      .PORT_BITS       (raster_pkg::TEXTURE_PORT_BITS),
      .WORD            (WORD),
      .PIXEL           (PIXEL),
      .OVER_W          (OVER_W),
      .COLOR_P_BITS    (COLOR_P),
      .COLOR_NARROW    (raster_pkg::COLOR_NARROW_BITS),
      .COLOR_SHIFT_BITS(raster_pkg::COLOR_SHIFT_BITS),
      .COLOR_REACH_BITS(raster_pkg::COLOR_REACH_BITS),
      .CONSTANT        (raster_pkg::TEXTURE_CONSTANT),
      .BORDER          (raster_pkg::TEXTURE_BORDER)
  ) u_texture (
      .clk_i,
      .power_on_ni,
      .rst_ni,
      .stamp_valid_i,
      .payload_i        (entering),
      .mask_i           (writes_i),
      .color_i,
      .is_triangle_i    (fragment_i.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE),
      .q_i              (q),
      .u_i              (u),
      .v_i              (v),
      .shift_i          (fragment_i.coordinates.shift),
      .reach_i          (fragment_i.coordinates.reach),
      .reference_i      (fragment_i.coordinates.origin),
      .sets_state_i     (is_token && register == raster_pkg::STATE_REGISTER_TEXTURE),
      .sets_levels_i    (is_levels && !is_constant && !is_border),
      .sets_constant_i  (is_constant),
      .sets_border_i    (is_border),
      .moves_in_i       (is_token && register == raster_pkg::STATE_REGISTER_TEXTURE_LINES),
      .x_i              (stamp_x),
      .y_i              (stamp_y),
      .state_i          (word[WORD-1:0]),
      .divides_colors_i (divides_colors),
      .color_p_i        (color_p),
      .color_shift_i    (color_shift),
      .color_reach_i    (color_reach),
      .least_color_i    (least_color),
      .greatest_color_i (greatest_color),
      .stamp_valid_o,
      .stamp_ready_i,
      .payload_o        (leaving),
      .mask_o,
      .color_o          (rgba_o),
      .request_valid_o  (texture_valid_o),
      .request_ready_i  (texture_ready_i),
      .request_address_o(texture_o.address),
      .request_beats_o  (texture_o.beats),
      .answer_valid_i   (texel_valid_i),
      .answer_ready_o   (texel_ready_o),
      .answer_data_i    (texel_i.data),
      .sample_o         (samples),
      .hit_o            (hits),
      .miss_o           (use_o[6]),
      .idle_o
  );

endmodule
