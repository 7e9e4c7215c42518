
  // Sums and differences in the edge functions, again with four bits more. The scissor lies in the target, the guard
  // band is larger.
  localparam int WIDE = C + 4;
  logic signed [WIDE-1:0] wide_px, wide_py, wide_cx, wide_cy;
  assign wide_px = (WIDE'({box_q.left[PX-1:TS], {TS{1'b0}}}) << S) + WIDE'(1 << (S - 1));
  assign wide_py = (WIDE'({box_q.top[PY-1:TS], {TS{1'b0}}}) << S) + WIDE'(1 << (S - 1));
  assign wide_cx = (WIDE'(box_q.left) << S) + WIDE'(1 << (S - 1));
  assign wide_cy = (WIDE'(box_q.top) << S) + WIDE'(1 << (S - 1));
  logic scissor_is_inside;
  assign scissor_is_inside = 32'(p_q.box.left) < raster_pkg::TARGET_WIDTH && 32'(p_q.box.right) < raster_pkg::TARGET_WIDTH &&
                             32'(p_q.box.top) < raster_pkg::TARGET_HEIGHT && 32'(p_q.box.bottom) < raster_pkg::TARGET_HEIGHT;
  always_comb if (primitive_valid_i)
    assume (32'(primitive_i.box.left) < raster_pkg::TARGET_WIDTH && 32'(primitive_i.box.right) < raster_pkg::TARGET_WIDTH &&
            32'(primitive_i.box.top) < raster_pkg::TARGET_HEIGHT && 32'(primitive_i.box.bottom) < raster_pkg::TARGET_HEIGHT);
  // All three sides shorter than 4 pixels.
  localparam logic signed [WIDE-1:0] LIMIT = WIDE'(4 << S);
  function automatic is_less(input signed [WIDE-1:0] side);
    is_less = side >= -LIMIT && side < LIMIT;
  endfunction
  logic all_short;
  assign all_short = is_less(WIDE'(x1) - WIDE'(x0)) && is_less(WIDE'(x2) - WIDE'(x1)) && is_less(WIDE'(x0) - WIDE'(x2)) &&
                     is_less(WIDE'(y1) - WIDE'(y0)) && is_less(WIDE'(y2) - WIDE'(y1)) && is_less(WIDE'(y0) - WIDE'(y2));
  always_comb if (runs_q && sort_busy_q) begin
    assert (scissor_is_inside);
    assert (WIDE'(dx) == WIDE'(to_x) - WIDE'(from_x) && WIDE'(dy) == WIDE'(to_y) - WIDE'(from_y));
    assert (WIDE'(px) == wide_px && WIDE'(py) == wide_py);
    assert (WIDE'(to_px) == wide_px - WIDE'(from_x_q) && WIDE'(to_py) == wide_py - WIDE'(from_y_q));
    assert (WIDE'(first_x) == (WIDE'(x_min_q) + WIDE'(HALF) - 1) >>> S && WIDE'(last_x) == (WIDE'(x_max_q) - WIDE'(HALF)) >>> S);
    assert (WIDE'(first_y) == (WIDE'(y_min_q) + WIDE'(HALF) - 1) >>> S && WIDE'(last_y) == (WIDE'(y_max_q) - WIDE'(HALF)) >>> S);
    // The box is inside the scissor, if it is not empty.
    if (left <= right && top <= bottom)
      assert (left >= 0 && 32'(right) < raster_pkg::TARGET_WIDTH && top >= 0 && 32'(bottom) < raster_pkg::TARGET_HEIGHT);
  end
  always_comb if (runs_q && sort_busy_q && sort_step_q != 2'd0) assert (x_min_q == x_min && x_max_q == x_max &&
                                                                        y_min_q == y_min && y_max_q == y_max);
  // After step 1 the edge's first vertex is one of the three.
  always_comb if (runs_q && sort_busy_q && sort_step_q[1])
    assert ((from_x_q == x0 && from_y_q == y0) || (from_x_q == x1 && from_y_q == y1) || (from_x_q == x2 && from_y_q == y2));
  always_comb if (runs_q && sort_busy_q && sort_step_q[1] && !is_empty_q) begin
    assert (left <= right && top <= bottom);
    assert (32'(box_q.left) == 32'(left) && 32'(box_q.right) == 32'(right) && 32'(box_q.top) == 32'(top) &&
            32'(box_q.bottom) == 32'(bottom));
    // For a small triangle the first pixel of its box fits few bits, its columns and rows three.
    if (is_triangle && all_short) begin
      assert (WIDE'(to_cx) == wide_cx - WIDE'(from_x_q) && WIDE'(to_cy) == wide_cy - WIDE'(from_y_q));
      assert (box_q.right - box_q.left < PX'(8) && box_q.bottom - box_q.top < PY'(8));
    end
  end
  always_comb if (runs_q && decide_busy_q && !d_is_empty_q) begin
    assert (d_box_q.left <= d_box_q.right && 32'(d_box_q.right) < raster_pkg::TARGET_WIDTH &&
            d_box_q.top <= d_box_q.bottom && 32'(d_box_q.bottom) < raster_pkg::TARGET_HEIGHT);
  end
