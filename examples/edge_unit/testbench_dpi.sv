// Three edge units against fine_raster of Halfplane, called through DPI-C: no files. Random edges over a whole tile, many of
// them through pixel centres; the first pixel that differs ends it. docs/your-rtl.md.
module testbench_dpi;
  import raster_pkg::*;
  import halfplane_dpi::*;

  localparam int TILES = 2000;

  tile_packet_t               tile;
  edge_context_t              edges;
  logic [TILE_PIXEL_BITS-1:0] x, y;
  logic [2:0]                 is_inside;

  for (genvar e = 0; e < 3; ++e) begin : gen_edge
    edge_unit #(
        .VALUE_BITS(TILE_EDGE_BITS),
        .STEP_BITS (EDGE_STEP_BITS),
        .PIXEL_BITS(TILE_PIXEL_BITS)
    ) edge_unit_i (
        .value_i (tile.edge_value[e*TILE_EDGE_BITS+:TILE_EDGE_BITS]),
        .step_x_i(edges.step_x[e*EDGE_STEP_BITS+:EDGE_STEP_BITS]),
        .step_y_i(edges.step_y[e*EDGE_STEP_BITS+:EDGE_STEP_BITS]),
        .x_i     (x),
        .y_i     (y),
        .inside_o(is_inside[e])
    );
  end

  chandle stage;
  bit [TILE_SIZE*TILE_SIZE-1:0] covered;  // row by row
  int seed = 1, pixels = 0;

  function automatic int below(int n);
    return int'(unsigned'($random(seed)) % unsigned'(n));
  endfunction

  // Small steps, and a value that makes the edge pass through some pixel of the tile.
  task automatic draw_edges();
    int step_x, step_y;
    tile = '0;
    tile.is_visit = 1'b1;
    tile.ends_primitive = 1'b1;
    tile.box.right = TILE_PIXEL_BITS'(TILE_SIZE - 1);
    tile.box.bottom = TILE_PIXEL_BITS'(TILE_SIZE - 1);
    for (int e = 0; e < 3; ++e) begin
      step_x = below(64) - 32;
      step_y = below(64) - 32;
      edges.step_x[e*EDGE_STEP_BITS+:EDGE_STEP_BITS] = EDGE_STEP_BITS'(step_x);
      edges.step_y[e*EDGE_STEP_BITS+:EDGE_STEP_BITS] = EDGE_STEP_BITS'(step_y);
      tile.edge_value[e*TILE_EDGE_BITS+:TILE_EDGE_BITS] =
          TILE_EDGE_BITS'(-step_x * below(TILE_SIZE) - step_y * below(TILE_SIZE));
    end
  endtask

  task automatic ask_the_model();
    stamp_packet_t stamp;
    covered = '0;
    put_fine_raster_tile(stage, tile);
    put_fine_raster_edges(stage, edges);
    while (get_fine_raster_stamp(stage, stamp))
      if (stamp.mask[0]) covered[stamp.stamp] = 1'b1;  // a stamp of one pixel
  endtask

  initial begin
    stage = new_fine_raster();
    for (int n = 0; n < TILES; ++n) begin
      draw_edges();
      ask_the_model();
      for (int p = 0; p < TILE_SIZE * TILE_SIZE; ++p) begin
        x = TILE_PIXEL_BITS'(p % TILE_SIZE);
        y = TILE_PIXEL_BITS'(p / TILE_SIZE);
        #1;
        pixels += int'(&is_inside);
        if (&is_inside != covered[p])
          $fatal(1, "tile %0d, pixel %0d %0d: edge_unit says %b, the model %b; edge values %h", n, x, y, &is_inside,
                 covered[p], tile.edge_value);
      end
    end
    halfplane_stage_free(stage);
    $display("%0d tiles of seed 1, %0d pixels inside: equal", TILES, pixels);
    if (pixels == 0) $fatal(1, "nothing was inside");
    $finish;
  end
endmodule
