// Stencil test of the samples of a stamp, and what becomes of the values that are stored under them. Combinational.
// Specification: test_sample of model/stages/depth_test.hpp, model/stencil_ops.hpp.
module stencil_test (
    // The side that the triangle shows
    input logic [raster_pkg::DEPTH_FUNC_BITS-1:0] func_i,
    input logic [7:0]                             reference_i,
    input logic [7:0]                             read_i,
    input logic [8:0]                             ops_i,  // sfail, zfail, zpass, lowest first
    input logic [7:0]                             write_i,

    input logic [8*raster_pkg::SAMPLES-1:0] stored_i,
    input logic [raster_pkg::SAMPLES-1:0]   is_nearer_i,  // it passes the depth test

    output logic [raster_pkg::SAMPLES-1:0]   passes_o,
    output logic [raster_pkg::SAMPLES-1:0]   marks_o,  // the stored value changes
    output logic [8*raster_pkg::SAMPLES-1:0] stencil_o
);

  localparam logic [2:0] KEEP = 3'd0;
  localparam logic [2:0] ZERO = 3'd1;
  localparam logic [2:0] REPLACE = 3'd2;
  localparam logic [2:0] INCR = 3'd3;
  localparam logic [2:0] DECR = 3'd4;
  localparam logic [2:0] INVERT = 3'd5;
  localparam logic [2:0] INCR_WRAP = 3'd6;

  logic less_passes, equal_passes, greater_passes;
  passing_orders u_orders (
      .func_i   (func_i),
      .less_o   (less_passes),
      .equal_o  (equal_passes),
      .greater_o(greater_passes)
  );

  logic [7:0] wanted;
  assign wanted = reference_i & read_i;

  genvar s;
  generate
    for (s = 0; s < raster_pkg::SAMPLES; s++) begin : gen_sample
      logic [7:0] stored, looked_at, result;
      logic [2:0] op;
      logic       is_less, is_equal;
      assign stored      = stored_i[8*s+:8];
      assign looked_at   = stored & read_i;
      assign is_less     = wanted < looked_at;
      assign is_equal    = wanted == looked_at;
      assign passes_o[s] = is_less ? less_passes : (is_equal ? equal_passes : greater_passes);
      assign op          = !passes_o[s] ? ops_i[2:0] : (is_nearer_i[s] ? ops_i[8:6] : ops_i[5:3]);
      assign marks_o[s]  = op != KEEP && write_i != '0;
      always_comb begin
        case (op)
          KEEP: result = stored;
          ZERO: result = '0;
          REPLACE: result = reference_i;
          INCR: result = stored == 8'hff ? stored : stored + 8'd1;
          DECR: result = stored == 8'h00 ? stored : stored - 8'd1;
          INVERT: result = ~stored;
          INCR_WRAP: result = stored + 8'd1;
          default: result = stored - 8'd1;
        endcase
      end
      assign stencil_o[8*s+:8] = (result & write_i) | (stored & ~write_i);
    end
  endgenerate

endmodule
