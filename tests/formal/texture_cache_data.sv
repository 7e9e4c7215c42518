
  // An arbitrary line of memory, and an arbitrary word of it: the result must equal memory's, as without a cache. The
  // line's samples are marked in their payload, with their number, and with their order relative to an arbitrary
  // invalidation, with which memory may change. RAMs and queues are cut out, and behave as sram_word and fifo_stream
  // prove.
  localparam int COUNTED = $clog2(IN_FLIGHT) + 1;
  localparam int SEQUENCE = TAIL - 2;
  (* anyconst *) logic [27:0]          any_address;
  (* anyconst *) logic [LINE-1:0]      any_line;  // its place in the cache
  (* anyconst *) logic [1:0]           any_size;
  (* anyconst *) logic [WORDS-1:0]     any_word;
  (* anyconst *) logic [WORD_BITS-1:0] old_word, new_word;
  (* anyseq *) logic                   is_chosen;
  logic                is_new_q;  // the invalidation has happened
  logic [SEQUENCE-1:0] entered_q, left_q;
  always_ff @(posedge clk_i) begin
    is_new_q  <= rst_ni && (is_new_q || (drop_i && is_chosen));
    entered_q <= rst_ni ? entered_q + SEQUENCE'(t_enters) : '0;
    left_q    <= rst_ni ? left_q + SEQUENCE'(code_valid_o && code_ready_i) : '0;
  end
  always_comb begin
    assume (power_on_ni == rst_ni);
    assume (any_size != 2'd3 && 4'(any_word) < (4'd2 << any_size));
    if (sample_valid_i) begin
      assume (tail_i == {is_new_q, address_i == any_address, entered_q});
      if (address_i == any_address) assume (line_i == any_line && size_of(format_i) == any_size);
    end
    if (drop_i) assume (!t_valid_q && !sample_valid_i);
  end

  // Samples in the queue: its content, the next to leave lowest.
  localparam int WAITING = 1 + LINE + 4 + 3 + TAIL;
  logic [WAITING-1:0] wait_q[0:IN_FLIGHT-1];
  logic [COUNTED-1:0] waits_q;
  always_ff @(posedge clk_i) begin
    waits_q <= rst_ni ? waits_q + COUNTED'(t_goes) - COUNTED'(reads) : '0;
    for (int i = 0; i < IN_FLIGHT; i++) begin
      if (t_goes && COUNTED'(i) == waits_q - COUNTED'(reads)) wait_q[i] <= {!is_known, t_line_q, t_texel_q, t_format_q, t_tail_q};
      else if (reads && i + 1 < IN_FLIGHT) wait_q[i] <= wait_q[(i+1)%IN_FLIGHT];
    end
  end
  // Lines that have not come, likewise; memory sees which of them have any_address (below).
  localparam int FILL = LINE + 2 + 2;
  logic [FILL-1:0]    fill_q[0:IN_FLIGHT-1];
  logic [COUNTED-1:0] fills_q;
  logic               fills_ready, fills_valid, request_valid_q, recovers_q;  // in u_answers
  logic [27:0]        request_address_q;
  logic [1:0]         request_size_q;
  logic [2:0]         beat_q;
  logic [6:0]         unanswered_q;
  always_ff @(posedge clk_i) begin
    fills_q <= rst_ni ? fills_q + COUNTED'(miss_o) - COUNTED'(ends_line) : '0;
    for (int i = 0; i < IN_FLIGHT; i++) begin
      if (miss_o && COUNTED'(i) == fills_q - COUNTED'(ends_line))
        fill_q[i] <= {t_tail_q[TAIL-1:TAIL-2], t_line_q, size_of(t_format_q)};
      else if (ends_line && i + 1 < IN_FLIGHT) fill_q[i] <= fill_q[(i+1)%IN_FLIGHT];
    end
  end
  always_comb if (runs_q) begin
    assume (waiting_ready == (waits_q != COUNTED'(IN_FLIGHT)) && waiting_valid == (waits_q != '0));
    if (waiting_valid) assume ({is_miss, line, texel, format, tail} == wait_q[0]);
    assume (fills_ready == (fills_q != COUNTED'(IN_FLIGHT)) && fills_valid == (fills_q != '0));
    if (fills_valid) assume ({fill_line, fill_size} == fill_q[0][LINE+1:0]);
  end

  // Memory answers its requests, in order.
  logic       request_is_it, fill_is_it, fill_is_new;
  logic [6:0] owed_q, on_offer;
  assign {fill_is_new, fill_is_it} = fill_q[0][FILL-1-:2];
  assign on_offer = request_valid_q ? 7'd2 << request_size_q : '0;
  always_ff @(posedge clk_i)
    owed_q <= rst_ni ? owed_q + (request_valid_o && request_ready_i ? 7'(request_beats_o) : '0) - 7'(answer_valid_i) : '0;
  always_comb if (runs_q) begin
    if (answer_valid_i) assume (owed_q != '0);
    if (answer_valid_i && fill_is_it && beat_q == any_word) assume (answer_data_i == (fill_is_new ? new_word : old_word));
    if (request_valid_o) begin
      assert (fills_q != '0 && fill_q[fills_q-1'b1][1:0] == request_size_q);
      assert (fill_q[fills_q-1'b1][FILL-2] == (request_address_o == {any_address, 4'd0}));
      assert (request_beats_o == 6'd2 << request_size_q);
    end
    assert (answer_ready_o && !recovers_q);
  end

  // RAMs: the words of the line. A read in the cycle of a write of its word may give anything.
  logic                 tag_writes, cell_valid_q, old_valid_q, tag_is_it_q, data_writes, data_is_it, data_is_it_q, stays_q, data_stays_q;
  logic [27:0]          cell_tag_q, old_tag_q;
  logic [NUMBER-1:0]    cell_group_q, old_group_q;
  logic [WORD_BITS-1:0] data_q, old_data_q, word_before_q;
  logic [NUMBER+28:0]   tag_before_q;
  assign tag_writes  = (t_goes || sweeps_q) && tag_write_line == any_line;
  assign data_is_it  = data_read_address == {any_line, any_word};
  assign data_writes = fills_word && data_write_address == {any_line, any_word};
  always_ff @(posedge clk_i) begin
    if (tag_writes) {cell_valid_q, cell_tag_q, cell_group_q} <= tag_new;
    if (t_enters) begin
      {old_valid_q, old_tag_q, old_group_q} <= {cell_valid_q, cell_tag_q, cell_group_q};
      tag_is_it_q                           <= line_i == any_line && !tag_writes;
    end
    if (data_writes) data_q <= fill_word;
    if (reads) begin
      old_data_q   <= data_q;
      data_is_it_q <= data_is_it && !data_writes;
    end
    {stays_q, data_stays_q}       <= {!t_enters, !reads};
    {tag_before_q, word_before_q} <= {tag_valid, tag, tag_group, word};
  end
  always_comb if (runs_q) begin
    if (stays_q) assume ({tag_valid, tag, tag_group} == tag_before_q);
    if (data_stays_q) assume (word == word_before_q);
    if (tag_is_it_q) assume ({tag_valid, tag, tag_group} == {old_valid_q, old_tag_q, old_group_q});
    if (data_is_it_q) assume (word == old_data_q);
  end

  // The claim: each sample leaves in order, and a sample of any_address with memory's content when it came.
  logic                 d_claims_q;
  logic [WORD_BITS-1:0] truth;
  logic [5:0]           at;  // bits of the word below the texel
  assign truth = code_tail_o[TAIL-1] ? new_word : old_word;
  assign at    = 6'({d_offset_q, 3'd0});
  always_ff @(posedge clk_i) if (reads) d_claims_q <= tail[TAIL-2] && offset[5:WORD] == any_word;
  always_comb if (runs_q && code_valid_o) begin
    assert (code_tail_o[SEQUENCE-1:0] == left_q);
    if (d_claims_q) begin
      assert (data_is_it_q && word == truth && size_of(code_format_o) == any_size);
      assert (code_o[7:0] == 8'(truth >> at));
      if (any_size != 2'd0) assert (code_o[15:8] == 8'(truth >> (at + 6'd8)));
      if (any_size == 2'd2) assert (code_o[31:16] == 16'(truth >> (at + 6'd16)));
    end
  end
  always_ff @(posedge clk_i) if (runs_q && $past(runs_q) && $past(code_valid_o && !code_ready_i)) begin
    assert (code_valid_o && code_o == $past(code_o) && code_tail_o == $past(code_tail_o));
  end

  // For induction. All samples in the queue that were found in any_line are of one line of memory, and all but the
  // first are hits: a miss waits until the place is free. The n-th miss waits for the n-th line.
  logic [IN_FLIGHT-1:0]   waits_here, waits_it, waits_new, waits_miss, here_before, is_to_come;
  logic [COUNTED-1:0]     misses_before[0:IN_FLIGHT];
  logic [IN_FLIGHT*3-1:0] size_of_wait;
  logic                   cell_is_it, cell_waits, has_come_so_far;
  logic [COUNT-1:0]       number[0:IN_FLIGHT-1];
  logic [6:0]             beats;
  always_comb begin
    misses_before[0] = '0;
    here_before      = '0;
    beats            = '0;
    for (int i = 0; i < IN_FLIGHT; i++) begin
      {waits_new[i], waits_it[i]} = wait_q[i][TAIL-1-:2];
      waits_miss[i]      = COUNTED'(i) < waits_q && wait_q[i][WAITING-1];
      waits_here[i]      = COUNTED'(i) < waits_q && wait_q[i][WAITING-2-:LINE] == any_line;
      misses_before[i+1] = misses_before[i] + COUNTED'(waits_miss[i]);
      if (i + 1 < IN_FLIGHT) here_before[i+1] = here_before[i] || waits_here[i];
      is_to_come[i]      = waits_miss[i] && misses_before[i] >= come_q;
      number[i]          = read_q + COUNT'(i);
      if (COUNTED'(i) < fills_q) beats = beats + (7'd2 << fill_q[i][1:0]);
    end
  end
  assign cell_is_it      = !sweeps_q && cell_valid_q && cell_tag_q == any_address;
  assign cell_waits      = (is_to_come & waits_here) != '0;
  assign has_come_so_far = !cell_waits || (fill_q[0][LINE+1-:LINE] == any_line && beat_q > any_word);
  always_comb if (runs_q) begin
    assert (waits_q <= COUNTED'(IN_FLIGHT) && fills_q <= COUNTED'(IN_FLIGHT));
    assert (issued_q - read_q == COUNT'(waits_q));
    assert (entered_q == left_q + SEQUENCE'(waits_q) + SEQUENCE'(d_valid_q) + SEQUENCE'(t_valid_q));
    assert (32'(misses_before[IN_FLIGHT]) == 32'(come_q) + 32'(fills_q));
    assert (unanswered_q == beats - 7'(beat_q) && unanswered_q == owed_q + on_offer);
    if (request_valid_q) assert (owed_q < unanswered_q && (fills_q > COUNTED'(1) || beat_q == '0));
    for (int i = 0; i < IN_FLIGHT; i++) if (COUNTED'(i) < fills_q) assert (fill_q[i][1:0] != 2'd3);
    if (fills_q == '0) assert (beat_q == '0);
    else assert (4'(beat_q) < (4'd2 << fill_q[0][1:0]));
    if (t_valid_q) begin
      assert (!sweeps_q && t_tail_q == {is_new_q, t_address_q == any_address, left_q + SEQUENCE'(waits_q) + SEQUENCE'(d_valid_q)});
      if (t_address_q == any_address) assert (t_line_q == any_line && size_of(t_format_q) == any_size);
      if (t_line_q == any_line && same_place_q)
        assert (cell_valid_q && same_line_q == (cell_tag_q == t_address_q) && cell_group_q == last_group);
      if (t_line_q == any_line && !same_place_q)
        assert (tag_is_it_q && {old_valid_q, old_tag_q, old_group_q} == {cell_valid_q, cell_tag_q, cell_group_q});
    end
    if (sweeps_q && sweep_q > any_line) assert (!cell_valid_q);
    for (int i = 0; i < IN_FLIGHT; i++) begin
      if (COUNTED'(i) < waits_q) begin
        assert (wait_q[i][SEQUENCE-1:0] == left_q + SEQUENCE'(d_valid_q) + SEQUENCE'(i));
        if (waits_it[i]) assert (waits_here[i] && size_of(wait_q[i][TAIL+:3]) == any_size);
      end
      if (waits_miss[i] && here_before[i]) assert (!waits_here[i]);
      if (waits_here[i]) begin
        // The tags know a sample that is read no earlier than this one.
        assert (NUMBER'(group - cell_group_q) <= NUMBER'(group - number[i][COUNT-1:GROUP]));
        if (!sweeps_q && cell_valid_q) assert (waits_it[i] == (cell_tag_q == any_address) && waits_new[i] == is_new_q);
        for (int j = 0; j < i; j++)
          if (waits_here[j]) assert ({waits_it[j], waits_new[j]} == {waits_it[i], waits_new[i]});
        if (waits_it[i] && has_come_so_far) assert (data_q == (waits_new[i] ? new_word : old_word));
      end
      for (int j = 0; j < IN_FLIGHT; j++)
        if (is_to_come[i] && COUNTED'(j) == misses_before[i] - come_q)
          assert (fill_q[j] == {waits_new[i], waits_it[i], wait_q[i][WAITING-2-:LINE], size_of(wait_q[i][TAIL+:3])});
    end
    if (cell_is_it && has_come_so_far) assert (data_q == (is_new_q ? new_word : old_word));
  end

  // No deadlock: when memory does its part and texels are taken, the remaining work decreases in every cycle.
  logic [7:0] work;
  assign work = 8'd24 * 8'(t_valid_q) + 8'd2 * 8'(waits_q) + 8'(d_valid_q) + 8'(request_valid_q) + 8'(unanswered_q) +
                (sweeps_q ? 8'(LINES) - 8'(sweep_q) : '0);
  always_ff @(posedge clk_i)
    if (runs_q && $past(runs_q) && $past(code_ready_i && request_ready_i && (answer_valid_i || owed_q == '0) && !t_enters && !drop_i) &&
        $past(work) != '0) assert (work < $past(work));
  always_comb if (runs_q) begin
    assert (idle_o == (work == '0));
    if (idle_o) assert (sample_ready_o);
    cover (code_valid_o && d_claims_q && any_size == 2'd1 && fills_q != '0 && hit_o);
    cover (code_valid_o && d_claims_q && code_tail_o[TAIL-1] && old_word != new_word && waits_it[0] && waits_q == COUNTED'(2));
    cover (t_valid_q && t_line_q == any_line && !is_known && !may_take && may_ask && waits_it[0]);
    cover (waits_q == COUNTED'(IN_FLIGHT) && cell_is_it && waits_miss[0] && here_before[1] && misses_before[IN_FLIGHT] == COUNTED'(3));
  end
