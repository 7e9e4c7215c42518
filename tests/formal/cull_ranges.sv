
  // Sums and differences on the way to the edge functions, again in four bits more. The scissor lies in the target, the
  // guard band is larger.
  localparam int WIDE = C + 4;
  logic signed [WIDE-1:0] wide_px, wide_py;
  assign wide_px = (WIDE'({box_q.left[PX-1:TS], {TS{1'b0}}}) << S) + WIDE'(1 << (S - 1));
  assign wide_py = (WIDE'({box_q.top[PY-1:TS], {TS{1'b0}}}) << S) + WIDE'(1 << (S - 1));
  logic scissor_is_inside;
  assign scissor_is_inside = 32'(p_q.box.left) < raster_pkg::TARGET_WIDTH && 32'(p_q.box.right) < raster_pkg::TARGET_WIDTH &&
                             32'(p_q.box.top) < raster_pkg::TARGET_HEIGHT && 32'(p_q.box.bottom) < raster_pkg::TARGET_HEIGHT;
  always_comb if (primitive_valid_i)
    assume (32'(primitive_i.box.left) < raster_pkg::TARGET_WIDTH && 32'(primitive_i.box.right) < raster_pkg::TARGET_WIDTH &&
            32'(primitive_i.box.top) < raster_pkg::TARGET_HEIGHT && 32'(primitive_i.box.bottom) < raster_pkg::TARGET_HEIGHT);
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
      assert (box_q.left <= box_q.right && 32'(box_q.right) < raster_pkg::TARGET_WIDTH && box_q.top <= box_q.bottom &&
              32'(box_q.bottom) < raster_pkg::TARGET_HEIGHT);
  end
