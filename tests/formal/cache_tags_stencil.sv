
  // With a stencil, in cache_tags_data: a word that is replaced is not read, and a word of which a part stays is read.
  always_comb if (runs_q && is_known_q) begin
    cover (leaves && is_it && found_o.source == raster_pkg::DEPTH_SOURCE_NONE && changes_word);
    cover (leaves && is_it && found_o.source == raster_pkg::DEPTH_SOURCE_CLEAR && !fragment_q.state.depth_write && changes_word);
  end
