// Stamp rop: rop of each pixel of a shaded stamp, copied to all samples that get the colour. Blended or dithered
// colours are packed in color_write. Combinational. Specification: model/stages/texture_stage.hpp.
module stamp_rop #(
    parameter int PIXELS = raster_pkg::PIXELS,  // derived; not to be set
    parameter int RGBA = 8 * raster_pkg::COLOR_PLANES,
    parameter int COLOR = raster_pkg::SHADED_COLOR_BITS
) (
    input  logic [PIXELS-1:0]                     mask_i,
    input  logic [PIXELS*RGBA-1:0]                rgba_i,
    output logic [raster_pkg::SAMPLES*COLOR-1:0]  color_o,  // input of color_write
    output logic [PIXELS*8-1:0]                   alpha_o,
    output raster_pkg::color_packet_t             packet_o  // the same with 0 for samples that are not written
);

  localparam int N = raster_pkg::MSAA_SAMPLES;  // samples of a pixel, which has one colour, whichever are written
  // A sample that is not written has colour 0 where more than its mask is read.
  localparam bit CLEANS = N > 1 || raster_pkg::BLEND_LANES != 0;
  genvar s;
  generate
    for (s = 0; s < PIXELS; s++) begin : gen_pixel
      logic [COLOR-1:0] packed_color;
      if (raster_pkg::BLEND_LANES != 0 || raster_pkg::DITHER_UNIT != 0) begin : gen_whole
        assign packed_color = rgba_i[s*RGBA+:RGBA];
      end else begin : gen_rop
        rop u_rop (
            .rgba_i (rgba_i[s*RGBA+:RGBA]),
            .color_o(packed_color)
        );
      end
      assign alpha_o[s*8+:8]                    = rgba_i[(s+1)*RGBA-1-:8];
      assign color_o[s*N*COLOR+:N*COLOR]        = {N{packed_color & {COLOR{mask_i[s] || !CLEANS}}}};
      assign packet_o.color[s*N*COLOR+:N*COLOR] = {N{packed_color & {COLOR{mask_i[s]}}}};
      assign packet_o.mask[s*N+:N]              = {N{mask_i[s]}};
    end
  endgenerate

endmodule
