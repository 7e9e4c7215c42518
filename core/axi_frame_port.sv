// Frame port: beats and answers of raster_top as AXI4 bursts, reads to an arbiter, writes to a master of its own.
//
//   beat -> read  -> burst_split -> [no unanswered write to the place, room for the answer] -> AR
//        -> write -> burst_fifo -> W,  address -> fifo -> AW
//   answer <- fifo <- R
//          <- count of answers owed <- B
//
// Every burst has ID 0, is INCR, and lies in an aligned window of 16 beats. Longer bursts of raster_top are cut; of a
// cut write the last B is the answer. Answers of reads keep their order. The answer to a write comes when B has come,
// and may pass answers of earlier reads: raster_top counts these. R and B are always taken: a read is sent only when
// there is room for its answer, so no other client of the same R channel waits for raster_top.
//
// Order. AXI does not order a read after a write that has no answer, and raster_top reads blocks that it has just
// evicted.
// So every write beat notes the number of its burst in a table, in the bucket of its granule's hash, and a read waits
// while its bucket's number is among the numbers without B. Two granules may share a bucket: the read waits in vain, at most
// for B. A write needs not wait for earlier reads: raster_top writes a place only after it has used the data read there.
//
// Reset: rst_ni is that of the bus: everything is forgotten. forget_i drops the requests of raster_top when
// raster_top alone begins anew (reset_order): no beat is taken until memory has answered everything, and these answers
// are dropped.
module axi_frame_port #(
    parameter int WRITES = 64,       // write bursts without an answer, at most: a power of two
    parameter int READ_BEATS = 32,   // beats of reads under way or not taken, at most: a power of two, 16 at least
    parameter int WRITE_BEATS = 16,  // beats of writes that wait: a power of two, 16 at least
    parameter int BUCKETS = 10,      // log2 of the buckets of the table: one block RAM
    parameter int NUMBER = 12        // bits of a burst's number: an older one is taken for an unanswered one at times
) (
    input logic clk_i,
    input logic rst_ni,    // synchronised (reset_sync)
    input logic forget_i,  // a pulse; raster_top's power_on_ni comes with it

    // From and to raster_top
    input  logic                       beat_valid_i,
    output logic                       beat_ready_o,
    input  raster_pkg::memory_beat_t   beat_i,
    output logic                       answer_valid_o,
    input  logic                       answer_ready_i,
    output raster_pkg::memory_answer_t answer_o,

    // Reads, to axi_arbiter
    output logic                                    frame_arvalid,
    input  logic                                    frame_arready,
    output logic [31:0]                             frame_araddr,
    output logic [7:0]                              frame_arlen,
    input  logic                                    frame_rvalid,
    output logic                                    frame_rready,
    input  logic [raster_pkg::MEMORY_PORT_BITS-1:0] frame_rdata,
    input  logic                                    frame_rerror,

    // Writes
    output logic                                      m_axi_awvalid,
    input  logic                                      m_axi_awready,
    output logic [31:0]                               m_axi_awaddr,
    output logic [7:0]                                m_axi_awlen,
    output logic                                      m_axi_wvalid,
    input  logic                                      m_axi_wready,
    output logic [raster_pkg::MEMORY_PORT_BITS-1:0]   m_axi_wdata,
    output logic [raster_pkg::MEMORY_PORT_BITS/8-1:0] m_axi_wstrb,
    output logic                                      m_axi_wlast,
    input  logic                                      m_axi_bvalid,
    output logic                                      m_axi_bready,
    input  logic [1:0]                                m_axi_bresp,

    input  logic clear_errors_i,
    output logic read_error_o,   // a read was answered with SLVERR or DECERR, since reset or clear_errors_i
    output logic write_error_o,  // a write was
    output logic idle_o          // memory has answered everything, and raster_top has the answers
);

  localparam int BITS = raster_pkg::MEMORY_PORT_BITS;
  localparam int PORT = raster_pkg::PORT_SHIFT;
  localparam int DEPTH_SHIFT = $clog2(raster_pkg::SAMPLES * raster_pkg::DEPTH_SAMPLE_BYTES);  // log2 bytes of a stamp
  localparam int COLOR_SHIFT = $clog2(raster_pkg::MEMORY_COLORS * raster_pkg::COLOR_SAMPLE_BYTES);
  localparam int STAMP = (DEPTH_SHIFT > COLOR_SHIFT) ? DEPTH_SHIFT : COLOR_SHIFT;
  localparam int BUFFER = (raster_pkg::PLANE_SHIFT > raster_pkg::FLAG_ROW_SHIFT) ? raster_pkg::PLANE_SHIFT :
                                                                                  raster_pkg::FLAG_ROW_SHIFT;
  localparam bit SPLITS = BUFFER - PORT > 4;  // a burst may have more than 16 beats
  // Reads: a stamp, or the buffer of a tile. The granule contains whatever one read asks for.
  localparam bit HAS_BLOCKS = raster_pkg::CACHE_KIND != 0;
  localparam int READ = HAS_BLOCKS ? STAMP : raster_pkg::PLANE_SHIFT;
  localparam int LONGEST = (READ > PORT) ? 1 << (READ - PORT) : 1;
  localparam int PLACE = HAS_BLOCKS ? STAMP + 2 * $clog2(raster_pkg::BLOCK_SIDE) : READ;
  localparam int GRANULE = (PLACE > PORT) ? PLACE : PORT;

  function automatic [BUCKETS-1:0] bucket_of(input [31:0] address);
    integer i;
    begin
      bucket_of = '0;
      for (i = GRANULE; i < 32; i = i + 1)
        bucket_of[(i - GRANULE) % BUCKETS] = bucket_of[(i - GRANULE) % BUCKETS] ^ address[i];
    end
  endfunction

  logic forgets_q, is_clearing;
  logic takes_read, takes_write, read_ready, write_ready;
  assign beat_ready_o = !forgets_q && !forget_i && !is_clearing && (beat_i.is_write ? write_ready : read_ready);
  assign takes_read   = beat_valid_i && beat_ready_o && !beat_i.is_write;
  assign takes_write  = beat_valid_i && beat_ready_o && beat_i.is_write;

  // ---------------------------------------------------------------------------------------------------------- writes
  localparam int PENDING = $clog2(WRITES + 1);
  logic [3:0]         index, start, start_q;  // place in the window: of the beat, and of the burst's first
  logic               ends, enters_burst, beats_ready, bursts_ready, read_waits, is_whole;
  logic [PENDING-1:0] pending_q;              // bursts without B
  logic [NUMBER-1:0]  next_q, answered_q;     // numbers: of the burst that enters, and of the oldest without B
  logic               is_answered;

  assign index        = beat_i.address[PORT+:4];
  assign start        = (beat_i.is_first || index == '0) ? index : start_q;
  assign ends         = beat_i.length == 1 || (SPLITS && index == '1);
  assign enters_burst = takes_write && ends;
  assign write_ready  = beats_ready && bursts_ready && !read_waits && pending_q != PENDING'(WRITES);
  assign is_answered  = m_axi_bvalid;
  assign m_axi_bready = 1'b1;

  always_ff @(posedge clk_i) if (takes_write) start_q <= start;

  burst_fifo #(
      .WIDTH(BITS + BITS / 8 + 1),
      .DEPTH(WRITE_BEATS)
  ) u_beats (
      .clk_i,
      .rst_ni,
      .drops_i   (forget_i),
      .valid_i   (takes_write),
      .ready_o   (beats_ready),
      .last_i    (ends),
      .data_i    ({ends, beat_i.strobe, beat_i.data}),
      .valid_o   (m_axi_wvalid),
      .ready_i   (m_axi_wready),
      .data_o    ({m_axi_wlast, m_axi_wstrb, m_axi_wdata}),
      .is_whole_o(is_whole)
  );

  logic [31:PORT+4] window;
  logic [3:0]       first, length;
  fifo #(
      .WIDTH(32 - PORT + 4),
      .DEPTH(16)
  ) u_bursts (
      .clk_i,
      .rst_ni,
      .valid_i(enters_burst),
      .ready_o(bursts_ready),
      .data_i ({beat_i.address[31:PORT], start}),
      .valid_o(m_axi_awvalid),
      .ready_i(m_axi_awready),
      .data_o ({window, length, first})
  );
  assign m_axi_awaddr = {window, first, PORT'(0)};
  assign m_axi_awlen  = 8'(4'(length - first));

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      pending_q  <= '0;
      next_q     <= '0;
      answered_q <= '0;
    end else begin
      if (enters_burst != is_answered) pending_q <= pending_q + (enters_burst ? PENDING'(1) : {PENDING{1'b1}});  // or -1
      next_q     <= next_q + NUMBER'(enters_burst);
      answered_q <= answered_q + NUMBER'(is_answered);
    end
  end

  // B of a burst of raster_top that was cut counts once.
  logic is_owed;
  generate
    if (SPLITS) begin : gen_cut
      logic is_last;
      fifo #(
          .WIDTH(1),
          .DEPTH(WRITES)
      ) u_flags (
          .clk_i,
          .rst_ni,
          .valid_i(enters_burst),
          .ready_o(),  // fewer than WRITES bursts are without B
          .data_i (beat_i.length == 1),
          .valid_o(),
          .ready_i(is_answered),
          .data_o (is_last)
      );
      assign is_owed = is_answered && is_last;
    end else begin : gen_whole
      assign is_owed = is_answered;
    end
  endgenerate

  // ----------------------------------------------------------------------------------------------------------- reads
  localparam int ROOM = $clog2(READ_BEATS + 1);
  logic               split_valid, split_ready, is_behind_write, has_room;
  logic [ROOM-1:0]    room_q;
  logic [BUCKETS-1:0] bucket;
  logic               asks, answers_read;

  burst_split #(
      .SHIFT  (PORT),
      .BEATS  (raster_pkg::BURST_LENGTH_BITS),
      .LONGEST(LONGEST)
  ) u_split (
      .clk_i,
      .rst_ni,
      .valid_i  (takes_read),
      .ready_o  (read_ready),
      .address_i(32'(beat_i.address)),
      .beats_i  (beat_i.length),
      .valid_o  (split_valid),
      .ready_i  (split_ready),
      .address_o(frame_araddr),
      .length_o (frame_arlen)
  );
  assign read_waits    = split_valid && !read_ready;
  assign has_room      = room_q > ROOM'(frame_arlen);
  assign frame_arvalid = split_valid && !is_behind_write && has_room;
  assign split_ready   = frame_arready && !is_behind_write && has_room;
  assign asks          = frame_arvalid && frame_arready;

  // The table. After reset it is filled once, so that no bucket is undefined: as many cycles as it has buckets. A beat
  // is a read or a write, so no bucket is read while it is written; later writes do not change the data of a waiting read.
  logic [BUCKETS:0]  fill_q;
  logic [NUMBER-1:0] noted;  // in the bucket of the read
  logic [NUMBER-1:0] age;    // age of that burst, 0: the oldest without B
  assign is_clearing     = !fill_q[BUCKETS];
  assign bucket          = bucket_of(32'(beat_i.address));
  assign age             = noted - answered_q;
  assign is_behind_write = age < NUMBER'(pending_q);

  sram #(
      .WIDTH    (NUMBER),
      .DEPTH    (1 << BUCKETS),
      .READS_OLD(0),
      .BLOCK    (1)
  ) u_table (
      .clk_i,
      .read_i         (takes_read),
      .read_address_i (bucket),
      .data_o         (noted),
      .write_i        (is_clearing || takes_write),
      .write_address_i(is_clearing ? fill_q[BUCKETS-1:0] : bucket),
      .data_i         (is_clearing ? '0 : next_q)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) fill_q <= '0;
    else if (is_clearing) fill_q <= fill_q + 1'b1;
  end

  // --------------------------------------------------------------------------------------------------------- answers
  logic               answer_waits, tells_write;
  logic [BITS-1:0]    answer;
  logic [PENDING-1:0] owed_q;  // answers to writes
  logic               holds_q;  // an answer to a read is on offer, and stays

  fifo #(
      .WIDTH(BITS),
      .DEPTH(READ_BEATS)
  ) u_answers (
      .clk_i,
      .rst_ni,
      .valid_i(frame_rvalid),
      .ready_o(),  // room_q counts
      .data_i (frame_rdata),
      .valid_o(answer_waits),
      .ready_i(answers_read),
      .data_o (answer)
  );
  assign frame_rready      = 1'b1;
  assign answer_o.is_write = owed_q != '0 && !holds_q;
  assign answer_o.data     = answer;
  assign answer_valid_o    = !forgets_q && (answer_o.is_write || answer_waits);
  assign tells_write       = answer_valid_o && answer_ready_i && answer_o.is_write;
  assign answers_read      = answer_waits && (forgets_q || (answer_ready_i && !answer_o.is_write));

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      owed_q    <= '0;
      holds_q   <= 1'b0;
      forgets_q <= 1'b0;
      room_q    <= ROOM'(READ_BEATS);
    end else begin
      if (forgets_q) owed_q <= '0;
      else if (is_owed != tells_write) owed_q <= owed_q + (is_owed ? PENDING'(1) : {PENDING{1'b1}});  // or -1
      holds_q   <= answer_valid_o && !answer_ready_i && !answer_o.is_write;
      forgets_q <= forget_i || (forgets_q && !idle_o);
      room_q    <= room_q - (asks ? ROOM'(frame_arlen) + 1'b1 : '0) + ROOM'(answers_read);
    end
  end
  assign idle_o = !split_valid && room_q == ROOM'(READ_BEATS) && pending_q == '0 && owed_q == '0 && is_whole;

  // ---------------------------------------------------------------------------------------------------------- errors
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      read_error_o  <= 1'b0;
      write_error_o <= 1'b0;
    end else begin
      read_error_o  <= (frame_rvalid && frame_rerror) || (read_error_o && !clear_errors_i);
      write_error_o <= (is_answered && m_axi_bresp[1]) || (write_error_o && !clear_errors_i);
    end
  end

endmodule
