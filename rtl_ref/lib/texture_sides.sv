// Constants of a texture's levels, from a state on: log2 of level 0's blocks along each side, the first level of one
// block, and the number whose bits are the starts of levels. Specification: level_place of
// model/stages/texture_levels.hpp.
module texture_sides (
    input logic       clk_i,
    input logic       sets_state_i,
    input logic [7:0] log2_size_i,  // width lowest

    output logic [7:0]  log2_size_o,
    output logic [3:0]  wide_o,
    output logic [3:0]  high_o,
    output logic [3:0]  first_of_one_o,
    output logic [20:0] ones_o
);

  function automatic [3:0] blocks_of(input [3:0] log2_size);  // log2
    blocks_of = log2_size[3:1] == '0 ? 4'd0 : log2_size - 4'd2;
  endfunction

  logic [3:0] new_wide, new_high, new_longer, new_shorter, new_odds;
  logic [4:0] new_blocks;
  assign new_wide    = blocks_of(log2_size_i[3:0]);
  assign new_high    = blocks_of(log2_size_i[7:4]);
  assign new_longer  = new_wide > new_high ? new_wide : new_high;
  assign new_shorter = new_wide > new_high ? new_high : new_wide;
  assign new_odds    = new_longer - new_shorter;
  assign new_blocks  = {1'b0, new_wide} + {1'b0, new_high};
  always_ff @(posedge clk_i)
    if (sets_state_i) begin
      log2_size_o    <= log2_size_i;
      wide_o         <= new_wide;
      high_o         <= new_high;
      first_of_one_o <= new_longer;
      // From level 0 down every second bit while both sides are halved; then every bit.
      ones_o         <= ((21'h155555 << new_odds) | ~(21'h1ffffe << new_odds)) & ~(21'h1ffffe << new_blocks);
    end

endmodule
