
  // The line as it was taken, the number of pixels sent before this one, and first + n steps, summed up.
  raster_pkg::line_setup_t g_q;
  logic [COUNT-1:0] n_q;
  logic             sends;
  assign sends = pixel_valid_o && pixel_ready_i;
  always_ff @(posedge clk_i) begin
    if (takes) begin
      g_q <= line_i;
      n_q <= '0;
    end else if (sends) n_q <= n_q + 1'b1;
  end

  always_comb if (runs_q && valid_q) begin
    assert (line_q == g_q && remaining_q == g_q.remaining - n_q && n_q <= g_q.remaining);
    assert (is_before_start_q == (g_q.is_before_start && n_q == '0));
  end
  genvar k;
  generate
    for (k = 0; k < PLANES; k++) begin : gen_proof
      localparam int W = LINE_BITS_OF[32*k+:32];
      localparam int AT = LINE_AT[32*k+:32];
      localparam int B = CODE_BITS_OF[32*k+:32];
      localparam int CODE = CODE_AT[32*k+:32];
      logic [W-1:0] sum_q;
      always_ff @(posedge clk_i) begin
        if (takes) sum_q <= line_i.value[AT+:W];
        else if (sends) sum_q <= sum_q + g_q.step[AT+:W];
      end
      always_comb if (runs_q && valid_q) begin
        assert (gen_plane[k].value_q == sum_q);
        assert (pixel_o.code[CODE+:B] == (g_q.is_before_start && n_q == '0 ? g_q.start[CODE+:B] : sum_q[W-1-:B]));
      end
    end
  endgenerate
