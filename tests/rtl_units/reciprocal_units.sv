// The reciprocal units of several widths side by side, and the same with a fault each (faults.cmake).
module reciprocal_units (
    input logic clk_i,
    input logic rst_ni,

    // The lowest bits of it are the mantissas below their highest bit.
    input  logic [18:0]  mantissa_i,
    output logic [119:0] table_o,         // 20 bits for each of k = 8, 13, 14, 16, 18, 20
    output logic [59:0]  table_faults_o,  // k = 14
    output logic [119:0] division_o,      // likewise
    output logic [59:0]  division_faults_o,

    input  logic         valid_i,
    input  logic         ready_i,
    output logic [5:0]   restoring_ready_o,
    output logic [5:0]   restoring_valid_o,
    output logic [119:0] restoring_o,
    output logic [2:0]   fault_valid_o,
    output logic [2:0]   fault_ready_o,
    output logic [59:0]  restoring_faults_o
);

  localparam logic [6*32-1:0] BITS_OF = {32'd20, 32'd18, 32'd16, 32'd14, 32'd13, 32'd8};

  genvar i;
  generate
    for (i = 0; i < 6; i++) begin : gen_width
      localparam int BITS = BITS_OF[32*i+:32];
      logic [BITS-1:0] from_table, from_row, from_division;
      assign table_o[20*i+:20]     = 20'(from_table);
      assign division_o[20*i+:20]  = 20'(from_row);
      assign restoring_o[20*i+:20] = 20'(from_division);
      reciprocal_division #(
          .BITS(BITS)
      ) u_division (
          .clk_i       (clk_i),
          .mantissa_i  (mantissa_i[0+:BITS-1]),
          .reciprocal_o(from_row)
      );
      reciprocal_table #(
          .BITS(BITS)
      ) u_table (
          .clk_i       (clk_i),
          .mantissa_i  (mantissa_i[0+:BITS-1]),
          .reciprocal_o(from_table)
      );
      reciprocal_restoring #(
          .BITS(BITS)
      ) u_restoring (
          .clk_i       (clk_i),
          .rst_ni      (rst_ni),
          .valid_i     (valid_i),
          .ready_o     (restoring_ready_o[i]),
          .mantissa_i  (mantissa_i[0+:BITS-1]),
          .valid_o     (restoring_valid_o[i]),
          .ready_i     (ready_i),
          .reciprocal_o(from_division)
      );
    end
  endgenerate

`define TABLE_FAULT(n) \
  reciprocal_table_fault_``n #( \
      .BITS(14) \
  ) u_table_fault_``n ( \
      .clk_i       (clk_i), \
      .mantissa_i  (mantissa_i[12:0]), \
      .reciprocal_o(table_faults_o[20*n+:14]) \
  ); \
  assign table_faults_o[20*n+14+:6] = '0;
`define DIVISION_FAULT(n) \
  reciprocal_division_fault_``n #( \
      .BITS(14) \
  ) u_division_fault_``n ( \
      .clk_i       (clk_i), \
      .mantissa_i  (mantissa_i[12:0]), \
      .reciprocal_o(division_faults_o[20*n+:14]) \
  ); \
  assign division_faults_o[20*n+14+:6] = '0;
`define RESTORING_FAULT(n) \
  reciprocal_restoring_fault_``n #( \
      .BITS(14) \
  ) u_restoring_fault_``n ( \
      .clk_i       (clk_i), \
      .rst_ni      (rst_ni), \
      .valid_i     (valid_i), \
      .ready_o     (fault_ready_o[n]), \
      .mantissa_i  (mantissa_i[12:0]), \
      .valid_o     (fault_valid_o[n]), \
      .ready_i     (ready_i), \
      .reciprocal_o(restoring_faults_o[20*n+:14]) \
  ); \
  assign restoring_faults_o[20*n+14+:6] = '0;
  `TABLE_FAULT(0)
  `TABLE_FAULT(1)
  `TABLE_FAULT(2)
  `DIVISION_FAULT(0)
  `DIVISION_FAULT(1)
  `DIVISION_FAULT(2)
  `RESTORING_FAULT(0)
  `RESTORING_FAULT(1)
  `RESTORING_FAULT(2)

endmodule
