// Which of four samples agree: can go together through a cache of 16 banks of texels and four of lines. Along both axes
// any two of their texels lie in the same block, or in different banks of lines and of texels. Combinational.
// Specification: agree() of model/stages/texture_unit.hpp.
module texture_agree #(
    parameter int ENDS = 1,       // texels of a sample along an axis: 1 or 2
    parameter int SIDE_BITS = 12  // log2 of the longest side
) (
    // Texel e of lane l along axis d: ((l*ENDS + e)*2 + d)*SIDE_BITS
    input  logic [4*ENDS*2*SIDE_BITS-1:0] texel_i,
    output logic [5:0]                    agree_o  // 0 and 1, 0 and 2, 1 and 2, 0 and 3, 1 and 3, 2 and 3
);

  function automatic [0:0] agree(input [SIDE_BITS-1:0] a, input [SIDE_BITS-1:0] b);
    agree = a[SIDE_BITS-1:2] == b[SIDE_BITS-1:2] || (a[2] != b[2] && a[1:0] != b[1:0]);
  endfunction

  genvar l, m, e, f, d;
  generate
    for (m = 1; m < 4; m++) begin : gen_second
      for (l = 0; l < m; l++) begin : gen_first
        logic [2*ENDS*ENDS-1:0] agree_at;
        for (e = 0; e < ENDS; e++) begin : gen_end
          for (f = 0; f < ENDS; f++) begin : gen_other_end
            for (d = 0; d < 2; d++) begin : gen_axis
              assign agree_at[(e*ENDS+f)*2+d] = agree(texel_i[((l*ENDS+e)*2+d)*SIDE_BITS+:SIDE_BITS],
                                                      texel_i[((m*ENDS+f)*2+d)*SIDE_BITS+:SIDE_BITS]);
            end
          end
        end
        assign agree_o[m*(m-1)/2+l] = &agree_at;
      end
    end
  endgenerate

endmodule
