
  // Each line gives remaining + 1 pixels, the last one marked, before the next line is taken.
  raster_pkg::line_setup_t g_q;
  logic             under_way_q;
  logic [COUNT-1:0] n_q;
  logic             sends;
  assign sends = pixel_valid_o && pixel_ready_i;
  always_ff @(posedge clk_i) begin
    if (!rst_ni) under_way_q <= 1'b0;
    else if (takes) under_way_q <= 1'b1;
    else if (sends && pixel_o.is_last) under_way_q <= 1'b0;
    if (takes) g_q <= line_i;
    if (takes) n_q <= '0;
    else if (sends) n_q <= n_q + 1'b1;
  end
  always_comb if (runs_q) begin
    assert (pixel_valid_o == under_way_q);
    if (takes) assert (!under_way_q || (sends && pixel_o.is_last));  // none is overtaken
    if (under_way_q) begin
      assert (pixel_o.primitive_id == g_q.primitive_id);
      assert (pixel_o.is_last == (n_q == g_q.remaining));
      assert (n_q <= g_q.remaining && remaining_q == g_q.remaining - n_q && line_q.primitive_id == g_q.primitive_id);
    end
    if (pixel_ready_i) assert (sends || line_ready_o);  // no deadlock
    cover (sends && pixel_o.is_last && n_q == COUNT'(3));
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(pixel_valid_o && !pixel_ready_i)) begin
    assert (pixel_valid_o && pixel_o == $past(pixel_o));
  end
