
  // The new stored word of a sample: nothing is written where nothing is covered; a depth stays unless the fragment
  // passed and writes it; the stencil stays unless the primitive tests it, and then outside the write mask; a passing
  // sample passed both tests.
  genvar f;
  generate
    for (f = 0; f < SAMPLES; f++) begin : gen_claim
      logic [WORD-1:0] old_word, new_word;
      logic            is_written, is_new_depth;
      logic [7:0]      mask;
      assign old_word     = is_held_i[f] ? held_depth_i[f*WORD+:WORD] : stored_depth_i[f*WORD+:WORD];
      assign new_word     = word_o[f*WORD+:WORD];
      assign is_written   = write_o.write_depth[f];
      assign is_new_depth = write_o.passed[f] && fragment_q.state.depth_write;
      assign mask         = gen_stencil.update_q[fragment_q.state.is_back][16:9];
      always_comb if (write_valid_o) begin
        if (is_written) begin
          assert (fragment_q.mask[f]);
          assert (new_word[CODE-1:0] == (is_new_depth ? fragment_q.code[f*CODES+:CODE] : old_word[CODE-1:0]));
          assert (((new_word[WORD-1-:8] ^ old_word[WORD-1-:8]) & ~(fragment_q.state.tests_stencil ? mask : 8'd0)) == '0);
        end
        if (!is_written) assert (new_word == old_word);
        if (is_new_depth && opaque[f]) assert (is_written);
        if (write_o.passed[f]) assert (fragment_q.mask[f] && is_nearer[f]);
      end
    end
  endgenerate
  always_comb cover (write_valid_o && (write_o.write_depth & ~write_o.passed) != '0);
