// Checks the behaviour of raster_top's host on its ports. Simulation only, bound from outside:
//
//   bind raster_top primitive_stream_checker u_primitive_stream_checker (.*);
//
// A broken rule is an assertion that fails, with a message: the error, the primitive's number in the stream, the packet to send
// instead. Primitives are counted from reset, the first is 0. Verilator wants --assert.
//
// A test bench waits for is_written before it reads the picture from memory. idle_o alone is not enough: pixels drawn
// since the last flush may still be on the chip.
module primitive_stream_checker (
    input logic clk_i,
    input logic rst_ni,

    // From the host, as in raster_top
    input logic                          primitive_valid_i,
    input logic                          primitive_ready_o,
    input raster_pkg::primitive_packet_t primitive_i,
    input logic                          line_valid_i,
    input logic                          line_ready_o,
    input raster_pkg::line_setup_t       line_i,
    input raster_pkg::memory_layout_t    layout_i,
    input logic                          idle_o
);

  /* verilator coverage_off */  // of the design alone
  localparam bit HAS_BLOCKS = raster_pkg::CACHE_KIND == 1;
  localparam bit HAS_TEXTURE = raster_pkg::COORDINATES != 0;
  localparam bit HAS_STENCIL = raster_pkg::STENCIL_BITS != 0;
  localparam bit HAS_ALPHA = raster_pkg::ALPHA_UNIT != 0 && HAS_BLOCKS && raster_pkg::SETUP_KIND == 0;
  localparam bit HAS_OPS = raster_pkg::BLEND_LANES != 0 || raster_pkg::DITHER_UNIT != 0;
  // By the number of a unit's register (state_register_t): whether the unit is there.
  localparam logic [7:0] UNIT_REGISTERS = {HAS_STENCIL, HAS_ALPHA, {2{HAS_OPS}}, HAS_STENCIL, {3{HAS_TEXTURE}}};

  logic [63:0] taken_q;      // primitives, of all kinds
  logic [63:0] unwritten_q;  // primitives since the last flush; states write nothing
  logic        has_target_q;
  logic [raster_pkg::PIXEL_X_BITS-1:0] last_x_q;  // of the target: the last fast clear of both buffers
  logic [raster_pkg::PIXEL_Y_BITS-1:0] last_y_q;

  logic takes, is_state, is_clear, is_flush, is_bin, clears_both, has_known_kind;
  assign takes       = primitive_valid_i && primitive_ready_o;
  assign is_state    = primitive_i.kind == raster_pkg::PRIMITIVE_KIND_STATE;
  assign is_clear    = primitive_i.kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR;
  assign is_flush    = primitive_i.kind == raster_pkg::PRIMITIVE_KIND_FLUSH;
  assign is_bin      = is_clear && primitive_i.state.depth_test == raster_pkg::DEPTH_FUNC_EQUAL;
  assign clears_both = is_clear && !is_bin && primitive_i.state.depth_write && primitive_i.state.color_write;
  assign has_known_kind =
      primitive_i.kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE || primitive_i.kind == raster_pkg::PRIMITIVE_KIND_RECTANGLE ||
      primitive_i.kind == raster_pkg::PRIMITIVE_KIND_POINT || is_clear || is_flush || is_state ||
      (primitive_i.kind == raster_pkg::PRIMITIVE_KIND_LINE && raster_pkg::LINES_UNIT != 0);

  // Everything taken in earlier cycles is in memory.
  logic is_written;
  assign is_written = idle_o && unwritten_q == '0;

  // A packet on offer stays until it is taken.
  logic                          waits_q;
  raster_pkg::primitive_packet_t waiting_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) waits_q <= 1'b0;
    else waits_q <= primitive_valid_i && !primitive_ready_o;
  end
  always_ff @(posedge clk_i) begin
    if (primitive_valid_i && !primitive_ready_o) waiting_q <= primitive_i;
    if (rst_ni) begin
      assert (!$isunknown(primitive_valid_i)) else $error("primitive_valid_i is unknown; drive it, 0 from reset on");
      if (waits_q)
        assert (primitive_valid_i && primitive_i == waiting_q)
        else
          $error("primitive %0d was taken back or changed before it was taken; hold valid and packet until ready",
                 taken_q);
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      taken_q      <= '0;
      unwritten_q  <= '0;
      has_target_q <= 1'b0;
    end else if (takes) begin
      taken_q <= taken_q + 64'd1;
      if (is_flush) unwritten_q <= '0;
      else if (!is_state) unwritten_q <= unwritten_q + 64'd1;
      if (clears_both) has_target_q <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    if (takes && clears_both) begin
      last_x_q <= primitive_i.box.right;
      last_y_q <= primitive_i.box.bottom;
    end
  end

  // The rules of a primitive, at the clock edge that takes it. A state has no box, and may precede everything else.
  logic is_whole, is_in_target;
  assign is_whole = primitive_i.box.left == '0 && primitive_i.box.top == '0 && primitive_i.box.right == last_x_q &&
                    primitive_i.box.bottom == last_y_q;
  assign is_in_target = primitive_i.box.right <= last_x_q && primitive_i.box.bottom <= last_y_q;
  always_ff @(posedge clk_i) begin
    if (rst_ni && takes) begin
      assert (!$isunknown({primitive_i.kind, primitive_i.box, primitive_i.state}))
      else $error("primitive %0d has unknown bits in its kind, box or state; drive them", taken_q);
      assert (has_known_kind)
      else
        $error("primitive %0d is of kind %0d, which this hardware does not have; send one of primitive_kind_t", taken_q,
               primitive_i.kind);
      assert (!is_state || UNIT_REGISTERS[primitive_i.state.depth_test])
      else
        $error("primitive %0d sets state register %0d, of a unit that this hardware does not have", taken_q,
               primitive_i.state.depth_test);
    end
    if (rst_ni && takes && !is_state) begin
      assert (has_target_q || clears_both)
      else
        $error("primitive %0d is drawn before the first clear; send a fast clear of depth and colour in front of it",
               taken_q);
      assert (primitive_i.box.left <= primitive_i.box.right && primitive_i.box.top <= primitive_i.box.bottom)
      else
        $error("primitive %0d has an inverted box, x %0d to %0d, y %0d to %0d; leave out what covers no pixel", taken_q,
               primitive_i.box.left, primitive_i.box.right, primitive_i.box.top, primitive_i.box.bottom);
    end
    if (rst_ni && takes && !is_state && has_target_q && !clears_both) begin
      assert (is_in_target)
      else
        $error("primitive %0d has a box outside the target, to pixel %0d, %0d of %0d, %0d; cut it with the target", taken_q,
               primitive_i.box.right, primitive_i.box.bottom, last_x_q, last_y_q);
      assert (is_whole || is_bin || !(is_clear || is_flush))
      else
        $error("primitive %0d, a fast clear or flush, has a part of the target as its box; give the box of the first clear",
               taken_q);
    end
    if (rst_ni && takes && clears_both) begin
      assert (primitive_i.box.left == '0 && primitive_i.box.top == '0 &&
              int'(primitive_i.box.right) < raster_pkg::TARGET_WIDTH &&
              int'(primitive_i.box.bottom) < raster_pkg::TARGET_HEIGHT)
      else
        $error("primitive %0d, a fast clear, has the box x %0d to %0d, y %0d to %0d; give the whole target, at most %0d x %0d",
               taken_q, primitive_i.box.left, primitive_i.box.right, primitive_i.box.top, primitive_i.box.bottom,
               raster_pkg::TARGET_WIDTH, raster_pkg::TARGET_HEIGHT);
      assert (!has_target_q || unwritten_q == '0 || is_whole)
      else
        $error("primitive %0d, a fast clear, changes the target's size after %0d primitives without a flush; flush first",
               taken_q, unwritten_q);
    end
    if (rst_ni && takes && (is_clear || is_flush)) begin
      assert (primitive_i.state.depth_test == raster_pkg::DEPTH_FUNC_ALWAYS ||
              (HAS_BLOCKS && primitive_i.state.depth_test == raster_pkg::DEPTH_FUNC_NEVER) || (HAS_BLOCKS && is_bin))
      else
        $error("primitive %0d, a fast clear or flush, has the depth test %0d; give always (never and equal: docs/pipeline.md)",
               taken_q, primitive_i.state.depth_test);
      assert (!is_bin || !primitive_i.state.depth_write)
      else $error("primitive %0d, a fast clear of one bin, clears depth; that is of the whole target", taken_q);
    end
  end

  // The addresses of buffers may change when nothing is under way and nothing is left on the chip for the old
  // addresses; and after a reset, while caches are still swept.
  raster_pkg::memory_layout_t layout_q;
  always_ff @(posedge clk_i) begin
    layout_q <= layout_i;
    if (rst_ni && layout_i != layout_q)
      assert (is_written || taken_q == '0)
      else
        $error("layout_i changes before memory has the picture, %0d primitives after the last flush; flush, wait for idle_o",
               unwritten_q);
  end

  // Lines: setups and their places in program order; either may come first.
  generate
    if (raster_pkg::LINES_UNIT != 0) begin : gen_lines
      localparam int ID = raster_pkg::PRIMITIVE_ID_BITS;
      logic [63:0] places_q, setups_q;
      logic        line_waits_q, takes_place, takes_setup;
      raster_pkg::line_setup_t line_q;
      logic [ID-1:0] ids[$];  // lines whose other half is missing
      assign takes_place = takes && primitive_i.kind == raster_pkg::PRIMITIVE_KIND_LINE;
      assign takes_setup = line_valid_i && line_ready_o;

      always_ff @(posedge clk_i or negedge rst_ni) begin
        if (!rst_ni) begin
          places_q     <= '0;
          setups_q     <= '0;
          line_waits_q <= 1'b0;
        end else begin
          places_q     <= places_q + 64'(takes_place);
          setups_q     <= setups_q + 64'(takes_setup);
          line_waits_q <= line_valid_i && !line_ready_o;
        end
      end
      always_ff @(posedge clk_i) begin
        if (line_valid_i && !line_ready_o) line_q <= line_i;
        if (!rst_ni) ids.delete();
        else begin
          assert (!$isunknown(line_valid_i)) else $error("line_valid_i is unknown; drive it, 0 from reset on");
          if (line_waits_q)
            assert (line_valid_i && line_i == line_q)
            else $error("line %0d was taken back or changed before it was taken; hold valid and packet until ready", setups_q);
          if (takes_place) pair(primitive_i.primitive_id, setups_q > places_q);
          if (takes_setup) pair(line_i.primitive_id, places_q > setups_q || (takes_place && places_q == setups_q));
        end
      end

      function automatic void pair(input logic [ID-1:0] id, input logic is_second);
        logic [ID-1:0] first;
        if (!is_second) ids.push_back(id);
        else begin
          first = ids.pop_front();
          assert (first == id)
          else
            $error("a line and its place have the primitive_id %0d and %0d; send both in the same order", first, id);
        end
      endfunction

      final
        if (places_q != setups_q)
          $error("the stream ends with %0d places of lines and %0d lines; send one line for each place", places_q, setups_q);
    end
  endgenerate

  final
    if (unwritten_q != '0)
      $error("the stream ends with %0d primitives after the last flush, on the chip alone; send a flush, wait for idle_o",
             unwritten_q);

endmodule
