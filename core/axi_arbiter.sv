// Several clients that read, and one AXI4 read channel. The client with the lowest number is served first.
//
// Clients: 0 scan-out, which must not wait; then frame, textures, command ring. No client starves for good: scan-out
// asks at the rate of the display, and frame and textures stop asking when the pipeline has no more commands.
// Arrays are flat, client 0 lowest. Data, last and error are shared by all clients; valid names the client.
//
// An address on offer stays on offer. Every burst has ID 0, so answers come in the order of the bursts; a queue has the
// client of each. A client that is not ready holds back all others: each should request only items that it has room for.
module axi_arbiter #(
    parameter int CLIENTS = 2,     // 2 at least
    parameter int PORT_BITS = 64,  // data of a beat
    parameter int BURSTS = 32      // without an answer, at most: a power of two
) (
    input logic clk_i,
    input logic rst_ni,  // synchronised (reset_sync)

    input  logic [CLIENTS-1:0]    s_arvalid,
    output logic [CLIENTS-1:0]    s_arready,
    input  logic [32*CLIENTS-1:0] s_araddr,
    input  logic [8*CLIENTS-1:0]  s_arlen,
    output logic [CLIENTS-1:0]    s_rvalid,
    input  logic [CLIENTS-1:0]    s_rready,
    output logic [PORT_BITS-1:0]  s_rdata,
    output logic                  s_rlast,
    output logic                  s_rerror,

    output logic                 m_axi_arvalid,
    input  logic                 m_axi_arready,
    output logic [31:0]          m_axi_araddr,
    output logic [7:0]           m_axi_arlen,
    input  logic                 m_axi_rvalid,
    output logic                 m_axi_rready,
    input  logic [PORT_BITS-1:0] m_axi_rdata,
    input  logic                 m_axi_rlast,
    input  logic [1:0]           m_axi_rresp,

    output logic idle_o  // every burst has been answered
);

  localparam int CLIENT = $clog2(CLIENTS);

  logic              waits_q;  // an address is on offer, of client client_q
  logic [CLIENT-1:0] client, client_q, answered;
  logic              has_room, is_answered;
  always_comb begin
    client = client_q;
    if (!waits_q) begin
      client = CLIENT'(CLIENTS - 1);
      for (int i = CLIENTS - 2; i >= 0; i--) if (s_arvalid[i]) client = CLIENT'(i);
    end
  end

  assign m_axi_arvalid = s_arvalid[client] && has_room;
  assign m_axi_araddr  = s_araddr[32*client+:32];
  assign m_axi_arlen   = s_arlen[8*client+:8];
  assign s_arready     = CLIENTS'(m_axi_arready && has_room) << client;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) waits_q <= 1'b0;
    else waits_q <= m_axi_arvalid && !m_axi_arready;
  end
  always_ff @(posedge clk_i) client_q <= client;

  logic is_under_way;
  fifo #(
      .WIDTH(CLIENT),
      .DEPTH(BURSTS)
  ) u_bursts (
      .clk_i,
      .rst_ni,
      .valid_i(m_axi_arvalid && m_axi_arready),
      .ready_o(has_room),
      .data_i (client),
      .valid_o(is_under_way),
      .ready_i(is_answered),
      .data_o (answered)
  );
  assign is_answered  = m_axi_rvalid && m_axi_rready && m_axi_rlast;
  // `answered` is undefined while no burst is under way: no port may be.
  assign m_axi_rready = is_under_way && s_rready[answered];
  assign s_rvalid     = {CLIENTS{m_axi_rvalid}} & (CLIENTS'(1) << answered);
  assign s_rdata      = m_axi_rdata;
  assign s_rlast      = m_axi_rlast;
  assign s_rerror     = m_axi_rresp[1];
  assign idle_o       = !is_under_way;

endmodule
