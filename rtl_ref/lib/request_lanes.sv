// Request lanes: the data of a memory write, one lane per sample, from the bytes in memory: the inverse of
// request_bytes. A word of flags fills the lanes from the first bit on. Combinational.
module request_lanes (
    input  raster_pkg::tile_plane_t                                       plane_i,
    input  logic [8*raster_pkg::REQUEST_BYTES-1:0]                        bytes_i,
    output logic [raster_pkg::SAMPLES*raster_pkg::MEMORY_LANE_BITS-1:0] data_o
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int LANE = raster_pkg::MEMORY_LANE_BITS;
  localparam int DATA = SAMPLES * LANE;
  localparam int DEPTH = 8 * raster_pkg::DEPTH_SAMPLE_BYTES;
  localparam int COLOR = 8 * raster_pkg::COLOR_SAMPLE_BYTES;
  logic [DATA-1:0] depth, color;
  genvar s;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_sample
      assign depth[s*LANE+:LANE] = LANE'(bytes_i[s*DEPTH+:DEPTH]);
      if (s < raster_pkg::MEMORY_COLORS) begin : gen_color
        assign color[s*LANE+:LANE] = LANE'(bytes_i[s*COLOR+:COLOR]);
      end else begin : gen_none
        assign color[s*LANE+:LANE] = '0;
      end
    end
  endgenerate
  assign data_o = plane_i[1] ? DATA'(bytes_i[raster_pkg::FLAG_WORD-1:0]) : plane_i[0] ? color : depth;

endmodule
