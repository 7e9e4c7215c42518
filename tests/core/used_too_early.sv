// Verilator and Yosys take this; slang and the compilers of FPGA vendors do not.
module used_too_early (
    output logic y_o
);
  assign y_o = x;
  logic x;
  assign x = 1'b1;
endmodule
