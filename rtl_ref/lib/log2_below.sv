// Fraction of a logarithm: log2(1 + f/256), in 256ths, by a parabola. Combinational: f + (f (256 - f) 95 >> 16), whose
// second part is the same for f and 256 - f. Specification: log2_code of model/stages/level_of_detail.hpp.
module log2_below (
    input  logic [7:0] below_i,
    output logic [7:0] log2_o
);

  logic [4:0] bow_rom[0:127];
  initial for (int n = 0; n < 128; n++) bow_rom[n] = 5'((32'(n) * (32'd256 - 32'(n)) * 32'd95) >> 16);

  logic [7:0] back;
  logic [6:0] from_end;  // the parabola at 128 is taken as at 127
  assign back     = 8'd0 - below_i;
  assign from_end = !below_i[7] ? below_i[6:0] : back[7] ? 7'd127 : back[6:0];
  assign log2_o   = below_i + 8'(bow_rom[from_end]);

endmodule
