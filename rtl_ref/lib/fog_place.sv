// Place of a sample's Q in the fog table: Q as a floating-point number, read as one integer, from the table's first
// octave on. The highest 8 bits of a place are its table line. Combinational. Specification: fog_position of
// model/stages/fog.cpp, 2^19 places for any number of octaves.
module fog_place #(
    parameter int Q_BITS = 27  // at most 32
) (
    input  logic [Q_BITS-1:0] q_i,       // not 0
    input  logic signed [5:0] octave_i,  // the octave of Q = 1
    input  logic [2:0]        octaves_i, // log2 of the table's octaves, at most 4
    output logic [18:0]       place_o
);

  // Leading zeros are shifted out by 16, 8, 4, 2, 1: their number, and the mantissa.
  function automatic [19:0] normalised(input [31:0] value);
    logic [31:0] left;
    logic [4:0]  zeros;
    left = value;
    for (int n = 4; n >= 0; n--) begin
      zeros[n] = (left >> (32 - (1 << n))) == '0;
      left     = zeros[n] ? left << (1 << n) : left;
    end
    normalised = {zeros, left[30:16]};
  endfunction

  logic [4:0]  zeros;
  logic [14:0] mantissa;
  logic signed [7:0] octave;
  logic        is_below, is_above;
  logic [18:0] place;
  assign {zeros, mantissa} = normalised({q_i, {(32 - Q_BITS) {1'b0}}});
  assign octave   = 8'(octave_i) + 8'sd0 + 8'(Q_BITS - 1) - $signed({3'd0, zeros});
  assign is_below = octave[7];
  assign is_above = (octave[6:0] >> octaves_i) != '0;
  assign place    = is_below ? '0 : {octave[3:0], mantissa} | {19{is_above}};
  assign place_o  = place << (3'd4 - octaves_i);

endmodule
