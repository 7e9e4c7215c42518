# Faults that the co-simulation must catch. cmake/Mutants.cmake says how they get into the design.

# cull
mutant(1 stages/cull.sv "tie rule: bottom edges take the samples on them, top edges leave them"
  [=[(!dx_q[D-1] && dx_q != '0)]=] [=[dx_q[D-1]]=])
mutant(2 stages/cull.sv "sign: the front face is the other one"
  [=[area[E] != front_cw_q]=] [=[area[E] == front_cw_q]=])
mutant(3 stages/cull.sv "off by one: the box loses a first column whose centre is on the leftmost vertex"
  [=[(B'(x_min_q) + TO_FIRST) >>> S]=] [=[(B'(x_min_q) + HALF) >>> S]=])
mutant(4 stages/cull.sv "order: of vertices 1 and 2 the larger one comes first"
  [=[!(key2 < key1)]=] [=[!(key1 < key2)]=])
mutant(5 stages/cull.sv "carry: turned edges gain the +1 of a negation"
  [=[~edge_q[(2-i)*V+:V]]=] [=[-edge_q[(2-i)*V+:V]]=])
mutant(6 stages/cull.sv "counter: empty triangles count when they face away, too"
  [=[is_counted && !is_zero && !is_back && d_is_empty_q]=] [=[is_counted && !is_zero && d_is_empty_q]=])

# triangle_setup
mutant(7 stages/triangle_setup.sv "rounding: the reciprocal is truncated"
  [=[R'(quotient_q[QUOTIENT-B-1])]=] [=[R'(0)]=])
mutant(8 stages/triangle_setup.sv "rounding: the x gradient is truncated"
  [=[P'(shifted[0])]=] [=[lane == 0 ? P'(0) : P'(shifted[0])]=])
mutant(9 stages/triangle_setup.sv "divider: an area that is a power of two has no quotient"
  [=[{2'b00, highest}]=] [=[first_area == highest ? '0 : {2'b00, highest}]=])
mutant(10 stages/triangle_setup.sv "range: the lower clamp overlooks the third vertex"
  [=[is_1_below_0 ? (is_2_below_1 ? c2 : c1) : (is_2_below_0 ? c2 : c0)]=]
  [=[is_1_below_0 ? (is_2_below_1 ? c2 : c1) : c0]=])
mutant(11 stages/triangle_setup.sv "carry: planes start half a local unit low"
  [=[moved + move_q[(LANES-1)*P+:P]]=]
  [=[moved + move_q[(LANES-1)*P+:P] - (P'(1) << (F - L - 1))]=])

# coarse_raster
mutant(12 stages/coarse_raster.sv "trivial reject: a tile whose best sample is on the edge is skipped"
  [=[largest[V]]=] [=[largest[V] || largest == '0]=])
mutant(13 stages/coarse_raster.sv "trivial accept: a tile whose worst sample is on the edge is not accepted"
  [=[!smallest[V]]=] [=[!smallest[V] && smallest != '0]=])
mutant(14 stages/coarse_raster.sv "saturation: large edge values wrap"
  [=[{value_q[V-1], {(TE - 1) {~value_q[V-1]}}}]=] [=[value_q[TE-1:0]]=])
mutant(15 stages/hiz.sv "early HiZ: an update is seen as soon as it is there"
  [=[(!is_settled_o || (starts_visit_i && started_q + (N + 1)'(1) == full))]=] [=[1'b1]=])
mutant(16 stages/hiz.sv "HiZ: a bound that equals the smallest depth rejects, whatever the depth test"
  [=[(HIZ + 1)'(is_equal_behind)]=] [=[(HIZ + 1)'(1)]=])
mutant(17 stages/hiz.sv "HiZ: greater and its like are tested"
  [=[setup_i.state.depth_test != raster_pkg::DEPTH_FUNC_NEVER && !can_raise]=]
  [=[setup_i.state.depth_test != raster_pkg::DEPTH_FUNC_NEVER]=])
mutant_text(18 stages/coarse_raster.sv "tile walk: a row of tiles starts where the one above ended"
  [=[moved_q && returned_q ? row_q]=]
  [=[moved_q && returned_q && (i != 0 || raster_cosim.mutant_q != 16'd18) ? row_q]=])  # depth alone
mutant(19 stages/coarse_raster.sv "off by one: the last column of a tile that the box crosses is left out"
  [=[is_rightmost ? s_q.box.right[TS-1:0] : '1]=] [=[is_rightmost ? s_q.box.right[TS-1:0] : ~TS'(1)]=])
mutant(20 stages/coarse_raster.sv "rounding: the local x step of depth is truncated"
  [=[SB'(step_x[NARROW-1])]=] [=[i == 0 ? SB'(0) : SB'(step_x[NARROW-1])]=])
mutant(21 stages/coarse_raster.sv "counter: rectangles count as triangles"
  [=[steps && is_triangle]=] [=[steps]=])
mutant(22 stages/coarse_raster.sv "context: the last slot is never given"
  [=[used_q != (SLOT + 1)'(SLOTS)]=] [=[used_q != (SLOT + 1)'(SLOTS - 1)]=])

# fine_raster
mutant(23 lib/edge_columns.sv "tie rule: samples on an edge are outside in a tile's first column"
  [=[value_i[WIDTH-1]]=] [=[value_i[WIDTH-1] || value_i == '0]=])
mutant(400 lib/edge_columns.sv "coverage: the last step of the search for an edge's column does not count"
  [=[OFFSET'(i) > column]=] [=[OFFSET'(i) > (column & ~OFFSET'(1))]=])
mutant(24 stages/fine_raster.sv "scissor: the right side of the box is not looked at"
  [=[PIXEL'(i) <= tile_q.box.right]=] [=[(PIXEL'(i) <= '1)]=])
mutant(25 stages/fine_raster.sv "end of visit: told with every row"
  [=[stamps_last_row_q && is_last_stamp_q && stamp_tile_q.is_visit]=] [=[is_last_stamp_q && stamp_tile_q.is_visit]=])
mutant(26 stages/fine_raster.sv "dropped stall: a row moves on before its stamps are taken over"
  [=[stamps_ready || !row_is_sent]=] [=[1'b1]=])

# interpolate
mutant(27 stages/interpolate.sv "offset: half of all codes stays in a code"
  [=[{!value_q[L+B-1], value_q[L+:B-1]}]=] [=[value_q[L+:B]]=])
mutant(28 stages/interpolate.sv "dropped stall: a stamp enters without a place for its fragment"
  [=[used_q == USED'(ROOM - 1)]=] [=[used_q == '1]=])
mutant(29 stages/interpolate.sv "sign: rows of stamps above the tile's centre count as below"
  [=[PIXEL'(row) << STAMP_SHIFT]=] [=[PIXEL'(row[PER_ROW_BITS-2:0]) << STAMP_SHIFT]=])
mutant(30 lib/fifo.sv "dropped stall: a full queue takes what it refuses, too"
  [=[valid_i && ready_o]=] [=[valid_i]=])

# depth_test and rop
mutant(31 stages/depth_test.sv "hazard: the mask of the stamp ahead is ignored, its depth is not seen"
  [=[valid_q && fragment_q.state.depth_write && fragment_q.key.tile_x == fragment_i.key.tile_x]=]
  [=[1'b0 && fragment_q.key.tile_x == fragment_i.key.tile_x]=])
mutant(32 lib/passing_orders.sv "depth test: gequal fails on equal codes"
  [=[func_i == raster_pkg::DEPTH_FUNC_GEQUAL || func_i == raster_pkg::DEPTH_FUNC_ALWAYS]=]
  [=[func_i == raster_pkg::DEPTH_FUNC_ALWAYS]=])
mutant(33 stages/depth_test.sv "HiZ: the bound comes from the stamp's first sample"
  [=[is_bottom ? (is_right ? pixel_11 : pixel_10) : (is_right ? pixel_01 : pixel_00)]=] [=[pixel_00]=])
mutant(34 stages/depth_test.sv "stale HiZ: greater and its like leave the bound as it was"
  [=[may_clear_q && any_passed]=] [=[1'b0]=])
mutant(35 stages/depth_test.sv "counter: samples count as written with both masks off"
  [=[is_counted && writes]=] [=[is_counted]=])

# framebuffer of tiles: `tiny` has it
mutant(36 stages/framebuffer.sv "write back: colour is always taken for dirty"
  [=[valid_q[line] && dirty_color_q[line]]=] [=[valid_q[line]]=])
mutant(37 stages/framebuffer.sv "fast clear: the flag of a plane outlives its write back"
  [=[{2{(state_q == EVICT || is_resolve) && ends_plane}} & {plane_q, !plane_q}]=]
  [=[{2{is_resolve && ends_plane}} & {plane_q, !plane_q}]=])
mutant(38 stages/framebuffer.sv "tag: only the tile's column is compared"
  [=[tag_y == access_i.key.tile_y >> LINE_Y]=] [=[1'b1]=])

mutant(121 stages/framebuffer.sv "write back: a plane ends with the first row of stamps that has none to write"
  [=[row_q == (ROW_BITS + 1)'(ROWS) && is_free]=] [=[row_q != '0 && is_free]=])
mutant(122 stages/framebuffer.sv "fill: what was not drawn into keeps what the colour RAM had"
  [=[fill_steps && flag_color]=] [=[1'b0]=])
mutant(123 stages/framebuffer.sv "fill: the stamps that the tile before had written count as written"
  [=[{2 * ROWS{is_fill}}]=] [=[{2 * ROWS{1'b0}}]=])
mutant(124 stages/framebuffer.sv "fast clear, flush: the walk over the flags ends with the first row of tiles"
  [=[ends_row && walk_y_q == access_i.key.tile_y]=] [=[ends_row]=])
mutant(125 stages/framebuffer.sv "flags: with that of a tile those of its word fall"
  [=[state_q == MARK ? '1 : WORD'(1) << bit_x]=] [=[{WORD{1'b1}}]=])
mutant(126 stages/framebuffer.sv "run of stamps: a row comes before the last one has been read"
  [=[(steps && left == one)]=] [=[steps]=])
mutant(127 stages/framebuffer.sv "write back: of a plane that memory has as garbage only what was written"
  [=[state_q != EVICT || (plane_q ? flag_color : flag_depth)]=] [=[state_q != EVICT]=])
mutant(128 stages/framebuffer.sv "write back: the stamps of depth stand for those of colour"
  [=[plane_q ? dirty_rows[ROWS*SAMPLES+:ROWS*SAMPLES] : dirty_rows[0+:ROWS*SAMPLES]]=] [=[dirty_rows[0+:ROWS*SAMPLES]]=])
mutant(129 stages/framebuffer.sv "flush: a tile whose colour is cleared counts as resolved"
  [=[(resolves ? !flag_color : request_ready_i)]=] [=[(resolves || request_ready_i)]=])

# reset
mutant_text(39 stages/coarse_raster.sv "wrong reset: the first primitive gets the second slot"
  [=[      slot_q  <= '0;]=] [=[      slot_q  <= SLOT'(raster_cosim.mutant_q == 16'd39);]=])

# line_raster
mutant(40 stages/line_raster.sv "tie rule: an error of 0 stays in the row"
  [=[!error_q[E-1]]=] [=[!error_q[E-1] && error_q != '0]=])
mutant(41 stages/line_raster.sv "error: a step to the next row gains what a step within it gains"
  [=[(moves ? step_move : step_stay)]=] [=[step_stay]=])
mutant(42 stages/line_raster.sv "direction: every line goes down"
  [=[line_q.is_y_negative ? '1 : PY'(1)]=] [=[PY'(1)]=])
mutant(43 stages/line_raster.sv "off by one: the last pixel of a line is left out"
  [=[remaining_q == '0]=] [=[remaining_q <= COUNT'(1)]=])
mutant(44 stages/line_raster.sv "start: a pixel before the line's start shows an extrapolated depth"
  [=[is_before_start_q ? line_q.start[CODE+:B] : value_q[W-1-:B]]=]
  [=[is_before_start_q && p != 0 ? line_q.start[CODE+:B] : value_q[W-1-:B]]=])
mutant(45 stages/line_raster.sv "depth: only steps to the next row change it"
  [=[value_q + line_q.step[LINE+:W]]=] [=[value_q + (moves || p != 0 ? line_q.step[LINE+:W] : '0)]=])
mutant(46 stages/line_raster.sv "dropped stall: the next line is taken while the last pixel waits"
  [=[!valid_q]=] [=[!valid_q || is_last]=])

# primitive_join
mutant(47 stages/primitive_join.sv "mask: row and column of the sample are swapped"
  [=[inner_x == TS'(s / N % SIZE) && inner_y == TS'(s / N / SIZE)]=]
  [=[inner_y == TS'(s / N % SIZE) && inner_x == TS'(s / N / SIZE)]=])
mutant(48 stages/primitive_join.sv "end of line: a line's place is gone after one pixel"
  [=[(pixel_valid_i && pixel_i.is_last)]=] [=[pixel_valid_i]=])
mutant_text(49 stages/primitive_join.sv "state: lines write depth, whatever the mask"
  [=[      joined.mask           = mask;]=]
  [=[      joined.mask           = mask;
      if (raster_cosim.mutant_q == 16'd49) joined.state.depth_write = 1'b1;]=])
mutant(50 stages/primitive_join.sv "order: a pixel goes first when it is there first"
  [=[fragment_i.kind == raster_pkg::PRIMITIVE_KIND_LINE]=] [=[pixel_valid_i]=])

# lines and points on their way through the other stages
mutant(51 stages/hiz.sv "stale HiZ: bounds are read behind a line that can raise depths"
  [=[bounds_hold_q && is_triangle]=] [=[is_triangle]=])
mutant(52 stages/depth_test.sv "HiZ: pixels of a line count for the tile visit behind it"
  [=[is_stamp && !fragment_q.kind[1]]=] [=[is_stamp]=])
mutant(53 stages/depth_test.sv "counter: samples of points and lines are left out"
  [=[(fragment_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE || fragment_q.kind[2])]=]
  [=[fragment_q.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE]=])
mutant(54 stages/cull.sv "counter: points and lines do not count as primitives"
  [=[d_is_triangle || (kind_q[2] && !kind_q[0])]=] [=[d_is_triangle]=])
mutant(55 stages/framebuffer.sv "token: pixels of a line are taken for a fast clear"
  [=[access_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR]=]
  [=[access_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR || access_i.kind == raster_pkg::PRIMITIVE_KIND_LINE]=])

# triangles without a sample, and the phases of triangle_setup
mutant(56 stages/cull.sv "no sample: the first pixel of the box counts as missed"
  [=[{has_column_q && has_row_q, has_row_q, has_column_q, 1'b1}]=]
  [=[{has_column_q && has_row_q, has_row_q, has_column_q, 1'b0}]=])
mutant(57 stages/cull.sv "no sample: the length of the sides does not matter"
  [=[is_small_q && edge_is_short_q]=] [=[is_small_q]=])
mutant(58 stages/cull.sv "no sample: a third row of samples is overlooked"
  [=[rows <= 3'd1]=] [=[rows <= 3'd2]=])
mutant(59 stages/cull.sv "no sample: the fourth sample is looked for in the first column"
  [=[below - NV'(edge_y_q)]=] [=[below]=])
mutant(60 stages/triangle_setup.sv "dropped stall: a part hands over to one that is not free"
  [=[at_q[i*STEPS+STEPS-1] && ready_q[i+1]]=] [=[at_q[i*STEPS+STEPS-1]]=])
mutant(61 stages/triangle_setup.sv "numerators: the first plane's product comes a phase late"
  [=[flows[NUMERATOR] || flows[NUMERATOR+1]]=] [=[flows[NUMERATOR+1]]=])

# the tile walk
mutant(65 stages/coarse_raster.sv "tile walk: what lies to the left of a row's start is left out"
  [=[start_x != s_q.box.left[PX-1:TS]]=] [=[1'b0]=])
mutant(66 stages/coarse_raster.sv "tile walk: a row ends at an upright edge that has not been met"
  [=[(dy[D-1] || dy == '0)]=] [=[1'b1]=])
mutant_text(67 stages/coarse_raster.sv "tile walk: the first tile to the left of the start has the planes of the start"
  [=[moved_left_q <= moves_left]=] [=[moved_left_q <= raster_cosim.mutant_q != 16'd67 ? moves_left : goes_left_q]=])

mutant(401 stages/triangle_setup.sv "divider: what is negative is not made good"
  [=[!from[REMAINDER-1]]=] [=[1'b1]=])
mutant(402 lib/registered_fifo.sv "dropped stall: the item on offer gives way before it is taken"
  [=[!valid_o || ready_i]=] [=[1'b1]=])

# the lag of HiZ
mutant(62 stages/hiz.sv "stale HiZ: a visit that may raise a depth is believed not to, until it is seen"
  [=[quiet_q == '1]=] [=[1'b1]=])
mutant(63 stages/hiz.sv "HiZ: a visit that may raise a depth is forgotten a visit too early"
  [=[raises_i ? '0 : quiet_q + N'(quiet_q != '1)]=]
  [=[raises_i ? N'(1) : quiet_q + N'(quiet_q != '1)]=])
mutant(64 stages/hiz.sv "fast clear: what earlier visits had to say comes behind it"
  [=[clears_i ? started_q : seen_q + (N + 1)'(sees)]=] [=[seen_q + (N + 1)'(sees)]=])

# framebuffer of blocks
mutant(70 stages/cache_tags.sv "tag: only the block's column is compared"
  [=[line_read[STATE-4-:TAG_X+TAG_Y] == read_tag]=] [=[line_read[STATE-4-:TAG_X] == read_tag[TAG_Y+:TAG_X]]=])
mutant(71 stages/clear_flags.sv "fast clear: the flag of a block outlives its eviction"
  [=[WORD'(1) << bit_of(writes_x_q)]=] [=[WORD'(0)]=])
mutant(72 stages/cache_tags.sv "order: a block on its way to memory is read as memory has it"
  [=[!is_access || hits_q]=] [=[1'b1]=])
mutant(73 stages/cache_tags.sv "tags: a line that is read while it is written is seen as it was"
  [=[is_forwarded_q ? forward_q : line_read]=] [=[line_read]=])
mutant(74 stages/cache_tags.sv "depth unread: always, with some samples of a stamp"
  [=[fragment_q.mask == '1]=] [=[1'b1]=])
mutant(75 stages/cache_tags.sv "fast clear: marks stop at the last whole word"
  [=[~({WORD{1'b1}} << 1 << bit_of(last_x))]=] [=[{WORD{1'b0}}]=])
mutant(76 stages/depth_cache.sv "hazard: a stamp does not have what the one before it writes"
  [=[is_again && writes]=] [=[1'b0]=])
mutant(77 stages/depth_cache.sv "victims: the stamp that is about to be written is not read first"
  [=[goes && (found.evicts || left_line_q == found.line) && (left & item_bit) != '0]=] [=[1'b0]=])
mutant(78 stages/depth_cache.sv "strobes: samples count as written that only came from memory"
  [=[{write_i.write_depth[s], word_i[s*CODE+:CODE]}]=] [=[{1'b1, word_i[s*CODE+:CODE]}]=])
mutant(79 stages/color_write.sv "fill: what was not drawn into keeps what the colour RAM had"
  [=[dirty[s] ? code[s*COLOR+:COLOR] : clear_color_i & {COLOR{fills_q}}]=] [=[code[s*COLOR+:COLOR]]=])
mutant(80 stages/write_back.sv "victims: a block goes to memory before its colours are here"
  [=[depth_ready_q != '0 && color_ready_q != '0]=] [=[depth_ready_q != '0]=])

# two evictions in flight in color_write
mutant(261 stages/color_write.sv "evictions: the stamp that is about to be written is not read first"
  [=[hits ? own : raster_pkg::lowest_stamp(left)]=] [=[raster_pkg::lowest_stamp(of_second ? second : first_q)]=])
mutant(262 stages/color_write.sv "evictions: a third begins while two are under way"
  [=[!started_q && !second_begun_q]=] [=[!started_q]=])
mutant(263 stages/color_write.sv "evictions: the colours of the second go to the slot of the first"
  [=[of_second ? second_slot : first_slot_q]=] [=[first_q == '0 ? second_slot : first_slot_q]=])
mutant(264 stages/color_write.sv "evictions: a block goes to memory as soon as its eviction begins"
  [=[delay_q[DELAY-1]]=] [=[delay_q[0]]=])

# three steps of the tags
mutant(220 stages/cache_tags.sv "tags: what the fragment before leaves in its line is not seen by the next one"
  [=[(is_access || (valid_q && walks_q)) && line_q == read_line_q]=] [=[1'b0]=])
mutant(221 stages/cache_tags.sv "tags: what the fragment before has brought into the line is not compared"
  [=[block_x == read_x && block_y == read_y]=] [=[1'b1]=])
mutant(222 stages/cache_tags.sv "flags: the next fragment's are not looked at where only its row is another"
  [=[fragment_x == read_x && fragment_y == read_y]=] [=[fragment_x == read_x]=])
mutant(223 stages/cache_tags.sv "flags: of two that fall in a row the second takes the word from before the first"
  [=[falls && flags_are_busy]=] [=[1'b0]=])

# memory_port
mutant(101 lib/beat_bytes.sv "length: a burst of several stamps is a beat short"
  [=[LENGTH'(run_i) << (SHIFT - PORT)]=] [=[(LENGTH'(run_i) << (SHIFT - PORT)) - LENGTH'(run_i[raster_pkg::RUN_BITS-1:1] != '0)]=])
mutant(102 lib/beat_bytes.sv "strobes: every byte of a stamp is written"
  [=[{SAMPLE_BYTES{strobe_i[s]}}]=] [=[{SAMPLE_BYTES{1'b1}}]=])
mutant_text(103 stages/memory_port.sv "carry: the column of a tile is not added to its row, but ored"
  [=[layout_i.row_stride[STRIDE-1:TILE]);]=]
  [=[layout_i.row_stride[STRIDE-1:TILE]) - (raster_cosim.mutant_q != 16'd103 ? '0 :
      ((ADDRESS - TILE)'(rows_q) * (ADDRESS - TILE)'(layout_i.row_stride[STRIDE-1:TILE])) &
       (ADDRESS - TILE)'(address_q >> (TILE - PORT)));]=])
mutant(104 stages/memory_port.sv "answers: stamps are counted, not bursts"
  [=[8'(takes && begins)]=] [=[8'(takes && request_i.is_write)]=])
mutant(105 stages/memory_port.sv "idle: taken is as good as written"
  [=[!discards && reads_q == '0 && writes_q == '0]=] [=[!discards && reads_q == '0]=])
mutant(106 stages/memory_port.sv "reset: answers to what was asked for before it are handed on"
  [=[is_read && is_whole && !discards]=] [=[is_read && is_whole]=])
mutant(107 stages/memory_port.sv "reset: a burst that it cuts is never ended"
  [=[in_burst_q && length_q != '0]=] [=[1'b0]=])
mutant(108 stages/write_back.sv "runs: a gap counts as a stamp"
  [=[(gaps & ((STAMPS'(2) << i) - 1'b1)) == '0]=] [=[1'b1]=])
mutant(109 lib/stamp_bytes.sv "answers: of those that share a beat always the first stamp"
  [=[(32'(sub_i) & 32'((1 << SHARED) - 1))]=] [=[32'd0]=])
# clock and area
mutant(111 stages/performance_counters.sv "counters: those that are held go on"
  [=[!hold_i]=] [=[1'b1]=])
mutant(112 stages/hiz.sv "HiZ: two groups of tiles share their bounds"
  [=[WORD'({y, x} >> GROUP)]=] [=[WORD'(({y, x} >> GROUP) | (TX + TY)'(1))]=])
mutant(113 stages/triangle_setup.sv "phases: a part is free when its triangle is in the last phase, whether it goes on or not"
  [=[at_d[i*STEPS+STEPS-1] && ready_d[i+1]]=] [=[at_d[i*STEPS+STEPS-1]]=])
# binned order
mutant(91 stages/cache_tags.sv "bins: once lost, depth is lost in frames that store it too"
  [=[drops_depth && is_clear]=] [=[drops_depth_q || (drops_depth && is_clear)]=])
mutant(92 stages/cache_tags.sv "bins: the flag of a block falls though its depth is lost"
  [=[{line_has_color, line_depth != '0}]=] [=[{line_has_color, line_has_depth}]=])
mutant(93 stages/cache_tags.sv "bins: a block begins with the depths of the one that was lost"
  [=[hits_q ? line_known : '0]=] [=[hits_q || drops_depth_q ? line_known : '0]=])
mutant(94 stages/cache_tags.sv "flush: the flags of depth that is lost are written"
  [=[!is_clear && drops_depth_q]=] [=[1'b0]=])
mutant(95 stages/cache_tags.sv "flush: the depth of the last blocks is stored whatever it says"
  [=[is_clear ? drops_depth_q : drops_depth]=] [=[drops_depth_q]=])
mutant_text(96 stages/clear_flags.sv "flags: a fragment looks at the word of a flag that falls, not at its own"
  [=[is_busy_o = reads_q]=] [=[is_busy_o = reads_q && raster_cosim.mutant_q != 16'd96]=])

# A clear of one bin, after a frame that holds other bins.
mutant(404 stages/cache_tags.sv "bins: a clear of one forgets the flags that share its words"
  [=[(clears_bin ? word_color : '0)]=] [=['0]=])
mutant(405 stages/cache_tags.sv "bins: a clear of one begins with the first column"
  [=[clears_bin ? last_x & ~BIN_X : '0]=] [=['0]=])
mutant(406 stages/cache_tags.sv "bins: a clear of one is that of its last row of blocks"
  [=[last_y & ~BIN_Y]=] [=[last_y]=])
mutant(407 stages/cache_tags.sv "bins: a clear of one looks for lines to write"
  [=[clears_all || clears_bin]=] [=[clears_all]=])

# a texture unit and its inputs
mutant(141 stages/triangle_setup.sv "texture: planes over w start at vertex 0"
  [=[{is_2_less, is_1_less && !is_2_less}]=] [=[2'b00]=])
mutant(142 stages/triangle_setup.sv "texture: planes over w have the window of codes"
  [=[sums_over_w ? HALVES_OVER_W : HALVES]=] [=[HALVES]=])
mutant(143 stages/triangle_setup.sv "texture: the way to the anchor is that of vertex 0"
  [=[moves_over_w ? {to_base_y_q, to_base_x_q} : {to_anchor_y_q, to_anchor_x_q}]=]
  [=[moves_over_w ? {to_base_y_q, to_anchor_x_q} : {to_anchor_y_q, to_anchor_x_q}]=])
mutant_text(495 stages/context_ram.sv "texture: of two triangles the second one has the constants of the first"
  [=[.read_address_i (coming_number_i)]=]
  [=[.read_address_i (coming_number_i & ~NUMBER'(raster_cosim.mutant_q == 16'd495))]=])
mutant(144 stages/cull.sv "texture: a triangle has the coordinate frame of the one that comes"
  [=[raster_pkg::COORDINATE_FRAME_BITS'(coordinates_q)]=] [=[raster_pkg::COORDINATE_FRAME_BITS'(p_q.coordinates)]=])
mutant(145 stages/texture_stage.sv "texture: points and clears have it too"
  [=[fragment_i.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE]=] [=[fragment_i.kind != raster_pkg::PRIMITIVE_KIND_STATE]=])
mutant(146 stages/depth_cache.sv "texture: samples that fail the depth test are looked up"
  [=[{SAMPLES{write_valid_i}} & (tests_alpha ? looked_at : write_i.write_color)]=] [=[{SAMPLES{write_valid_i}} & x1_item_q.mask]=])
mutant(147 raster_top.sv "texture: idle though its memory has not answered what was asked for before a reset"
  [=[orders_are_done && texture_is_idle]=] [=[orders_are_done]=])
mutant(148 stages/depth_cache.sv "texture: one stamp more goes in than there is room for"
  [=[behind_q != BEHIND'(PLACES)]=] [=[behind_q <= BEHIND'(PLACES)]=])
mutant(149 stages/texture_tags.sv "texture: of the tag the lowest bits"
  [=[tag == t_address_q[b*28+:28]]=] [=[tag[5:0] == t_address_q[b*28+:6]]=])
mutant(150 lib/texture_answers.sv "texture: an answer of before a reset is taken"
  [=[answer_valid_i && !discards]=] [=[answer_valid_i]=])
mutant(151 stages/texture_tags.sv "texture: a line that is still to be read is overwritten"
  [=[(asks & referenced) != '0]=] [=[1'b0]=])
mutant(152 stages/texture_tags.sv "texture: a sample does not wait for its lines"
  [=[come_q >= COME'(waits_for)]=] [=[1'b1]=])
mutant(153 stages/texture_tags.sv "texture: another texture begins with the lines of the one before"
  [=[drop_i || (sweeps_q && sweep_q != '1)]=] [=[sweeps_q && sweep_q != '1]=])
mutant(154 lib/over_w_narrow.sv "texture: P is cut off"
  [=[(NARROW + 1)'(shifted_q[0])]=] [=[(NARROW + 1)'(1'b0)]=])
mutant(155 lib/texture_wrap.sv "texture: mirror repeats"
  [=[is_mirrored && turn != '0]=] [=[1'b0]=])
mutant(156 lib/texture_combine.sv "texture: add does not hold"
  [=[{8{sum[8]}}]=] [=[8'd0]=])
mutant(157 stages/texture_unit.sv "texture: the frame of a triangle goes with its first sample"
  [=[INDEX'(splits && is_last)]=] [=[INDEX'(splits)]=])
mutant(158 stages/texture_levels.sv "texture: rows of blocks are as long on all levels"
  [=[less(wide_q, level)]=] [=[wide_q]=])
mutant(159 stages/texture_stage.sv "texture: a level of detail is that of the tile's first pixel"
  [=[((PIXEL'(fragment_i.stamp) >> ROW) << STAMP)]=] [=[PIXEL'(0)]=])
mutant(160 stages/texture_stage.sv "texture: levels are never set"
  [=[is_token && register == raster_pkg::STATE_REGISTER_TEXTURE_LEVELS]=] [=[1'b0]=])
mutant(161 stages/level_of_detail.sv "texture: the two slopes are one"
  [=[lines_q[128+32*(n%2)+:32]]=] [=[lines_q[128+:32]]=])
mutant(162 stages/level_of_detail.sv "texture: the octagon is a square"
  [=[!more[32]]=] [=[1'b0]=])
mutant(163 stages/level_of_detail.sv "texture: magnified begins at 0"
  [=[12'd128]=] [=[12'd0]=])
mutant(164 stages/level_of_detail.sv "texture: the nearest level is rounded the other way"
  [=[{1'b0, level_q} + 13'd127]=] [=[{1'b0, level_q} + 13'd128]=])
mutant(165 stages/level_of_detail.sv "texture: a bias is whole levels"
  [=[lines_q[192+:16]]=] [=[{lines_q[200+:8], 8'd0}]=])
mutant(166 lib/log2_below.sv "texture: the logarithm is made of lines"
  [=[below_i + 8'(bow_rom[from_end])]=] [=[below_i]=])
mutant(167 stages/texture_levels.sv "texture: a level begins where the larger one does"
  [=[(ones_q & (21'h1ffffe << blocks))]=] [=[(ones_q & (21'h1ffffc << blocks))]=])
mutant(168 stages/texture_levels.sv "texture: the second pass is on the first one's level"
  [=[level_i + 4'(is_second_q)]=] [=[level_i]=])
mutant(169 lib/texture_on_level.sv "texture: coordinates on a level are cut off"
  [=[PLACE'(is_linear_q && scaled_q[0])]=] [=[PLACE'(1'b0)]=])
mutant(170 lib/texture_blend.sv "texture: between levels sums are cut off"
  [=[sum_i[24*n+8+:16] + 16'(sum_i[24*n+7])]=] [=[sum_i[24*n+8+:16]]=])

# colour operations
mutant(180 lib/blend_lane.sv "colours: one minus a factor is one too little or too much"
  [=[{8{chooses_i[6*f+5]}}]=] [=[{{7{chooses_i[6*f+5]}}, 1'b0}]=])
mutant(181 lib/blend_lane.sv "colours: reverse subtract adds"
  [=[equation == REVERSE_SUBTRACT]=] [=[1'b0]=])
mutant(182 lib/blend_lane.sv "colours: a sum above 1 does not hold"
  [=[!differs && quotient[17]]=] [=[1'b0]=])
mutant(183 lib/blend_lane.sv "colours: a difference below 0 does not hold"
  [=[differs && sum[16] != reverses]=] [=[1'b0]=])
mutant(184 lib/blend_lane.sv "colours: a blend is cut off"
  [=[(reverses ? 3'b111 : 3'b001)]=] [=[(reverses ? 3'b110 : 3'b000)]=])
mutant(185 lib/blend_lane.sv "colours: a blend is divided by 256"
  [=[{{7{upper[2] && differs}}, upper, sum[14:8], sum[7]}]=] [=[{{7{upper[2] && differs}}, upper, 7'd0, 1'b0}]=])
mutant(186 lib/blend_lane.sv "colours: src_alpha_saturate does not look at what is stored"
  [=[(source_alpha < room ? source_alpha : room)]=] [=[source_alpha]=])
mutant(187 lib/blend_lane.sv "colours: max is min"
  [=[(source < stored) == (equation == MIN)]=] [=[source < stored]=])
mutant(188 stages/color_write.sv "colours: the masks of red and blue are exchanged"
  [=[{{5{out[0]}}, {6{out[1]}}, {5{out[2]}}}]=] [=[{{5{out[2]}}, {6{out[1]}}, {5{out[0]}}}]=])
mutant(189 stages/color_write.sv "colours: what has been written of a stamp is lost when the rest of it comes"
  [=[is_here_1_q || held[s]]=] [=[is_here_1_q]=])
mutant(190 stages/color_write.sv "colours: hazard: a stamp does not have what the one in front makes of it"
  [=[{line_2_q, stamp_2_q} == {line_1_q, stamp_1_q}]=] [=[1'b0]=])
mutant(191 stages/color_write.sv "colours: hazard: a block is evicted while a stamp of it is on its way to the RAM"
  [=[is_same_line != '0]=] [=[1'b0]=])
mutant(192 stages/color_write.sv "colours: samples that memory does not have pass for read ones"
  [=[mask_1_q | held]=] [=[mask_1_q]=])
mutant_text(193 stages/color_write.sv "colours: a stamp has the masks of the one behind it"
  [=[assign out           = out_2_q;]=]
  [=[assign out           = raster_cosim.mutant_q == 16'd193 ? ops_q[DITHERS:WRITES] : out_2_q;]=])
mutant(194 stages/color_write.sv "colours: dithering: the matrix is turned"
  [=[~{x[0] ^ y[0], y[0], x[1] ^ y[1], y[1]}]=] [=[~{x[0] ^ y[0], x[0], x[1] ^ y[1], x[1]}]=])
mutant(195 lib/sample_place.sv "colours: dithering: every stamp begins at the matrix' first column"
  [=[2'(stamp_i[SIDE_BITS-1:0])]=] [=[2'd0]=])
mutant(196 stages/cache_tags.sv "colours: what a clear has left is asked of memory"
  [=[cleared[1] ? raster_pkg::DEPTH_SOURCE_CLEAR : raster_pkg::DEPTH_SOURCE_MEMORY]=] [=[raster_pkg::DEPTH_SOURCE_MEMORY]=])
mutant(197 stages/cache_tags.sv "colours: a block begins with what was known of the one before it"
  [=[hits_q ? line_state_q[KNOWN-1:0] : '0]=] [=[line_state_q[KNOWN-1:0]]=])
mutant(198 stages/write_back.sv "colours: asked for ahead of depth"
  [=[order_reads_color && (!order.reads || depth_asked_q)]=] [=[order_reads_color && !depth_asked_q]=])
mutant(199 stages/memory_answers.sv "colours: an answer goes to the other plane"
  [=[response_valid_i && !is_color]=] [=[response_valid_i && (!is_color || color_valid_o)]=])

# alpha test
mutant(200 lib/alpha_test.sv "alpha: equal passes for less"
  [=[alpha_i[8*p+:8] < reference_i]=] [=[alpha_i[8*p+:8] <= reference_i]=])
mutant(201 stages/depth_test.sv "alpha: what may still be dropped sets the bound of HiZ"
  [=[kept == '1 && !is_late]=] [=[kept == '1]=])
mutant(202 stages/depth_cache.sv "alpha: depth is written before it is decided"
  [=[write_valid_i && writes && !x1_late]=] [=[write_valid_i && writes]=])
mutant(203 stages/depth_cache.sv "alpha: a stamp does not wait for what is decided about it"
  [=[(pending_here & item_bit) != '0]=] [=[1'b0]=])
mutant(204 stages/depth_cache.sv "alpha: a block leaves before what is decided about it"
  [=[(found.evicts && pending_here != '0)]=] [=[1'b0]=])
mutant(205 stages/depth_cache.sv "alpha: what is not tested overtakes what is"
  [=[late_behind_q != '0]=] [=[1'b0]=])
mutant(206 stages/cache_tags.sv "alpha: depth unread where always writes all that alpha lets pass"
  [=[(tests_alpha && fragment_q.state.depth_write)]=] [=[1'b0]=])
mutant(207 stages/late_test.sv "alpha: counter: samples that fail the depth test are counted too"
  [=[raster_pkg::count_samples(stamp_i.passed & ~alpha_passes)]=]
  [=[raster_pkg::count_samples(~alpha_passes)]=])
mutant(324 lib/alpha_test.sv "alpha: less and greater are exchanged"
  [=[is_less ? less_passes : (is_equal ? equal_passes : greater_passes)]=]
  [=[is_less ? greater_passes : (is_equal ? equal_passes : less_passes)]=])
mutant(325 lib/alpha_test.sv "alpha: values that differ in the lowest bit are equal"
  [=[alpha_i[8*p+:8] == reference_i]=] [=[alpha_i[8*p+1+:7] == reference_i[7:1]]=])
mutant(326 stages/late_test.sv "alpha: the reference is a bit further up in its word"
  [=[stamp_i.state[10:3]]=] [=[stamp_i.state[11:4]]=])
mutant(327 stages/late_test.sv "alpha: what it drops writes its depth"
  [=[changes[s] && alpha_passes[s]]=] [=[changes[s]]=])
mutant(328 stages/late_test.sv "alpha: a depth that was read for what it drops does not come into the RAM"
  [=[is_kept || !stamp_i.on_chip]=] [=[is_kept]=])
mutant(329 stages/late_test.sv "alpha: counter: what it drops counts as written"
  [=[raster_pkg::count_samples(stamp_i.passed & alpha_passes)]=]
  [=[raster_pkg::count_samples(stamp_i.passed)]=])
mutant(330 stages/color_write.sv "alpha: what it drops writes its colour"
  [=[tested_i.mask & opaque_i]=] [=[tested_i.mask]=])

# stencil
mutant(208 lib/stencil_test.sv "stencil: the reference is compared without the mask"
  [=[(stored ^ reference_i) & read_i]=] [=[(stored & read_i) ^ reference_i]=])
mutant(209 lib/stencil_test.sv "stencil: what fails the depth test alone does what passes"
  [=[(is_nearer_i[s] ? ops_i[8:6] : ops_i[5:3])]=] [=[ops_i[8:6]]=])
mutant(210 lib/stencil_test.sv "stencil: bits outside of the write mask become 0"
  [=[stored ^ (write_i & (toggles | carries))]=] [=[write_i & (stored ^ (toggles | carries))]=])
mutant(211 lib/stencil_test.sv "stencil: incr goes on at 0"
  [=[!(saturates && is_at_end)]=] [=[!(saturates && is_at_end && is_down)]=])
mutant(212 stages/cull.sv "stencil: every triangle shows its front"
  [=[d_is_triangle && state_q.tests_stencil && is_negative == front_cw_q]=] [=[1'b0]=])
mutant(213 stages/hiz.sv "stencil: tiles are left out where what fails is marked"
  [=[setup_i.state.marks_failed]=] [=[1'b0]=])
mutant(214 stages/depth_test.sv "stencil: where it alone changes the fragment's depth is stored"
  [=[takes[s]]=] [=[changes[s]]=])
mutant(215 stages/depth_test.sv "stencil: samples that are not covered change"
  [=[fragment_q.mask & opaque & {SAMPLES{fragment_q.state.tests_stencil}}]=] [=[opaque & {SAMPLES{fragment_q.state.tests_stencil}}]=])
mutant(216 stages/cache_tags.sv "stencil: a depth that is overwritten goes unread, and what is above it"
  [=[!(fragment_q.state.tests_stencil && replaces)]=] [=[fragment_q.state.tests_stencil && !replaces]=])
mutant(217 stages/cache_tags.sv "stencil: a clear takes its value of the back"
  [=[fragment_q.code[SIDES]]=] [=[fragment_q.code[SIDES+1]]=])
mutant(218 stages/depth_cache.sv "stencil: a late alpha test, or an eviction, does not wait for a stamp of which only that changes"
  [=[item.state.depth_write || item.state.writes_stencil]=] [=[item.state.depth_write]=])
mutant(219 stages/depth_cache.sv "stencil: with a late alpha test, what has failed keeps its value"
  [=[write_i.passed | write_i.write_depth]=] [=[write_i.passed]=])

mutant(322 stages/cache_tags.sv "stencil: what replaces a part of it goes unread"
  [=[fragment_q.code[UPDATE_SIDES-1-:8] == 8'hff]=] [=[fragment_q.code[UPDATE_SIDES-1-:8] != 8'h00]=])
mutant(323 stages/cache_tags.sv "stencil: what replaces it goes unread where not all pass"
  [=[passes_all_q[fragment_q.state.is_back]]=] [=[1'b1]=])

# The lane of states beside triangle_setup; counters of a texture unit; its division.
mutant(250 lib/setup_states.sv "texture states: one overtakes the triangle in front of it"
  [=[waits && number == left_q]=] [=[waits]=])
mutant(251 lib/setup_states.sv "texture states: a triangle overtakes the one in front of it"
  [=[!is_next && is_free]=] [=[is_free && (!is_next || made_valid_i)]=])
mutant(252 lib/setup_states.sv "texture states: one has the range of the triangle behind it"
  [=[is_next ? own : made_i.range.high[AT+:B]]=] [=[made_i.range.high[AT+:B]]=])
mutant(253 stages/cull.sv "texture states: one has the box of the primitive in front"
  [=[is_empty_q && !is_state]=] [=[is_empty_q]=])
mutant(254 stages/texture_linear.sv "texture counter: a sample between two levels is looked up twice"
  [=[looked_up && !ends_first]=] [=[looked_up]=])
mutant(255 stages/texture_linear.sv "texture counter: what a sample's first level lacked does not count"
  [=[!(ends_second && misses_first_q)]=] [=[1'b1]=])
mutant(256 lib/texture_answers.sv "texture: a line begins with the last beat of the one before"
  [=[ends_line_o ? '0 : beat_q + BEATS'(takes)]=] [=[beat_q + BEATS'(takes)]=])

# Colours in flight, forwarded to the next stamp.
mutant(300 stages/color_write.sv "colours: hazard: a stamp does not have what was written while it was read"
  [=[{line_3_q, stamp_3_q} == {line_1_q, stamp_1_q}]=] [=[1'b0]=])
mutant(301 stages/color_write.sv "colours: what a clear has left is mixed with an answer of before"
  [=[{SAMPLES*COLOR{is_answered_1_q}}]=] [=['1]=])
mutant(302 stages/color_write.sv "colours: what is left of the block before counts as written"
  [=[!starts_1_q]=] [=[1'b1]=])

# fog
mutant(310 lib/fog_place.sv "fog: what lies nearer than the table begins it again"
  [=[{19{is_above}}]=] [=[19'd0]=])
mutant(311 lib/fog_place.sv "fog: what lies farther than the table is at its near end"
  [=[octave[7]]=] [=[1'b0]=])
mutant(312 lib/fog_place.sv "fog: lines are spread as those of 16 octaves"
  [=[(3'd4 - octaves_i)]=] [=[3'd0]=])
mutant(313 stages/fog_lookup.sv "fog: points and clears are fogged too"
  [=[enable_q && fragment_i.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE]=] [=[enable_q && !is_token]=])
mutant(314 stages/fog_lookup.sv "fog: another one has the octaves of the first"
  [=[is_token && unit == 2'd1]=] [=[is_token && unit == 2'd1 && !enable_q]=])
mutant(315 stages/fog_unit.sv "fog: f is that of the line's first place"
  [=[$signed({2'b00, product})]=] [=[30'sd0]=])
mutant(316 stages/fog_unit.sv "fog: f is cut off"
  [=[30'sd8192]=] [=[30'sd0]=])
mutant(317 stages/fog_unit.sv "fog: f goes beyond 1"
  [=[whole > 16'sd4096]=] [=[1'b0]=])
mutant(318 stages/fog_unit.sv "fog: f goes below 0"
  [=[whole[15]]=] [=[1'b0]=])
mutant(319 stages/fog_unit.sv "fog: the mix is cut off"
  [=[12'd2048]=] [=[12'd0]=])
mutant(320 stages/fog_unit.sv "fog: two lines of the table lie in one place"
  [=[word_i[START+RISE+:LINE]]=] [=[word_i[START+RISE+:LINE] & 8'hfe]=])
mutant(321 stages/fog_unit.sv "fog: a stamp that waits reads the line of the one behind it"
  [=[enters_1 && !sets_line_i]=] [=[!sets_line_i]=])

# light
mutant(441 stages/light_unit.sv "light: a register changes under the samples in front of its token"
  [=[head_sets && lit_q[LOOKS-1:1] != '0]=] [=[1'b0]=])
mutant(442 stages/light_unit.sv "light: points and clears are lit too"
  [=[enable_q && head_triangle]=] [=[enable_q && !head_sets]=])
mutant(443 stages/light_unit.sv "light: m of 15 bits is not held where it rounds up to 16"
  [=[moved[P-1-:M] != {1'b0, {(M - 1) {1'b1}}}]=] [=[1'b1]=])
mutant(444 stages/light_unit.sv "light: a long m counts as a short one"
  [=[square_5_q[2*M-1:2*M-2] != '0]=] [=[square_5_q[2*M-1]]=])
mutant(445 stages/light_unit.sv "light: what looks away has its highlight"
  [=[light_cosine == '0]=] [=[1'b0]=])
mutant(446 stages/light_unit.sv "light: the power is cut off"
  [=[(START + PART + 2)'(2048)]=] [=[(START + PART + 2)'(0)]=])
mutant(447 stages/light_unit.sv "light: what is brighter than 255 begins again"
  [=[{8{colored[22:20] != '0}}]=] [=[8'd0]=])
mutant(448 stages/light_unit.sv "light: a stamp's last sample lights all of them"
  [=[first_q[11] || is_own]=] [=[first_q[11] || sample_q[11*SAMPLES-1]]=])
mutant(449 lib/root_table.sv "light: the root has the line of the other octave"
  [=[!zeros[0]]=] [=[zeros[0]]=])

# Four lanes of a texture unit.
mutant(340 lib/texture_agree.sv "lanes: two texels of one bank go together"
  [=[a[1:0] != b[1:0]]=] [=[1'b1]=])
mutant(341 lib/texture_agree.sv "lanes: two lines of one bank go together"
  [=[a[2] != b[2]]=] [=[1'b1]=])
mutant(342 stages/texture_lanes.sv "lanes: a pass begins again with samples that have been"
  [=[done_q | joins]=] [=[joins]=])
mutant(343 stages/texture_lanes.sv "lanes: counter: a sample finds its lines only where all beside it do"
  [=[(t_uses[4*l+:4] & lacks) == '0]=] [=[lacks == '0]=])
mutant(344 stages/texture_unit.sv "lanes: a pass colours what it brings only where that is the first sample, too"
  [=[e_lanes_q[i%LANES]]=] [=[e_lanes_q[0]]=])
mutant(463 lib/texture_sides.sv "texture: levels of oblong textures begin where those of square ones do"
  [=[(21'h155555 << new_odds)]=] [=[21'h155555]=])
mutant(464 stages/texture_rounds.sv "lanes: the second round is on the first one's levels"
  [=[level_i[4*l+:4] + 4'(is_second_q)]=] [=[level_i[4*l+:4]]=])
mutant(465 stages/texture_rounds.sv "lanes: samples of two levels go together"
  [=[wrapped_level_q[4*l+:4] == wrapped_level_q[4*m+:4]]=] [=[1'b1]=])
mutant(466 stages/texture_lanes.sv "lanes: of upper levels there is as much as of the first sample's"
  [=[sum_level_part[8*l+:8]]=] [=[sum_level_part[7:0]]=])
mutant(467 stages/texture_lanes.sv "lanes: a sum that waits for its upper level is replaced by another sample's"
  [=[sum_joins[l]]=] [=[1'b1]=])

# Two ways of the texture cache.
mutant(345 stages/texture_tags.sv "texture, two ways: the line that was looked up last goes"
  [=[same_place_q ? !recent_way_q : !newer]=] [=[same_place_q ? !recent_way_q : newer]=])
mutant(346 stages/texture_tags.sv "texture, two ways: the line in front is in both"
  [=[same_place_q && recent_way == 1'(w)]=] [=[same_place_q]=])
mutant(347 stages/texture_tags.sv "texture, two ways: a line takes both places"
  [=[sweeps_q || way[b] == 1'(w)]=] [=[1'b1]=])
mutant(348 stages/texture_tags.sv "texture, two ways: a line that is still to be read in the second is overwritten"
  [=[groups[way[b]*NUMBER+:NUMBER]]=] [=[groups[0+:NUMBER]]=])
mutant(349 stages/texture_cache_linear.sv "texture, two ways: all texels are read in the way of the first bank"
  [=[found_ways[{at_y[Y*WAY_Y+1], at_x[X*WAY_X+1]}]]=] [=[found_ways[0]]=])

# Colours over w in the texture unit.
mutant(280 stages/colors_over_w.sv "texture, colours over w: the quotient is cut off"
  [=[WHOLE'(placed[POINT-1])]=] [=[WHOLE'(1'b0)]=])
mutant(283 stages/colors_over_w.sv "texture, colours over w: all channels have the reach of red"
  [=[reach[n*REACH_BITS+:REACH_BITS]]=] [=[reach[0+:REACH_BITS]]=])
mutant(284 stages/colors_over_w.sv "texture, colours over w: all channels have the binary point of red"
  [=[shift[n*SHIFT_BITS+:SHIFT_BITS]]=] [=[shift[0+:SHIFT_BITS]]=])
mutant(285 stages/colors_over_w.sv "texture, colours over w: the range is that of the next sample's triangle"
  [=[range_ram_q[index_q[6*INDEX+:INDEX]]]=] [=[range_ram_q[index_q[5*INDEX+:INDEX]]]=])
mutant(287 stages/texture_unit.sv "texture, colours over w: a texel is combined with the affine colour"
  [=[stamp_divides ? divided : own_color_q]=] [=[own_color_q]=])
mutant(288 stages/texture_unit.sv "texture, colours over w: a quotient overwrites the stamp before"
  [=[divided_valid && is_free]=] [=[divided_valid]=])
mutant(289 stages/texture_unit.sv "texture, colours over w: behind a texel the quotient stays"
  [=[(e_moves && stamp_divides && e_ends_q)]=] [=[(e_moves && stamp_divides && e_ends_q && !e_last_q)]=])
mutant(290 stages/interpolate.sv "texture, colours over w: the range ends where it begins"
  [=[samples_context_q.range.high[AT+:8*raster_pkg::COLOR_PLANES]]=] [=[samples_context_q.range.low[AT+:8*raster_pkg::COLOR_PLANES]]=])
mutant(291 stages/texture_stage.sv "texture, colours over w: they are affine"
  [=[fragment_i.coordinates.divides_colors]=] [=[1'b0]=])

# Ordered dithering, as 194 and 195.
mutant(350 lib/dithered_rop.sv "colours: dithering: the half of a threshold is left out"
  [=[{1'b0, threshold_i, 4'd8}]=] [=[{1'b0, threshold_i, 4'd0}]=])
mutant(351 lib/dithered_rop.sv "colours: dithering: what rounding has below its offset is added, too"
  [=[dithers_i ? 3'd0 : 3'd6]=] [=[3'd6]=])
mutant(352 lib/dithered_rop.sv "colours: dithering: a green above its offset has the sign of one below"
  [=[{{5{g_rest[8]}}, g_rest, 1'b0, !dithers_i}]=] [=[{5'd0, g_rest, 1'b0, !dithers_i}]=])
mutant(353 lib/dithered_rop.sv "colours: dithering: blue has the rest of green"
  [=[{{4{b_rest[8]}}, b_rest, below}]=] [=[{{4{g_rest[8]}}, g_rest, below}]=])
mutant(354 lib/dithered_rop.sv "colours: dithering: red has the next lower threshold"
  [=[{1'b0, rgba_i[7:0]}]=] [=[{1'b0, rgba_i[7:0]} + 9'd16]=])
mutant(355 stages/color_write.sv "colours: dithering: always"
  [=[(out[4])]=] [=[1'b1]=])
mutant(356 stages/color_write.sv "colours: dithering: a stamp has the place of the one behind it"
  [=[(stamp_2_q)]=] [=[stamp_1_q]=])
mutant_text(357 stages/color_write.sv "colours: dithering: what is blended is dithered as it came"
  [=[.rgba_i     (rgba),]=] [=[.rgba_i     (raster_cosim.mutant_q == 16'd357 ? color_2_q[s*SHADED+:SHADED] : rgba),]=])
mutant_text(358 lib/sample_place.sv "colours: dithering: the columns of a stamp have one threshold"
  [=[* 2'(SIZE) + 2'(PIXEL % SIZE);]=]
  [=[* 2'(SIZE) + (raster_cosim.mutant_q == 16'd358 ? 2'd0 : 2'(PIXEL % SIZE));]=])
mutant(359 lib/sample_place.sv "colours: dithering: every stamp begins at the matrix' first row"
  [=[2'(stamp_i[2*SIDE_BITS-1:SIDE_BITS])]=] [=[2'd0]=])

# Masks of channels, as 188 and 193.
mutant(370 stages/color_write.sv "colours: masks: samples that are not drawn are written, too"
  [=[(packed_color & channels & {COLOR{mask_2_q[s]}})]=] [=[packed_color & channels]=])
mutant(371 stages/color_write.sv "colours: masks: a channel that is left out is added to what is stored"
  [=[(packed_color & channels & {COLOR{mask_2_q[s]}})]=] [=[packed_color & {COLOR{mask_2_q[s]}}]=])
mutant(372 stages/color_write.sv "colours: masks: a channel that is left out becomes 0"
  [=[(stored_2_q[s*COLOR+:COLOR] & ~(channels & {COLOR{mask_2_q[s]}}))]=]
  [=[stored_2_q[s*COLOR+:COLOR] & {COLOR{!mask_2_q[s]}}]=])
mutant(373 stages/color_write.sv "colours: masks: samples that are not drawn lose the channels that are"
  [=[(stored_2_q[s*COLOR+:COLOR] & ~(channels & {COLOR{mask_2_q[s]}}))]=] [=[stored_2_q[s*COLOR+:COLOR] & ~channels]=])
mutant(375 stages/color_write.sv "colours: masks: a token writes all channels"
  [=[tested_i.state[BLENDS:0]]=] [=[tested_i.state[BLENDS:0] | (BLENDS + 1)'(15 << WRITES)]=])
mutant_text(376 stages/color_write.sv "colours: masks: the constant of blending sets them, too"
  [=[if (tested_i.state_register == raster_pkg::STATE_REGISTER_COLOR_OPS) ops_q]=]
  [=[if (tested_i.state_register == raster_pkg::STATE_REGISTER_COLOR_OPS ||
              (raster_cosim.mutant_q == 16'd376 && tested_i.state_register == raster_pkg::STATE_REGISTER_BLEND_CONSTANT)) ops_q]=])
mutant(377 stages/color_write.sv "colours: masks: what memory has of a stamp comes into the RAM only where it is drawn"
  [=[tested_i.starts_color || is_fetched]=] [=[tested_i.starts_color]=])
mutant(378 stages/cache_tags.sv "colours: masks: what is stored is not read for the channels that stay"
  [=[fragment_q.code[READS]]=] [=[1'b0]=])
mutant(379 stages/cache_tags.sv "colours: masks: what has been read for the channels that stay is not known to be here"
  [=[(color_source != raster_pkg::DEPTH_SOURCE_NONE ? stamp_bit : '0)]=] [=['0]=])
mutant_text(403 stages/color_write.sv "colours: masks: they hold for what is blended only"
  [=[out_2_q      <= ops_q[DITHERS:WRITES];]=]
  [=[out_2_q      <= ops_q[DITHERS:WRITES] | {1'b0, {4{raster_cosim.mutant_q == 16'd403 && !ops_q[BLENDS]}}};]=])

# several samples a pixel
mutant(420 lib/sample_offsets.sv "samples: pattern: the way right is the way down, too"
  [=[times(step_y_i, SIZE_Y)]=] [=[times(step_y_i, SIZE_X)]=])
mutant(421 stages/fine_raster.sv "samples: pattern: the bits below an edge's value are taken for 0"
  [=[WIDE'(edges_i.low[e*S+:S])]=] [=[WIDE'(0)]=])
mutant(451 raster_top.sv "samples, textures: a pixel lives by its first sample"
  [=[passed_samples[s*N+:N] != '0]=] [=[passed_samples[s*N]]=])
mutant(452 stages/stamp_rop.sv "samples, textures: a pixel's colour goes to its first sample"
  [=[{N{packed_color & {COLOR{mask_i[s] || !CLEANS}}}}]=] [=[{N{packed_color & {COLOR{mask_i[s] || !CLEANS}}}} & ~({(N * COLOR) {1'b1}} << COLOR)]=])
mutant(453 stages/late_test.sv "samples, textures: alpha behind the texture covers all samples or none"
  [=[raster_pkg::MSAA_SAMPLES > 1 && stamp_i.state[11]]=] [=[1'b0]=])
mutant(454 stages/depth_cache.sv "samples, textures: what alpha does not cover is not late"
  [=[(raster_pkg::MSAA_SAMPLES > 1 && item.code[11])]=] [=[1'b0]=])
mutant_text(450 lib/registered_fifo.sv "samples: dropped stall: an item's depths give way before it is taken"
  [=[.ready_i(is_free),
          .data_o (data_o[STORED-1:0])]=]
  [=[.ready_i(is_free || raster_cosim.mutant_q == 16'd450),
          .data_o (data_o[STORED-1:0])]=])
mutant(422 stages/cull.sv "samples: the bits below the value of a turned edge stay as they were"
  [=[~low_q[(2-l)*S+:S]]=] [=[low_q[(2-l)*S+:S]]=])
mutant(423 stages/cull.sv "samples: the box ends with the last pixel whose centre is inside"
  [=[(B'(x_max_q) - TO_LAST) >>> S]=] [=[(B'(x_max_q) - HALF) >>> S]=])
mutant(424 stages/coarse_raster.sv "samples: a tile is accepted by the centres of its pixels"
  [=[(TE'(worst) <<< TS) - TE'(worst) - TE'(reach)]=] [=[(TE'(worst) <<< TS) - TE'(worst)]=])
mutant(425 stages/coarse_raster.sv "samples: a tile is rejected by the centres of its pixels"
  [=[(TE'(best) <<< TS) - TE'(best) + TE'(reach)]=] [=[(TE'(best) <<< TS) - TE'(best)]=])
mutant(426 stages/coarse_raster.sv "samples: counter: pixels are counted for samples"
  [=[(2 * TS + 1 + SAMPLE_SHIFT)'(area) << SAMPLE_SHIFT]=] [=[(2 * TS + 1 + SAMPLE_SHIFT)'(area)]=])
mutant_text(427 stages/interpolate.sv "samples: a pixel is shaded at its first covered sample, its centre covered or not"
  [=[y_stamp_q.centre[i] ?]=] [=[y_stamp_q.centre[i] && raster_cosim.mutant_q != 16'd427 ?]=])
mutant(428 stages/interpolate.sv "samples: pattern: the way of a plane to a sample is cut instead of rounded"
  [=[WIDE'(1 << (S - 1))]=] [=[WIDE'(0)]=])
mutant(429 stages/interpolate.sv "samples: mask: it is not looked at"
  [=[~{PIXELS{samples_context_q.state.masked_samples}}]=] [=[{raster_pkg::SAMPLES{1'b1}}]=])
mutant(430 stages/primitive_join.sv "samples: mask: lines do not look at it"
  [=[!fragment_i.state.masked_samples[s%N]]=] [=[1'b1]=])
mutant(431 lib/alpha_test.sv "samples: alpha: it covers a sample too many"
  [=[(SHIFT + 1)'(k) < count]=] [=[(SHIFT + 1)'(k) < count + 1'b1]=])
mutant(432 stages/depth_test.sv "samples: HiZ: a tile's bound is that of its first samples"
  [=[depths[(i+1)*CODE-1-:HIZ] > farthest]=] [=[1'b0]=])
mutant(433 stages/cache_tags.sv "samples: alpha: what it may leave out is not asked for"
  [=[(raster_pkg::MSAA_SAMPLES > 1 && fragment_q.code[11])]=] [=[1'b0]=])
mutant(435 raster_top.sv "samples: colours: a pixel has its neighbour's"
  [=[color[s/raster_pkg::MSAA_SAMPLES*WRITTEN+:WRITTEN]]=] [=[color[(s/raster_pkg::MSAA_SAMPLES+raster_pkg::MSAA_SAMPLES-1)%PIXELS*WRITTEN+:WRITTEN]]=])
mutant(436 lib/resolve.sv "resolve: means are cut off instead of rounded"
  [=[(BITS + SHIFT)'(N / 2)]=] [=[(BITS + SHIFT)'(0)]=])
mutant(437 lib/resolve.sv "resolve: the last sample counts as the first"
  [=[(BITS + SHIFT)'(color_i[(p*N+k)*COLOR+AT+:BITS])]=] [=[(BITS + SHIFT)'(color_i[(p*N+k%(N-1))*COLOR+AT+:BITS])]=])
mutant(438 stages/cache_tags.sv "resolve: a clear block is written with a colour for each sample"
  [=[SAMPLES'({CLEARED_COLORS{1'b1}})]=] [=['1]=])
mutant(439 lib/victim_bytes.sv "resolve: a pixel is stored where its first sample is not"
  [=[color_strobe_i[s*N]]=] [=[!color_strobe_i[s*N]]=])
mutant(455 stages/pixel_colors.sv "samples, compression: colours that differ are written with one a pixel"
  [=[is_even && (fills || is_whole_q || is_stored)]=] [=[(fills || is_whole_q || is_stored)]=])
mutant(456 stages/pixel_colors.sv "samples, compression: a block's bit stays as it was"
  [=[updates || token_writes_i]=] [=[token_writes_i]=])
mutant(457 stages/pixel_colors.sv "samples, compression: a merge reads one stamp again and again"
  [=[STAMP'(asked_q)]=] [=[STAMP'(asked_q == '0)]=])
mutant(458 stages/pixel_colors.sv "samples, compression: a merge does not wait for the reads before it"
  [=[merges_o && others_q == '0]=] [=[merges_o]=])
mutant(459 stages/pixel_colors.sv "samples, compression: a block that lacks samples counts as whole"
  [=[come_strobe_i == '1]=] [=[1'b1]=])
mutant(460 lib/victim_bytes.sv "samples, compression: what was read lies over what is sent"
  [=[merges_i && !here[s]]=] [=[merges_i]=])
mutant(461 stages/cache_tags.sv "samples, compression: a cleared block keeps its bit"
  [=[pixel_word_i & ~marks & {WORD{clears_bin}}]=] [=[pixel_word_i]=])
mutant(462 stages/memory_port.sv "samples, compression: pixels lie as far apart as all their samples"
  [=[PLANE'(place & IN_BLOCK) << PIXEL_SHIFT]=] [=[PLANE'(place & IN_BLOCK) << COLOR_SHIFT]=])

# triangle_setup with two cycles a plane
mutant(470 stages/triangle_setup.sv "two clocks: the way to the anchor is that along x in both"
  [=[is_y ? anchor_q[C+1+:C+1] : anchor_q[0+:C+1]]=] [=[anchor_q[0+:C+1]]=])
mutant(471 stages/triangle_setup.sv "two clocks: no plane over w starts at the third vertex"
  [=[(differs_over_w && starts_at_2)]=] [=[1'b0]=])
mutant(472 stages/triangle_setup.sv "two clocks: the upper clamp overlooks a third vertex above a second that is below the first"
  [=[is_1_below_0_q ? !difference[DC-1] : !is_2_below_1]=] [=[!is_1_below_0_q && !is_2_below_1]=])
mutant(473 stages/triangle_setup.sv "two clocks, dropped stall: a plane begins whether its triangle goes on or not"
  [=[begins | moves[START+i]]=] [=[begins | at_q[START+i]]=])
mutant(474 lib/long_product.sv "products: the last digit of the left number has no sign"
  [=[i == LEFT_DIGITS - 1 && left[i*DIGIT+DIGIT]]=] [=[1'b0]=])

# The texture unit's constant
mutant(480 lib/texture_combine.sv "colours, the texture's constant: its green counts for all channels"
  [=[constant_i[8*n+:8]]=] [=[constant_i[15:8]]=])
mutant(481 lib/texture_combine.sv "colours, the texture's constant: colours are added to it"
  [=[{8{is_decal || is_blended}}]=] [=[{8{is_decal}}]=])
mutant(482 stages/texture_unit.sv "colours, the texture's constant: it is set as the token enters, by a stamp that leaves"
  [=[passes && stamp_flags[FLAGS-1]]=] [=[stamp_valid_i && sets_constant_i]=])
mutant(483 stages/texture_stage.sv "colours, the texture's constant: its token sets levels as well"
  [=[is_levels && !is_constant]=] [=[is_levels]=])
mutant(484 stages/texture_stage.sv "colours, the texture's constant: no token sets it"
  [=[is_levels && word[raster_pkg::CONSTANT_WORD_BIT]]=] [=[1'b0]=])

# The texture unit's border
mutant(485 lib/texture_border.sv "texture, border: a coordinate beyond the image is not held"
  [=[is_held ? 8'h80 : part_i]=] [=[part_i]=])
mutant(486 lib/texture_border.sv "texture, border: where coordinates are held there is none beyond the last texel"
  [=[(holds && next_is_above)]=] [=[1'b0]=])
mutant(487 lib/texture_filter.sv "texture, border: rows have none"
  [=[part_i[18+n/2]]=] [=[1'b0]=])
mutant(488 stages/texture_unit.sv "texture, border: its token does not wait for samples"
  [=[inside_q == '0]=] [=[1'b1]=])
mutant(489 stages/texture_stage.sv "texture, border: its token sets levels as well"
  [=[!is_border]=] [=[1'b1]=])
mutant(490 stages/texture_stage.sv "texture, border: no token sets it"
  [=[is_levels && word[raster_pkg::BORDER_WORD_BIT]]=] [=[1'b0]=])

# Logic operations
mutant(491 stages/color_write.sv "colours, logic operations: a new one on a stored zero counts as a zero on a one"
  [=[(rounded & ~old & {COLOR{truth[1]}})]=] [=[(rounded & ~old & {COLOR{truth[2]}})]=])
mutant_text(492 stages/color_write.sv "colours, logic operations: they take what the stamp in front has made"
  [=[assign old          = stored_2_q[s*COLOR+:COLOR];]=]
  [=[assign old          = raster_cosim.mutant_q == 16'd492 ? code_3_q[s*COLOR+:COLOR] : stored_2_q[s*COLOR+:COLOR];]=])
mutant(493 stages/color_write.sv "colours, logic operations: a factor of blending counts as one"
  [=[ops_q[EQUATION+:3] == IS_LOGIC]=] [=[ops_q[EQUATION+2]]=])
mutant(494 stages/color_write.sv "colours, logic operations: zeros on zeros stay"
  [=[(~rounded & ~old & {COLOR{truth[3]}})]=] [=['0]=])
