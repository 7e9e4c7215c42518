// 1 / |m| from |m|^2, by a table in block RAM. Its line is chosen by the 7 bits after the leading one and the parity of
// the octave of |m|^2; the value falls along the line by the next 10 bits. One clock for the RAM, the arithmetic within
// the next. A line of the specification, root_lines() of model/stages/phong.cpp: a start of 17 bits without the
// highest, which is set, and a fall of 11. Specification: inverse_length of model/stages/phong.cpp.
module root_table #(
    parameter int SQUARE = 32,  // bits of |m|^2, whose leading one is one of the four highest
    parameter int ROOT   = 18   // bits of the reciprocal root
) (
    input logic clk_i,

    input  logic [SQUARE-1:0] square_i,
    output logic [ROOT-1:0]   root_o  // unit 2^-18 2^-k, k = 14 or 15, half of the leading one's place; a clock later
);

  localparam int LINE = 7;
  localparam int PLACE = 10;
  localparam int FALL = 11;
  localparam int WIDTH = ROOT - 1 + FALL;
  localparam logic [256*WIDTH-1:0] LINES = {
      28'h0080901, 28'h0101902, 28'h0183904, 28'h0206105, 28'h0289907, 28'h030d908, 28'h039290a, 28'h041890c,
      28'h049f10d, 28'h052690f, 28'h05af111, 28'h0638112, 28'h06c2114, 28'h074d116, 28'h07d8917, 28'h0865119,
      28'h08f291b, 28'h098111d, 28'h0a1011e, 28'h0aa0920, 28'h0b31922, 28'h0bc3924, 28'h0c56926, 28'h0cea928,
      28'h0d7f12a, 28'h0e1512c, 28'h0eab92e, 28'h0f43930, 28'h0fdc932, 28'h1076134, 28'h1111136, 28'h11ad138,
      28'h124993a, 28'h12e793c, 28'h138693e, 28'h1427140, 28'h14c8142, 28'h156a945, 28'h160e147, 28'h16b2949,
      28'h175814b, 28'h17ff14e, 28'h18a7150, 28'h1950953, 28'h19fb155, 28'h1aa6957, 28'h1b5395a, 28'h1c0195c,
      28'h1cb115f, 28'h1d61961, 28'h1e13964, 28'h1ec7167, 28'h1f7b969, 28'h203196c, 28'h20e896f, 28'h21a1971,
      28'h225b974, 28'h2317177, 28'h23d417a, 28'h249217d, 28'h2552180, 28'h2613183, 28'h26d6186, 28'h279a989,
      28'h286018c, 28'h292798f, 28'h29f0992, 28'h2abb195, 28'h2b87998, 28'h2c5519c, 28'h2d2499f, 28'h2df61a2,
      28'h2ec91a6, 28'h2f9d9a9, 28'h30741ad, 28'h314c1b0, 28'h32261b4, 28'h33021b8, 28'h33df9bb, 28'h34bf1bf,
      28'h35a09c3, 28'h36841c7, 28'h37699cb, 28'h38511cf, 28'h393a9d3, 28'h3a261d7, 28'h3b139db, 28'h3c031df,
      28'h3cf51e4, 28'h3de91e8, 28'h3edf9ec, 28'h3fd81f1, 28'h40d29f6, 28'h41cf9fa, 28'h42cf1ff, 28'h43d1204,
      28'h44d5209, 28'h45dc20d, 28'h46e5212, 28'h47f1218, 28'h48ffa1d, 28'h4a10a22, 28'h4b24227, 28'h4c3aa2d,
      28'h4d53a32, 28'h4e6fa38, 28'h4f8ea3e, 28'h50b0243, 28'h51d5249, 28'h52fca4f, 28'h5427255, 28'h555525c,
      28'h5686262, 28'h57ba268, 28'h58f1a6f, 28'h5a2ca76, 28'h5b6aa7c, 28'h5caca83, 28'h5df1a8a, 28'h5f3aa92,
      28'h6086a99, 28'h61d72a0, 28'h632aaa8, 28'h6482ab0, 28'h65de2b7, 28'h673e2bf, 28'h68a1ac8, 28'h6a09ad0,
      28'h6abf96b, 28'h6b7616d, 28'h6c2d96f, 28'h6ce6972, 28'h6da0974, 28'h6e5b976, 28'h6f17978, 28'h6fd497b,
      28'h709317d, 28'h715297f, 28'h7213982, 28'h72d5984, 28'h7398986, 28'h745d189, 28'h752298b, 28'h75e998e,
      28'h76b1990, 28'h777a993, 28'h7845195, 28'h7911198, 28'h79de19a, 28'h7aac99d, 28'h7b7c9a0, 28'h7c4d9a2,
      28'h7d201a5, 28'h7df41a8, 28'h7ec99ab, 28'h7fa01ad, 28'h80781b0, 28'h81519b3, 28'h822c9b6, 28'h83091b9,
      28'h83e71bc, 28'h84c61bf, 28'h85a71c2, 28'h86899c5, 28'h876d9c8, 28'h88531cb, 28'h893a9ce, 28'h8a231d2,
      28'h8b0d9d5, 28'h8bf99d8, 28'h8ce71db, 28'h8dd69df, 28'h8ec79e2, 28'h8fba9e6, 28'h90af1e9, 28'h91a51ed,
      28'h929d1f0, 28'h93971f4, 28'h94929f7, 28'h95909fb, 28'h968f9ff, 28'h9791203, 28'h9894206, 28'h9999a0a,
      28'h9aa0a0e, 28'h9ba9a12, 28'h9cb4a16, 28'h9dc221a, 28'h9ed121e, 28'h9fe2a23, 28'ha0f6227, 28'ha20ba2b,
      28'ha323a30, 28'ha43da34, 28'ha559a38, 28'ha67823d, 28'ha799242, 28'ha8bc246, 28'ha9e1a4b, 28'hab09a50,
      28'hac33a55, 28'had60a59, 28'hae8fa5e, 28'hafc1a64, 28'hb0f5a69, 28'hb22ca6e, 28'hb366273, 28'hb4a2a78,
      28'hb5e127e, 28'hb723283, 28'hb867a89, 28'hb9aea8f, 28'hbaf8a94, 28'hbc45a9a, 28'hbd95aa0, 28'hbee8aa6,
      28'hc03eaac, 28'hc1982b2, 28'hc2f42b8, 28'hc453abf, 28'hc5b62c5, 28'hc71c2cc, 28'hc885ad3, 28'hc9f22d9,
      28'hcb622e0, 28'hccd5ae7, 28'hce4caee, 28'hcfc7af5, 28'hd1462fd, 28'hd2c8304, 28'hd44e30c, 28'hd5d7b13,
      28'hd76531b, 28'hd8f6b23, 28'hda8cb2b, 28'hdc26333, 28'hddc433c, 28'hdf66344, 28'he10cb4d, 28'he2b7b56,
      28'he466b5f, 28'he61ab68, 28'he7d3371, 28'he990b7a, 28'heb52b84, 28'hed1938e, 28'heee5398, 28'hf0b63a2,
      28'hf28c3ac, 28'hf467bb7, 28'hf6483c1, 28'hf82e3cc, 28'hfa1a3d7, 28'hfc0b3e3, 28'hfe02bee, 28'hffffbfa
  };

  logic [WIDTH-1:0] lines_rom[0:255];
  initial for (int n = 0; n < 256; n++) lines_rom[n] = LINES[WIDTH*n+:WIDTH];

  // The bits after the leading one: in an even octave it is the second or the fourth bit.
  logic [1:0]            zeros;
  logic [LINE+PLACE-1:0] behind;
  logic [WIDTH-1:0]      line_q;
  logic [PLACE-1:0]      place_q;
  logic [FALL+PLACE-1:0] product;
  assign zeros  = square_i[SQUARE-1] ? 2'd0 : square_i[SQUARE-2] ? 2'd1 : square_i[SQUARE-3] ? 2'd2 : 2'd3;
  assign behind = (LINE + PLACE)'(square_i[SQUARE-2-:LINE+PLACE+3] >> (2'd3 - zeros));
  always_ff @(posedge clk_i) begin
    line_q  <= lines_rom[{!zeros[0], behind[LINE+PLACE-1-:LINE]}];
    place_q <= behind[PLACE-1:0];
  end
  assign product = (FALL + PLACE)'(line_q[FALL-1:0]) * (FALL + PLACE)'(place_q) + (FALL + PLACE)'(1 << (PLACE - 1));
  assign root_o  = {1'b1, line_q[WIDTH-1:FALL]} - ROOT'(product[FALL+PLACE-1:PLACE]);

endmodule
