
  // Each step of each plane, from the content of the step before: to the stamp's first column, to its first row, to
  // each sample; x and y from pixel (T/2, T/2), modulo 2^W, as sums of their bits. A stamp's context and values move
  // from step to step together (interpolate_stream), so that the three add up to anchor + x step_x + y step_y. Then the
  // codes: the bits above the fraction, less the half range by which anchors are offset. For any content of the
  // registers.
  localparam int MIDDLE = raster_pkg::TILE_SIZE / 2;
  genvar k, n;
  generate
    for (k = 0; k < PLANES; k++) begin : gen_proof
      localparam int N = LOCAL_BITS_OF[32*k+:32];
      localparam int AT = LOCAL_AT[32*k+:32];
      localparam int B = FRAGMENT_BITS_OF[32*k+:32];
      localparam int CODE = FRAGMENT_AT[32*k+:32];
      function automatic [N-1:0] sum(input [N-1:0] value, input [PIXEL-1:0] offset, input [N-1:0] step);
        sum = value;
        for (int b = PIXEL - 1; b >= 0; b--)
          sum = b == PIXEL - 1 ? sum - (offset[b] ? step << b : '0) : sum + (offset[b] ? step << b : '0);
      endfunction
      logic [N-1:0] anchor, step_x_0, step_y_1, step_x_2, step_y_2;
      logic [PIXEL-1:0] from_middle_x, from_middle_y;
      assign anchor        = context_stamp_q.anchor[AT+:N];
      assign step_x_0      = context_i.step_x[AT+:N];
      assign step_y_1      = x_context_q.step_y[AT+:N];
      assign step_x_2      = y_context_q.step_x[AT+:N];
      assign step_y_2      = y_context_q.step_y[AT+:N];
      assign from_middle_x = (PIXEL'(context_stamp_q.stamp) << STAMP_SHIFT) ^ PIXEL'(MIDDLE);
      assign from_middle_y = (PIXEL'(x_stamp_q.stamp >> PER_ROW_BITS) << STAMP_SHIFT) ^ PIXEL'(MIDDLE);
      always_comb begin
        assert ($unsigned(gen_plane[k].x_value) == sum(anchor, from_middle_x, step_x_0));
        assert ($unsigned(gen_plane[k].y_value) == sum(gen_plane[k].x_value_q, from_middle_y, step_y_1));
      end
      for (n = 0; n < PIXELS; n++) begin : gen_proof_pixel
        logic [N-1:0] at_sample;
        logic [B-1:0] floored;
        assign at_sample = gen_plane[k].y_value_q + (((n / STAMP) & 2) ? step_y_2 << 1 : '0) +
                           (((n / STAMP) & 1) ? step_y_2 : '0) + (((n % STAMP) & 2) ? step_x_2 << 1 : '0) +
                           (((n % STAMP) & 1) ? step_x_2 : '0);
        assign floored = B'(gen_plane[k].gen_pixel[n].value_q >> L) - (B'(1) << (B - 1));
        always_comb begin
          assert ($unsigned(gen_plane[k].gen_pixel[n].value) == at_sample);
          assert (code[n*CODES+CODE+:B] == floored);
        end
      end
    end
  endgenerate
