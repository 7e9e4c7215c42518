
  // Assumptions on inputs. A fragment on offer stays until it is taken; a token has no samples; from the host a fast
  // clear of both buffers comes before all else. A clear of one bin clears colours, and directly follows a token.
  logic token_waits_q, is_known_q, takes_token, is_empty_q;
  assign takes_token = fragment_valid_i && fragment_ready_o && is_token;
  var raster_pkg::fragment_packet_t before_q;
  always_ff @(posedge clk_i) begin
    token_waits_q <= rst_ni && fragment_valid_i && !fragment_ready_o;
    before_q      <= fragment_i;
    if (!rst_ni) is_known_q <= 1'b0;
    else if (takes_token) is_known_q <= 1'b1;
    if (!rst_ni || (takes_fragment && fragment_i.mask != '0)) is_empty_q <= 1'b0;
    else if (takes_token) is_empty_q <= 1'b1;
  end
  always_comb if (runs_q) begin
    if (token_waits_q) assume (fragment_valid_i && fragment_i == before_q);
    if (is_token) assume (fragment_i.mask == '0);
    if (fragment_valid_i && !is_known_q) assume (clears_all && !clears_bin);
    if (fragment_valid_i && clears_bin) assume (is_empty_q && fragment_i.state.color_write && !fragment_i.state.depth_write);
  end
