// Checks a channel with valid and ready: what is on offer stays as it is until it is taken. With LINES it is video (tuser is
// the first pixel of a frame, tlast the last one of a line): the first pixel begins a frame, a frame begins after the end of a
// line, its lines have one length. How many lines it has is not checked. Simulation only:
//
//   bind halfplane_core axi_stream_protocol_checker #(.NAME("m_axis_video"), .BITS(26), .LINES(1)) u_video_checker (
//       .clk_i, .rst_ni, .valid(m_axis_video_tvalid), .ready(m_axis_video_tready),
//       .data({m_axis_video_tuser, m_axis_video_tlast, m_axis_video_tdata}));
//
// A broken rule is an assertion that fails, with a message.
module axi_stream_protocol_checker #(
    parameter     NAME = "stream",
    parameter int BITS = 32,
    parameter bit LINES = 0         // data's highest bits are tuser and tlast
) (
    input logic            clk_i,
    input logic            rst_ni,
    input logic            valid,
    input logic            ready,
    input logic [BITS-1:0] data
);

  /* verilator coverage_off */  // of the design alone
  logic            waits_q;
  logic [BITS-1:0] data_q;
  always @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) waits_q <= 1'b0;
    else begin
      waits_q <= valid && !ready;
      data_q  <= data;
      assert (!waits_q || (valid && data == data_q))
      else $error("%s: an item was taken back or changed before ready", NAME);
    end
  end

  if (LINES) begin : g_lines
    logic is_first, is_last, has_begun, has_ended;
    int   pixels, width;  // of the line under way; of the frame's lines before it, 0: none
    assign {is_first, is_last} = data[BITS-1-:2];
    always @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) begin
        has_begun = 1'b0;
        has_ended = 1'b1;
        pixels    = 0;
        width     = 0;
      end else if (valid && ready) begin
        assert (has_begun || is_first)
        else $error("%s: the first pixel does not begin a frame", NAME);
        has_begun = 1'b1;
        if (is_first) begin
          assert (has_ended)
          else $error("%s: a frame begins within a line", NAME);
          width = 0;
        end
        pixels    = pixels + 1;
        has_ended = is_last;
        if (is_last) begin
          assert (width == 0 || pixels == width)
          else $error("%s: a line of %0d pixels in a frame of %0d", NAME, pixels, width);
          width  = pixels;
          pixels = 0;
        end
      end
    end
  end

endmodule
