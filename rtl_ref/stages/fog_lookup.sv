// Fog lookup: finds the places of a stamp's pixels in the fog table, upstream of the texture unit, where Q is still
// available; the places go with the stamp to fog_stage. Combinational but for the table's octaves, which a token sets.
//
// The word: from bit 0 the places of the pixels, FOG_PLACE_BITS each, or a token's value; above them three bits: fog is
// enabled, a token sets the fog's colour, a token sets a line of the table. Specification: model/stages/fog_unit.hpp.
module fog_lookup #(
    parameter int PLACES = raster_pkg::FOG_PLACES_BITS,  // derived; not to be set
    parameter int WORD = raster_pkg::FOG_WORD_BITS
) (
    input  logic                         clk_i,
    input  logic                         rst_ni,
    input  logic                         stamp_valid_i,
    input  raster_pkg::fragment_packet_t fragment_i,
    output logic [WORD-1:0]              word_o
);

  genvar s;
  generate
    if (raster_pkg::FOG_UNIT == 0) begin : gen_clear
      assign word_o = '0;
    end else begin : gen_fogged
      localparam int PLACE = raster_pkg::FOG_PLACE_BITS;
      localparam int COLOR_BITS = 24;
      localparam int FRAGMENT = raster_pkg::ALL_FRAGMENT_BITS;  // bits of a pixel
      localparam int Q = raster_pkg::FRAGMENT_BITS_OF[32*raster_pkg::AFFINE_PLANES+:32];
      localparam int Q_AT = raster_pkg::FRAGMENT_AT[32*raster_pkg::AFFINE_PLANES+:32];
      logic              enable_q;   // fog is enabled
      logic [2:0]        octaves_q;  // octaves of the table
      logic [PLACES-1:0] places;
      logic              is_token, sets_color, sets_line;
      logic [1:0]        unit;
      logic [raster_pkg::STATE_WORD_BITS-1:0] word;
      state_token u_token (
          .fragment_i,
          .is_token_o(is_token),
          .register_o(),
          .word_o    (word),
          .unit_o    (unit)
      );
      assign sets_color = is_token && unit == 2'd1;
      assign sets_line  = is_token && unit == 2'd2;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) enable_q <= 1'b0;
        else if (stamp_valid_i && sets_color) enable_q <= word[COLOR_BITS+3];
      end
      always_ff @(posedge clk_i) if (stamp_valid_i && sets_color) octaves_q <= word[COLOR_BITS+:3];
      for (s = 0; s < raster_pkg::PIXELS; s++) begin : gen_place
        fog_place #(
            .Q_BITS(Q)
        ) u_place (
            .q_i      (fragment_i.code[s*FRAGMENT+Q_AT+:Q]),
            .octave_i (fragment_i.coordinates.fog_octave),
            .octaves_i(octaves_q),
            .place_o  (places[PLACE*s+:PLACE])
        );
      end
      if (PLACES > PLACE * raster_pkg::PIXELS) begin : gen_rest
        assign places[PLACES-1:PLACE*raster_pkg::PIXELS] = '0;
      end
      assign word_o[PLACES-1:0] = is_token ? PLACES'(word[raster_pkg::UNIT_WORD_BITS-1:0]) : places;
      assign word_o[PLACES+:3]  = {sets_line, sets_color, enable_q && fragment_i.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE};
    end
  endgenerate

endmodule
