// Stencil test of the samples of a stamp, and the new values of their stored stencils. Combinational. Specification:
// test_sample of model/stages/depth_test.hpp, model/stages/stencil_ops.hpp.
module stencil_test (
    // The registers of the side that the triangle shows
    input logic [raster_pkg::DEPTH_FUNC_BITS-1:0] func_i,
    input logic [7:0]                             reference_i,
    input logic [7:0]                             read_i,
    input logic [8:0]                             ops_i,  // sfail, zfail, zpass, lowest first, as depth_test's as_bits
    input logic [7:0]                             write_i,

    input logic [raster_pkg::SAMPLES-1:0]   may_mark_i,
    input logic [8*raster_pkg::SAMPLES-1:0] stored_i,
    input logic [raster_pkg::SAMPLES-1:0]   is_nearer_i,  // the sample passes the depth test

    output logic [raster_pkg::SAMPLES-1:0]   passes_o,
    output logic [raster_pkg::SAMPLES-1:0]   marks_o,  // the stored value is written; else stencil_o is unchanged
    output logic [8*raster_pkg::SAMPLES-1:0] stencil_o
);

  logic less_passes, equal_passes, greater_passes;
  passing_orders u_orders (
      .func_i   (func_i),
      .less_o   (less_passes),
      .equal_o  (equal_passes),
      .greater_o(greater_passes)
  );

  // Whether a sample passes if bit i is the highest that differs: the reference is less if it has a 0 there.
  logic [7:0] passes_if;
  assign passes_if = (reference_i & {8{greater_passes}}) | (~reference_i & {8{less_passes}});

  genvar s;
  generate
    for (s = 0; s < raster_pkg::SAMPLES; s++) begin : gen_sample
      // Bit by bit, each a table of four inputs. Comparison: the highest bit that differs decides. Update: a bit
      // toggles if the operation says so, or if the operation counts and all bits below are ones (zeros, counting
      // down).
      logic [7:0] stored, differs, toggles, carries;
      logic [2:0] op;
      logic [1:0] sets;  // the operations that do not count
      logic       counts, is_down, saturates, is_at_end;
      assign stored  = stored_i[8*s+:8];
      assign differs = (stored ^ reference_i) & read_i;
      always_comb begin
        passes_o[s] = equal_passes;
        for (int i = 0; i < 8; i++) if (differs[i]) passes_o[s] = passes_if[i];
      end

      always_comb begin
        op = !passes_o[s] ? ops_i[2:0] : (is_nearer_i[s] ? ops_i[8:6] : ops_i[5:3]);
        if (!may_mark_i[s]) op = '0;
      end
      assign marks_o[s] = op != '0 && write_i != '0;
      assign counts     = op[2];
      assign is_down    = op[1];
      assign saturates  = op[0];
      assign is_at_end  = stored == {8{!is_down}};
      assign sets       = counts ? '0 : op[1:0];
      assign toggles    = sets[1] ? (sets[0] ? '1 : stored ^ reference_i) : (sets[0] ? stored : '0);
      always_comb begin
        for (int i = 0; i < 8; i++)
          carries[i] = counts && !(saturates && is_at_end) && ((stored ^ {8{!is_down}}) & ((8'd1 << i) - 8'd1)) == '0;
      end
      assign stencil_o[8*s+:8] = stored ^ (write_i & (toggles | carries));
    end
  endgenerate

endmodule
