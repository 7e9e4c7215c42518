
  // The line as it was taken; the pixels sent before this one, n; how many of them changed the row, m; and
  // first error + n d - m D, summed up in two bits more than the stage has.
  localparam int WIDE = E + 2;
  raster_pkg::line_setup_t g_q;
  logic        [COUNT-1:0] n_q, m_q;
  logic signed [WIDE-1:0]  sum_q, stay, move;
  assign stay = WIDE'($signed({1'b0, g_q.step_stay}));
  assign move = WIDE'($signed(g_q.step_move));
  always_ff @(posedge clk_i) begin
    if (takes) begin
      g_q   <= line_i;
      n_q   <= '0;
      m_q   <= '0;
      sum_q <= WIDE'($signed(line_i.error));
    end else if (pixel_valid_o && pixel_ready_i) begin
      n_q   <= n_q + 1'b1;
      m_q   <= m_q + COUNT'(sum_q >= 0);
      sum_q <= sum_q + stay - (sum_q >= 0 ? stay - move : WIDE'(0));
    end
  end

  // From the host: d = step_stay, D = step_stay - step_move >= d, and an error in [d - D, d), if it is used.
  always_comb if (line_valid_i) begin
    assume ($signed(line_i.step_move) <= 0);
    if (line_i.remaining != '0)
      assume ($signed(line_i.step_move) <= $signed(line_i.error) &&
              WIDE'($signed(line_i.error)) < WIDE'($signed({1'b0, line_i.step_stay})));
  end

  always_comb if (runs_q && valid_q) begin
    assert (line_q == g_q && remaining_q == g_q.remaining - n_q && n_q <= g_q.remaining);
    // Position: n columns, m rows.
    assert (x_q == (g_q.is_x_major ? (g_q.is_x_negative ? g_q.x - PX'(n_q) : g_q.x + PX'(n_q)) :
                                     (g_q.is_x_negative ? g_q.x - PX'(m_q) : g_q.x + PX'(m_q))));
    assert (y_q == (g_q.is_x_major ? (g_q.is_y_negative ? g_q.y - PY'(m_q) : g_q.y + PY'(m_q)) :
                                     (g_q.is_y_negative ? g_q.y - PY'(n_q) : g_q.y + PY'(n_q))));
    // The error is that sum, exactly, and in [d - D, d): so it is the remainder, and m the quotient, of one division.
    if (g_q.remaining != '0) begin
      assert (WIDE'($signed(error_q)) == sum_q);
      assert (move <= sum_q && sum_q < stay && move <= 0);
    end
    cover (n_q == COUNT'(3) && m_q == COUNT'(2));
  end
