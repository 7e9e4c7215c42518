
  // Sums and differences on the way to the edge functions, again in four bits more. The scissor lies in the target, the
  // guard band is larger.
  localparam int WIDE = C + 4;
  logic signed [WIDE-1:0] wide_px, wide_py;
  assign wide_px = (WIDE'({left_q[PX-1:TS], {TS{1'b0}}}) << S) + WIDE'(1 << (S - 1));
  assign wide_py = (WIDE'({top_q[PY-1:TS], {TS{1'b0}}}) << S) + WIDE'(1 << (S - 1));
  logic scissor_is_inside;
  assign scissor_is_inside = 32'(p_q.left) < raster_pkg::TARGET_WIDTH && 32'(p_q.right) < raster_pkg::TARGET_WIDTH &&
                             32'(p_q.top) < raster_pkg::TARGET_HEIGHT && 32'(p_q.bottom) < raster_pkg::TARGET_HEIGHT;
  always_comb if (primitive_valid_i)
    assume (32'(primitive_i.left) < raster_pkg::TARGET_WIDTH && 32'(primitive_i.right) < raster_pkg::TARGET_WIDTH &&
            32'(primitive_i.top) < raster_pkg::TARGET_HEIGHT && 32'(primitive_i.bottom) < raster_pkg::TARGET_HEIGHT);
  always_comb if (runs_q && step_q != IDLE) begin
    assert (scissor_is_inside);
    assert (WIDE'(dx) == WIDE'(x1) - WIDE'(x0) && WIDE'(dy) == WIDE'(y1) - WIDE'(y0));
    assert (WIDE'(px) == wide_px && WIDE'(py) == wide_py);
    assert (WIDE'(to_px) == wide_px - WIDE'(x0) && WIDE'(to_py) == wide_py - WIDE'(y0));
    assert (WIDE'(first_x) == (WIDE'(x_min) + WIDE'(HALF) - 1) >>> S && WIDE'(last_x) == (WIDE'(x_max) - WIDE'(HALF)) >>> S);
    assert (WIDE'(first_y) == (WIDE'(y_min) + WIDE'(HALF) - 1) >>> S && WIDE'(last_y) == (WIDE'(y_max) - WIDE'(HALF)) >>> S);
    // The box is inside the scissor, if it is not empty.
    if (left <= right && top <= bottom)
      assert (left >= 0 && 32'(right) < raster_pkg::TARGET_WIDTH && top >= 0 && 32'(bottom) < raster_pkg::TARGET_HEIGHT);
  end
  always_comb if (runs_q && (step_q == EDGES || step_q == OFFER)) begin
    if (!is_empty_q)
      assert (left_q <= right_q && 32'(right_q) < raster_pkg::TARGET_WIDTH && top_q <= bottom_q &&
              32'(bottom_q) < raster_pkg::TARGET_HEIGHT);
  end
