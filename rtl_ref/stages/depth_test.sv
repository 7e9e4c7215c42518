// Depth test: compares a stamp's depth codes with the stored ones and makes the write and the retirement.
//
// In: fragments. Out: an access of the framebuffer for each stamp with a covered sample and for each token (fast clear,
// flush); one cycle later, with the stored codes, the write of the passed samples; another cycle later the retirement
// of the tile visit. One stamp a cycle. With tiles a stamp waits one cycle after a stamp whose depth it must read; a
// framebuffer of blocks forwards it. Specification: model/stages/depth_test.hpp.
module depth_test (
    input logic clk_i,
    input logic rst_ni,

    // From primitive_join
    input  logic                         fragment_valid_i,
    output logic                         fragment_ready_o,
    input  raster_pkg::fragment_packet_t fragment_i,

    // To framebuffer: the access, answered in the next cycle
    output logic                                                    access_valid_o,
    input  logic                                                    access_ready_i,
    output raster_pkg::fragment_packet_t                            access_o,
    output logic [raster_pkg::STORED_COLOR_BITS-1:0]                access_color_o,  // stored colour 0, a cycle later
    // Stored words: stored_depth_i from the framebuffer's RAM, late in the cycle; held_depth_i of samples with is_held_i
    input  logic [raster_pkg::SAMPLES*raster_pkg::STORED_DEPTH_BITS-1:0] stored_depth_i,
    input  logic [raster_pkg::SAMPLES-1:0]                               is_held_i,
    input  logic [raster_pkg::SAMPLES*raster_pkg::STORED_DEPTH_BITS-1:0] held_depth_i,

    // To framebuffer; never waits. The depths of the packet are the fragment's
    output logic                      write_valid_o,
    output raster_pkg::write_packet_t write_o,
    // New stored word of each sample that is written or held
    output logic [raster_pkg::SAMPLES*raster_pkg::STORED_DEPTH_BITS-1:0] word_o,

    // To coarse_raster; never waits
    output logic                       retire_valid_o,
    output raster_pkg::retire_packet_t retire_o,

    // Samples of triangles, points and lines to be counted in this cycle
    output logic [$clog2(raster_pkg::SAMPLES+1)-1:0] covered_o,
    output logic [$clog2(raster_pkg::SAMPLES+1)-1:0] passed_o,
    output logic [$clog2(raster_pkg::SAMPLES+1)-1:0] written_o,
    output logic [$clog2(raster_pkg::SAMPLES+1)-1:0] killed_o
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int PIXELS = raster_pkg::PIXELS;
  localparam int N = raster_pkg::MSAA_SAMPLES;  // samples of a pixel
  localparam int STAMP = raster_pkg::STAMP_SIZE;
  localparam int CODE = raster_pkg::DEPTH_CODE_BITS;
  localparam int WORD = raster_pkg::STORED_DEPTH_BITS;  // a code and above it the stencil, if there is one
  localparam int CODES = raster_pkg::ALL_FRAGMENT_BITS;  // bits of a pixel: lowest its depth code, then its colours
  localparam int COLORS = raster_pkg::VERTEX_COLOR_BITS;
  localparam int COLOR = raster_pkg::WRITTEN_COLOR_BITS;
  localparam int STAMP_BITS = raster_pkg::STAMP_INDEX_BITS;
  localparam int STAMPS = raster_pkg::STAMPS_PER_ROW * raster_pkg::STAMPS_PER_ROW;
  localparam int HIZ = raster_pkg::HIZ_CODE_BITS;
  localparam bit HAS_ALPHA = raster_pkg::ALPHA_UNIT != 0 && raster_pkg::CACHE_KIND == 1 && raster_pkg::SETUP_KIND == 0;

  // D0: the fragment on offer. Tokens (bit 1 of a kind) have no covered sample; tokens of lines have become pixels by
  // now.
  logic needs_access, must_wait, takes_fragment;
  logic [SAMPLES*COLOR-1:0] color;

  // D1: never stalls.
  logic valid_q;
  raster_pkg::fragment_packet_t fragment_q;
  logic [SAMPLES*COLOR-1:0] color_q;
  logic [SAMPLES*CODE-1:0]  depth;
  logic [SAMPLES-1:0]       is_nearer, passes_stencil;  // passes the depth test; the stencil test
  logic [SAMPLES-1:0]       passed, kept;  // samples that pass both, and samples that pass the alpha test too
  logic [SAMPLES-1:0]       opaque;        // samples that pass the alpha test, if it is here
  logic [SAMPLES-1:0]       takes;         // samples whose depth is written
  logic [SAMPLES-1:0]       changes;       // samples whose stored word is
  logic                     is_stamp;

  // With several samples per pixel a line's pixel may have no sample to draw.
  assign needs_access = (fragment_i.kind[1] && !(N > 1 && fragment_i.kind == raster_pkg::PRIMITIVE_KIND_LINE)) ||
                        fragment_i.mask != '0;
  assign must_wait = raster_pkg::CACHE_KIND == 0 && valid_q && fragment_q.state.depth_write && fragment_q.key.tile_x == fragment_i.key.tile_x &&
                     fragment_q.key.tile_y == fragment_i.key.tile_y && fragment_q.stamp == fragment_i.stamp &&
                     (fragment_q.mask & fragment_i.mask) != '0;
  assign access_valid_o   = fragment_valid_i && needs_access && !must_wait;
  assign access_o         = fragment_i;
  assign access_color_o   = raster_pkg::STORED_COLOR_BITS'(color_q[0+:COLOR]);
  assign fragment_ready_o = !needs_access || (access_ready_i && !must_wait);
  assign takes_fragment   = fragment_valid_i && fragment_ready_o;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= 1'b0;
    else valid_q <= takes_fragment;
  end

  always_ff @(posedge clk_i) begin
    fragment_q <= fragment_i;
    color_q    <= color;
  end

  logic less_passes, equal_passes, greater_passes;
  passing_orders u_orders (
      .func_i   (fragment_q.state.depth_test),
      .less_o   (less_passes),
      .equal_o  (equal_passes),
      .greater_o(greater_passes)
  );

  // The alpha test, where the colour is known here: without a texture unit. With a texture unit late_test decides, and
  // a fragment that writes depth is late. Its register is set by a token.
  logic is_late;
  // An operation of the stencil as stencil_test expects it: counting has bit 2, down bit 1, saturation bit 0; the
  // others keep, zero, replace, invert.
  function automatic [2:0] as_bits(input [2:0] op);
    case (op)
      raster_pkg::STENCIL_OP_KEEP: as_bits = 3'b000;
      raster_pkg::STENCIL_OP_ZERO: as_bits = 3'b001;
      raster_pkg::STENCIL_OP_REPLACE: as_bits = 3'b010;
      raster_pkg::STENCIL_OP_INVERT: as_bits = 3'b011;
      raster_pkg::STENCIL_OP_INCR_WRAP: as_bits = 3'b100;
      raster_pkg::STENCIL_OP_INCR: as_bits = 3'b101;
      raster_pkg::STENCIL_OP_DECR_WRAP: as_bits = 3'b110;
      default: as_bits = 3'b111;
    endcase
  endfunction

  genvar s;
  generate
    if (HAS_ALPHA) begin : gen_alpha
      localparam int ALPHA = CODE + COLORS - 8;  // alpha, the last colour channel
      logic [raster_pkg::DEPTH_FUNC_BITS-1:0] alpha_func_q;
      logic [7:0] reference_q;
      logic       covers_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          alpha_func_q <= raster_pkg::DEPTH_FUNC_ALWAYS;
          reference_q  <= '0;
          covers_q     <= 1'b0;
        end else if (valid_q && fragment_q.kind == raster_pkg::PRIMITIVE_KIND_STATE &&
                     fragment_q.state.depth_test == raster_pkg::STATE_REGISTER_ALPHA_TEST) begin
          alpha_func_q <= fragment_q.code[2:0];
          reference_q  <= fragment_q.code[10:3];
          covers_q     <= fragment_q.code[11];
        end
      end
      if (raster_pkg::COORDINATES == 0) begin : gen_here
        logic [8*PIXELS-1:0] alpha;
        logic [SAMPLES-1:0]  alpha_passes;
        for (s = 0; s < PIXELS; s++) begin : gen_pixel
          assign alpha[8*s+:8] = fragment_q.code[s*CODES+ALPHA+:8];
        end
        alpha_test u_alpha (
            .func_i     (alpha_func_q),
            .reference_i(reference_q),
            .covers_i   (covers_q),
            .alpha_i    (alpha),
            .passes_o   (alpha_passes)
        );
        assign opaque  = alpha_passes;
        assign is_late = 1'b0;
      end else begin : gen_late
        logic [7:0] unused;
        assign unused = reference_q;
        assign opaque  = '1;
        assign is_late = alpha_func_q != raster_pkg::DEPTH_FUNC_ALWAYS || (N > 1 && covers_q);
      end
    end else begin : gen_no_alpha
      assign opaque  = '1;
      assign is_late = 1'b0;
    end

    // The stencil registers of the side that the triangle shows. Tokens set them, for one side or for both.
    if (raster_pkg::STENCIL_BITS != 0) begin : gen_stencil
      localparam int TEST = raster_pkg::DEPTH_FUNC_BITS + 16;  // function, reference, read mask, lowest first
      localparam int UPDATE = 9 + 8;                           // sfail, zfail, zpass, write mask
      logic [TEST-1:0]      test_q[0:1];
      logic [UPDATE-1:0]    update_q[0:1];
      logic [TEST-1:0]      test;
      logic [UPDATE-1:0]    update;
      logic                 sets_test, sets_update;
      logic [8:0]           ops;
      for (s = 0; s < 3; s++) begin : gen_op
        assign ops[3*s+:3] = as_bits(fragment_q.code[3*s+:3]);
      end
      logic [8*SAMPLES-1:0] stored, result;
      logic [SAMPLES-1:0]   side_passes, may_mark, marks;
      assign sets_test   = valid_q && fragment_q.kind == raster_pkg::PRIMITIVE_KIND_STATE &&
                           fragment_q.state.depth_test == raster_pkg::STATE_REGISTER_STENCIL_TEST;
      assign sets_update = valid_q && fragment_q.kind == raster_pkg::PRIMITIVE_KIND_STATE &&
                           fragment_q.state.depth_test == raster_pkg::STATE_REGISTER_STENCIL_UPDATE;
      always_ff @(posedge clk_i) begin
        for (int i = 0; i < 2; i++) begin
          if (sets_test && fragment_q.code[TEST+i]) test_q[i] <= fragment_q.code[TEST-1:0];
          if (sets_update && fragment_q.code[UPDATE+i]) update_q[i] <= {fragment_q.code[UPDATE-1-:8], ops};
        end
      end
      assign test   = test_q[fragment_q.state.is_back];
      assign update = update_q[fragment_q.state.is_back];
      assign may_mark = fragment_q.mask & opaque & {SAMPLES{fragment_q.state.tests_stencil}};
      stencil_test u_test (
          .func_i     (test[2:0]),
          .reference_i(test[10:3]),
          .read_i     (test[18:11]),
          .ops_i      (update[8:0]),
          .write_i    (update[16:9]),
          .may_mark_i (may_mark),
          .stored_i   (stored),
          .is_nearer_i(is_nearer),
          .passes_o   (side_passes),
          .marks_o    (marks),
          .stencil_o  (result)
      );
      assign passes_stencil = side_passes | {SAMPLES{!fragment_q.state.tests_stencil}};
      for (s = 0; s < SAMPLES; s++) begin : gen_word
        assign stored[8*s+:8]         = is_held_i[s] ? held_depth_i[s*WORD+CODE+:8] : stored_depth_i[s*WORD+CODE+:8];
        assign word_o[s*WORD+CODE+:8] = result[8*s+:8];
      end
      assign changes = takes | marks;
    end else begin : gen_no_stencil
      assign passes_stencil = '1;
      assign changes        = takes;
    end
    for (s = 0; s < SAMPLES; s++) begin : gen_sample
      // Each source has its own comparison: the RAM is read, compared and written in one cycle.
      logic passes_stored, passes_held;
      localparam int PIXEL = s / N;
      if (s % N == 0) begin : gen_first
        assign depth[s*CODE+:CODE] = fragment_q.code[PIXEL*CODES+:CODE];
      end else begin : gen_further
        assign depth[s*CODE+:CODE] = fragment_q.further_depth[(PIXEL*(N-1)+s%N-1)*CODE+:CODE];
      end
      order_test #(
          .WIDTH(CODE)
      ) u_stored (
          .less_i   (less_passes),
          .equal_i  (equal_passes),
          .greater_i(greater_passes),
          .value_i  (depth[s*CODE+:CODE]),
          .other_i  (stored_depth_i[s*WORD+:CODE]),
          .passes_o (passes_stored)
      );
      order_test #(
          .WIDTH(CODE)
      ) u_held (
          .less_i   (less_passes),
          .equal_i  (equal_passes),
          .greater_i(greater_passes),
          .value_i  (depth[s*CODE+:CODE]),
          .other_i  (held_depth_i[s*WORD+:CODE]),
          .passes_o (passes_held)
      );
      assign is_nearer[s] = is_held_i[s] ? passes_held : passes_stored;
      assign write_o.depth[s*WORD+:WORD] = WORD'(depth[s*CODE+:CODE]);
      if (raster_pkg::STENCIL_BITS != 0) begin : gen_new_word
        logic [CODE-1:0] code;
        assign code = is_held_i[s] ? held_depth_i[s*WORD+:CODE] : stored_depth_i[s*WORD+:CODE];
        assign word_o[s*WORD+:CODE] = takes[s] ? depth[s*CODE+:CODE] : code;
      end else begin : gen_new_depth  // a word of the RAM that stays is not written: word_o does not wait for its comparison
        logic keeps_held;
        assign keeps_held = is_held_i[s] && !(fragment_q.mask[s] && passes_held && opaque[s] && fragment_q.state.depth_write);
        assign word_o[s*WORD+:CODE] = keeps_held ? held_depth_i[s*WORD+:CODE] : depth[s*CODE+:CODE];
      end

      if (raster_pkg::COORDINATES == 0 && raster_pkg::BLEND_LANES == 0 && raster_pkg::DITHER_UNIT == 0 &&
          (raster_pkg::CACHE_KIND == 0 || raster_pkg::ALPHA_UNIT != 0)) begin : gen_rop
        rop u_rop (
            .rgba_i (fragment_i.code[PIXEL*CODES+CODE+:COLORS]),
            .color_o(color[s*COLOR+:COLOR])
        );
      end else begin : gen_whole  // packed in the cache of blocks, after the texture unit, or where it is written
        assign color[s*COLOR+:COLOR] = COLOR'(fragment_i.code[PIXEL*CODES+CODE+:COLORS]);
      end
    end
  endgenerate

  assign passed               = fragment_q.mask & is_nearer & passes_stencil;
  assign kept                 = passed & opaque;
  assign takes                = kept & {SAMPLES{fragment_q.state.depth_write}};
  assign is_stamp             = valid_q && fragment_q.mask != '0;
  assign write_valid_o        = is_stamp;
  assign write_o.key          = fragment_q.key;
  assign write_o.stamp        = fragment_q.stamp;
  assign write_o.passed       = passed;
  assign write_o.write_depth  = changes;
  assign write_o.write_color  = fragment_q.state.color_write ? kept : '0;
  assign write_o.color        = color_q;

  // Counters, one cycle late: the masks are registered and summed in the next cycle, far from the RAM that feeds them.

  logic is_counted, writes;
  logic [SAMPLES-1:0] covered_q, passed_q, written_q;
  assign is_counted = valid_q && (fragment_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE || fragment_q.kind[2]);  // point, line
  assign writes     = fragment_q.state.depth_write || fragment_q.state.color_write;
  assign covered_o  = raster_pkg::count_samples(covered_q);
  assign passed_o   = raster_pkg::count_samples(passed_q);
  assign written_o  = raster_pkg::count_samples(written_q);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      covered_q <= '0;
      passed_q  <= '0;
      written_q <= '0;
    end else begin
      covered_q <= is_counted ? fragment_q.mask : '0;
      passed_q  <= is_counted ? passed : '0;
      written_q <= is_counted && writes ? kept : '0;
    end
  end
  generate
    if (HAS_ALPHA) begin : gen_killed
      logic [SAMPLES-1:0] killed_q;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) killed_q <= '0;
        else killed_q <= is_counted ? passed & ~kept : '0;
      end
      assign killed_o = raster_pkg::count_samples(killed_q);
    end else begin : gen_none_killed
      assign killed_o = '0;
    end
  endgenerate

  // The retirement of a visit.
  raster_pkg::tile_key_t retire_key_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) retire_valid_o <= 1'b0;
    else retire_valid_o <= valid_q && fragment_q.ends_visit;
  end

  always_ff @(posedge clk_i) retire_key_q <= fragment_q.key;
  assign retire_o.key = retire_key_q;

  generate
    if (raster_pkg::HIZ_BITS == 0) begin : gen_no_hiz
      assign retire_o.update   = raster_pkg::HIZ_UPDATE_NONE;
      assign retire_o.hiz_code = '0;
    end else begin : gen_hiz
      // State of the visit before this stamp. The visit covers its tile when the last of STAMPS full stamps comes.
      // What depends on the test is counted a cycle late, with the retirement: the test's result is late.
      logic [STAMP_BITS-1:0] full_stamps_q;
      logic                  any_passed_q;
      logic [HIZ-1:0]        max_q;
      logic                  in_visit, in_visit_q, is_full_q, any_kept_q, writes_depth_q, may_clear_q;
      logic                  any_passed, covers_tile;
      logic [HIZ-1:0]        max;
      logic                  sets, clears;  // the visit that retires sets its tile's bound, clears it
      logic [HIZ-1:0]        max_of_visit_q;

      assign in_visit    = is_stamp && !fragment_q.kind[1];  // a pixel of a line belongs to no visit
      assign any_passed  = any_passed_q || any_kept_q;
      assign covers_tile = is_full_q && full_stamps_q == STAMP_BITS'(STAMPS - 1);

      // The codes of a covered tile are a plane, rounded and clamped, which keeps their order: the largest is at a
      // corner of the tile. So one pixel of a stamp is enough, the pixel towards the tile's corner on the stamp's side;
      // with several samples the farthest of its samples, whose planes are shifted copies.
      function automatic [HIZ-1:0] farthest(input [N*CODE-1:0] depths);
        farthest = depths[CODE-1-:HIZ];
        for (int i = 1; i < N; i++)
          if (depths[(i+1)*CODE-1-:HIZ] > farthest) farthest = depths[(i+1)*CODE-1-:HIZ];
      endfunction
      logic [N*CODE-1:0] pixel_00, pixel_01, pixel_10, pixel_11;  // row, column
      logic [HIZ-1:0]    corner;
      assign pixel_00 = depth[0+:N*CODE];
      assign pixel_01 = depth[(STAMP-1)*N*CODE+:N*CODE];
      assign pixel_10 = depth[(PIXELS-STAMP)*N*CODE+:N*CODE];
      assign pixel_11 = depth[(PIXELS-1)*N*CODE+:N*CODE];

      if (STAMPS == 1) begin : gen_one_stamp
        logic [HIZ-1:0] corner_00, corner_01, corner_10, corner_11, top, bottom;
        assign corner_00 = farthest(pixel_00);
        assign corner_01 = farthest(pixel_01);
        assign corner_10 = farthest(pixel_10);
        assign corner_11 = farthest(pixel_11);
        assign top       = corner_00 > corner_01 ? corner_00 : corner_01;
        assign bottom    = corner_10 > corner_11 ? corner_10 : corner_11;
        assign corner    = top > bottom ? top : bottom;
      end else begin : gen_stamps
        logic is_bottom, is_right;
        assign is_bottom = fragment_q.stamp[STAMP_BITS-1];
        assign is_right  = fragment_q.stamp[STAMP_BITS/2-1];
        assign corner    = farthest(is_bottom ? (is_right ? pixel_11 : pixel_10) : (is_right ? pixel_01 : pixel_00));
      end
      assign max    = corner > max_q ? corner : max_q;
      assign sets   = writes_depth_q && covers_tile;
      assign clears = may_clear_q && any_passed;

      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          full_stamps_q <= '0;
          any_passed_q  <= 1'b0;
          max_q         <= '0;
          in_visit_q    <= 1'b0;
        end else begin
          in_visit_q <= in_visit;
          if (retire_valid_o) begin
            full_stamps_q <= '0;
            any_passed_q  <= 1'b0;
          end else if (in_visit_q) begin
            full_stamps_q <= full_stamps_q + STAMP_BITS'(is_full_q);
            any_passed_q  <= any_passed;
          end
          if (valid_q && fragment_q.ends_visit) max_q <= '0;
          else if (in_visit) max_q <= max;
        end
      end

      always_ff @(posedge clk_i) begin
        is_full_q      <= kept == '1 && !is_late;
        any_kept_q     <= kept != '0;
        writes_depth_q <= fragment_q.state.depth_write;
        may_clear_q    <= fragment_q.state.depth_write && greater_passes;
        max_of_visit_q <= max;
      end
      assign retire_o.update   = sets ? raster_pkg::HIZ_UPDATE_SET :
                                 clears ? raster_pkg::HIZ_UPDATE_CLEAR : raster_pkg::HIZ_UPDATE_NONE;
      assign retire_o.hiz_code = sets ? max_of_visit_q : {HIZ{clears}};
    end
  endgenerate

endmodule
