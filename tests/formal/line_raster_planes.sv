
  // The line as it was taken, the pixels sent before this one, and first + n steps, summed up.
  var raster_pkg::line_setup_t g_q;
  logic [COUNT-1:0]      n_q;
  logic [D-1:0]          depth_sum_q;
  logic [CHANNELS*C-1:0] color_sum_q;
  logic                  sends;
  assign sends = pixel_valid_o && pixel_ready_i;
  always_ff @(posedge clk_i) begin
    if (takes) begin
      g_q         <= line_i;
      n_q         <= '0;
      depth_sum_q <= line_i.depth;
    end else if (sends) begin
      n_q         <= n_q + 1'b1;
      depth_sum_q <= depth_sum_q + g_q.depth_step;
    end
  end

  always_comb if (runs_q && valid_q) begin
    assert (line_q == g_q && remaining_q == g_q.remaining - n_q && n_q <= g_q.remaining);
    assert (is_before_start_q == (g_q.is_before_start && n_q == '0));
    assert (depth_q == depth_sum_q);
    assert (pixel_o.depth == (g_q.is_before_start && n_q == '0 ? g_q.depth_start : depth_sum_q[D-1-:CODE]));
  end
  genvar k;
  generate
    for (k = 0; k < CHANNELS; k++) begin : gen_proof
      always_ff @(posedge clk_i) begin
        if (takes) color_sum_q[k*C+:C] <= line_i.color[k*C+:C];
        else if (sends) color_sum_q[k*C+:C] <= color_sum_q[k*C+:C] + g_q.color_step[k*C+:C];
      end
      always_comb if (runs_q && valid_q) begin
        assert (color_q[k*C+:C] == color_sum_q[k*C+:C]);
        assert (pixel_o.color[8*k+:8] ==
                (g_q.is_before_start && n_q == '0 ? g_q.color_start[8*k+:8] : color_sum_q[(k+1)*C-1-:8]));
      end
    end
  endgenerate
