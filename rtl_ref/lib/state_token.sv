// State token: decodes a fragment of kind state: the unit whose register it sets, and the value, which takes the place
// of a fragment's codes. Combinational. Specification: model/packets/state_packets.hpp.
module state_token #(
    parameter int WORD = raster_pkg::STATE_WORD_BITS  // derived; not to be set
) (
    input  raster_pkg::fragment_packet_t           fragment_i,
    output logic                                   is_token_o,
    output logic [raster_pkg::DEPTH_FUNC_BITS-1:0] register_o,
    output logic [WORD-1:0]                        word_o,
    output logic [1:0]                             unit_o  // for register texture_levels: levels, fog, fog table, light
);

  localparam int AFFINE = raster_pkg::AFFINE_PLANES;
  localparam int AFFINE_BITS = raster_pkg::ALL_AFFINE_CODE_BITS;
  localparam int Q = raster_pkg::FRAGMENT_BITS_OF[32*AFFINE+:32];
  localparam int P = raster_pkg::FRAGMENT_BITS_OF[32*(AFFINE+1)+:32];
  localparam int Q_AT = raster_pkg::FRAGMENT_AT[32*AFFINE+:32];
  localparam int L = raster_pkg::PERSPECTIVE_GUARD_BITS;
  assign is_token_o = fragment_i.kind == raster_pkg::PRIMITIVE_KIND_STATE;
  assign register_o = fragment_i.state.depth_test;
  assign word_o     = {fragment_i.code[Q_AT+Q+P+L+:P-L-1], fragment_i.code[Q_AT+Q+L+:P-L-1], fragment_i.code[Q_AT+L+:Q-L-1],
                       fragment_i.code[0+:AFFINE_BITS]};
  generate
    if (raster_pkg::FOG_UNIT != 0 || raster_pkg::NORMALS != 0) begin : gen_units
      assign unit_o = is_token_o && register_o == raster_pkg::STATE_REGISTER_TEXTURE_LEVELS ? word_o[raster_pkg::UNIT_WORD_BITS+:2] : 2'd0;
    end else begin : gen_levels
      assign unit_o = 2'd0;
    end
  endgenerate

endmodule
