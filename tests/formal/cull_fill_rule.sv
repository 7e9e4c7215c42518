
  // The fill rule of a triangle in canonical order against its definition, for any exact edge value and any direction:
  // covered when E > 0, or E = 0 on a top or left edge. And of an edge seen from its two sides, E and -E with dx, dy and
  // -dx, -dy, exactly one covers a sample.
  function automatic covers(input signed [E-1:0] exact, input signed [D-1:0] dx, input signed [D-1:0] dy);
    covers = exact > 0 || (exact == 0 && (dy < 0 || (dy == 0 && dx > 0)));
  endfunction
  (* anyseq *) logic signed [E-1:0] any_exact;
  (* anyseq *) logic signed [D-1:0] any_dx, any_dy;
  always_comb begin
    assume (any_exact != $signed({1'b1, {(E - 1) {1'b0}}}));  // no code without its negative
    assume (any_dx != $signed({1'b1, {(D - 1) {1'b0}}}) && any_dy != $signed({1'b1, {(D - 1) {1'b0}}}));
    if (any_dx != 0 || any_dy != 0)
      assert (covers(any_exact, any_dx, any_dy) != covers(-any_exact, -any_dx, -any_dy));
  end
  genvar k;
  generate
    for (k = 0; k < 3; k++) begin : gen_proof
      // The triangle's own edge k runs the way of the canonical order: turned round if the area was negative.
      logic signed [E-1:0] oriented;
      logic signed [D-1:0] dx, dy;
      assign oriented = is_negative ? -gen_edge[k].exact : gen_edge[k].exact;
      assign dx       = is_negative ? -gen_edge[k].edge_dx : gen_edge[k].edge_dx;
      assign dy       = is_negative ? -gen_edge[k].edge_dy : gen_edge[k].edge_dy;
      always_comb begin
        // The proven range of E (Proofs.EdgeValuesOverTheWholeGuardBand...), and of a difference of coordinates.
        assume (gen_edge[k].exact < $signed(E'(1) << (V + S - 1)) && gen_edge[k].exact > -$signed(E'(1) << (V + S - 1)));
        assume (gen_edge[k].edge_dx != $signed({1'b1, {(D - 1) {1'b0}}}) &&
                gen_edge[k].edge_dy != $signed({1'b1, {(D - 1) {1'b0}}}));
        assert (!is_triangle || (gen_edge[k].edge_dx == 0 && gen_edge[k].edge_dy == 0) ||
                !value[k*V+V-1] == covers(oriented, dx, dy));
      end
    end
  endgenerate
