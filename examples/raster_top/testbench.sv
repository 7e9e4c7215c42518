// raster_top in a top of one's own: it clears, draws one triangle into a memory that is an array, flushes, and writes the picture
// to +picture=FILE (PPM). No package of test code, no struct: every packet is put together by hand, first field highest, as
// raster_pkg declares it, so that the same file also runs in Icarus on the plain Verilog of raster_top. docs/integrate.md.
`timescale 1ns / 1ps
module testbench;
  localparam int WIDTH = 64, HEIGHT = 48;  // of the target, pixels
  localparam int BYTES = raster_pkg::MEMORY_PORT_BITS / 8;
  localparam int LATENCY = 20;  // cycles from a beat to its answer, at least

  logic clk = 1'b0, rst_n = 1'b0;
  always #5 clk = !clk;

  // ---------------------------------------------------------------------------------------------------------- raster_top
  // Where the buffers lie: the two planes of a tile side by side, tiles in rows, then a bit of flags for each block.
  localparam int PLANE = 1 << raster_pkg::PLANE_SHIFT;  // bytes of a plane of a tile
  localparam int TILE = raster_pkg::TILE_SIZE;
  localparam int STRIDE = 2 * PLANE * ((WIDTH + TILE - 1) / TILE);
  localparam int FLAGS = STRIDE * ((HEIGHT + TILE - 1) / TILE);
  localparam int FLAG_ROWS = ((HEIGHT + 3) / 4) << raster_pkg::FLAG_ROW_SHIFT;
  localparam int BEATS = (FLAGS + 2 * FLAG_ROWS) / BYTES;  // of the memory
  localparam int ADDRESS = raster_pkg::ADDRESS_BITS;
  localparam int LAYOUT = 4 * ADDRESS + raster_pkg::ROW_STRIDE_BITS;
  logic [LAYOUT-1:0] layout;  // bases of depth, colour, flags of depth, flags of colour; from one row of tiles to the next
  assign layout = {ADDRESS'(0), ADDRESS'(PLANE), ADDRESS'(FLAGS), ADDRESS'(FLAGS + FLAG_ROWS), raster_pkg::ROW_STRIDE_BITS'(STRIDE)};

  logic primitive_valid, primitive_ready, line_ready, beat_valid, beat_ready = 1'b0, answer_valid = 1'b0, answer_ready;
  logic texture_valid, texel_ready, idle;
  logic [raster_pkg::PRIMITIVE_PACKET_BITS-1:0] packet;
  logic [raster_pkg::MEMORY_BEAT_BITS-1:0]      beat;
  logic [raster_pkg::MEMORY_ANSWER_BITS-1:0]    answer;
  logic [raster_pkg::TEXTURE_REQUEST_BITS-1:0]  texture;
  logic [raster_pkg::COUNTER_PACKET_BITS-1:0]   counters;
  raster_top dut (
      .clk_i(clk),
      .rst_ni(rst_n),
      .power_on_ni(rst_n),
      .stall_i(raster_pkg::STALL_BITS'(0)),
      .primitive_valid_i(primitive_valid),
      .primitive_ready_o(primitive_ready),
      .primitive_i(packet),
      .line_valid_i(1'b0),
      .line_ready_o(line_ready),
      .line_i(raster_pkg::LINE_SETUP_BITS'(0)),
      .layout_i(layout),
      .beat_valid_o(beat_valid),
      .beat_ready_i(beat_ready),
      .beat_o(beat),
      .answer_valid_i(answer_valid),
      .answer_ready_o(answer_ready),
      .answer_i(answer),
      .texture_valid_o(texture_valid),
      .texture_ready_i(1'b0),
      .texture_o(texture),
      .texel_valid_i(1'b0),
      .texel_ready_o(texel_ready),
      .texel_i(raster_pkg::TEXEL_BEAT_BITS'(0)),
      .counters_hold_i(1'b0),
      .counters_o(counters),
      .idle_o(idle)
  );

  // ---------------------------------------------------------------------------------------------------------- the memory
  // Its rule: each beat that is read is answered, and each burst that was written, once, in the order of the bursts, at any time.
  // A burst that reads is one beat on this port, with the beats to come back as its length.
  logic                               is_write, is_first;
  logic [ADDRESS-1:0]                 address;
  logic [raster_pkg::BURST_LENGTH_BITS-1:0] left;  // beats of the burst, with this one
  logic [BYTES-1:0]                   strobe;
  logic [8*BYTES-1:0]                 data, word;
  assign {is_write, is_first, address, left, strobe, data} = beat;

  logic [8*BYTES-1:0] memory[0:BEATS-1];
  logic [8*BYTES:0]   answers[0:1023];  // what is owed, oldest first: is_write, data
  int                 due[0:1023];      // the cycle in which it may come
  int                 head = 0, tail = 0, cycle = 0, reads = 0, writes = 0;

  always @(posedge clk) begin
    cycle <= cycle + 1;
    beat_ready <= cycle % 7 != 0 && tail - head < 900;  // not always
    if (beat_valid && beat_ready) begin
      if (is_write) begin
        word = memory[int'(address) / BYTES];
        for (int i = 0; i < BYTES; i++) if (strobe[i]) word[8*i+:8] = data[8*i+:8];
        memory[int'(address) / BYTES] = word;
        if (left == 1) owe(1'b1, '0);
        writes <= writes + 1;
      end else begin
        for (int i = 0; i < int'(left); i++) owe(1'b0, memory[int'(address) / BYTES + i]);
        reads <= reads + int'(left);
      end
    end
    if (answer_valid && answer_ready) answer_valid <= 1'b0;
    if ((!answer_valid || answer_ready) && head != tail && due[head%1024] <= cycle) begin
      answer_valid <= 1'b1;
      answer <= answers[head%1024];
      head = head + 1;
    end
  end

  task owe(input logic written, input logic [8*BYTES-1:0] value);
    answers[tail%1024] = {written, value};
    due[tail%1024] = cycle + LATENCY;
    tail = tail + 1;
  endtask

  // ---------------------------------------------------------------------------------------------------------- the drawing
  localparam int GRID = 1 << raster_pkg::GRID_BITS;  // subpixels of a pixel
  localparam int X = raster_pkg::COORDINATE_BITS;
  localparam int CODES = raster_pkg::ALL_CODE_BITS;  // of a vertex: depth lowest, then red, green, blue
  localparam int D = raster_pkg::DEPTH_BITS;
  localparam int PX = raster_pkg::PIXEL_X_BITS, PY = raster_pkg::PIXEL_Y_BITS;

  // The box of all packets: the whole target, last pixel included. A vertex: its codes.
  logic [2*PX+2*PY-1:0] box;
  assign box = {PX'(0), PY'(0), PX'(WIDTH - 1), PY'(HEIGHT - 1)};
  function [CODES-1:0] codes(input [D-1:0] depth, input [7:0] red, input [7:0] green, input [7:0] blue);
    codes = {blue, green, red, depth};
  endfunction

  // A packet: kind, number, box, depth test, writes of depth and colour, cull, front_cw; x and y of vertices 2, 1, 0, their codes.
  localparam logic [2:0] TRIANGLE = 3'd0, FAST_CLEAR = 3'd2, FLUSH = 3'd3;  // raster_pkg::primitive_kind_t
  localparam logic [2:0] LESS = 3'd1, ALWAYS = 3'd7;                        // raster_pkg::depth_func_t
  localparam logic [raster_pkg::PRIMITIVE_ID_BITS-1:0] NUMBER = '0;         // no hardware looks at it
  localparam logic [7:0] RED = 8'd20, GREEN = 8'd20, BLUE = 8'd30;          // of the clear
  int step = 0;  // packets taken
  assign primitive_valid = rst_n && step < 3;
  always_comb
    case (step)
      // The codes of a clear stand at all three vertices. Depth 1.0 is all ones.
      0: packet = {FAST_CLEAR, NUMBER, box, ALWAYS, 2'b11, 3'b0, {6 * X{1'b0}}, {3{codes({D{1'b1}}, RED, GREEN, BLUE)}}};
      // triangle.hpt: (32, 4), (58, 44), (6, 40) in subpixels, depths 0.5, 0.25, 0.75, red, green, blue.
      1: packet = {TRIANGLE, NUMBER, box, LESS, 2'b11, 3'b0,
                   X'(6 * GRID), X'(58 * GRID), X'(32 * GRID), X'(40 * GRID), X'(44 * GRID), X'(4 * GRID),
                   codes(D'((3 << (D - 2)) - 1), 8'd0, 8'd0, 8'd255), codes(D'(1 << (D - 2)), 8'd0, 8'd255, 8'd0),
                   codes(D'(1 << (D - 1)), 8'd255, 8'd0, 8'd0)};
      default: packet = {FLUSH, NUMBER, box, ALWAYS, 2'b00, 3'b0, {6 * X{1'b0}}, {3 * CODES{1'b0}}};
    endcase

  // From the cycle after a flush was taken, idle says that memory has the picture.
  always @(posedge clk) begin
    if (primitive_valid && primitive_ready) step <= step + 1;
    if (step == 3 && idle) begin
      if ($isunknown(counters)) $display("no picture: a counter is undefined");  // seen by simulators with four states
      else write_picture();
      $display("%0d cycles, %0d beats read, %0d written", cycle, reads, writes);
      $finish;
    end
    if (cycle == 1_000_000) begin
      $display("no picture after a million cycles");
      $finish;
    end
  end

  initial begin
    for (int i = 0; i < BEATS; i++) memory[i] = {BYTES{8'ha5}};
    repeat (4) @(negedge clk);
    rst_n = 1'b1;
  end

  // ---------------------------------------------------------------------------------------------------------- the picture
  function [7:0] byte_of(input int at);
    word = memory[at/BYTES];
    byte_of = word[8*(at%BYTES)+:8];
  endfunction

  // Of a tile: blocks row by row, in each its stamps, in each its pixels; rgb565, lowest byte first. (With the cache of tiles a tile
  // is one block.) A block whose flag is set has the colour of the clear (frame.clears=flags; otherwise the flush wrote that).
  // Codes are rounded to 5 and 6 bits.
  logic [15:0] cleared;
  assign cleared = {5'((int'(RED) * 249 + 1014) >> 11), 6'((int'(GREEN) * 253 + 505) >> 10), 5'((int'(BLUE) * 249 + 1014) >> 11)};
  function [15:0] pixel(input int x, input int y);
    int stamp, block, place, at;
    stamp = raster_pkg::STAMP_SIZE;
    block = raster_pkg::BLOCK_SIDE * stamp;
    place = ((y % TILE / block) * (TILE / block) + x % TILE / block) * block * block +
            ((y % block / stamp) * (block / stamp) + x % block / stamp) * stamp * stamp + y % stamp * stamp + x % stamp;
    at = PLANE + y / TILE * STRIDE + x / TILE * 2 * PLANE + 2 * place;
    pixel = {byte_of(at + 1), byte_of(at)};
    at = FLAGS + FLAG_ROWS + ((y / block) << raster_pkg::FLAG_ROW_SHIFT) + x / block / 8;
    if (raster_pkg::FRAME_CLEARS == 1 && byte_of(at) >> x / block % 8 & 1'b1) pixel = cleared;
  endfunction

  task write_picture;
    string name;
    int file;
    logic [15:0] code;
    if ($value$plusargs("picture=%s", name) == 0) name = "picture.ppm";
    file = $fopen(name, "wb");
    $fwrite(file, "P6\n%0d %0d\n255\n", WIDTH, HEIGHT);
    for (int y = 0; y < HEIGHT; y++)
      for (int x = 0; x < WIDTH; x++) begin
        code = pixel(x, y);
        $fwrite(file, "%c%c%c", {code[15:11], code[15:13]}, {code[10:5], code[10:9]}, {code[4:0], code[4:2]});
      end
    $fclose(file);
  endtask
endmodule
