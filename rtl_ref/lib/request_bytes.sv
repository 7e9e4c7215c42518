// Request bytes: what a request to memory writes, as it lies there: the stamp's samples one behind the other, or a word of flags;
// behind them 0. Combinational. Specification: put() of model/stages/memory_port.hpp.
module request_bytes #(
    parameter int DEPTH_BYTES = raster_pkg::SAMPLES * raster_pkg::DEPTH_SAMPLE_BYTES,  // of a stamp; derived, not to be set
    parameter int COLOR_BYTES = raster_pkg::SAMPLES * raster_pkg::COLOR_SAMPLE_BYTES,
    parameter int STAMP_BYTES = (DEPTH_BYTES > COLOR_BYTES) ? DEPTH_BYTES : COLOR_BYTES,
    parameter int DATA_BYTES = (raster_pkg::FLAG_WORD / 8 > STAMP_BYTES) ? raster_pkg::FLAG_WORD / 8 : STAMP_BYTES
) (
    /* verilator lint_off UNUSEDSIGNAL */  // its plane and its data count
    input  raster_pkg::memory_request_t request_i,
    /* verilator lint_on UNUSEDSIGNAL */
    output logic [8*DATA_BYTES-1:0]     bytes_o
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int LANE = raster_pkg::MEMORY_LANE_BITS;
  localparam int DEPTH = 8 * raster_pkg::DEPTH_SAMPLE_BYTES;
  localparam int COLOR = 8 * raster_pkg::COLOR_SAMPLE_BYTES;
  localparam int DEPTH_TAKEN = (LANE < DEPTH) ? LANE : DEPTH;
  localparam int COLOR_TAKEN = (LANE < COLOR) ? LANE : COLOR;
  logic [8*DEPTH_BYTES-1:0] depth;
  logic [8*COLOR_BYTES-1:0] color;
  genvar s;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_sample
      assign depth[s*DEPTH+:DEPTH] = DEPTH'(request_i.data[s*LANE+:DEPTH_TAKEN]);
      assign color[s*COLOR+:COLOR] = COLOR'(request_i.data[s*LANE+:COLOR_TAKEN]);
    end
  endgenerate
  assign bytes_o = request_i.plane[1] ? (8 * DATA_BYTES)'(request_i.data[raster_pkg::FLAG_WORD-1:0]) :
                   request_i.plane[0] ? (8 * DATA_BYTES)'(color) : (8 * DATA_BYTES)'(depth);

endmodule
