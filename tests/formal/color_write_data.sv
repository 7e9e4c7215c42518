
  // With blending. A stamp on offer stays until it is taken, and so does an answer; the answer's data are valid after
  // it is taken, until the next take. The first stamp of a new block finds none of its colours in the RAM, a stamp
  // whose colours are on the chip does (cache_tags_color); tokens write nothing.
  logic waits_q, answer_waits_q, answer_taken_q;
  logic [LINE+STAMP+3+STAMPS+3*SAMPLES+38-1:0] offer, offer_before_q;
  logic [SAMPLES*COLOR-1:0] answer_before_q;
  assign offer = {tested_i.line, tested_i.stamp, tested_i.starts_color, tested_i.evicts, tested_i.fills, tested_i.evicted, mask, color_i, tested_i.sets_state, tested_i.state_register, tested_i.state, tested_i.color_source};
  always_ff @(posedge clk_i) begin
    waits_q         <= rst_ni && stamp_valid_i && !stamp_ready_o;
    offer_before_q  <= offer;
    answer_waits_q  <= rst_ni && answer_valid_i && !answer_ready_o;
    answer_taken_q  <= rst_ni && answer_valid_i && answer_ready_o;
    answer_before_q <= answer_i;
  end
  always_comb if (runs_q) begin
    if (waits_q) assume (stamp_valid_i && offer == offer_before_q);
    if (answer_waits_q) assume (answer_valid_i);
    if (!answer_taken_q) assume (answer_i == answer_before_q);
    if (tested_i.color_source == raster_pkg::DEPTH_SOURCE_CHIP) assume (!tested_i.starts_color);
    if (tested_i.evicts && (mask != '0 || tested_i.color_source != raster_pkg::DEPTH_SOURCE_NONE)) assume (tested_i.starts_color);
    // An eviction takes the samples written since the last eviction of its line, whose reads are complete
    // (cache_tags_data).
    if (starts && tested_i.line == first_line_q) assume ((tested_i.evicted & first_q) == '0);
    if (tested_i.sets_state) assume (mask == '0 && !tested_i.evicts && !tested_i.starts_color && tested_i.color_source == raster_pkg::DEPTH_SOURCE_NONE);
  end

  // An arbitrary sample of an arbitrary stamp of a line; `word` is its RAM content, `newest` its content after all
  // writes in flight.
  (* anyconst *) logic [LINE-1:0]  any_line;
  (* anyconst *) logic [STAMP-1:0] any_stamp;
  (* anyconst *) logic [$clog2(SAMPLES+1)-1:0] any_sample;
  logic [COLOR:0] word_q, read_word_q, snapshot_q, ram, found_2_q, made_2, newest;
  logic           writes_it, looks_at_it, reads_it_q, collided_q, looked_q, is_first_q, victim_is_it_q, begun_q;
  logic [2:0]     is_it;         // items of stages 1 to 3 that are of this stamp
  logic [2:0]     on_way_to_it;  // items of these that will write it, or have in the last clock
  logic [STAMPS-1:0] any_bit;
  localparam int BLENDS = 27;
  assign any_bit      = STAMPS'(1) << any_stamp;
  assign ram          = {dirty[any_sample], code[any_sample*COLOR+:COLOR]};
  assign writes_it    = writes[any_sample] && write_address == {any_line, any_stamp};
  assign looks_at_it  = looks && {tested_i.line, tested_i.stamp} == {any_line, any_stamp};
  assign is_it        = gen_blends.on_way_q & {{gen_blends.line_3_q, gen_blends.stamp_3_q} == {any_line, any_stamp},
                                               {gen_blends.line_2_q, gen_blends.stamp_2_q} == {any_line, any_stamp},
                                               {gen_blends.line_1_q, gen_blends.stamp_1_q} == {any_line, any_stamp}};
  assign on_way_to_it = is_it & {gen_blends.writes_3_q[any_sample], gen_blends.writes_2_q[any_sample], gen_blends.writes_1_q[any_sample]};
  assign made_2 = {gen_blends.dirty_2_q[any_sample], gen_blends.made[any_sample*COLOR+:COLOR]};
  // The value that stage 1 must find: the result of the stages after it.
  assign newest = on_way_to_it[1] ? made_2 : word_q;
  logic is_left;  // the stamp of an eviction is still to be read
  assign is_left = (first_line_q == any_line && (first_q & any_bit) != '0) || (second_line_q == any_line && (second_q & any_bit) != '0);
  logic             own_is_left;  // the same for the stamp on offer
  assign own_is_left = (first_line_q == tested_i.line && (first_q & (STAMPS'(1) << tested_i.stamp)) != '0) ||
                       (second_line_q == tested_i.line && (second_q & (STAMPS'(1) << tested_i.stamp)) != '0);
  always_ff @(posedge clk_i) begin
    if (writes_it) word_q <= {dirty_new[any_sample], code_new[any_sample*COLOR+:COLOR]};
    if (reads || looks) begin
      read_word_q <= word_q;
      reads_it_q  <= read_address == {any_line, any_stamp};
      collided_q  <= writes_it;
    end
    looked_q       <= rst_ni && looks_at_it;
    is_first_q     <= gen_blends.is_first;
    victim_is_it_q <= rst_ni && reads && !looks && read_address == {any_line, any_stamp};
    if (starts && tested_i.line == any_line) snapshot_q <= word_q;
    begun_q <= rst_ni && (starts ? tested_i.line == any_line : begun_q);
    // The value that stage 1 has found.
    found_2_q <= {gen_blends.held[any_sample], gen_blends.stored[any_sample*COLOR+:COLOR]};
  end
  always_comb begin
    assume (any_sample < SAMPLES);
    if (runs_q) begin
      if (reads_it_q && !collided_q) assume (ram == read_word_q);  // sram_word
      assert (!(looks && reads));
      // A stamp sees the writes of the stamps before it, in the RAM or in flight, one a clock.
      if (looked_q && gen_blends.on_way_q[0]) begin
        assert (is_it[0] && reads_it_q && !gen_blends.starts_1_q);
        assert (gen_blends.held[any_sample] == newest[COLOR]);
        assert (gen_blends.stored[any_sample*COLOR+:COLOR] ==
                (gen_blends.is_here_1_q || newest[COLOR] ? newest[COLOR-1:0] : gen_blends.base[any_sample*COLOR+:COLOR]));
      end
      // Nor does a group of a stamp undo the result of another.
      if (on_way_to_it[0] && !gen_blends.mask_1_q[any_sample] && !is_first_q)
        assert ({gen_blends.held[any_sample], gen_blends.stored[any_sample*COLOR+:COLOR]} == newest);
      // A sample that is neither blended nor replaced is written as it was found, dirty or not.
      if (on_way_to_it[1] && !gen_blends.mask_2_q[any_sample]) assert (made_2 == found_2_q);
      if (on_way_to_it[1] && gen_blends.mask_2_q[any_sample]) assert (made_2[COLOR]);
      if (writes_it) assert (on_way_to_it[1]);
      // An eviction takes the content at its begin.
      if (starts) assert (second_q == '0);  // takes the place of a complete one
      if (starts && tested_i.line == any_line) assert (on_way_to_it == '0);
      if (is_left && begun_q) assert (word_q == snapshot_q);
      if (is_left) assert (on_way_to_it == '0);
      if (victim_is_it_q && begun_q) begin
        assert (reads_it_q && !collided_q && read_word_q == snapshot_q && victim_valid_o);
        assert (victim_o.strobe[any_sample] == (fills_q || snapshot_q[COLOR]));
        if (snapshot_q[COLOR]) assert (victim_o.color[any_sample*COLOR+:COLOR] == snapshot_q[COLOR-1:0]);
      end
      // For induction.
      if (on_way_to_it[2])
        assert (word_q == {gen_blends.dirty_3_q[any_sample], gen_blends.code_3_q[any_sample*COLOR+:COLOR]});
      if (looked_q && gen_blends.on_way_q[0]) begin
        assert (collided_q == on_way_to_it[2]);
        if (!collided_q) assert (read_word_q == word_q);
      end
      if (is_it[0] && gen_blends.on_way_q[0] && !gen_blends.starts_1_q && gen_blends.is_here_1_q) assert (looked_q);
      if (gen_blends.on_way_q[1])
        assert ({gen_blends.dirty_2_q[any_sample], gen_blends.stored_2_q[any_sample*COLOR+:COLOR]} ==
                {found_2_q[COLOR] || gen_blends.mask_2_q[any_sample], found_2_q[COLOR-1:0]});
      if (gen_blends.on_way_q[0]) assert ((gen_blends.mask_1_q & ~gen_blends.writes_1_q) == '0);
      if (gen_blends.on_way_q[1]) assert ((gen_blends.mask_2_q & ~gen_blends.writes_2_q) == '0);
      if (gen_blends.on_way_q[1]) assert ((gen_blends.mask_2_q & ~gen_blends.dirty_2_q) == '0);
      if (started_q) assert (stamp_valid_i && tested_i.evicts && waits_q);
      if (started_q && gen_blends.done_q == '0) assert (!is_busy);
      if (first_q == '0) assert (second_q == '0 && !second_begun_q);
      if (!second_begun_q) assert (second_q == '0);
      if (first_line_q == second_line_q) assert ((first_q & second_q) == '0);
      if (started_q && tested_i.line == any_line && tested_i.stamp != any_stamp) assert (on_way_to_it == '0);
      if (gen_blends.done_q != '0) begin
        assert (waits_q && gen_blends.wanted != '0 && gen_blends.ops_q[BLENDS]);
        assert (!own_is_left);
        if (tested_i.color_source != raster_pkg::DEPTH_SOURCE_NONE && !tested_i.starts_color) assert (first_q == '0);
      end
      // A stamp of an eviction per clock; and the written stamp was read before.
      if (reads) assert (next != '0 && (next & ~(of_second ? second : first_q)) == '0);
      if (goes && own != '0 && own_is_left) assert (reads && next == own);
      // A stamp waits only for an eviction or an answer: the same stamp goes every clock. So there is no deadlock
      // either.
      if (stamp_valid_i && !goes && first_q == '0 && (!tested_i.evicts || gen_blends.on_way_q == '0))
        assert (tested_i.color_source == raster_pkg::DEPTH_SOURCE_MEMORY && !answer_valid_i);
      cover (on_way_to_it == 3'b111 && looked_q && gen_blends.stored[any_sample*COLOR+:COLOR] != word_q[COLOR-1:0]);
      cover (victim_is_it_q && begun_q && snapshot_q[COLOR]);
      cover (gen_blends.done_q != '0 && looks_at_it);
      cover (second_begun_q && hits_second);
    end
  end
