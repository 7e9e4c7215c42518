// Drives three edge units with the vectors of fine_raster, `tiny`: reads tile.hex and edges.hex of a folder, and writes
// stamp.hex as the unit has it. `halfplane check` judges it. docs/your-rtl.md.
module testbench;
  import raster_pkg::*;

  tile_packet_t             tile;
  edge_context_t            edges;
  logic [TILE_PIXEL_BITS-1:0] x, y;
  logic [2:0]               is_inside;

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

  string folder;
  int tiles, edge_contexts, stamps;

  // A stamp that nothing covers.
  function automatic stamp_packet_t empty_stamp();
    stamp_packet_t stamp = '0;
    stamp.kind = tile.kind;
    stamp.key = tile.key;
    stamp.slot = tile.slot;
    stamp.anchor = tile.anchor;
    return stamp;
  endfunction

  // The stamps of one tile: those with a covered sample, and of the last row one in any case, because it ends the visit.
  task automatic draw_tile();
    stamp_packet_t stamp = empty_stamp(), held = empty_stamp();
    if (!tile.is_visit) begin
      stamp.ends_primitive = tile.ends_primitive;
      $fdisplay(stamps, "%h", stamp);
      return;
    end
    held.stamp = STAMP_INDEX_BITS'(int'(tile.box.bottom) * STAMPS_PER_ROW);
    for (int row = int'(tile.box.top); row <= int'(tile.box.bottom); ++row) begin
      for (int column = int'(tile.box.left); column <= int'(tile.box.right); ++column) begin
        x = TILE_PIXEL_BITS'(column);
        y = TILE_PIXEL_BITS'(row);
        #1;
        if (is_inside != 3'b111 && !tile.is_inside) continue;
        stamp.mask  = 1'b1;
        stamp.stamp = STAMP_INDEX_BITS'(row * STAMPS_PER_ROW + column);
        if (row != int'(tile.box.bottom)) $fdisplay(stamps, "%h", stamp);
        else begin
          if (held.mask != 0) $fdisplay(stamps, "%h", held);
          held = stamp;
        end
      end
    end
    held.ends_visit = 1'b1;
    held.ends_primitive = tile.ends_primitive;
    $fdisplay(stamps, "%h", held);
  endtask

  initial begin
    if (!$value$plusargs("folder=%s", folder)) $fatal(1, "give +folder=FOLDER");
    tiles = $fopen({folder, "/tile.hex"}, "r");
    edge_contexts = $fopen({folder, "/edges.hex"}, "r");
    stamps = $fopen({folder, "/stamp.hex"}, "w");
    if (tiles == 0 || edge_contexts == 0 || stamps == 0) $fatal(1, "the folder lacks vectors");
    while ($fscanf(tiles, "%h\n", tile) == 1 && $fscanf(edge_contexts, "%h\n", edges) == 1) draw_tile();
    $fclose(stamps);
    $finish;
  end
endmodule
