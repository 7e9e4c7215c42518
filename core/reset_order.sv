// The order of resets inside the core, for a memory that may still owe answers.
//
// Two resets, for two purposes:
//  - rst_ni, through reset_sync: that of the bus. Memory drops outstanding answers, so everything here begins anew at once.
//  - restart_i, from a register: the core alone begins anew; the bus and its other masters go on.
//
// restart_i takes these steps, each at an edge of the clock, so that raster_top may use its resets as data:
//  1. raster_no is low for two cycles: raster_top drops its work. core_no, of all modules upstream of it, is low
// to
//     the end.
//  2. raster_top ends its burst with beats that write nothing, and memory answers everything (idle_i).
//  3. If it does not within 2^PATIENCE cycles: raster_top is powered on again (power_on_no) and the ports forget
//     (forget_o). timed_out_o stays high until the next restart or rst_ni. Registers work again; the ports take no
// request
//     until the last answer has come and was dropped. If none will ever come, only rst_ni helps, together with the
// bus's.
module reset_order #(
    parameter int PATIENCE = 16
) (
    input logic clk_i,
    input logic rst_ni,  // synchronised (reset_sync)

    input logic restart_i,  // a pulse, or longer
    input logic idle_i,     // raster_top's idle_o, and the idle_o of all ports to memory

    output logic core_no,      // reset of commands, scan-out and all other masters of the memory
    output logic raster_no,    // rst_ni of raster_top
    output logic power_on_no,  // power_on_ni of raster_top
    output logic forget_o,     // to the ports
    output logic is_busy_o,    // a restart is under way
    output logic timed_out_o
);

  logic [PATIENCE-1:0] waited_q;
  logic                core_q, raster_q, power_on_q;  // resets, active high: why is in reset_sync
  logic                starts, gives_up, was_idle_q;

  assign core_no     = !core_q;
  assign raster_no   = !raster_q;
  assign power_on_no = !power_on_q;
  assign is_busy_o   = core_q;
  assign starts      = restart_i && !core_q;
  assign gives_up    = core_q && waited_q == {{(PATIENCE - 1) {1'b1}}, 1'b0};  // the cycle before the last

  // raster_top's idle_o is low in the cycles after its reset only because of the reset, so the first look is at 4.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      core_q      <= 1'b1;
      raster_q    <= 1'b1;
      power_on_q  <= 1'b1;
      forget_o    <= 1'b0;
      timed_out_o <= 1'b0;
      was_idle_q  <= 1'b0;
      waited_q    <= '0;
    end else begin
      waited_q    <= core_q ? waited_q + 1'b1 : '0;
      was_idle_q  <= idle_i;
      raster_q    <= starts || (core_q && waited_q == '0) || gives_up;
      power_on_q  <= gives_up;
      forget_o    <= gives_up;
      timed_out_o <= gives_up || (timed_out_o && !starts);
      core_q      <= starts || (core_q && !((waited_q[PATIENCE-1:2] != '0 && idle_i && was_idle_q) || waited_q == '1));
    end
  end

endmodule
