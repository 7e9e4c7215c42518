
  always_comb if (runs_q) begin
    assert (x1_valid_q == tested_valid_q);
    if (x1_valid_q && tested_q.mask == '0) assert (x1_q.source == raster_pkg::DEPTH_SOURCE_NONE && !x1_q.starts_color && !x1_writes_q);
    if (x1_valid_q && tested_q.mask != '0)
      assert (x1_writes_q == (tested_writes || (x1_q.source != raster_pkg::DEPTH_SOURCE_CHIP &&
                                                             x1_q.source != raster_pkg::DEPTH_SOURCE_NONE)));
  end

  // An arbitrary place of the RAMs: a sample m of a stamp of a line.
  (* anyconst *) logic [LINE-1:0]   any_line;
  (* anyconst *) logic [STAMP-1:0]  any_stamp;
  // The data of an eviction: after all earlier writes and before any later one. Memory gets exactly these, each
  // sample once, and only then the slot is free. In between the data are in the RAM, in flight, or in the slot.
  logic [STAMPS-1:0] any_bit;
  logic              sends_any;
  assign any_bit   = STAMPS'(1) << any_stamp;
  assign sends_any = sends && takes_request && oldest_q == any_slot && sent == any_bit;
  logic [SAMPLES-1:0]       w_mask_q;  // mask that color_write took in the clock before
  logic [SAMPLES*COLOR-1:0] w_color_q;
  always_ff @(posedge clk_i) begin
    w_mask_q  <= w.mask;
    w_color_q <= w_color;
  end
  genvar p, m;
  generate
    for (p = 0; p < 2; p++) begin : gen_plane
      localparam int BITS = p == 0 ? CODE : COLOR;
      logic            begins, is_line_q, is_here_q, fills_q, read_is_it, writes_it, is_left, is_read, is_begun, is_behind;
      logic [STAMPS-1:0] stamps, left_now;
      logic [LINE-1:0] begins_line;
      logic [LINE+STAMP-1:0] write_address, read_address;
      logic            reads, slot_left;
      assign stamps        = p == 0 ? found.depth : w.evicted;
      assign begins        = p == 0 ? goes && found.evicts && slot_q == any_slot : w_starts && w_slot_q == any_slot;
      assign begins_line   = p == 0 ? found.line : w.line;
      assign reads         = p == 0 ? reads_victim || goes : w_reads;
      assign read_address  = p == 0 ? depth_read_address : w_read_address;
      assign write_address = p == 0 ? {x1_q.line, x1_q.stamp} : w_write_address;
      // An eviction being read is that of the slot, and its stamp is still to be read, or has been.
      assign is_begun  = p == 0 ? holds_any : any_begun;
      assign is_left   = is_begun && (p == 0 ? SLOT'(slot_q - 1'b1) == any_slot && (left_q & any_bit) != '0 :
                                      (w_first_slot_q == any_slot && (w_first_q & any_bit) != '0) ||
                                      (w_second_slot_q == any_slot && (w_second_q & any_bit) != '0));
      assign is_read   = p == 0 ? v_valid_q && v_slot_q == any_slot && v_stamp_q == any_stamp :
                                  c_valid && c.slot == any_slot && c.stamp == any_stamp;
      assign slot_left = ((p == 0 ? depth_left_q[any_slot] : color_left_q[any_slot]) & any_bit) != '0;
      always_ff @(posedge clk_i) if (begins) begin
        is_line_q <= begins_line == any_line;
        is_here_q <= (stamps & any_bit) != '0;
        fills_q   <= p == 0 ? found.fills[0] : w.fills;
      end
      always_comb if (runs_q && is_begun) begin
        if (p == 0 && SLOT'(slot_q - 1'b1) == any_slot && v_valid_q)
          assert (is_line_q == (left_line_q == any_line) && fills_q == v_fills_q);
        if (p == 1 && w_first_slot_q == any_slot && w_first_q != '0)
          assert (is_line_q == (w_first_line_q == any_line) && fills_q == w_first_fills_q);
        if (p == 1 && w_second_slot_q == any_slot && w_two_q)
          assert (is_line_q == (w_second_line_q == any_line) && fills_q == w_second_fills_q);
        if (p == 1 && c_valid && c.slot == any_slot) assert (fills_q == c_fills_q);
        if (is_left || is_read) assert (is_here_q && slot_left == fills_q);
        if (!is_here_q && slot_left) assert (fills_q);
        if (is_read) assert (is_here_q && !is_left);
        assert (((p == 0 ? here_depth_any : here_color_any) & any_bit) != '0 == is_here_q);
      end
      for (m = 0; m < SAMPLES; m++) begin : gen_truth
        logic [BITS:0] word_q, read_word_q, snapshot_q, ram, stored;  // the lane's dirty bit above its code
        logic          writes, read_is_it_q, collided_q, sent_q, owes, lane_strobe;
        logic [BITS-1:0] lane;
        assign writes = p == 0 ? write_valid_i && gen_depth[m].writes : w_ram_writes[m];
        assign ram    = p == 0 ? (BITS + 1)'({gen_depth[m].dirty, gen_depth[m].code}) :
                                 (BITS + 1)'({w_ram_dirty[m], w_ram_code[m*COLOR+:COLOR]});
        assign stored = p == 0 ? (BITS + 1)'(gen_depth[m].word) : (BITS + 1)'({w_ram_dirty_new[m], w_ram_code_new[m*COLOR+:COLOR]});
        assign lane   = BITS'(request_data[m*LANE+:BITS]);
        assign owes   = fills_q || (is_here_q && snapshot_q[BITS]);
        always_ff @(posedge clk_i) begin
          if (writes && write_address == {any_line, any_stamp}) word_q <= stored;
          if (reads) begin
            read_word_q  <= word_q;
            read_is_it_q <= read_address == {any_line, any_stamp};
            collided_q   <= writes && write_address == {any_line, any_stamp};
          end
          if (begins) begin
            snapshot_q <= word_q;
            sent_q     <= 1'b0;
          end else if (sends_any && is_color == (p == 1) && request_o.strobe[m]) sent_q <= 1'b1;
        end
        always_comb if (runs_q) begin
          if (read_is_it_q && !collided_q) assume (ram == read_word_q);  // sram_word
          // Written data: passed depths, or the stored ones (a colour: garbage, under a strobe that says so).
          if (p == 0 && writes) assert (stored == {write_i.write_depth[m], write_i.write_depth[m] ? write_i.depth[m*CODE+:CODE] :
                                                                            stored_depth_o[m*CODE+:CODE]});
          if (p == 1 && writes) assert (stored == (BITS + 1)'({w_mask_q[m], w_color_q[m*COLOR+:COLOR]}));
          // The test sees the last write, up to the clock before.
          if (p == 0 && x1_valid_q && x1_q.source == raster_pkg::DEPTH_SOURCE_CHIP && tested_q.mask != '0 &&
              {x1_q.line, x1_q.stamp} == {any_line, any_stamp}) begin
            assert (read_is_it_q && gen_depth[m].in_ram_q == !collided_q);
            if (!collided_q) assert (read_word_q == word_q);
            assert (stored_depth_o[m*CODE+:CODE] == CODE'(word_q));
          end
          if (begins && begins_line == any_line && (stamps & any_bit) != '0)
            assert (!(writes && write_address == {any_line, any_stamp}));
          if (is_begun && is_line_q) begin
            if (is_left || is_read) assert (!sent_q);
            if (is_left) assert (word_q == snapshot_q);
            if (is_read) assert (read_is_it_q && !collided_q && read_word_q == snapshot_q);
            // Data in the slot.
            if (is_here_q && !is_left && !is_read) begin
              assert ((p == 0 ? slot_depth_strobe[m] : slot_color_strobe[m]) == owes);
              if (owes)
                assert ((p == 0 ? BITS'(slot_depth[m*CODE+:CODE]) : BITS'(slot_color[m*COLOR+:COLOR])) ==
                        (snapshot_q[BITS] || p == 0 ? snapshot_q[BITS-1:0] : BITS'(clear_color)));
            end
            if (!is_left && !is_read && owes) assert (sent_q || slot_left);
            if (slot_left) assert (!sent_q);
            // Data sent to memory.
            if (sends_any && is_color == (p == 1)) begin
              assert (request_o.strobe[m] == owes);
              if (owes)
                assert (lane == (is_here_q && (snapshot_q[BITS] || p == 0) ? snapshot_q[BITS-1:0] : BITS'(p == 0 ? clear_depth : clear_color)));
            end
            if (finishes && oldest_q == any_slot && owes) assert (sent_q || (sends_any && is_color == (p == 1)));
          end
        end
      end
    end
  endgenerate
  logic [SAMPLES*CODE-1:0]  slot_depth;
  logic [SAMPLES*COLOR-1:0] slot_color;
  logic [SAMPLES-1:0]       slot_depth_strobe, slot_color_strobe;
  assign {slot_depth_strobe, slot_depth} = victim_depth_q[{any_slot, any_stamp}];
  assign {slot_color_strobe, slot_color} = victim_color_q[{any_slot, any_stamp}];
  always_comb if (runs_q) begin
    cover (gen_plane[0].is_begun && gen_plane[0].is_line_q && gen_plane[0].gen_truth[0].owes && sends_any && !is_color);
    cover (gen_plane[1].is_begun && gen_plane[1].is_line_q && gen_plane[1].is_here_q && gen_plane[1].fills_q && sends_any && is_color);
    cover (x1_valid_q && x1_q.source == raster_pkg::DEPTH_SOURCE_CHIP && tested_q.mask != '0 && is_again && goes && !gen_depth[0].in_ram_q);
  end
