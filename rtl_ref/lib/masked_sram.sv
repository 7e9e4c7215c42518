// Masked SRAM: an SRAM (sram.sv) with a write enable for each bit of a word. A word read while it is written is
// undefined.
module masked_sram #(
    parameter int WIDTH = 1,               // bits of a word
    parameter int DEPTH = 2,               // words, at least 2
    parameter bit EARLY = 0,               // 1: may_write_i comes earlier than write_i
    parameter int HAS_MASK = 1,  // 1: block RAM with enables per bit (iCE40); 0: a RAM for each bit, on any part
    parameter int ADDRESS = $clog2(DEPTH)  // derived; not to be set
) (
    input logic clk_i,

    input  logic               read_i,
    input  logic [ADDRESS-1:0] read_address_i,
    output logic [WIDTH-1:0]   data_o,

    input logic               may_write_i,  // high whenever a bit of write_i is
    input logic [WIDTH-1:0]   write_i,
    input logic [ADDRESS-1:0] write_address_i,
    input logic [WIDTH-1:0]   data_i
);

  genvar b;
  generate
    if (HAS_MASK != 0) begin : gen_masked
      // The enable of a block RAM in synthesis is the OR of its bits' enables. A bit that nothing reads is written
      // with may_write_i: then may_write_i alone is the enable.
      localparam int BITS = EARLY ? WIDTH + 1 : WIDTH;
      logic [BITS-1:0] write, data;
      assign write = BITS'({may_write_i, write_i});
      assign data  = BITS'({1'b1, data_i});

      (* no_rw_check, ramstyle = "no_rw_check", rw_addr_collision = "no", syn_ramstyle = "no_rw_check" *)
      logic [BITS-1:0] memory_q[0:DEPTH-1];
      logic [BITS-1:0] data_q;

      assign data_o = data_q[WIDTH-1:0];

      always_ff @(posedge clk_i) begin
        if (read_i) data_q <= memory_q[read_address_i];
        for (int i = 0; i < BITS; i++) if (write[i]) memory_q[write_address_i][i] <= data[i];
      end
    end else begin : gen_bits
      for (b = 0; b < WIDTH; b++) begin : gen_bit
        sram #(
            .WIDTH    (1),
            .DEPTH    (DEPTH),
            .READS_OLD(0)
        ) u_ram (
            .clk_i,
            .read_i,
            .read_address_i,
            .data_o         (data_o[b]),
            .write_i        (write_i[b]),
            .write_address_i,
            .data_i         (data_i[b])
        );
      end
    end
  endgenerate

endmodule
