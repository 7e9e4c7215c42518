
  // With blending, on top of cache_tags_data: the place of a stamp's colours that its operations read. `g_` as there.
  logic [STAMPS-1:0] g_color_known_q;
  logic              g_reads_q, reads_it;
  assign reads_it = fragment_q.state.color_write && g_reads_q;
  always_ff @(posedge clk_i) begin
    if (leaves && is_it) g_color_known_q <= (here_q ? g_color_known_q : '0) | (reads_it ? stamp_bit : '0);
    if (leaves && valid_q && !walks_q && fragment_q.kind == raster_pkg::PRIMITIVE_KIND_STATE &&
        fragment_q.state.depth_test == raster_pkg::STATE_REGISTER_COLOR_OPS)
      g_reads_q <= fragment_q.code[28];
    if (!rst_ni) g_reads_q <= 1'b0;
  end
  always_comb if (runs_q && is_known_q) begin
    assert (gen_reads_color.reads_color_q == g_reads_q);
    if (leaves && is_it) begin
      assert (found_o.color_source == (!reads_it ? raster_pkg::DEPTH_SOURCE_NONE :
                                      here_q && g_color_known_q[stamp] ? raster_pkg::DEPTH_SOURCE_CHIP :
                                      flag_q[1] ? raster_pkg::DEPTH_SOURCE_CLEAR : raster_pkg::DEPTH_SOURCE_MEMORY));
      assert (order_o.reads_color == (found_o.color_source == raster_pkg::DEPTH_SOURCE_MEMORY));
      // Only colours on the chip are known, and they leave with their block.
      if (found_o.color_source == raster_pkg::DEPTH_SOURCE_CHIP) assert (!found_o.starts_color);
    end
    if (here_q) assert ((g_color_known_q & ~colored_q) == '0);
    if (leaves && !is_access) assert (!order_o.reads_color);
    if (!is_marking && here_q) assert (word_q[KNOWN-1:0] == g_color_known_q);
    cover (leaves && is_it && order_o.reads_color && order_o.reads);
    cover (leaves && is_it && found_o.color_source == raster_pkg::DEPTH_SOURCE_CHIP && g_reads_q);
  end
  always_comb if (runs_q && !is_known_q) assert (gen_reads_color.reads_color_q == g_reads_q);
