// Texture port: requests of raster_top's texture unit as AXI reads, to an arbiter or to a master of their own.
//
// texture_base_i is added to each address. Lines of up to 64 bytes are cut where an aligned window of 16 beats ends.
// raster_top takes texels as they come, so no other client of the same R channel waits for it.
//
// Reset: as in axi_frame_port.sv. After forget_i no request is taken until memory has answered everything.
module axi_texture_port #(
    // Bits of the count of beats without an answer: at most 2 to that power, less 64
    parameter int UNDER_WAY = 10
) (
    input logic clk_i,
    input logic rst_ni,    // synchronised (reset_sync)
    input logic forget_i,  // a pulse; raster_top's power_on_ni comes with it

    input logic [31:0] texture_base_i,  // stays while anything is under way

    // From and to raster_top
    input  logic                         texture_valid_i,
    output logic                         texture_ready_o,
    input  raster_pkg::texture_request_t texture_i,
    output logic                         texel_valid_o,
    input  logic                         texel_ready_i,
    output raster_pkg::texel_beat_t      texel_o,

    // Reads
    output logic                                     texture_arvalid,
    input  logic                                     texture_arready,
    output logic [31:0]                              texture_araddr,
    output logic [7:0]                               texture_arlen,
    input  logic                                     texture_rvalid,
    output logic                                     texture_rready,
    input  logic [raster_pkg::TEXTURE_PORT_BITS-1:0] texture_rdata,
    input  logic                                     texture_rerror,

    input  logic clear_errors_i,
    output logic read_error_o,  // a read was answered with SLVERR or DECERR, since reset or clear_errors_i
    output logic idle_o         // memory has answered everything
);

  logic                 forgets_q, split_valid, split_ready, request_ready, asks, answers, has_room;
  logic [UNDER_WAY-1:0] beats_q;  // asked for and not answered

  assign has_room        = beats_q[UNDER_WAY-1:6] != '1;
  assign texture_ready_o = request_ready && !forgets_q && !forget_i;
  burst_split #(
      .SHIFT  ($clog2(raster_pkg::TEXTURE_PORT_BITS / 8)),
      .BEATS  (raster_pkg::TEXTURE_BEATS_BITS),
      .LONGEST(512 / raster_pkg::TEXTURE_PORT_BITS)
  ) u_split (
      .clk_i,
      .rst_ni,
      .valid_i  (texture_valid_i && !forgets_q && !forget_i),
      .ready_o  (request_ready),
      .address_i(32'(texture_i.address) + texture_base_i),
      .beats_i  (texture_i.beats),
      .valid_o  (split_valid),
      .ready_i  (split_ready),
      .address_o(texture_araddr),
      .length_o (texture_arlen)
  );
  assign texture_arvalid = split_valid && has_room;
  assign split_ready     = texture_arready && has_room;
  assign asks            = texture_arvalid && texture_arready;

  assign texture_rready = texel_ready_i || forgets_q;
  assign texel_valid_o  = texture_rvalid && !forgets_q;
  assign texel_o.data   = texture_rdata;
  assign answers        = texture_rvalid && texture_rready;
  assign idle_o         = !split_valid && beats_q == '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      beats_q      <= '0;
      forgets_q    <= 1'b0;
      read_error_o <= 1'b0;
    end else begin
      beats_q      <= beats_q + (asks ? UNDER_WAY'(texture_arlen) + 1'b1 : '0) - UNDER_WAY'(answers);
      forgets_q    <= forget_i || (forgets_q && !idle_o);
      read_error_o <= (answers && texture_rerror) || (read_error_o && !clear_errors_i);
    end
  end

endmodule
