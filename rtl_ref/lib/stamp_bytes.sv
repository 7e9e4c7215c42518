// Stamp bytes: extracts a stamp from the beats that memory has answered. Combinational. Specification: unpack() of
// model/stages/memory_port.hpp.
module stamp_bytes #(
    parameter int CODES = raster_pkg::SAMPLES,  // codes of a stamp; the lanes above them are 0
    parameter int SAMPLE_BYTES = 2,             // bytes of a sample in memory
    parameter int WORD = 8,                     // bytes of word_i
    parameter int SHARED = 0,                   // log2 of the stamps in a beat
    parameter int PART = 1                      // bits of a stamp's number in its beat
) (
    input  logic [8*WORD-1:0] word_i,  // the last beats, the newest highest
    input  logic [PART-1:0]   sub_i,   // number of the stamp in its beat
    output logic [raster_pkg::SAMPLES*raster_pkg::MEMORY_LANE_BITS-1:0] data_o
);

  localparam int SAMPLES = raster_pkg::SAMPLES;
  localparam int LANE = raster_pkg::MEMORY_LANE_BITS;
  localparam int BYTES = CODES * SAMPLE_BYTES;
  localparam int TAKEN = (LANE < 8 * SAMPLE_BYTES) ? LANE : 8 * SAMPLE_BYTES;

  logic [8*BYTES-1:0] bytes;
  genvar s;
  generate
    if (SHARED == 0) begin : gen_whole
      assign bytes = word_i[8*WORD-1-:8*BYTES];
    end else begin : gen_shared
      assign bytes = (8 * BYTES)'(word_i >> ((32'(sub_i) & 32'((1 << SHARED) - 1)) * (8 * BYTES)));
    end
    for (s = 0; s < SAMPLES; s++) begin : gen_sample
      if (s < CODES) begin : gen_code
        assign data_o[s*LANE+:LANE] = LANE'(bytes[8*SAMPLE_BYTES*s+:TAKEN]);
      end else begin : gen_none
        assign data_o[s*LANE+:LANE] = '0;
      end
    end
  endgenerate

endmodule
