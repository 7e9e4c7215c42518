
  // An arbitrary word: a read gives the last write of an earlier cycle, and the answer stays until the next read.
  (* anyconst *) logic [ADDRESS-1:0] any_address;
  always_comb assume (32'(any_address) < DEPTH && 32'(read_address_i) < DEPTH && 32'(write_address_i) < DEPTH);
  logic             was_written_q = 1'b0, was_read_q = 1'b0;
  logic [WIDTH-1:0] word_q, answer_q;
  always_ff @(posedge clk_i) begin
    if (write_i && write_address_i == any_address) begin
      word_q        <= data_i;
      was_written_q <= 1'b1;
    end
    if (read_i) begin
      was_read_q <= read_address_i == any_address && was_written_q;
      answer_q   <= word_q;
    end
  end
  logic [WIDTH-1:0] held;
  generate
    if (DEPTH > WHOLE && HIGH <= LOW / 8) begin : gen_held_in_parts
      assign held = any_address[ADDRESS-1] ? gen_parts.high_q[any_address[HIGH_ADDRESS-1:0]] : gen_parts.low_q[any_address[ADDRESS-2:0]];
    end else begin : gen_held
      assign held = gen_whole.memory_q[any_address];
    end
  endgenerate
  always_comb begin
    if (was_written_q) assert (held == word_q);
    if (was_read_q) assert (data_o == answer_q);
  end
  // Any answer stays.
  logic             stays_q = 1'b0;
  logic [WIDTH-1:0] before_q;
  always_ff @(posedge clk_i) begin
    stays_q  <= !read_i;
    before_q <= data_o;
  end
  always_comb if (stays_q) assert (data_o == before_q);
