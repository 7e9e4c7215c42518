
  // An arbitrary word: each bit read is the last one written into it in an earlier cycle, and the answer stays until
  // the next read.
  (* anyconst *) logic [ADDRESS-1:0] any_address;
  logic [WIDTH-1:0] was_written_q = '0, was_read_q = '0, word_q, answer_q;
  always_ff @(posedge clk_i) begin
    if (write_address_i == any_address) begin
      word_q        <= (word_q & ~write_i) | (data_i & write_i);
      was_written_q <= was_written_q | write_i;
    end
    if (read_i) begin
      was_read_q <= read_address_i == any_address ? was_written_q : '0;
      answer_q   <= word_q;
    end
  end
  generate
    if (HAS_MASK != 0) begin : gen_held
      always_comb assert (((gen_masked.memory_q[any_address] ^ word_q) & was_written_q) == '0);
    end
  endgenerate
  always_comb assert (((data_o ^ answer_q) & was_read_q) == '0);
  // Any answer stays.
  logic             stays_q = 1'b0;
  logic [WIDTH-1:0] before_q;
  always_ff @(posedge clk_i) begin
    stays_q  <= !read_i;
    before_q <= data_o;
  end
  always_comb if (stays_q) assert (data_o == before_q);
