// Request bytes: the data of a memory write, as they lie in memory: the stamp's samples one after the other, or a word
// of flags; above them 0. Combinational. Specification: put() of model/stages/memory_port.hpp.
module request_bytes (
    input  raster_pkg::memory_request_t request_i,
    output logic [8*raster_pkg::REQUEST_BYTES-1:0] bytes_o
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int LANE = raster_pkg::MEMORY_LANE_BITS;
  localparam int DEPTH = 8 * raster_pkg::DEPTH_SAMPLE_BYTES;
  localparam int COLOR = 8 * raster_pkg::COLOR_SAMPLE_BYTES;
  localparam int DEPTH_TAKEN = (LANE < DEPTH) ? LANE : DEPTH;
  localparam int COLOR_TAKEN = (LANE < COLOR) ? LANE : COLOR;
  localparam int DATA = 8 * raster_pkg::REQUEST_BYTES;
  logic [SAMPLES*DEPTH-1:0] depth;
  logic [SAMPLES*COLOR-1:0] color;
  genvar s;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_sample
      assign depth[s*DEPTH+:DEPTH] = DEPTH'(request_i.data[s*LANE+:DEPTH_TAKEN]);
      assign color[s*COLOR+:COLOR] = COLOR'(request_i.data[s*LANE+:COLOR_TAKEN]);
    end
  endgenerate
  assign bytes_o = request_i.plane[1] ? DATA'(request_i.data[raster_pkg::FLAG_WORD-1:0]) :
                   request_i.plane[0] ? DATA'(color) : DATA'(depth);

endmodule
