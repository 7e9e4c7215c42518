
  // Two bins share their words of flags, and one is cleared: in cache_tags_data the flags of its blocks are set, and
  // the flags of the other bin stay.
  always_comb if (runs_q && is_known_q) begin
    cover (takes_token && clears_bin && clears_it);
    cover (takes_token && clears_bin && !clears_it && flag_q[1] && any_y == last_y);
  end
