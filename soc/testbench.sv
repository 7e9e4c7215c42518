// The system with a clock, a reset and a display: every picture that differs from the previous one is written to picture_N.ppm.
// A picture of two frames (torn) would be one of them. +pictures=N: ends after so many; +cycles=N: and after these in any case.
`timescale 1ns / 1ps
module testbench;
  logic clk = 1'b0, reset = 1'b1;
  always #10 clk = !clk;

  logic [23:0] data;
  logic        valid, ready = 1'b0, last, user;
  soc dut (
      .clk       (clk),
      .reset     (reset),
      .sim_trace (1'b0),
      .video_data(data),
      .video_valid(valid),
      .video_ready(ready),
      .video_last(last),
      .video_user(user)
  );

  localparam int MOST = 1 << 20;  // pixels of a picture
  logic [23:0] pixels[0:MOST-1];
  logic [63:0] hash, shown = '0;
  int pictures, scanned = 0, width, column, count = 0, file, cycle = 0, limit, written = 0;
  string name;

  initial begin
    if ($value$plusargs("pictures=%d", pictures) == 0) pictures = 3;
    if ($value$plusargs("cycles=%d", limit) == 0) limit = 5_000_000;
    if ($value$plusargs("width=%d", width) == 0) width = 96;
  end

  // A pixel is taken every eighth cycle: the display leaves the bus to the others.
  always @(posedge clk) begin
    cycle <= cycle + 1;
    reset <= cycle < 10;
    ready <= cycle % 8 == 0;
    if (valid && ready) begin
      if (user) begin  // the first pixel: the picture before it is complete
        if (count != 0) finish_picture();
        count = 0;
        column = 0;
        hash = 64'd14695981039346656037;
      end
      if (count < MOST) pixels[count] = data;
      count = count + 1;
      column = column + 1;
      hash = (hash ^ 64'(data)) * 64'd1099511628211;
      if (last && column != width) $display("a line of %0d pixels", column);
      if (last) column = 0;
    end
    if (written == pictures || cycle == limit) begin
      $display("%0d pictures, %0d scanned, %0d cycles", written, scanned, cycle);
      $finish;
    end
  end

  task finish_picture;
    scanned = scanned + 1;
    if (hash != shown) begin
      $sformat(name, "picture_%0d.ppm", written);
      file = $fopen(name, "wb");
      $fwrite(file, "P6\n%0d %0d\n255\n", width, count / width);
      for (int i = 0; i < count; i++) $fwrite(file, "%c%c%c", pixels[i][23:16], pixels[i][15:8], pixels[i][7:0]);
      $fclose(file);
      $display("cycle %0d: picture %0d", cycle, written);
      shown = hash;
      written = written + 1;
    end
  endtask
endmodule
