
  // An arbitrary byte of an arbitrary sample of a stamp that is written: it goes to memory once, at its address, with
  // the strobe and the value of the request, before the next request is taken or with it; no byte of its beat is
  // written that belongs to no stamp.
  (* anyconst *) logic [$clog2(SAMPLES+1)-1:0] any_sample;
  (* anyconst *) logic [1:0]                   any_byte;
  (* anyseq *) logic                           is_chosen;
  logic                  waits_q, strobed_q, was_chosen_q, at_color_q;
  logic [ADDRESS-1:PORT] sent;  // address of the beat on offer
  assign sent = beat_o.address[ADDRESS-1:PORT];
  logic [ADDRESS-1:0]    at_q, at;
  logic [7:0]            value_q, value;
  logic [ADDRESS-1:0]    first;  // address of the stamp's first byte
  always_comb begin
    assume (any_sample < SAMPLES);
    if (request_valid_i) assume (32'(any_byte) < (request_i.plane[0] ? raster_pkg::COLOR_SAMPLE_BYTES : raster_pkg::DEPTH_SAMPLE_BYTES));
  end
  // A run is within one tile: a stamp that joins a gathering beat belongs to that beat.
  always_comb if (runs_q && request_valid_i && gathers_q)
    assume (address[ADDRESS-1:PORT] == address_q && (is_flags ? '0 : request_i.tile_y) == rows_q);
  // The address by its definition (byte_address() of model/stages/memory_port.hpp), with bases at any multiple of a
  // buffer.
  assign first = ((is_color ? layout_i.color_base : layout_i.depth_base) >> PLANE << PLANE) +
                 ADDRESS'({(ADDRESS - TILE)'(request_i.tile_y) * (ADDRESS - TILE)'(layout_i.row_stride[STRIDE-1:TILE]),
                           {TILE{1'b0}}}) +
                 (ADDRESS'(request_i.tile_x) << TILE) + (ADDRESS'(place) << (is_color ? COLOR_SHIFT : DEPTH_SHIFT));
  assign at    = first + (is_color ? ADDRESS'(any_sample) * raster_pkg::COLOR_SAMPLE_BYTES
                                   : ADDRESS'(any_sample) * raster_pkg::DEPTH_SAMPLE_BYTES) + ADDRESS'(any_byte);
  assign value = 8'(LANE'(request_i.data >> (any_sample * LANE)) >> (8 * any_byte));
  logic hits;
  assign hits = sends && is_write_q && sent == at_q[ADDRESS-1:PORT] && waits_q;
  always_ff @(posedge clk_i) begin
    if (!power_on_ni) {waits_q, was_chosen_q} <= '0;
    else if (takes && request_i.is_write && !request_i.plane[1] && is_chosen && !was_chosen_q) {waits_q, was_chosen_q} <= '1;
    else if (hits) waits_q <= 1'b0;
    if (takes && !was_chosen_q) begin
      at_q       <= at;
      at_color_q <= is_color;
      value_q   <= value;
      strobed_q <= request_i.strobe[any_sample];
    end
  end
  logic [ADDRESS-1:PORT] behind;  // beats from the beat on offer to the byte's beat
  logic [WORD-1:0]       strobe_there;
  logic [8*WORD-1:0]     data_there;
  assign behind       = at_q[ADDRESS-1:PORT] - sent;
  assign strobe_there = strobe_q >> ((32'(behind[PORT+7:PORT]) << PORT) + 32'(at_q[PORT-1:0]));
  assign data_there   = data_q >> (8 * ((32'(behind[PORT+7:PORT]) << PORT) + 32'(at_q[PORT-1:0])));
  // A gathering beat holds nothing above the bytes that have come.
  logic [31:0] come;  // bytes
  assign come = 32'(place_in_beat_run) << (run_plane_q[1] ? FLAG_SHIFT : (run_plane_q[0] ? COLOR_SHIFT : DEPTH_SHIFT));
  always_comb if (runs_q && gathers_q && !discards) assert (strobe_q >> come == '0 && data_q >> (8 * come) == '0);
  always_comb if (runs_q && waits_q) begin
    assert (valid_q || gathers_q);
    assert (is_write_q && behind <= (ADDRESS - PORT)'(more_q));
    assert (strobe_there[0] == strobed_q);
    if (strobed_q) assert (data_there[7:0] == value_q);
    if (hits) assert (beat_o.strobe[at_q[PORT-1:0]] == strobed_q);
    if (hits && strobed_q) assert (beat_o.data[8*at_q[PORT-1:0]+:8] == value_q);
    if (takes && !gathers_q) assert (hits);
    if (gathers_q && !discards)  // bytes still to come lie above it in the beat
      assert ((16'(at_q[PORT-1:0]) >> (at_color_q ? COLOR_SHIFT : DEPTH_SHIFT)) < place_in_beat_run &&
              run_plane_q == (at_color_q ? raster_pkg::TILE_PLANE_COLOR : raster_pkg::TILE_PLANE_DEPTH));
    cover (hits && strobed_q);
  end

  // An arbitrary sample of a stamp that is read: the bytes of the beats answered by memory, at the stamp's place.
  localparam int DEPTH_BYTES = 1 << DEPTH_SHIFT;
  logic [7:0] kept_byte_q, answered_byte, response_byte;
  logic [31:0] byte_at;
  logic is_of_depth;
  assign is_of_depth   = 32'(any_byte) < raster_pkg::DEPTH_SAMPLE_BYTES;
  assign byte_at       = 32'(any_sample) * raster_pkg::DEPTH_SAMPLE_BYTES + 32'(any_byte);  // in its stamp, of depth
  assign answered_byte = 8'(answer_i.data >> (8 * (byte_at & 32'(BYTES - 1))));
  assign response_byte = 8'(LANE'(response_o.data >> (any_sample * LANE)) >> (8 * any_byte));
  always_ff @(posedge clk_i)
    if (answers && is_read && 32'(part_q) == byte_at >> PORT) kept_byte_q <= answered_byte;
  generate
    if (DEPTH_SHARED == 0) begin : gen_read
      always_comb if (runs_q && !discards) begin
        assert (part_q <= PARTS'(DEPTH_BEATS - 1));
        if (response_valid_o && is_of_depth)
          assert (response_byte == (byte_at >> PORT == DEPTH_BEATS - 1 ? answered_byte : kept_byte_q));
      end
      if (READ_WORD > BYTES) begin : gen_kept_bytes  // for induction: the place of the byte in the kept beats
        always_comb if (runs_q && !discards && is_of_depth && 32'(part_q) > byte_at >> PORT)
          assert (8'(gen_kept.kept_q >> (8 * (32'(READ_WORD) - 32'(BYTES) - (32'(part_q) << PORT) + byte_at))) == kept_byte_q);
      end
    end else begin : gen_shared_read
      always_comb if (runs_q && !discards && response_valid_o && is_of_depth)
        assert (response_byte == 8'(answer_i.data >> (8 * ((32'(sub) << DEPTH_SHIFT) + byte_at))));
    end
  endgenerate
