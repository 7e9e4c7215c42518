// Beat bytes: a stamp or a word of flags as bytes on their way to memory, and the number of beats: several where the
// word is wider than a beat, one that neighbouring stamps share where it is narrower. Combinational. Specification:
// BeatShare and put() of model/stages/memory_port.hpp.
module beat_bytes #(
    parameter int SAMPLES = 1,                            // samples of a stamp
    parameter int SAMPLE_BYTES = 2,                       // bytes of a sample in memory
    parameter int WORD = 8,                               // bytes of word_o: the larger of a stamp and a beat
    parameter int SHIFT = $clog2(SAMPLES * SAMPLE_BYTES)  // derived; not to be set
) (
    input  logic [8*WORD-1:0]               bytes_i,   // as they lie in memory, 0 above them
    input  logic [SAMPLES-1:0]              strobe_i,
    input  logic [15:0]                     place_i,   // number of the stamp in its row of beats
    input  logic [raster_pkg::RUN_BITS-1:0] run_i,     // stamps from this one on
    output logic [8*WORD-1:0]               word_o,
    output logic [WORD-1:0]                 strobe_o,
    output logic [7:0]                      more_o,    // beats of the stamp after its first
    output logic [raster_pkg::BURST_LENGTH_BITS-1:0] length_o,  // beats of the run
    output logic                            ends_o     // the stamp is the last in its beat
);

  localparam int PORT = raster_pkg::PORT_SHIFT;
  localparam int BYTES = 1 << SHIFT;
  localparam int LENGTH = raster_pkg::BURST_LENGTH_BITS;

  logic [BYTES-1:0] strobe;
  genvar s;
  generate
    for (s = 0; s < SAMPLES; s++) begin : gen_sample
      assign strobe[SAMPLE_BYTES*s+:SAMPLE_BYTES] = {SAMPLE_BYTES{strobe_i[s]}};
    end
    if (SHIFT >= PORT) begin : gen_whole
      assign word_o   = bytes_i;
      assign strobe_o = WORD'(strobe);
      assign more_o   = 8'((1 << (SHIFT - PORT)) - 1);
      assign length_o = LENGTH'(run_i) << (SHIFT - PORT);
      assign ends_o   = 1'b1;
    end else begin : gen_shared
      localparam int SUB = PORT - SHIFT;
      logic [SUB-1:0] sub;
      assign sub      = place_i[SUB-1:0];
      assign word_o   = (8 * WORD)'(bytes_i[8*BYTES-1:0]) << (32'(sub) << (SHIFT + 3));
      assign strobe_o = WORD'(strobe) << (32'(sub) << SHIFT);
      assign more_o   = '0;
      assign length_o = LENGTH'((16'(sub) + 16'(run_i) + 16'((1 << SUB) - 1)) >> SUB);  // rounded up
      assign ends_o   = sub == '1;
    end
  endgenerate

endmodule
