// Light unit: lights the colours of samples with normals, upstream of the texture unit. Stamps wait in a queue, in
// order; a lane takes one lit sample per clock, or a stamp without lit samples, and outputs it twelve clocks later.
//
//   1      the leading one of P, common to its three components     2  m: P shifted to it, 15 bits and the sign
//   3, 4   m^2, m.L, m.H: products, sums                               5  the line of 1 / |m|
//   6      1 / |m|                                                     7  N.L and N.H
//   8      N.L of 12 bits; the line of (N.H)^shininess                 9  the power
//   10     ambient + diffuse N.L, specular (N.H)^shininess             11 the colour
//
// The payload of a stamp waits in RAMs until its last sample is complete; its colours until stage 11 reads them. A
// token waits until no sample in flight still reads a register, and sets it on its way into the lane. A sample here is
// a pixel's shading point: one per pixel, however many samples coverage has. Specification: LightUnit of
// model/stages/light_unit.hpp; the times are LightTiming's in model/engines/cycle/block_timing.hpp.
module light_unit #(
    parameter int SAMPLES  = 4,
    parameter int CHANNELS = 4,   // channels of a colour
    parameter int P_BITS   = 27,  // bits of a component of P, signed; the highest bit is a copy of the sign
    parameter int PAYLOAD  = 1,   // bits that a stamp carries along
    parameter int WORD     = 43,  // bits of a token, at most 3 P_BITS SAMPLES
    parameter int PLACES   = 16   // stamps inside at most; a power of two
) (
    input logic clk_i,
    input logic rst_ni,

    // From light_stage
    input logic                          stamp_valid_i,
    input logic [PAYLOAD-1:0]            payload_i,
    input logic [8*CHANNELS*SAMPLES-1:0] color_i,        // R lowest
    input logic                          is_triangle_i,
    input logic [SAMPLES-1:0]            mask_i,         // samples that get a colour
    input logic [3*P_BITS*SAMPLES-1:0]   p_i,            // normal of each sample, x lowest
    input logic                          sets_i,         // a token for a register of the light
    input logic [WORD-1:0]               word_i,

    // The same stamp, lit
    output logic                          stamp_valid_o,
    output logic [PAYLOAD-1:0]            payload_o,
    output logic [8*CHANNELS*SAMPLES-1:0] color_o
);

  localparam int P = P_BITS - 1;  // significant bits of P
  localparam int M = 16;          // bits of m and of a direction, signed
  localparam int FACTOR = 13;     // 0 to 2^12
  localparam int COLOR = 8 * CHANNELS;
  localparam int NORMALS = 3 * P_BITS * SAMPLES;
  localparam int STAGES = 12;
  localparam int LOOKS = 10;      // the last stage that reads a register
  localparam int REGISTER = 40;   // place of the register's number in a word

  // --------------------------------------------------------------------------------------------------------- into the lane
  logic                 head_valid, head_triangle, head_sets, goes, ends;
  logic [SAMPLES-1:0]   head_mask, done_q, left, sample;
  logic [NORMALS-1:0]   head_p;
  logic [STAGES:1]      at_q, ends_q;
  logic [STAGES-1:1]    first_q;
  logic [LOOKS-1:1]     lit_q;
  logic [(STAGES-1)*SAMPLES-1:0] sample_q;  // stage 1 lowest
  logic                 enable_q;
  logic [WORD-1:0]      word;
  logic waiting_ready, colors_ready, carried_ready, colors_valid, carried_valid;

  fifo #(
      .WIDTH(2 + SAMPLES + NORMALS),
      .DEPTH(PLACES)
  ) u_waiting (
      .clk_i,
      .rst_ni,
      .valid_i(stamp_valid_i),
      .ready_o(waiting_ready),
      .data_i ({is_triangle_i, sets_i, mask_i, sets_i ? NORMALS'(word_i) : p_i}),
      .valid_o(head_valid),
      .ready_i(ends),
      .data_o ({head_triangle, head_sets, head_mask, head_p})
  );
  assign word   = head_p[WORD-1:0];
  assign left   = head_mask & ~done_q & {SAMPLES{enable_q && head_triangle}};
  assign sample = left & (~left + SAMPLES'(1));
  assign goes   = head_valid && !(head_sets && lit_q[LOOKS-1:1] != '0);
  assign ends   = goes && (left & ~sample) == '0;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      done_q <= '0;
      at_q   <= '0;
      lit_q  <= '0;
    end else begin
      if (goes) done_q <= ends ? '0 : done_q | sample;
      at_q  <= {at_q[STAGES-1:1], goes};
      lit_q <= {lit_q[LOOKS-2:1], goes && left != '0};
    end
  end
  always_ff @(posedge clk_i) begin
    ends_q   <= {ends_q[STAGES-1:1], ends};
    first_q  <= {first_q[STAGES-2:1], done_q == '0};
    sample_q <= {sample_q[(STAGES-2)*SAMPLES-1:0], sample};
  end

  // ------------------------------------------------------------------------------------------------------------- registers
  logic        sets, sets_line;
  logic [2:0]  which, narrow_q;
  logic [23:0] specular_q;
  logic [3*FACTOR-1:0] ambient_q, diffuse_q;
  logic [3*M-1:0]      direction_q, half_q;
  assign sets      = goes && head_sets;
  assign which     = word[REGISTER+:3];
  assign sets_line = sets && which == 3'd6;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) enable_q <= 1'b0;
    else if (sets && which == 3'd0) enable_q <= word[24];
  end
  always_ff @(posedge clk_i) begin
    if (sets && which == 3'd0) {narrow_q, specular_q} <= {word[27:25], word[23:0]};
    if (sets && which == 3'd1) ambient_q <= word[3*FACTOR-1:0];
    if (sets && which == 3'd2) diffuse_q <= word[3*FACTOR-1:0];
    if (sets && which == 3'd3) direction_q[2*M-1:0] <= word[2*M-1:0];
    if (sets && which == 3'd4) {half_q[M-1:0], direction_q[3*M-1:2*M]} <= word[2*M-1:0];
    if (sets && which == 3'd5) half_q[3*M-1:M] <= word[2*M-1:0];
  end

  // -------------------------------------------------------------------------------------------------- the normal: 0, 1 and 2
  // Leading zeros, by 16, 8, 4, 2, 1.
  function automatic [4:0] zeros_of(input [31:0] value);
    logic [31:0] rest;
    rest = value;
    for (int n = 4; n >= 0; n--) begin
      zeros_of[n] = (rest >> (32 - (1 << n))) == '0;
      rest        = zeros_of[n] ? rest << (1 << n) : rest;
    end
  endfunction

  logic [3*P-1:0] p, p_1_q, p_2_q;
  logic [P-2:0]   bits;  // up to the largest component; of a negative one its complement
  logic [4:0]     zeros_2_q;
  logic [3*M-1:0] m, m_3_q;
  always_comb begin
    p = '0;
    for (int s = 0; s < SAMPLES; s++)
      for (int i = 0; i < 3; i++) p[P*i+:P] |= head_p[P_BITS*(3*s+i)+:P] & {P{sample[s]}};
  end
  assign bits = (p_1_q[0+:P-1] ^ {(P - 1) {p_1_q[P-1]}}) | (p_1_q[P+:P-1] ^ {(P - 1) {p_1_q[2*P-1]}}) |
                (p_1_q[2*P+:P-1] ^ {(P - 1) {p_1_q[3*P-1]}}) | (P - 1)'(1);
  always_ff @(posedge clk_i) begin
    p_1_q     <= p;
    p_2_q     <= p_1_q;
    zeros_2_q <= zeros_of({bits, {(33 - P) {1'b0}}});
    m_3_q     <= m;
  end

  // -------------------------------------------------------------------------------------- products of m, and their sums: 3, 4
  logic [3*2*M-1:0] square_4_q, light_4_q, half_4_q;
  logic [2*M-1:0]   square_5_q;
  logic signed [2*M-1:0] light_5_q, half_5_q;
  genvar i;
  generate
    for (i = 0; i < 3; i++) begin : gen_component
      logic [P-1:0] moved;
      logic signed [M-1:0] own;
      assign moved       = p_2_q[P*i+:P] << zeros_2_q;
      assign m[M*i+:M]   = moved[P-1-:M] + M'(moved[P-1-M] && moved[P-1-:M] != {1'b0, {(M - 1) {1'b1}}});
      assign own         = m_3_q[M*i+:M];
      always_ff @(posedge clk_i) begin
        square_4_q[2*M*i+:2*M] <= own * own;
        light_4_q[2*M*i+:2*M]  <= own * $signed(direction_q[M*i+:M]);
        half_4_q[2*M*i+:2*M]   <= own * $signed(half_q[M*i+:M]);
      end
    end
  endgenerate
  always_ff @(posedge clk_i) begin
    square_5_q <= square_4_q[0+:2*M] + square_4_q[2*M+:2*M] + square_4_q[4*M+:2*M];
    light_5_q  <= light_4_q[0+:2*M] + light_4_q[2*M+:2*M] + light_4_q[4*M+:2*M];
    half_5_q   <= half_4_q[0+:2*M] + half_4_q[2*M+:2*M] + half_4_q[4*M+:2*M];
  end

  // ------------------------------------------------------------------------------------------------- 1 / |m|, cosines: 5 to 8
  localparam int ROOT = 18;
  logic [ROOT-1:0] root_7_q, root;
  root_table #(
      .SQUARE(2 * M),
      .ROOT  (ROOT)
  ) u_root (
      .clk_i,
      .square_i(square_5_q),
      .root_o  (root)
  );

  // m.L, m.H in 17 bits, plus a half for the dropped bits; for |m| of 15 bits or of 14.
  function automatic [ROOT-1:0] part_of(input [2*M-1:0] dot, input is_long);
    part_of = {is_long ? dot[14+:ROOT-1] : dot[13+:ROOT-1], 1'b1};
  endfunction
  logic            is_long;
  logic [ROOT-1:0] light_6_q, half_6_q, light_7_q, half_7_q;
  logic [8:6]      faces_light_q, faces_half_q;
  logic [2*ROOT-1:0] light_8_q, half_8_q;
  logic [2*ROOT-1:0] light_sum, half_sum;
  logic [ROOT-1:0]   light_cosine, half_cosine;  // 2^-17
  assign is_long = square_5_q[2*M-1:2*M-2] != '0;
  always_ff @(posedge clk_i) begin
    light_6_q     <= part_of(light_5_q, is_long);
    half_6_q      <= part_of(half_5_q, is_long);
    faces_light_q <= {faces_light_q[7:6], !light_5_q[2*M-1] && light_5_q != '0};
    faces_half_q  <= {faces_half_q[7:6], !half_5_q[2*M-1] && half_5_q != '0};
    root_7_q      <= root;
    light_7_q     <= light_6_q;
    half_7_q      <= half_6_q;
    light_8_q     <= (2*ROOT)'(light_7_q) * (2*ROOT)'(root_7_q);
    half_8_q      <= (2*ROOT)'(half_7_q) * (2*ROOT)'(root_7_q);
  end
  assign light_sum    = light_8_q + (2*ROOT)'(1 << (ROOT - 1));
  assign half_sum     = half_8_q + (2*ROOT)'(1 << (ROOT - 1));
  assign light_cosine = light_sum[2*ROOT-1:ROOT] & {ROOT{faces_light_q[8]}};
  assign half_cosine  = half_sum[2*ROOT-1:ROOT] & {ROOT{faces_half_q[8]}};

  // --------------------------------------------------------------------------------------------------------- factors: 8 and 9
  localparam int LINE = 8;
  localparam int PART = 9;
  localparam int START = 16;
  localparam int FALL = 11;
  logic [ROOT-1:0]   away;  // 1 - N.H, 2^-17
  logic [ROOT+6:0]   place;
  logic [ROOT-1:0]   diffuse;
  logic signed [START+PART+1:0] sum;
  logic [FACTOR-1:0] diffuse_9_q, diffuse_10_q, specular, specular_10_q;
  logic              is_dark_9_q;
  logic [PART-1:0]   part_9_q;
  logic [START-1:0]  start;
  logic [FALL-1:0]   fall;
  logic signed [START+PART-11:0] whole;
  assign diffuse = light_cosine + ROOT'(16);
  assign away    = half_cosine[ROOT-1] ? '0 : ROOT'(1 << (ROOT - 1)) - half_cosine;
  assign place   = (ROOT + 7)'(away) << narrow_q;
  sram #(
      .WIDTH    (START + FALL),
      .DEPTH    (1 << LINE),
      .READS_OLD(0)
  ) u_power (
      .clk_i,
      .read_i         (lit_q[8]),
      .read_address_i (place[PART+:LINE]),
      .data_o         ({start, fall}),
      .write_i        (sets_line),
      .write_address_i(word[START+FALL+:LINE]),
      .data_i         (word[START+FALL-1:0])
  );
  assign sum      = $signed({2'b00, start, {PART{1'b0}}}) - $signed((START + PART + 2)'(fall) * (START + PART + 2)'(part_9_q)) +
                    (START + PART + 2)'(2048);
  assign whole    = sum[START+PART+1:12];
  assign specular = is_dark_9_q || whole[START+PART-11] ? '0 : whole > 4096 ? FACTOR'(4096) : whole[FACTOR-1:0];
  always_ff @(posedge clk_i) begin
    diffuse_9_q   <= diffuse[5+:FACTOR];
    is_dark_9_q   <= light_cosine == '0 || place[ROOT+6:LINE+PART] != '0;
    part_9_q      <= place[PART-1:0];
    diffuse_10_q  <= diffuse_9_q;
    specular_10_q <= specular;
  end

  // ---------------------------------------------------------------------------------------------------------- colours: 10, 11
  logic [COLOR*SAMPLES-1:0] head_color;
  logic [COLOR-1:0]         color_11;
  logic [23:0]              lit;
  fifo #(
      .WIDTH(COLOR * SAMPLES),
      .DEPTH(PLACES)
  ) u_colors (
      .clk_i,
      .rst_ni,
      .valid_i(stamp_valid_i),
      .ready_o(colors_ready),
      .data_i (color_i),
      .valid_o(colors_valid),
      .ready_i(at_q[11] && ends_q[11]),
      .data_o (head_color)
  );
  always_comb begin
    color_11 = '0;
    for (int s = 0; s < SAMPLES; s++)
      color_11 |= head_color[COLOR*s+:COLOR] & {COLOR{sample_q[10*SAMPLES+s]}};
  end
  genvar c, s;
  generate
    for (c = 0; c < 3; c++) begin : gen_channel
      logic [2*FACTOR-1:0] weighed;
      logic [22:0]         colored;
      logic [FACTOR:0]     much_11_q;
      logic [20:0]         highlight_11_q;
      assign weighed = (2*FACTOR)'(diffuse_q[FACTOR*c+:FACTOR]) * (2*FACTOR)'(diffuse_10_q) + (2*FACTOR)'(2048);
      assign colored = 23'(color_11[8*c+:8]) * 23'(much_11_q) + 23'(highlight_11_q) + 23'd2048;
      assign lit[8*c+:8] = colored[19:12] | {8{colored[22:20] != '0}};
      always_ff @(posedge clk_i) begin
        much_11_q      <= (FACTOR + 1)'(ambient_q[FACTOR*c+:FACTOR]) + weighed[12+:FACTOR+1];
        highlight_11_q <= 21'(specular_q[8*c+:8]) * 21'(specular_10_q);
      end
    end
    for (s = 0; s < SAMPLES; s++) begin : gen_sample
      logic is_own;
      assign is_own = sample_q[10*SAMPLES+s];
      always_ff @(posedge clk_i)
        if (at_q[11] && (first_q[11] || is_own)) begin
          color_o[COLOR*s+:COLOR] <= head_color[COLOR*s+:COLOR];
          if (is_own) color_o[COLOR*s+:24] <= lit;
        end
    end
  endgenerate

  // --------------------------------------------------------------------------------------------------------- out of the lane
  assign stamp_valid_o = at_q[STAGES] && ends_q[STAGES];
  fifo #(
      .WIDTH(PAYLOAD),
      .DEPTH(PLACES)
  ) u_carried (
      .clk_i,
      .rst_ni,
      .valid_i(stamp_valid_i),
      .ready_o(carried_ready),
      .data_i (payload_i),
      .valid_o(carried_valid),
      .ready_i(stamp_valid_o),
      .data_o (payload_o)
  );

endmodule
