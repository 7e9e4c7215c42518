// halfplane_core in a top of one's own: words of the driver in a ring, the least memory that AXI allows, registers written
// one by one, the interrupt of the fence, and a display that writes the picture to +picture=FILE (PPM). +words=FILE: the
// words, a line of hexadecimal digits each. The same file runs in Icarus on the plain Verilog of halfplane_core.
// docs/integrate.md.
`timescale 1ns / 1ps
module testbench;
  localparam int WIDTH = 320, HEIGHT = 240;  // of the target, pixels: driver/example/triangle.c
  localparam int BYTES = raster_pkg::MEMORY_PORT_BITS / 8;
  localparam int MEMORY = 1 << 20;      // bytes, from address 0 on
  localparam int RING = 'h80000;        // a multiple of the ring's size
  localparam int RING_WORDS = 256;
  localparam int LATENCY = 10;          // cycles from an address to the first beat or the answer

  logic clk = 1'b0, rst_n = 1'b0;
  always #5 clk = !clk;

  // -------------------------------------------------------------------------------------------------------------- the core
  logic [6:0] awaddr, araddr;
  logic [31:0] wdata, rdata;
  logic awvalid = 1'b0, awready, wvalid = 1'b0, wready, arvalid = 1'b0, arready, rvalid, irq;
  logic m_awvalid, m_awready, m_wlast, m_wvalid, m_wready, m_bvalid = 1'b0, m_bready;
  logic m_arvalid, m_arready, m_rlast, m_rvalid, m_rready;
  logic [31:0] m_awaddr, m_araddr;
  logic [7:0] m_awlen, m_arlen;
  logic [BYTES-1:0] m_wstrb;
  logic [8*BYTES-1:0] m_wdata, m_rdata;
  logic [23:0] pixel;
  logic pixel_valid, pixel_ready = 1'b0, ends_line, begins_frame;
  // Not connected: outputs that say the same in every burst (ID, size, burst, lock, cache, prot), and responses to registers.
  // An input that nothing drives is 0.
  halfplane_core dut (
      .clk_i(clk), .rst_ni(rst_n),
      .s_axil_awaddr(awaddr), .s_axil_awprot(3'd0), .s_axil_awvalid(awvalid), .s_axil_awready(awready),
      .s_axil_wdata(wdata), .s_axil_wstrb(4'hf), .s_axil_wvalid(wvalid), .s_axil_wready(wready), .s_axil_bready(1'b1),
      .s_axil_araddr(araddr), .s_axil_arprot(3'd0), .s_axil_arvalid(arvalid), .s_axil_arready(arready),
      .s_axil_rdata(rdata), .s_axil_rvalid(rvalid), .s_axil_rready(1'b1), .irq(irq),
      .s_axis_tdata(32'd0), .s_axis_tvalid(1'b0),  // RING = 1
      .m_axi_awaddr(m_awaddr), .m_axi_awlen(m_awlen), .m_axi_awvalid(m_awvalid), .m_axi_awready(m_awready),
      .m_axi_wdata(m_wdata), .m_axi_wstrb(m_wstrb), .m_axi_wlast(m_wlast), .m_axi_wvalid(m_wvalid), .m_axi_wready(m_wready),
      .m_axi_bid(1'b0), .m_axi_bresp(2'd0), .m_axi_bvalid(m_bvalid), .m_axi_bready(m_bready),
      .m_axi_araddr(m_araddr), .m_axi_arlen(m_arlen), .m_axi_arvalid(m_arvalid), .m_axi_arready(m_arready),
      .m_axi_rid(1'b0), .m_axi_rdata(m_rdata), .m_axi_rresp(2'd0), .m_axi_rlast(m_rlast), .m_axi_rvalid(m_rvalid),
      .m_axi_rready(m_rready),
      .m_axi_texture_arready(1'b0), .m_axi_texture_rid(1'b0), .m_axi_texture_rdata(raster_pkg::TEXTURE_PORT_BITS'(0)),
      .m_axi_texture_rresp(2'd0), .m_axi_texture_rlast(1'b0), .m_axi_texture_rvalid(1'b0),  // TEXTURE_MASTER = 0
      .m_axis_video_tdata(pixel), .m_axis_video_tvalid(pixel_valid), .m_axis_video_tready(pixel_ready),
      .m_axis_video_tlast(ends_line), .m_axis_video_tuser(begins_frame)
  );

  // ------------------------------------------------------------------------------------------------------------ the memory
  // One burst at a time in each direction. Bytes without a strobe keep what they are.
  logic [8*BYTES-1:0] memory[0:MEMORY/BYTES-1];
  logic [8*BYTES-1:0] word;
  logic is_writing = 1'b0, is_reading = 1'b0;
  int write_at, read_at, read_left, waited;
  assign m_awready = !is_writing && !m_bvalid;
  assign m_wready  = is_writing;
  assign m_arready = !is_reading;
  assign m_rvalid  = is_reading && waited == LATENCY;
  assign m_rdata   = memory[read_at];
  assign m_rlast   = read_left == 0;

  always @(posedge clk) begin
    if (m_awvalid && m_awready) begin
      is_writing <= 1'b1;
      write_at   <= int'(m_awaddr % MEMORY) / BYTES;
    end
    if (m_wvalid && m_wready) begin
      word = memory[write_at];
      for (int i = 0; i < BYTES; i++) if (m_wstrb[i]) word[8*i+:8] = m_wdata[8*i+:8];
      memory[write_at] = word;
      write_at <= write_at + 1;
      if (m_wlast) is_writing <= 1'b0;
    end
    if (m_wvalid && m_wready && m_wlast) m_bvalid <= 1'b1;
    else if (m_bready) m_bvalid <= 1'b0;

    if (m_arvalid && m_arready) begin
      is_reading <= 1'b1;
      read_at    <= int'(m_araddr % MEMORY) / BYTES;
      read_left  <= int'(m_arlen);
      waited     <= 0;
    end else if (is_reading && waited != LATENCY) begin
      waited <= waited + 1;
    end
    if (m_rvalid && m_rready) begin
      read_at   <= read_at + 1;
      read_left <= read_left - 1;
      if (m_rlast) is_reading <= 1'b0;
    end
  end

  task put(input int address, input logic [31:0] value);  // of the processor, into the ring
    for (int i = 0; i < 4; i++) begin
      word = memory[(address+i)/BYTES];
      word[8*((address+i)%BYTES)+:8] = value[8*i+:8];
      memory[(address+i)/BYTES] = word;
    end
  endtask

  // --------------------------------------------------------------------------------------------------------- the processor
  localparam logic [6:0] CONFIG_ID_LOW = 7'h08, CONTROL = 7'h20, STATUS = 7'h24, IRQ_ENABLE = 7'h28, IRQ_PENDING = 7'h2c,
      FENCE = 7'h30, WORDS = 7'h38, RING_BASE = 7'h40, RING_SIZE = 7'h44, RING_TAIL = 7'h4c, SCAN_CONTROL = 7'h60,
      SCAN_SIZE = 7'h64, SCAN_STRIDE = 7'h68;

  // Inputs change at the falling edge.
  task write(input logic [6:0] address, input logic [31:0] value);
    awaddr = address;
    wdata = value;
    awvalid = 1'b1;
    wvalid = 1'b1;
    #1;
    while (!awready || !wready) @(negedge clk);  // the core takes both together
    @(negedge clk);
    awvalid = 1'b0;
    wvalid = 1'b0;
  endtask

  task read(input logic [6:0] address, output logic [31:0] value);
    araddr = address;
    arvalid = 1'b1;
    #1;
    while (!arready) @(negedge clk);
    @(negedge clk);
    arvalid = 1'b0;
    while (!rvalid) @(negedge clk);
    value = rdata;
  endtask

  string name;
  int words, count = 0, cycles = 0;
  logic [31:0] value;
  initial begin
    repeat (4) @(negedge clk);
    rst_n = 1'b1;
    read(CONFIG_ID_LOW, value);
    if (value != raster_pkg::CONFIG_ID[31:0]) $display("the core is of another configuration");
    if ($value$plusargs("words=%s", name) == 0) name = "words.hex";
    words = $fopen(name, "r");
    while ($fscanf(words, "%h", value) == 1) begin  // RING_WORDS of them at most: nothing waits for room here
      put(RING + 4 * count, value);
      count = count + 1;
    end
    write(RING_BASE, RING);
    write(RING_SIZE, RING_WORDS - 1);
    write(IRQ_ENABLE, 32'h1);  // fence
    write(SCAN_SIZE, (HEIGHT - 1) << 16 | (WIDTH - 1));
    write(SCAN_STRIDE, (2 << raster_pkg::PLANE_SHIFT) * ((WIDTH + raster_pkg::TILE_SIZE - 1) / raster_pkg::TILE_SIZE));
    write(CONTROL, 32'h1);  // start
    write(RING_TAIL, count);
    while (!irq) @(negedge clk);
    write(IRQ_PENDING, 32'h1);
    read(FENCE, value);
    $display("fence %0d after %0d cycles, %0d words", value, cycles, count);
    value = 32'h1;  // running: the stream ends with STOP, after PRESENT, which is taken at once while scan-out is off
    while (value[0]) read(STATUS, value);
    write(SCAN_CONTROL, 32'h1);
    pixel_ready = 1'b1;
  end

  // ----------------------------------------------------------------------------------------------------------- the display
  int file, pixels = 0;
  always @(posedge clk) begin
    cycles <= cycles + 1;
    if (pixel_valid && pixel_ready) begin
      if (begins_frame) begin
        if ($value$plusargs("picture=%s", name) == 0) name = "picture.ppm";
        file = $fopen(name, "wb");
        $fwrite(file, "P6\n%0d %0d\n255\n", WIDTH, HEIGHT);
      end
      $fwrite(file, "%c%c%c", pixel[23:16], pixel[15:8], pixel[7:0]);
      pixels = pixels + 1;
      if (pixels == WIDTH * HEIGHT) begin
        $fclose(file);
        $display("picture after %0d cycles", cycles);
        $finish;
      end
    end
    if (cycles == 1_000_000) begin
      $display("no picture after a million cycles");
      $finish;
    end
  end
endmodule
