
  // Assumptions on inputs. A fragment on offer stays unchanged until it is taken (primitive_join_stream and the proofs
  // upstream); a token has no samples. From depth_test: the write of an item with samples comes in the next cycle,
  // within its samples, for `always` of all of them, and in the buffers of its state, or in depth where the stencil
  // above it changes; with the new stored word of each sample (depth_test_stream). From memory: an answer belongs to a
  // read that was taken in an earlier cycle, in order.
  logic is_token, is_clear, takes_fragment, takes_token;
  assign is_clear       = fragment_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR;
  assign is_token       = is_clear || fragment_i.kind == raster_pkg::PRIMITIVE_KIND_FLUSH;
  assign takes_fragment = fragment_valid_i && fragment_ready_o;
  assign takes_token    = takes_fragment && is_token;
  logic                             waits_q, tested_valid_q;
  var raster_pkg::fragment_packet_t before_q, tested_q;
  logic [$clog2(QUEUE):0]           unanswered_q;
  logic                             takes_read, takes_response;
  assign takes_read     = takes_request && !request_o.is_write;
  logic [SAMPLES*LANE-1:0] request_data;  // data of a request, one lane per sample
  request_lanes u_request_lanes (
      .plane_i(request_o.plane),
      .bytes_i(request_bytes_o),
      .data_o (request_data)
  );
  assign takes_response = response_valid_i && response_ready_o;
  always_ff @(posedge clk_i) begin
    waits_q        <= rst_ni && fragment_valid_i && !fragment_ready_o;
    before_q       <= fragment_i;
    tested_valid_q <= rst_ni && tested_valid_o;
    tested_q       <= tested_o;
    unanswered_q   <= rst_ni ? unanswered_q + ($clog2(QUEUE) + 1)'(takes_read) - ($clog2(QUEUE) + 1)'(takes_response) : '0;
  end
  // Whether the word of a sample may change; with a stencil above its depth also for samples that fail.
  logic tested_writes, tested_marks;
  generate
    if (raster_pkg::STENCIL_BITS != 0) begin : gen_marks
      assign tested_writes = tested_q.state.depth_write || tested_q.state.writes_stencil;
      assign tested_marks  = tested_q.state.writes_stencil;
    end else begin : gen_no_marks
      assign tested_writes = tested_q.state.depth_write;
      assign tested_marks  = 1'b0;
    end
  endgenerate
  always_comb if (runs_q) begin
    if (waits_q) assume (fragment_valid_i && fragment_i == before_q);
    if (is_token) assume (fragment_i.mask == '0);
    if (is_clear) assume (fragment_i.state.depth_test != raster_pkg::DEPTH_FUNC_EQUAL);  // of bins: cache_tags_data
    assume (write_valid_i == (tested_valid_q && tested_q.mask != '0));
    assume ((write_i.passed & ~tested_q.mask) == '0);
    if (tested_q.state.depth_test == raster_pkg::DEPTH_FUNC_ALWAYS) assume (write_i.passed == tested_q.mask);
    assume ((write_i.write_depth & ~(tested_writes ? tested_q.mask : '0)) == '0);
    assume ((write_i.write_depth & (tested_q.state.depth_write ? write_i.passed : '0)) == (tested_q.state.depth_write ? write_i.passed : '0));
    if (!tested_marks) assume ((write_i.write_depth & ~write_i.passed) == '0);
    for (int i = 0; i < SAMPLES; i++)
      if (write_i.write_depth[i] || depth_is_held[i])
        assume (word_i[i*CODE+:CODE] == (write_i.write_depth[i] ? write_i.depth[i*CODE+:CODE] : stored_depth_o[i*CODE+:CODE]));
    assume (write_i.write_color == (tested_q.state.color_write ? write_i.passed : '0));
    if (response_valid_i) assume (unanswered_q != '0);
  end
