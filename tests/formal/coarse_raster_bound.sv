
  // The RAM is cut out; what it gave stays until the next read: sram_word.
  generate
    if (HIZ > 0) begin : gen_proof_bound
      logic [HIZ-1:0] before_q;
      logic           stays_q;
      always_ff @(posedge clk_i) begin
        before_q <= gen_hiz.bound;
        stays_q  <= state_q != WALK;
      end
      always_comb if (runs_q && stays_q) assume (gen_hiz.bound == before_q);
    end
  endgenerate
