// SRAM: one read port, one write port, the shape of a block RAM. Contents are undefined until written.
//
// A read takes one cycle, and its result stays until the next read. It sees the writes of earlier cycles. A read of a
// word that is written in the same cycle gives the old value, which some block RAMs need extra logic for: a user that
// ignores such results sets READS_OLD to 0.
module sram #(
    parameter int WIDTH = 1,               // bits of a word
    parameter int DEPTH = 2,               // words, at least 2
    parameter bit READS_OLD = 1,           // 0: a word read while it is written is never used; saves a comparator
    parameter bit BLOCK = 0,               // 1: in block RAM even if that is mostly empty
    parameter int WHOLE = 1024,            // up to this many words it is one RAM in any case
    parameter int ADDRESS = $clog2(DEPTH)  // derived; not to be set
) (
    input logic clk_i,

    input  logic               read_i,
    input  logic [ADDRESS-1:0] read_address_i,
    output logic [WIDTH-1:0]   data_o,

    input logic               write_i,
    input logic [ADDRESS-1:0] write_address_i,
    input logic [WIDTH-1:0]   data_i
);

  // A few words more than a power of two become a RAM of their own: otherwise the whole would be made of smaller blocks
  // and a multiplexer.
  localparam int LOW = 1 << (ADDRESS - 1);
  localparam int HIGH = DEPTH - LOW;  // words from LOW on
  localparam int HIGH_ADDRESS = HIGH < 2 ? 1 : $clog2(HIGH);

  // The same two hints for Yosys (no_rw_check, ram_style), Vivado (rw_addr_collision, ram_style), Quartus (ramstyle, whose
  // block RAMs have names of the part's: they are left to it), Synplify and Gowin (syn_ramstyle). Yosys takes ram_style before
  // all others.
  localparam KIND = BLOCK ? "block" : "auto";
  localparam COLLISION = READS_OLD ? "auto" : "no";
  localparam QUARTUS = READS_OLD ? "auto" : "no_rw_check";
  localparam SYN = BLOCK ? "block_ram" : READS_OLD ? "auto" : "no_rw_check";

  generate
    if (DEPTH > WHOLE && HIGH <= LOW / 8) begin : gen_parts
      (* no_rw_check = !READS_OLD, rw_addr_collision = COLLISION, ram_style = KIND, ramstyle = QUARTUS, syn_ramstyle = SYN *)
      logic [WIDTH-1:0] low_q[0:LOW-1];
      (* no_rw_check = !READS_OLD, rw_addr_collision = COLLISION, ram_style = "block", ramstyle = QUARTUS, syn_ramstyle = "block_ram" *)
      logic [WIDTH-1:0] high_q[0:HIGH-1];
      logic [WIDTH-1:0] low_data_q, high_data_q;
      logic             is_high_q;

      assign data_o = is_high_q ? high_data_q : low_data_q;

      always_ff @(posedge clk_i) begin
        if (read_i) begin
          is_high_q   <= read_address_i[ADDRESS-1];
          low_data_q  <= low_q[read_address_i[ADDRESS-2:0]];
          high_data_q <= high_q[read_address_i[HIGH_ADDRESS-1:0]];
        end
        if (write_i && !write_address_i[ADDRESS-1]) low_q[write_address_i[ADDRESS-2:0]] <= data_i;
        if (write_i && write_address_i[ADDRESS-1]) high_q[write_address_i[HIGH_ADDRESS-1:0]] <= data_i;
      end
    end else begin : gen_whole
      (* no_rw_check = !READS_OLD, rw_addr_collision = COLLISION, ram_style = KIND, ramstyle = QUARTUS, syn_ramstyle = SYN *)
      logic [WIDTH-1:0] memory_q[0:DEPTH-1];
      logic [WIDTH-1:0] data_q;

      assign data_o = data_q;

      always_ff @(posedge clk_i) begin
        if (read_i) data_q <= memory_q[read_address_i];
        if (write_i) memory_q[write_address_i] <= data_i;
      end
    end
  endgenerate

endmodule
