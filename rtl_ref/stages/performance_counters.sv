// Performance counters: the work of triangles, points and lines, and the traffic of tiles to and from memory, since
// reset. The framebuffer's events come through a register. A counter whose highest bit falls has wrapped, and
// `overflow` stays. Without the unit the counters are constant and are removed. Specification: CounterPacket of
// model/packets/packets.hpp.
module performance_counters #(
    parameter int COUNT = $clog2(raster_pkg::SAMPLES + 1),  // derived; not to be set
    parameter int TESTED = 2 * raster_pkg::TILE_SHIFT + $clog2(raster_pkg::MSAA_SAMPLES) + 1
) (
    input logic clk_i,
    input logic rst_ni,

    // Events of this cycle: primitives, from cull; visits and samples to be tested, from coarse_raster
    input logic              is_primitive_i,
    input logic              is_zero_area_i,
    input logic              is_backface_i,
    input logic              is_empty_i,
    input logic              is_no_sample_i,
    input logic              is_visited_i,
    input logic              is_outside_i,
    input logic              is_accepted_i,
    input logic              is_hiz_i,
    input logic [TESTED-1:0] samples_tested_i,
    // Samples, from depth_test or late_test
    input logic [COUNT-1:0]  covered_i,
    input logic [COUNT-1:0]  passed_i,
    input logic [COUNT-1:0]  written_i,
    input logic [COUNT-1:0]  killed_i,
    // Stamps of the framebuffer, and cache use of the texture unit
    input logic              fill_i,
    input logic              evict_i,
    input logic              clear_i,
    input logic [6:0]        texture_use_i,

    input  logic                        hold_i,  // the snapshot stays, and counting goes on
    output raster_pkg::counter_packet_t counters_o
);

  localparam int COUNTER = raster_pkg::COUNTER_BITS;
  localparam int COUNTERS = (raster_pkg::COUNTER_PACKET_BITS - 1) / COUNTER;
  localparam int TEXTURE_AT = raster_pkg::COORDINATES != 0 && raster_pkg::ALPHA_UNIT != 0 ? COUNTER : 0;
  raster_pkg::counter_packet_t counters_q, shown_q;
  logic [COUNTERS-1:0]         highest, highest_q;
  logic                        fill_q, evict_q, clear_q;
  logic [8:0]                  texture_use_q;
  logic                        overflow_q;
  assign counters_o = shown_q;

  always_comb begin
    for (int i = 0; i < COUNTERS; i++) highest[i] = counters_q[i*COUNTER+COUNTER-1];
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      fill_q        <= 1'b0;
      evict_q       <= 1'b0;
      clear_q       <= 1'b0;
      texture_use_q <= '0;
      highest_q     <= '0;
      overflow_q    <= 1'b0;
      counters_q    <= '0;
      shown_q       <= '0;
    end else if (raster_pkg::COUNTERS_UNIT != 0) begin
      fill_q        <= fill_i;
      evict_q       <= evict_i;
      clear_q       <= clear_i;
      texture_use_q <= 9'(texture_use_i);
      highest_q     <= highest;
      overflow_q    <= overflow_q || (highest_q & ~highest) != '0;
      counters_q.primitives_in      <= counters_q.primitives_in + COUNTER'(is_primitive_i);
      counters_q.zero_area          <= counters_q.zero_area + COUNTER'(is_zero_area_i);
      counters_q.backface           <= counters_q.backface + COUNTER'(is_backface_i);
      counters_q.empty              <= counters_q.empty + COUNTER'(is_empty_i);
      if (raster_pkg::SETUP_KIND == 0) counters_q.no_sample <= counters_q.no_sample + COUNTER'(is_no_sample_i);
      counters_q.tiles_visited      <= counters_q.tiles_visited + COUNTER'(is_visited_i);
      counters_q.tiles_outside      <= counters_q.tiles_outside + COUNTER'(is_outside_i);
      counters_q.trivially_accepted <= counters_q.trivially_accepted + COUNTER'(is_accepted_i);
      counters_q.tiles_hiz          <= counters_q.tiles_hiz + COUNTER'(is_hiz_i);
      counters_q.samples_tested     <= counters_q.samples_tested + COUNTER'(samples_tested_i);
      counters_q.covered            <= counters_q.covered + COUNTER'(covered_i);
      counters_q.depth_passed       <= counters_q.depth_passed + COUNTER'(passed_i);
      counters_q.written            <= counters_q.written + COUNTER'(written_i);
      counters_q.tile_fills         <= counters_q.tile_fills + COUNTER'(fill_q);
      counters_q.tile_evictions     <= counters_q.tile_evictions + COUNTER'(evict_q);
      counters_q.tile_clears        <= counters_q.tile_clears + COUNTER'(clear_q);
      if (raster_pkg::ALPHA_UNIT != 0 && raster_pkg::CACHE_KIND == 1 && raster_pkg::SETUP_KIND == 0)
        counters_q[COUNTER-1:0] <= counters_q[COUNTER-1:0] + COUNTER'(killed_i);  // the last is alpha_killed
      if (raster_pkg::COORDINATES != 0)  // before that texture_samples, texture_hits, texture_fills
        for (int i = 0; i < 3; i++)
          counters_q[TEXTURE_AT+(2-i)*COUNTER+:COUNTER] <= counters_q[TEXTURE_AT+(2-i)*COUNTER+:COUNTER] +
                                                           COUNTER'(texture_use_q[3*i+:3]);
      if (!hold_i) begin
        shown_q          <= counters_q;
        shown_q.overflow <= overflow_q;
      end
    end
  end

endmodule
