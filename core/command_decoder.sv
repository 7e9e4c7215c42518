// Command decoder: words of the command stream to the packets of raster_top. docs/core.md has the stream bit by bit.
//
// In: 32-bit words, valid/ready. Out: primitives and lines, the layout of buffers, fences and the picture for scan-out.
// The words of a primitive go into `payload_q`, each to its place, from which packet and line are read as they are: a
// flip-flop with an enable for each bit and no multiplexer. A primitive is on offer in the cycle after its last word;
// the next header is taken in the cycle in which it leaves, so a triangle of n words takes n cycles.
//
// Waiting: a write of the layout until nothing is under way; FENCE and PRESENT for an earlier one of their kind;
// WAIT_VBLANK for scan-out; FLUSH while three are under way. A wrong word stops the stream, with error_o, until reset.
// So does the watchdog where it waits for something else than the display and nothing moves for 2^WATCHDOG cycles.
module command_decoder #(
    parameter int WATCHDOG = 24  // 0: none
) (
    input logic clk_i,
    input logic rst_ni,

    // Control: begins after reset, a stop or STOP; ends at the next header
    input  logic        start_i,
    input  logic        stop_i,
    output logic        is_running_o,
    output logic        is_written_o,  // everything taken so far is in memory, and the decoder holds nothing
    output logic [3:0]  error_o,       // core_pkg::ERROR_*, 0: none
    output logic [31:0] words_o,       // taken since reset; after an error the last of them is the wrong one

    // Words of the stream; an error of the bus comes with the word
    input  logic        word_valid_i,
    output logic        word_ready_o,
    input  logic [31:0] word_i,
    input  logic        word_error_i,
    input  logic        is_owed_i,  // there are words that are not on offer yet: memory has them

    // To raster_top
    output logic                          primitive_valid_o,
    input  logic                          primitive_ready_i,
    output raster_pkg::primitive_packet_t primitive_o,
    output logic                          line_valid_o,
    input  logic                          line_ready_i,
    output raster_pkg::line_setup_t       line_o,
    output raster_pkg::memory_layout_t    layout_o,
    output logic [31:12]                  texture_base_o,
    input  logic                          idle_i,
    input  logic                          flushed_i,
    input  logic                          moves_i,  // something moves between raster_top and memory

    // A fence: everything before it is in memory
    output logic        fence_valid_o,  // for a cycle
    output logic [31:0] fence_o,

    // To scan-out: a frame that is in memory, taken at the start of vertical blank, or at once when it is off
    output logic        present_valid_o,
    input  logic        present_ready_i,
    output logic [31:0] present_color_base_o,
    output logic [31:0] present_color_flags_base_o
);

  localparam int C = raster_pkg::COORDINATE_BITS;
  localparam int AFFINE = raster_pkg::ALL_AFFINE_CODE_BITS;
  localparam int CODES = raster_pkg::ALL_CODE_BITS;
  localparam int OVER_W = CODES - AFFINE;
  localparam int FRAME = raster_pkg::COORDINATE_FRAME_BITS;
  localparam int LINE = raster_pkg::LINE_SETUP_BITS - raster_pkg::PRIMITIVE_ID_BITS;
  localparam bit HAS_LINES = raster_pkg::LINES_UNIT != 0;
  localparam bit HAS_BLOCKS = raster_pkg::CACHE_KIND == 1;
  localparam bit HAS_STENCIL = raster_pkg::STENCIL_BITS != 0;
  localparam bit HAS_SAMPLES = raster_pkg::MSAA_SAMPLES > 1;
  localparam bit HAS_TEXTURE = raster_pkg::COORDINATES != 0;
  localparam bit HAS_ALPHA = raster_pkg::ALPHA_UNIT != 0 && HAS_BLOCKS && raster_pkg::SETUP_KIND == 0;
  localparam bit HAS_OPS = raster_pkg::BLEND_LANES != 0 || raster_pkg::DITHER_UNIT != 0;
  // By the number of a unit's register: whether the unit is there (has_register in model/host/stream_rules.cpp).
  localparam logic [7:0] UNIT_REGISTERS = {HAS_STENCIL, HAS_ALPHA, {2{HAS_OPS}}, HAS_STENCIL, {3{HAS_TEXTURE}}};
  localparam bit HAS_STATES = UNIT_REGISTERS != '0;

  // Words of the payload: the slots of three vertices, each xy and its affine codes; the codes over w of the three; the
  // frame of coordinates. A line uses them from the first one on.
  localparam int SLOT = 1 + (AFFINE + 31) / 32;
  localparam int OVER = (OVER_W + 31) / 32;
  localparam int OVER1 = OVER == 0 ? 1 : OVER;
  localparam int OVER_AT = 3 * SLOT;
  localparam int FRAME_AT = OVER_AT + 3 * OVER;
  localparam int TRIANGLE_WORDS = FRAME_AT + (FRAME + 31) / 32;
  localparam int LINE_WORDS = HAS_LINES ? (LINE + 31) / 32 : 0;
  localparam int WORDS = TRIANGLE_WORDS > LINE_WORDS ? TRIANGLE_WORDS : LINE_WORDS;
  localparam int INDEX = $clog2(WORDS + 1);
  localparam int STATE_OVER = HAS_STATES ? (raster_pkg::STATE_WORD_BITS - AFFINE + 31) / 32 : 0;
  localparam bit HAS_FRAME = TRIANGLE_WORDS > OVER_AT;

  localparam int PX = raster_pkg::PIXEL_X_BITS;
  localparam int PY = raster_pkg::PIXEL_Y_BITS;

  generate
    if (C > 16) begin : gen_refused
      $fatal(1, "x and y of a vertex share a word: 16 bits each, not %0d", C);
    end
  endgenerate

  // ---------------------------------------------------------------------------------------------- fields of a header
  logic [7:0] opcode;
  logic [2:0] kind;
  logic       is_set, is_fence, is_present, is_wait, is_stop, draws, is_triangle, is_clear, is_flush, is_line, is_state;
  assign opcode      = word_i[31:24];
  assign kind        = opcode[2:0];
  assign is_set      = opcode == core_pkg::COMMAND_SET;
  assign is_fence    = opcode == core_pkg::COMMAND_FENCE;
  assign is_present  = opcode == core_pkg::COMMAND_PRESENT;
  assign is_wait     = opcode == core_pkg::COMMAND_WAIT_VBLANK;
  assign is_stop     = opcode == core_pkg::COMMAND_STOP;
  assign draws       = opcode[7:3] == core_pkg::COMMAND_TRIANGLE[7:3] && kind != 3'd5;
  assign is_triangle = kind == raster_pkg::PRIMITIVE_KIND_TRIANGLE;
  assign is_clear    = kind == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR;
  assign is_flush    = kind == raster_pkg::PRIMITIVE_KIND_FLUSH;
  assign is_line     = kind == raster_pkg::PRIMITIVE_KIND_LINE;
  assign is_state    = kind == raster_pkg::PRIMITIVE_KIND_STATE;

  // ------------------------------------------------------------------------------------------------------- the state
  localparam logic [2:0] HEADER = 3'd0;
  localparam logic [2:0] PAYLOAD = 3'd1;  // words of a primitive
  localparam logic [2:0] SET = 3'd2;      // of state registers
  localparam logic [2:0] FENCE = 3'd3;
  localparam logic [2:0] PRESENT = 3'd4;
  localparam logic [2:0] PRESENT_FLAGS = 3'd5;

  logic [2:0]       state_q;
  logic             running_q, stops_q;  // stops_q: at the next header
  logic             cleared_q, drawn_q;  // depth and colour once; something since the last flush
  logic             primitive_valid_q, line_valid_q;
  logic [2:0]       kind_q;
  logic [3:0]       flags_q;   // of a triangle: flip; of a clear or flush, or the register of a state
  logic [2:0]       loads_q;   // slots that a triangle loads
  logic             over_q;    // values over w follow the slots
  logic [INDEX-1:0] index_q;   // the next word of the payload
  logic [3:0]       register_q, rest_q;  // of SET: its next register, words to come
  logic [1:0]       flushes_q;        // under way
  logic [31:0]      words_q;
  logic [3:0]       error_q;

  logic takes, takes_header, primitive_leaves, line_leaves, holds, is_open, may_set, ends_payload, ends_slot;
  assign primitive_leaves = primitive_valid_q && primitive_ready_i;
  assign line_leaves      = line_valid_q && line_ready_i;
  assign holds            = (primitive_valid_q && !primitive_ready_i) || (line_valid_q && !line_ready_i);
  assign takes            = word_valid_i && word_ready_o;
  assign takes_header     = takes && state_q == HEADER;

  // A fence and scan-out's next picture wait for this many flushes.
  logic       fence_waits_q, present_waits_q;
  logic [1:0] fence_left_q, present_left_q;
  assign fence_valid_o   = fence_waits_q && fence_left_q == '0;
  assign present_valid_o = present_waits_q && present_left_q == '0;

  // A header stays on offer while its command waits.
  always_comb begin
    is_open = 1'b1;
    if (is_fence) is_open = !fence_waits_q;
    if (is_present || is_wait) is_open = !present_waits_q;
    if (draws && is_flush) is_open = flushes_q != '1;
  end
  assign may_set = register_q < 4'(core_pkg::STATE_REGISTER_DEPTH_BASE) || drawn_q || (idle_i && flushes_q == '0);
  always_comb begin
    case (state_q)
      HEADER: word_ready_o = running_q && !stops_q && !holds && is_open;
      SET: word_ready_o = running_q && may_set;
      default: word_ready_o = running_q;
    endcase
  end

  // ------------------------------------------------------------------------------------------------------ wrong words
  logic [PX-1:0] left_q, right_q, target_right_q;
  logic [PY-1:0] top_q, bottom_q, target_bottom_q;
  logic [3:0]    error;
  logic          reserved, is_bad_box, lacks_unit, needs_target;
  assign is_bad_box   = right_q < left_q || bottom_q < top_q || target_right_q < right_q || target_bottom_q < bottom_q;
  assign needs_target = draws && !is_state && !(is_clear && word_i[2:0] == 3'b011);
  assign lacks_unit   = draws && ((is_line && !HAS_LINES) || (is_state && !UNIT_REGISTERS[word_i[2:0]]) ||
                                  (is_triangle && word_i[4] && !HAS_FRAME) ||
                                  (is_clear && (word_i[2] || word_i[3]) && !HAS_BLOCKS) ||
                                  (is_flush && word_i[0] && !HAS_BLOCKS));
  always_comb begin
    // Header bits that a command does not name are 0.
    reserved = word_i[23:12] != '0 || word_i[7:5] != '0;
    if (!is_set && word_i[11:8] != '0) reserved = 1'b1;
    if (!(draws && is_triangle) && word_i[4]) reserved = 1'b1;
    if (!is_set && !(draws && (is_triangle || is_clear)) && word_i[3]) reserved = 1'b1;
    if (!is_set && !(draws && (is_triangle || is_clear || is_state)) && word_i[2:1] != '0) reserved = 1'b1;
    if (!is_set && !(draws && (is_triangle || is_clear || is_state || is_flush)) && word_i[0]) reserved = 1'b1;
    if (draws && is_clear && (word_i[2] ? word_i[0] || word_i[3] || !word_i[1] : word_i[1:0] == '0)) reserved = 1'b1;
  end
  always_comb begin
    error = core_pkg::ERROR_NONE;
    if (state_q == HEADER) begin
      if (!draws && (opcode[7:3] != '0 || opcode[2:0] > core_pkg::COMMAND_STOP[2:0])) error = core_pkg::ERROR_UNKNOWN_OPCODE;
      else if (lacks_unit) error = core_pkg::ERROR_NOT_SUPPORTED;
      else if (reserved) error = core_pkg::ERROR_RESERVED;
      else if (is_set && (word_i[11:8] == '0 || 5'(word_i[3:0]) + 5'(word_i[11:8]) > 5'(core_pkg::STATE_REGISTERS)))
        error = core_pkg::ERROR_BAD_REGISTER;
      else if (needs_target && !cleared_q) error = core_pkg::ERROR_NO_CLEAR;
      else if (draws && is_bad_box && (!(is_clear || is_flush || is_line || is_state) || (is_clear && word_i[2])))
        error = core_pkg::ERROR_BAD_BOX;
    end else if (state_q == SET && register_q >= 4'(core_pkg::STATE_REGISTER_TARGET) && drawn_q)
      error = core_pkg::ERROR_NOT_FLUSHED;
    if (word_error_i) error = core_pkg::ERROR_BUS;
  end
  logic fails, begins, is_stuck;  // a header begins its command
  assign fails  = takes && error != core_pkg::ERROR_NONE;
  assign begins = takes_header && !fails;

  // ---------------------------------------------------------------------------------------------------- the payload
  // Codes that are the same at all vertices go to the three slots at once.
  logic [32*WORDS-1:0] payload_q;
  logic [INDEX-1:0]    next_index;
  logic [2:0]          next_loads;
  logic                is_broadcast;
  assign is_broadcast = kind_q != raster_pkg::PRIMITIVE_KIND_TRIANGLE && kind_q != raster_pkg::PRIMITIVE_KIND_LINE;
  assign next_loads   = loads_q & (loads_q - 3'd1);

  function automatic [INDEX-1:0] first_of(input [2:0] loads);
    first_of = loads[0] ? '0 : loads[1] ? INDEX'(SLOT) : loads[2] ? INDEX'(2 * SLOT) : INDEX'(OVER_AT);
  endfunction

  always_comb begin
    next_index   = index_q + 1'b1;
    ends_payload = 1'b0;
    ends_slot    = 1'b0;
    if (kind_q == raster_pkg::PRIMITIVE_KIND_LINE) ends_payload = index_q == INDEX'(LINE_WORDS - 1);
    else if (is_broadcast) begin
      if (STATE_OVER != 0 && kind_q == raster_pkg::PRIMITIVE_KIND_STATE) begin
        if (index_q == INDEX'(SLOT - 1)) next_index = INDEX'(OVER_AT);
        ends_payload = index_q == INDEX'(OVER_AT + STATE_OVER - 1);
      end else ends_payload = index_q == INDEX'(SLOT - 1);
    end else begin
      if (index_q == INDEX'(SLOT - 1) || index_q == INDEX'(2 * SLOT - 1) || index_q == INDEX'(3 * SLOT - 1)) begin
        ends_slot    = 1'b1;
        next_index   = first_of(next_loads);
        ends_payload = next_loads == '0 && !over_q;
      end
      if (HAS_FRAME && index_q == INDEX'(TRIANGLE_WORDS - 1)) ends_payload = 1'b1;
    end
  end

  genvar w;
  generate
    for (w = 0; w < WORDS; w++) begin : gen_word
      localparam bit IN_SLOT = w < OVER_AT;
      localparam bit IN_OVER = w >= OVER_AT && w < FRAME_AT;
      localparam int FIRST = IN_SLOT ? w % SLOT : IN_OVER ? OVER_AT + (w - OVER_AT) % OVER1 : w;  // of vertex 0
      logic writes, clears;
      assign writes = takes && state_q == PAYLOAD &&
                      (index_q == INDEX'(w) || (is_broadcast && FIRST != w && index_q == INDEX'(FIRST)));
      // Boxes have vertices at 0, and planes over w are 0 unless the words give them.
      assign clears = takes_header && draws && (IN_SLOT ? !is_triangle && FIRST == 0 : !is_triangle || !word_i[4]);
      always_ff @(posedge clk_i) begin
        if (clears) payload_q[32*w+:32] <= '0;
        else if (writes) payload_q[32*w+:32] <= word_i;
      end
    end
  endgenerate

  // --------------------------------------------------------------------------------------------- the state registers
  logic [7:0] state_bits_q;   // depth test, masks, cull, front
  logic [3:0] stencil_bits_q;
  logic [7:0] masked_q;
  logic [31:0] depth_base_q, color_base_q, depth_flags_q, color_flags_q;
  logic [raster_pkg::ROW_STRIDE_BITS-1:0] stride_q;
  logic [31:12] texture_base_q;
  logic sets;
  assign sets = takes && state_q == SET;
  always_ff @(posedge clk_i) begin
    if (sets && register_q == 4'(core_pkg::STATE_REGISTER_BOX_MIN)) begin
      left_q <= word_i[0+:PX];
      top_q  <= word_i[16+:PY];
    end
    if (sets && register_q == 4'(core_pkg::STATE_REGISTER_BOX_MAX)) begin
      right_q  <= word_i[0+:PX];
      bottom_q <= word_i[16+:PY];
    end
    if (sets && register_q == 4'(core_pkg::STATE_REGISTER_STATE)) begin
      state_bits_q   <= word_i[7:0];
      stencil_bits_q <= word_i[11:8];
      masked_q       <= word_i[23:16];
    end
    if (sets && register_q == 4'(core_pkg::STATE_REGISTER_DEPTH_BASE)) depth_base_q <= word_i;
    if (sets && register_q == 4'(core_pkg::STATE_REGISTER_COLOR_BASE)) color_base_q <= word_i;
    if (sets && register_q == 4'(core_pkg::STATE_REGISTER_DEPTH_FLAGS_BASE)) depth_flags_q <= word_i;
    if (sets && register_q == 4'(core_pkg::STATE_REGISTER_COLOR_FLAGS_BASE)) color_flags_q <= word_i;
    if (sets && register_q == 4'(core_pkg::STATE_REGISTER_ROW_STRIDE))
      stride_q <= word_i[0+:raster_pkg::ROW_STRIDE_BITS];
    if (sets && register_q == 4'(core_pkg::STATE_REGISTER_TEXTURE_BASE)) texture_base_q <= word_i[31:12];
    if (takes && state_q == FENCE) fence_o <= word_i;
    if (takes && state_q == PRESENT) present_color_base_o <= word_i;
    if (takes && state_q == PRESENT_FLAGS) present_color_flags_base_o <= word_i;
  end
  // A primitive before the target is known is refused, but a state has its box.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      target_right_q  <= '0;
      target_bottom_q <= '0;
    end else if (sets && register_q == 4'(core_pkg::STATE_REGISTER_TARGET)) begin
      target_right_q  <= word_i[0+:PX];
      target_bottom_q <= word_i[16+:PY];
    end
  end

  // ---------------------------------------------------------------------------------------------------- the watchdog
  generate
    if (WATCHDOG != 0) begin : gen_watchdog
      logic [WATCHDOG:0] waited_q;
      logic              has_work;  // the display may be slow
      assign has_work = ((running_q && (word_valid_i || is_owed_i || state_q != HEADER)) || primitive_valid_q || flushes_q != '0) &&
                        !present_valid_o;
      always_ff @(posedge clk_i) begin  // its own clear is synchronous, which costs no LUTs
        if (!rst_ni || !has_work || takes || moves_i || error_q != core_pkg::ERROR_NONE) waited_q <= '0;
        else waited_q <= waited_q + 1'b1;
      end
      assign is_stuck = waited_q[WATCHDOG];
    end else begin : gen_no_watchdog
      assign is_stuck = 1'b0;
    end
  endgenerate

  // ------------------------------------------------------------------------------------------------- the next state
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q           <= HEADER;
      running_q         <= 1'b0;
      stops_q           <= 1'b0;
      cleared_q         <= 1'b0;
      drawn_q           <= 1'b0;
      primitive_valid_q <= 1'b0;
      line_valid_q      <= 1'b0;
      flushes_q         <= '0;
      fence_waits_q     <= 1'b0;
      present_waits_q   <= 1'b0;
      words_q           <= '0;
      error_q           <= core_pkg::ERROR_NONE;
    end else begin
      if (start_i && error_q == core_pkg::ERROR_NONE) running_q <= 1'b1;
      if (stop_i) stops_q <= running_q;
      if (stops_q && state_q == HEADER) begin
        running_q <= 1'b0;
        stops_q   <= 1'b0;
      end
      words_q <= words_q + 32'(takes);
      if (primitive_leaves) primitive_valid_q <= 1'b0;
      if (line_leaves) line_valid_q <= 1'b0;
      if (fence_valid_o) fence_waits_q <= 1'b0;
      if (present_valid_o && present_ready_i) present_waits_q <= 1'b0;
      flushes_q <= flushes_q + 2'(begins && draws && is_flush) - 2'(flushed_i);

      if (fails || is_stuck) begin
        error_q   <= fails ? error : core_pkg::ERROR_STUCK;
        running_q <= 1'b0;
      end else if (takes) begin
        case (state_q)
          HEADER: begin
            if (is_set) state_q <= SET;
            if (is_fence) state_q <= FENCE;
            if (is_present) state_q <= PRESENT;
            if (is_stop) running_q <= 1'b0;
            if (draws) begin
              if (is_flush || (is_triangle && word_i[2:0] == '0 && !word_i[4])) primitive_valid_q <= 1'b1;
              else state_q <= PAYLOAD;
              if (!is_state) drawn_q <= !is_flush;
              if (is_clear && !word_i[2] && word_i[1:0] == 2'b11) cleared_q <= 1'b1;
            end
          end
          PAYLOAD:
          if (ends_payload) begin
            state_q           <= HEADER;
            primitive_valid_q <= 1'b1;
            line_valid_q      <= kind_q == raster_pkg::PRIMITIVE_KIND_LINE;
          end
          SET: begin
            if (rest_q == 4'd1) state_q <= HEADER;
            if (register_q == 4'(core_pkg::STATE_REGISTER_TARGET)) cleared_q <= 1'b0;
          end
          FENCE: begin
            state_q       <= HEADER;
            fence_waits_q <= 1'b1;
          end
          PRESENT: state_q <= PRESENT_FLAGS;
          default: begin
            state_q         <= HEADER;
            present_waits_q <= 1'b1;
          end
        endcase
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (begins && draws) begin
      kind_q  <= kind;
      flags_q <= word_i[3:0];
      over_q  <= HAS_FRAME && word_i[4];
      loads_q <= word_i[2:0];
      index_q <= is_triangle ? first_of(word_i[2:0]) : is_line ? '0 : INDEX'(1);
    end else if (takes) begin
      index_q <= next_index;
      if (ends_slot) loads_q <= next_loads;
    end
    if (begins) begin
      register_q <= word_i[3:0];
      rest_q     <= word_i[11:8];
    end else if (sets) begin
      register_q <= register_q + 4'd1;
      rest_q     <= rest_q - 4'd1;
    end
    if (takes && state_q == FENCE) fence_left_q <= flushes_q - 2'(flushed_i);
    else if (fence_left_q != '0) fence_left_q <= fence_left_q - 2'(flushed_i);
    if (takes && state_q == PRESENT_FLAGS) present_left_q <= flushes_q - 2'(flushed_i);
    else if (present_left_q != '0) present_left_q <= present_left_q - 2'(flushed_i);
  end

  assign is_running_o = running_q;
  assign is_written_o = state_q == HEADER && !primitive_valid_q && !line_valid_q && !drawn_q && flushes_q == '0 &&
                        idle_i;
  assign error_o      = error_q;
  assign words_o      = words_q;

  // ------------------------------------------------------------------------------------------------------ the packets
  logic has_state, has_target;  // of the state registers; the target for a box
  assign has_state  = !kind_q[1] || kind_q == raster_pkg::PRIMITIVE_KIND_LINE;
  assign has_target = kind_q[1] && !(kind_q == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR && flags_q[2]);

  logic [2:0] depth_test;
  logic       depth_write, color_write;
  always_comb begin
    depth_test  = state_bits_q[2:0];
    depth_write = state_bits_q[3];
    color_write = state_bits_q[4];
    if (!has_state) begin
      depth_write = kind_q == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR && flags_q[0];
      color_write = kind_q == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR && flags_q[1];
      depth_test  = raster_pkg::DEPTH_FUNC_ALWAYS;
      if (kind_q == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR && flags_q[3]) depth_test = raster_pkg::DEPTH_FUNC_NEVER;
      if (kind_q == raster_pkg::PRIMITIVE_KIND_FAST_CLEAR && flags_q[2]) depth_test = raster_pkg::DEPTH_FUNC_EQUAL;
      if (kind_q == raster_pkg::PRIMITIVE_KIND_FLUSH && flags_q[0]) depth_test = raster_pkg::DEPTH_FUNC_NEVER;
      if (kind_q == raster_pkg::PRIMITIVE_KIND_STATE) depth_test = flags_q[2:0];
    end
  end

  // Enums among the fields are set with a neighbour: Yosys 0.23 reads no cast.
  assign primitive_valid_o = primitive_valid_q;
  // no stage reads it
  assign {primitive_o.kind, primitive_o.primitive_id} = {kind_q, {raster_pkg::PRIMITIVE_ID_BITS{1'b0}}};
  assign primitive_o.box.left   = has_target ? '0 : left_q;
  assign primitive_o.box.top    = has_target ? '0 : top_q;
  assign primitive_o.box.right  = has_target ? target_right_q : right_q;
  assign primitive_o.box.bottom = has_target ? target_bottom_q : bottom_q;
  assign {primitive_o.state.depth_test, primitive_o.state.depth_write, primitive_o.state.color_write} =
      {depth_test, depth_write, color_write};
  assign {primitive_o.cull, primitive_o.front_cw} =
      {state_bits_q[6:5] & {2{kind_q == raster_pkg::PRIMITIVE_KIND_TRIANGLE}}, state_bits_q[7] ^ flags_q[3]};
  genvar v;
  generate
    if (HAS_STENCIL) begin : gen_stencil
      assign primitive_o.state.tests_stencil  = has_state && stencil_bits_q[0];
      assign primitive_o.state.writes_stencil = has_state && stencil_bits_q[1];
      assign primitive_o.state.marks_failed   = has_state && stencil_bits_q[2];
      assign primitive_o.state.is_back        = has_state && stencil_bits_q[3];
    end
    if (HAS_SAMPLES) begin : gen_samples
      assign primitive_o.state.masked_samples = masked_q[raster_pkg::MSAA_SAMPLES-1:0] &
                                                {raster_pkg::MSAA_SAMPLES{has_state}};
    end
    for (v = 0; v < 3; v++) begin : gen_vertex
      assign primitive_o.vertex.x[v*C+:C]              = payload_q[32*v*SLOT+:C];
      assign primitive_o.vertex.y[v*C+:C]              = payload_q[32*v*SLOT+16+:C];
      assign primitive_o.vertex.code[v*CODES+:AFFINE]  = payload_q[32*(v*SLOT+1)+:AFFINE];
      if (OVER != 0) begin : gen_over
        assign primitive_o.vertex.code[v*CODES+AFFINE+:OVER_W] = payload_q[32*(OVER_AT+v*OVER)+:OVER_W];
      end
    end
    if (FRAME != 0) begin : gen_frame
      assign primitive_o.coordinates = payload_q[32*FRAME_AT+:FRAME];
    end
    if (HAS_LINES) begin : gen_line
      assign line_o = {{raster_pkg::PRIMITIVE_ID_BITS{1'b0}}, payload_q[LINE-1:0]};
    end else begin : gen_no_line
      assign line_o = '0;
    end
  endgenerate

  assign line_valid_o              = line_valid_q;
  assign layout_o.depth_base       = depth_base_q;
  assign layout_o.color_base       = color_base_q;
  assign layout_o.depth_flags_base = depth_flags_q;
  assign layout_o.color_flags_base = color_flags_q;
  assign layout_o.row_stride       = stride_q;
  assign texture_base_o            = texture_base_q;

endmodule
