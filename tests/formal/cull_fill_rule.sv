
  // The fill rule of a triangle in canonical order against its definition, for any exact edge value and any direction:
  // covered when E > 0, or E = 0 on a top or left edge. And for an edge seen from its two sides, E and -E with dx, dy
  // and -dx, -dy, exactly one covers a sample.
  function automatic covers(input signed [E-1:0] exact, input signed [D-1:0] dx, input signed [D-1:0] dy);
    covers = exact > 0 || (exact == 0 && (dy < 0 || (dy == 0 && dx > 0)));
  endfunction
  (* anyseq *) logic signed [E-1:0] any_exact;
  always_comb begin
    assume (any_exact != $signed({1'b1, {(E - 1) {1'b0}}}));  // excluded: a code without its negative
    assume (dx_q != $signed({1'b1, {(D - 1) {1'b0}}}) && dy_q != $signed({1'b1, {(D - 1) {1'b0}}}));
    if (dx_q != 0 || dy_q != 0) assert (covers(any_exact, dx_q, dy_q) != covers(-any_exact, -dx_q, -dy_q));
  end
  genvar k;
  generate
    for (k = 0; k < 3; k++) begin : gen_proof
      // An edge in the direction of dx_q, dy_q whose value, with the bias of this direction, becomes edge k. The
      // triangle's own edge has the direction of the canonical order: reversed if the area was negative.
      (* anyseq *) logic signed [E-1:0] exact;
      logic signed [E-1:0] oriented, biased;
      logic signed [D-1:0] dx, dy;
      logic [V-1:0]        kept;
      assign oriented = is_negative ? -exact : exact;
      assign dx       = is_negative ? -dx_q : dx_q;
      assign dy       = is_negative ? -dy_q : dy_q;
      assign biased   = exact - E'(is_biased);
      assign kept     = is_negative ? edge_q[(2-k)*V+:V] : edge_q[k*V+:V];
      always_comb begin
        // The proven range of E (Proofs.EdgeValuesOverTheWholeGuardBand...).
        assume (exact < $signed(E'(1) << (V + S - 1)) && exact > -$signed(E'(1) << (V + S - 1)));
        assume (kept == V'(biased >>> S));
        assert (!d_is_triangle || (dx_q == 0 && dy_q == 0) ||
                !triangle_o.edge_value[k*V+V-1] == covers(oriented, dx, dy));
      end
    end
  endgenerate
