// Checks both sides of an AXI4 port of the core: the core's requests, and the memory's answers. Simulation only:
//
//   bind halfplane_core axi_protocol_checker #(.PORT_BITS(64)) u_axi_protocol_checker (.*);
//
// A broken rule is an assertion that fails, with a message. Rules are those of AXI4 for one ID, and those of the core:
// bursts of at most LONGEST whole beats that do not cross 4 KB. Verilator wants --assert.
module axi_protocol_checker #(
    parameter int PORT_BITS = 64,
    parameter int LONGEST = 16  // beats
) (
    input logic clk_i,
    input logic rst_ni,

    input logic                   m_axi_awvalid,
    input logic                   m_axi_awready,
    input logic [31:0]            m_axi_awaddr,
    input logic [7:0]             m_axi_awlen,
    input logic [2:0]             m_axi_awsize,
    input logic [1:0]             m_axi_awburst,
    input logic                   m_axi_wvalid,
    input logic                   m_axi_wready,
    input logic [PORT_BITS-1:0]   m_axi_wdata,
    input logic [PORT_BITS/8-1:0] m_axi_wstrb,
    input logic                   m_axi_wlast,
    input logic                   m_axi_bvalid,
    input logic                   m_axi_bready,
    input logic [1:0]             m_axi_bresp,
    input logic                   m_axi_arvalid,
    input logic                   m_axi_arready,
    input logic [31:0]            m_axi_araddr,
    input logic [7:0]             m_axi_arlen,
    input logic [2:0]             m_axi_arsize,
    input logic [1:0]             m_axi_arburst,
    input logic                   m_axi_rvalid,
    input logic                   m_axi_rready,
    input logic [PORT_BITS-1:0]   m_axi_rdata,
    input logic                   m_axi_rlast,
    input logic [1:0]             m_axi_rresp
);

  /* verilator coverage_off */  // of the design alone
  localparam int BYTES = PORT_BITS / 8;
  localparam bit [2:0] SIZE = 3'($clog2(BYTES));

  // Items offered and not taken in the previous cycle.
  logic                           aw_waits_q, w_waits_q, b_waits_q, ar_waits_q, r_waits_q;
  logic [39:0]                    aw_q, ar_q;
  logic [PORT_BITS+PORT_BITS/8:0] w_q;
  logic [1:0]                     b_q;
  logic [PORT_BITS+2:0]           r_q;

  int aw_lengths[$];  // lengths of addresses whose data have not ended
  int w_lengths[$];   // lengths of data whose address has not come
  int ar_lengths[$];  // lengths of reads without their last beat
  int beats;    // beats of the write burst in flight
  int read;     // beats of the read that is answered
  int written;  // write bursts, address and data, without B

  function static bit is_whole(input logic [31:0] address, input logic [7:0] length);
    return address % BYTES == 0 && int'(length) < LONGEST && int'(address[11:0]) + (int'(length) + 1) * BYTES <= 4096;
  endfunction

  function static void forget();
    aw_lengths.delete();
    w_lengths.delete();
    ar_lengths.delete();
    beats   = 0;
    read    = 0;
    written = 0;
  endfunction

  // wlast comes at the beat that awlen says, whichever is first. B belongs to a burst whose address and last beat were
  // taken in earlier cycles.
  function static void check_writes();
    assert (!m_axi_bvalid || written > 0)
    else $error("axi: memory gave B without a write that waits for it");
    if (m_axi_bvalid && m_axi_bready) written = written - 1;
    if (m_axi_awvalid && m_axi_awready) aw_lengths.push_back(int'(m_axi_awlen) + 1);
    if (m_axi_wvalid && m_axi_wready) begin
      beats = beats + 1;
      if (m_axi_wlast) begin
        w_lengths.push_back(beats);
        beats = 0;
      end
    end
    if (aw_lengths.size() > 0 && w_lengths.size() > 0) begin
      assert (aw_lengths[0] == w_lengths[0])
      else $error("axi: wlast at beat %0d of a burst of %0d", w_lengths[0], aw_lengths[0]);
      void'(aw_lengths.pop_front());
      void'(w_lengths.pop_front());
      written = written + 1;
    end
    assert (aw_lengths.size() == 0 || beats < aw_lengths[0])
    else $error("axi: no wlast at beat %0d, the burst's last", beats);
  endfunction

  // Reads are answered in order, with rlast at the beat that arlen says, not in the cycle of the address.
  function static void check_reads();
    assert (!m_axi_rvalid || ar_lengths.size() > 0)
    else $error("axi: memory gave R without a read that waits for it");
    if (m_axi_rvalid && ar_lengths.size() > 0) begin
      assert (m_axi_rlast == (read + 1 == ar_lengths[0]))
      else $error("axi: memory's rlast is wrong at beat %0d of %0d", read + 1, ar_lengths[0]);
      if (m_axi_rready) begin
        read = read + 1;
        if (m_axi_rlast) begin
          read = 0;
          void'(ar_lengths.pop_front());
        end
      end
    end
    if (m_axi_arvalid && m_axi_arready) ar_lengths.push_back(int'(m_axi_arlen) + 1);
  endfunction

  always @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      {aw_waits_q, w_waits_q, b_waits_q, ar_waits_q, r_waits_q} <= '0;
      forget();
    end else begin
      aw_waits_q <= m_axi_awvalid && !m_axi_awready;
      w_waits_q  <= m_axi_wvalid && !m_axi_wready;
      b_waits_q  <= m_axi_bvalid && !m_axi_bready;
      ar_waits_q <= m_axi_arvalid && !m_axi_arready;
      r_waits_q  <= m_axi_rvalid && !m_axi_rready;
      aw_q <= {m_axi_awaddr, m_axi_awlen};
      ar_q <= {m_axi_araddr, m_axi_arlen};
      w_q  <= {m_axi_wlast, m_axi_wstrb, m_axi_wdata};
      b_q  <= m_axi_bresp;
      r_q  <= {m_axi_rresp, m_axi_rlast, m_axi_rdata};

      // An offer stays until it is taken.
      assert (!aw_waits_q || (m_axi_awvalid && aw_q == {m_axi_awaddr, m_axi_awlen}))
      else $error("axi: AW was taken back or changed before awready");
      assert (!ar_waits_q || (m_axi_arvalid && ar_q == {m_axi_araddr, m_axi_arlen}))
      else $error("axi: AR was taken back or changed before arready");
      assert (!w_waits_q || (m_axi_wvalid && w_q == {m_axi_wlast, m_axi_wstrb, m_axi_wdata}))
      else $error("axi: W was taken back or changed before wready");
      assert (!b_waits_q || (m_axi_bvalid && b_q == m_axi_bresp))
      else $error("axi: memory took B back or changed it before bready");
      assert (!r_waits_q || (m_axi_rvalid && r_q == {m_axi_rresp, m_axi_rlast, m_axi_rdata}))
      else $error("axi: memory took R back or changed it before rready");

      // Addresses.
      assert (!m_axi_awvalid || (is_whole(m_axi_awaddr, m_axi_awlen) && m_axi_awsize == SIZE && m_axi_awburst == 2'd1))
      else
        $error("axi: AW %h of %0d beats is not aligned, too long, over 4 KB, or not INCR of whole beats", m_axi_awaddr,
                  int'(m_axi_awlen) + 1);
      assert (!m_axi_arvalid || (is_whole(m_axi_araddr, m_axi_arlen) && m_axi_arsize == SIZE && m_axi_arburst == 2'd1))
      else
        $error("axi: AR %h of %0d beats is not aligned, too long, over 4 KB, or not INCR of whole beats", m_axi_araddr,
                  int'(m_axi_arlen) + 1);

      check_writes();
      check_reads();
    end
  end
  always @(posedge clk_i)
    assert (rst_ni || !(m_axi_awvalid || m_axi_wvalid || m_axi_arvalid))
    else $error("axi: valid during reset");

endmodule
