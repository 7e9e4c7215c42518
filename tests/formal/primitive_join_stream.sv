
  // Combinational, so one cycle is complete: the output, and the input taken from each side.
  logic takes_fragment, takes_pixel, sends;
  assign takes_fragment = fragment_valid_i && fragment_ready_o;
  assign takes_pixel    = pixel_valid_i && pixel_ready_o;
  assign sends          = fragment_valid_o && fragment_ready_i;
  always_comb begin
    if (fragment_i.kind != raster_pkg::PRIMITIVE_KIND_LINE) begin
      assert (sends == takes_fragment && !takes_pixel);
      if (fragment_valid_o) assert (fragment_o == fragment_i);
    end else begin
      assert (sends == takes_pixel);                             // each pixel goes out once,
      assert (takes_fragment == (takes_pixel && pixel_i.is_last));  // the line's place with the last
      if (fragment_valid_o) begin
        assert (fragment_o.key.primitive_id == fragment_i.key.primitive_id && fragment_o.kind == fragment_i.kind);
        assert (fragment_o.ends_primitive == pixel_i.is_last && !fragment_o.ends_visit);
        assert (fragment_o.state == fragment_i.state);
      end
    end
    if (fragment_ready_i && fragment_valid_i && pixel_valid_i) assert (sends);  // no deadlock
    if (fragment_ready_i && fragment_valid_i && fragment_i.kind != raster_pkg::PRIMITIVE_KIND_LINE) assert (sends);
    // An offer depends on no ready: it stays while the inputs stay.
    assert (fragment_valid_o == (fragment_valid_i && (fragment_i.kind != raster_pkg::PRIMITIVE_KIND_LINE || pixel_valid_i)));
  end

  // The mask has the pixel, and nothing else.
  logic [TS-1:0] of_stamp_x, of_stamp_y;
  assign of_stamp_x = TS'(fragment_o.stamp) & TS'((1 << (TS - SS)) - 1);
  assign of_stamp_y = TS'(fragment_o.stamp >> (TS - SS));
  genvar k;
  generate
    for (k = 0; k < SAMPLES; k++) begin : gen_proof
      logic is_the_pixel;
      assign is_the_pixel = {fragment_o.key.tile_x, (of_stamp_x << SS) + TS'(k % SIZE)} == (TX + TS)'(pixel_i.x) &&
                            {fragment_o.key.tile_y, (of_stamp_y << SS) + TS'(k / SIZE)} == (TY + TS)'(pixel_i.y);
      always_comb if (fragment_i.kind == raster_pkg::PRIMITIVE_KIND_LINE) begin
        assert (fragment_o.mask[k] == is_the_pixel);
        assert (fragment_o.code[k*raster_pkg::ALL_CODE_BITS+:raster_pkg::ALL_CODE_BITS] == pixel_i.code);
      end
    end
  endgenerate
