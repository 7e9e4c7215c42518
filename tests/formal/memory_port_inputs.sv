
  // Power comes once. The other reset may come at any time, any number of times.
  logic runs_q = 1'b0;
  always_ff @(posedge clk_i) runs_q <= 1'b1;
  always_comb assume (power_on_ni == runs_q);

  // From the framebuffer: runs in one buffer, the writes of a run consecutive, each with the length of the rest
  // (block_cache_stream, framebuffer_stream); a stamp of the tile. After a reset the framebuffer starts anew, without a
  // run. From memory: an answer belongs to a request, in order, and stays until it is taken: one per beat for a burst
  // that reads, one for a burst that was written to its end.
  localparam int STAMPS_I = raster_pkg::STAMPS_PER_ROW * raster_pkg::STAMPS_PER_ROW;
  localparam int N = READS + 9;
  logic [RUN-1:0] run_left_q;                      // stamps of a burst that are still to come
  raster_pkg::tile_plane_t run_plane_q;
  logic [N-1:0] reads_out_q, writes_out_q, stale_q;  // beats and bursts that memory owes; the stale ones of both
  logic [N-1:0] most_reads;
  logic [15:0] run_place_q;
  assign most_reads = N'(MOST);
  always_ff @(posedge clk_i) begin
    if (!power_on_ni || !rst_ni) run_left_q <= '0;
    else if (takes && request_i.is_write) run_left_q <= request_i.run - 1'b1;
    if (takes) begin
      run_plane_q <= request_i.plane;
      run_place_q <= (request_i.plane[1] ? 16'(request_i.tile_x) : place) + 1'b1;
    end
    if (!power_on_ni) {reads_out_q, writes_out_q, stale_q} <= '0;
    else begin
      reads_out_q  <= reads_out_q + (sends && !beat_o.is_write ? N'(beat_o.length) : '0) - N'(answers && is_read);
      writes_out_q <= writes_out_q + N'(sends && beat_o.is_write && beat_o.length == LENGTH'(1)) - N'(answers && answer_i.is_write);
      if (!rst_ni) stale_q <= N'(reads_q) + N'(writes_q) - N'(answers);
      else if (answers && stale_q != '0) stale_q <= stale_q - 1'b1;
    end
  end
  // From the host: the layout stays while anything is under way.
  logic                       is_used_q;
  raster_pkg::memory_layout_t layout_q;
  always_ff @(posedge clk_i) begin
    is_used_q <= takes || valid_q || gathers_q;
    layout_q  <= layout_i;
  end
  always_comb if (runs_q && is_used_q) assume (layout_i == layout_q);
  // A request comes with its data as they lie in memory.
  logic [8*raster_pkg::REQUEST_BYTES-1:0] data_bytes;
  request_bytes u_data_bytes (
      .request_i(request_i),
      .bytes_o  (data_bytes)
  );
  always_comb assume (bytes_i == data_bytes);
  always_comb if (runs_q) begin
    if (!rst_ni) assume (!request_valid_i);
    if (request_valid_i) begin
      assume (request_i.run != '0 && request_i.run <= RUN'(STAMPS_I));
      if (!request_i.is_write)
        assume (request_i.plane == raster_pkg::TILE_PLANE_DEPTH && request_i.strobe == '0 && request_i.data == '0);
      assume (!request_i.plane[2]);  // without COMPRESS_UNIT
      if (request_i.plane[1]) assume (request_i.strobe == '1);
      if (run_left_q != '0)
        assume (request_i.is_write && request_i.run == run_left_q && request_i.plane == run_plane_q &&
                (request_i.plane[1] ? 16'(request_i.tile_x) : place) == run_place_q);
      if (!request_i.is_write) assume (N'(reads_q) + N'(length) <= most_reads);
      if (HAS_BLOCKS != 0 && !request_i.is_write) assume (request_i.run == RUN'(1));
    end
    if (answer_valid_i) assume (answer_i.is_write ? writes_out_q != '0 : reads_out_q != '0);
  end
