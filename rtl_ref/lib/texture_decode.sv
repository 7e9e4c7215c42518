// A texel's code becomes a colour. Combinational. Specification: decode_texel of model/formats/texture.hpp.
module texture_decode (
    input  logic [31:0] code_i,
    input  logic [2:0]  format_i,  // 0 l8, 1 la88, 2 rgb565, 3 rgba5551, 4 rgba4444, 5 rgba8888
    output logic [31:0] texel_o    // 8 bits a channel, R lowest
);

  logic [7:0] r, g, b, a;
  assign texel_o = {a, b, g, r};
  always_comb begin
    {r, g, b, a} = code_i;
    case (format_i)
      3'd0: {r, g, b, a} = {{3{code_i[7:0]}}, 8'hff};
      3'd1: {r, g, b, a} = {{3{code_i[15:8]}}, code_i[7:0]};
      3'd2: begin
        r = {code_i[15:11], code_i[15:13]};
        g = {code_i[10:5], code_i[10:9]};
        b = {code_i[4:0], code_i[4:2]};
        a = 8'hff;
      end
      3'd3: begin
        r = {code_i[15:11], code_i[15:13]};
        g = {code_i[10:6], code_i[10:8]};
        b = {code_i[5:1], code_i[5:3]};
        a = {8{code_i[0]}};
      end
      3'd4: {r, g, b, a} = {{2{code_i[15:12]}}, {2{code_i[11:8]}}, {2{code_i[7:4]}}, {2{code_i[3:0]}}};
      default: ;
    endcase
  end

endmodule
