// Late test: the alpha test downstream of the texture unit (LATE_ALPHA). Samples that alpha may drop have not been
// written yet; the passed ones are written here: depths into depth_cache, colours into color_write. Dropped samples of
// a stamp read from memory are written with the values read. Without LATE_ALPHA every sample is kept. Specification:
// opaque of model/stages/texture_stage.hpp, FragmentPath::drop of fragment_path.hpp, block_cache.hpp.
module late_test #(
    parameter int SAMPLES = raster_pkg::SAMPLES,  // derived; not to be set
    parameter int CODE = raster_pkg::STORED_DEPTH_BITS,
    parameter int COUNT = raster_pkg::SAMPLE_COUNT_BITS
) (
    input logic clk_i,
    input logic rst_ni,

    // The stamp that color_write takes in this cycle, and alpha of its pixels
    input logic                             stamp_leaves_i,
    input raster_pkg::tested_stamp_t        stamp_i,
    input logic [raster_pkg::PIXELS*8-1:0]  alpha_i,
    output logic [SAMPLES-1:0]              opaque_o,  // samples that alpha keeps

    // To depth_cache: for each sample whether only the chip holds it, and its word
    output logic                        late_valid_o,
    output logic [SAMPLES-1:0]          late_writes_o,
    output logic [SAMPLES*(CODE+1)-1:0] late_word_o,

    // Samples of triangles, points and lines to be counted in this cycle
    output logic [COUNT-1:0] written_o,
    output logic [COUNT-1:0] killed_o
);

  genvar s;
  generate
    if (raster_pkg::LATE_ALPHA != 0) begin : gen_late
      logic [raster_pkg::DEPTH_FUNC_BITS-1:0] func_q;
      logic [7:0]           reference_q;
      logic                 covers_q;  // alpha to coverage
      logic [SAMPLES-1:0]   changes, alpha_passes;  // the sample would change the depth or the stencil
      logic                 is_counted;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          func_q      <= raster_pkg::DEPTH_FUNC_ALWAYS;
          reference_q <= '0;
          covers_q    <= 1'b0;
        end else if (stamp_leaves_i && stamp_i.sets_state && stamp_i.state_register == raster_pkg::STATE_REGISTER_ALPHA_TEST) begin
          func_q      <= stamp_i.state[2:0];
          reference_q <= stamp_i.state[10:3];
          covers_q    <= raster_pkg::MSAA_SAMPLES > 1 && stamp_i.state[11];
        end
      end
      alpha_test u_alpha (
          .func_i     (func_q),
          .reference_i(reference_q),
          .covers_i   (covers_q),
          .alpha_i,
          .passes_o   (alpha_passes)
      );
      if (raster_pkg::STENCIL_BITS != 0) begin : gen_changes
        assign changes = stamp_i.changes;
      end else begin : gen_depths
        assign changes = stamp_i.passed;
      end
      assign opaque_o     = alpha_passes;
      assign late_valid_o = stamp_leaves_i && stamp_i.is_late;
      for (s = 0; s < SAMPLES; s++) begin : gen_sample
        logic is_kept;
        assign is_kept          = changes[s] && alpha_passes[s];
        assign late_writes_o[s] = is_kept || !stamp_i.on_chip;
        assign late_word_o[s*(CODE+1)+:CODE+1] = {is_kept, is_kept ? stamp_i.word[s*CODE+:CODE] : stamp_i.stored[s*CODE+:CODE]};
      end
      assign is_counted = stamp_leaves_i && stamp_i.is_counted;
      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          written_o <= '0;
          killed_o  <= '0;
        end else begin
          written_o <= is_counted && stamp_i.writes ? raster_pkg::count_samples(stamp_i.passed & alpha_passes) : '0;
          killed_o  <= is_counted ? raster_pkg::count_samples(stamp_i.passed & ~alpha_passes) : '0;
        end
      end
    end else begin : gen_early
      assign opaque_o      = '1;
      assign late_valid_o  = 1'b0;
      assign late_writes_o = '0;
      assign late_word_o   = '0;
      assign written_o     = '0;
      assign killed_o      = '0;
    end
  endgenerate

endmodule
