// halfplane_core_wishbone, which soc/wishbone_shell.py writes, with a checker at both ports and the names that the benches have.
module wishbone_core (
    input  logic        clk_i,
    input  logic        rst_ni,
    output logic        irq,
    input  logic [29:0] registers_adr,
    input  logic [31:0] registers_dat_w,
    output logic [31:0] registers_dat_r,
    input  logic [3:0]  registers_sel,
    input  logic        registers_cyc,
    input  logic        registers_stb,
    input  logic        registers_we,
    output logic        registers_ack,
    output logic        registers_err,
    output logic [29:0] memory_adr,
    output logic [31:0] memory_dat_w,
    input  logic [31:0] memory_dat_r,
    output logic [3:0]  memory_sel,
    output logic        memory_cyc,
    output logic        memory_stb,
    output logic        memory_we,
    input  logic        memory_ack,
    input  logic        memory_err,
    output logic        video_valid,
    input  logic        video_ready
);

  halfplane_core_wishbone u_shell (
      .clk       (clk_i),
      .rst       (!rst_ni),
      .video_last(),
      .video_data(),
      .video_user(),
      .*
  );
  wishbone_protocol_checker u_registers (
      .clk_i,
      .rst_ni,
      .adr  (registers_adr),
      .dat_w(registers_dat_w),
      .sel  (registers_sel),
      .cyc  (registers_cyc),
      .stb  (registers_stb),
      .we   (registers_we),
      .ack  (registers_ack),
      .err  (registers_err)
  );
  wishbone_protocol_checker u_memory (
      .clk_i,
      .rst_ni,
      .adr  (memory_adr),
      .dat_w(memory_dat_w),
      .sel  (memory_sel),
      .cyc  (memory_cyc),
      .stb  (memory_stb),
      .we   (memory_we),
      .ack  (memory_ack),
      .err  (memory_err)
  );

endmodule
