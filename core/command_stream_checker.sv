// Checks the stream of command words, and the decoder's outputs. Simulation only, bound from outside:
//
//   bind command_decoder command_stream_checker u_command_stream_checker (.*);
//
// A broken rule is an assertion that fails, with a message: the error, its word, the word to send instead. Words
// are counted from reset as WORDS counts them, the first is 1. Errors that the decoder itself reports (docs/core.md, errors)
// are said here in words; the rest are rules that hardware does not check. Verilator wants --assert. CHECKS_ERRORS = 0:
// for test benches that send wrong words.
module command_stream_checker #(
    parameter bit CHECKS_ERRORS = 1,
    parameter int PATIENCE = 1 << 20  // cycles that a word may wait
) (
    input logic        clk_i,
    input logic        rst_ni,
    input logic        is_running_o,
    input logic [3:0]  error_o,
    input logic [31:0] words_o,
    input logic        word_valid_i,
    input logic        word_ready_o,
    input logic [31:0] word_i,
    input logic        primitive_valid_o,
    input logic        primitive_ready_i,
    input logic        line_valid_o,
    input logic        line_ready_i,
    input logic        flushed_i,
    input logic        is_written_o
);

  /* verilator coverage_off */  // of the design alone
  localparam int AFFINE = raster_pkg::ALL_AFFINE_CODE_BITS;
  localparam int AFFINE_WORDS = (AFFINE + 31) / 32;
  localparam int OVER = raster_pkg::ALL_CODE_BITS - AFFINE;
  localparam int OVER_WORDS = (OVER + 31) / 32;
  localparam int FRAME = raster_pkg::COORDINATE_FRAME_BITS;
  localparam int FRAME_WORDS = (FRAME + 31) / 32;
  localparam int LINE = raster_pkg::LINE_SETUP_BITS - raster_pkg::PRIMITIVE_ID_BITS;
  localparam int LINE_WORDS = (LINE + 31) / 32;
  localparam int STATE = raster_pkg::STATE_WORD_BITS - AFFINE;
  localparam int STATE_WORDS = STATE > 0 ? (STATE + 31) / 32 : 0;

  logic takes;
  assign takes = word_valid_i && word_ready_o;

  // Words that a header announces; 0: the next word is a header.
  int        left_q;
  int        number_q;  // of the word within its command, the header 0
  logic [31:0] header_q;
  logic [2:0]  slots_q;     // vertex slots that hold a vertex
  logic        has_state_q, has_box_q;
  logic [4:0]  has_layout_q;
  logic [63:0] drawn_q;     // since the last flush
  logic [1:0]  flushes_q;
  int          waited_q;

  function automatic int words_after(input logic [31:0] header);
    words_after = 0;
    case (header[31:24])
      core_pkg::COMMAND_SET: words_after = int'(header[11:8]);
      core_pkg::COMMAND_FENCE: words_after = 1;
      core_pkg::COMMAND_PRESENT: words_after = 2;
      core_pkg::COMMAND_TRIANGLE:
      words_after = $countones(header[2:0]) * (1 + AFFINE_WORDS) + (header[4] ? 3 * OVER_WORDS + FRAME_WORDS : 0);
      core_pkg::COMMAND_RECTANGLE, core_pkg::COMMAND_POINT, core_pkg::COMMAND_CLEAR: words_after = AFFINE_WORDS;
      core_pkg::COMMAND_LINE: words_after = LINE_WORDS;
      core_pkg::COMMAND_STATE: words_after = AFFINE_WORDS + STATE_WORDS;
      default: ;
    endcase
  endfunction

  logic is_header, is_draw;
  logic [7:0] opcode;
  assign is_header  = left_q == 0;
  assign opcode     = word_i[31:24];
  assign is_draw    = opcode == core_pkg::COMMAND_TRIANGLE || opcode == core_pkg::COMMAND_RECTANGLE ||
                      opcode == core_pkg::COMMAND_POINT ||
                      opcode == core_pkg::COMMAND_LINE;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      left_q       <= 0;
      number_q     <= 0;
      header_q     <= '0;
      slots_q      <= '0;
      has_state_q  <= 1'b0;
      has_box_q    <= 1'b0;
      has_layout_q <= '0;
      drawn_q      <= '0;
      flushes_q    <= '0;
      waited_q     <= 0;
    end else begin
      waited_q  <= word_valid_i && !word_ready_o && is_running_o ? waited_q + 1 : 0;
      flushes_q <= flushes_q + 2'(takes && is_header && opcode == core_pkg::COMMAND_FLUSH) - 2'(flushed_i);
      if (takes) begin
        left_q   <= is_header ? words_after(word_i) : left_q - 1;
        number_q <= is_header ? 1 : number_q + 1;
        if (is_header) begin
          header_q <= word_i;
          if (opcode == core_pkg::COMMAND_TRIANGLE) slots_q <= slots_q | word_i[2:0];
          else if (opcode >= core_pkg::COMMAND_RECTANGLE) slots_q <= '0;
          if (opcode == core_pkg::COMMAND_FLUSH) drawn_q <= '0;
          else if (is_draw || opcode == core_pkg::COMMAND_CLEAR) drawn_q <= drawn_q + 64'd1;
        end else if (header_q[31:24] == core_pkg::COMMAND_SET) begin
          for (int i = 0; i < 5; i++)
            if (int'(header_q[3:0]) + number_q - 1 == core_pkg::STATE_REGISTER_DEPTH_BASE + i) has_layout_q[i] <= 1'b1;
          if (int'(header_q[3:0]) + number_q - 1 == core_pkg::STATE_REGISTER_STATE) has_state_q <= 1'b1;
          if (int'(header_q[3:0]) + number_q - 1 == core_pkg::STATE_REGISTER_BOX_MAX) has_box_q <= 1'b1;
        end
      end
    end
  end

  // A word on offer stays until it is taken.
  logic        waits_q;
  logic [31:0] waiting_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) waits_q <= 1'b0;
    else waits_q <= word_valid_i && !word_ready_o;
  end
  always_ff @(posedge clk_i) begin
    waiting_q <= word_i;
    if (rst_ni) begin
      assert (!$isunknown(word_valid_i)) else $error("word_valid_i is unknown; drive it, 0 from reset on");
      if (waits_q)
        assert (word_valid_i && word_i == waiting_q)
        else
          $error("word %0d was taken back or changed before it was taken; hold valid and word until ready",
                 words_o + 1);
      if (word_valid_i && word_ready_o)
        assert (!$isunknown(word_i)) else $error("word %0d has unknown bits; write the whole word", words_o + 1);
      assert (waited_q != PATIENCE)
      else
        $error("word %0d, 0x%08h, has waited for %0d cycles; %s", words_o + 1, word_i, PATIENCE,
               line_valid_o || primitive_valid_o ? "the pipeline takes nothing: does memory answer?" :
               "it waits for an earlier fence, flush, picture or layout: does memory answer, does scan-out run?");
    end
  end

  // The rules of a header, and of the words after it.
  always_ff @(posedge clk_i) begin
    if (rst_ni && takes && is_header) begin
      if (is_draw) begin
        assert (has_state_q)
        else $error("word %0d draws before the state is set; SET the register STATE first", words_o + 1);
        assert (has_box_q || opcode == core_pkg::COMMAND_LINE)
        else $error("word %0d draws before the box is set; SET the registers BOX_MIN and BOX_MAX first", words_o + 1);
      end
      if (is_draw || opcode == core_pkg::COMMAND_CLEAR || opcode == core_pkg::COMMAND_FLUSH)
        assert (has_layout_q == '1)
        else
          $error("word %0d draws before the layout is set; SET the registers DEPTH_BASE to ROW_STRIDE first",
                 words_o + 1);
      if (opcode == core_pkg::COMMAND_TRIANGLE)
        assert ((slots_q | word_i[2:0]) == 3'b111)
        else
          $error("word %0d is a triangle without a vertex in slot %0d; any other drawing or state empties all",
                 words_o + 1, !(slots_q[0] || word_i[0]) ? 0 : !(slots_q[1] || word_i[1]) ? 1 : 2);
      if (opcode == core_pkg::COMMAND_PRESENT)
        assert (drawn_q == '0)
        else
          $error("word %0d presents a picture of which %0d primitives may not be in memory; FLUSH first",
                 words_o + 1, drawn_q);
    end
    // Bits above a field are 0: reserved.
    if (rst_ni && takes && !is_header) begin
      case (header_q[31:24])
        core_pkg::COMMAND_RECTANGLE, core_pkg::COMMAND_POINT, core_pkg::COMMAND_CLEAR:
        assert (left_q != 1 || AFFINE % 32 == 0 || word_i >> (AFFINE % 32) == '0)
        else $error("word %0d, 0x%08h, has bits above those of the codes; they are 0", words_o + 1, word_i);
        core_pkg::COMMAND_LINE:
        assert (left_q != 1 || LINE % 32 == 0 || word_i >> (LINE % 32) == '0)
        else $error("word %0d, 0x%08h, has bits above those of the line; they are 0", words_o + 1, word_i);
        default: ;
      endcase
    end
  end

  // Words that the decoder refuses.
  logic [3:0] error_q;
  always_ff @(posedge clk_i) begin
    error_q <= rst_ni ? error_o : '0;
    if (CHECKS_ERRORS && rst_ni && error_o != error_q) begin
      assert (error_o != core_pkg::ERROR_UNKNOWN_OPCODE)
      else $error("word %0d is no command; was the header before it right about its words?", words_o);
      assert (error_o != core_pkg::ERROR_RESERVED)
      else $error("word %0d sets a bit that its command does not have, or clears nothing; see docs/core.md", words_o);
      assert (error_o != core_pkg::ERROR_BAD_REGISTER)
      else $error("word %0d sets registers that are not there; there are %0d", words_o, core_pkg::STATE_REGISTERS);
      assert (error_o != core_pkg::ERROR_NOT_FLUSHED)
      else $error("word %0d changes target or addresses while drawings are on the chip alone; FLUSH first", words_o);
      assert (error_o != core_pkg::ERROR_NO_CLEAR)
      else $error("word %0d draws before the target is cleared; send CLEAR of depth and colour first", words_o);
      assert (error_o != core_pkg::ERROR_BAD_BOX)
      else
        $error("word %0d draws in a box that is inverted or ends beyond the target; cut it with the target", words_o);
      assert (error_o != core_pkg::ERROR_NOT_SUPPORTED)
      else $error("word %0d needs a unit that this configuration lacks; see the register UNITS", words_o);
      assert (error_o != core_pkg::ERROR_STUCK)
      else
        $error("nothing moves, after %0d words; does memory answer, is the last command whole?", words_o);
      assert (error_o != core_pkg::ERROR_BUS)
      else $error("word %0d came with an error of the bus; is the ring's base right?", words_o);
    end
  end

  // Guarantees of the decoder.
  logic primitive_waits_q, line_waits_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      primitive_waits_q <= 1'b0;
      line_waits_q      <= 1'b0;
    end else begin
      primitive_waits_q <= primitive_valid_o && !primitive_ready_i;
      line_waits_q      <= line_valid_o && !line_ready_i;
    end
  end
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!primitive_waits_q || primitive_valid_o) else $error("the decoder takes a primitive back");
      assert (!line_waits_q || line_valid_o) else $error("the decoder takes a line back");
      assert (!(flushed_i && flushes_q == '0)) else $error("a flush is answered that was not sent");
      assert (!is_written_o || drawn_q == '0)
      else $error("the decoder says written with %0d drawings on the chip", drawn_q);
      assert (error_o == core_pkg::ERROR_NONE || !takes) else $error("the decoder takes a word after an error");
    end
  end

  final begin
    if (left_q != 0 && error_o == core_pkg::ERROR_NONE)
      $error("the stream ends within a command: %0d words are missing", left_q);
    if (drawn_q != '0 && error_o == core_pkg::ERROR_NONE)
      $error("the stream ends with %0d drawings after the last FLUSH, on the chip alone", drawn_q);
  end

endmodule
