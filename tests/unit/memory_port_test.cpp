// The memory port: where stamps lie, how a run becomes a burst of beats, and the answers.
#include "model/stages/memory_port.hpp"

#include <gtest/gtest.h>

#include <map>

#include "../hardware_scene.hpp"

namespace halfplane::memory_port_test {
namespace {

using test::with;

const std::vector<Config>& configurations() {
  static const std::vector<Config> all{
      preset("embedded"),
      preset("tiny"),
      preset("full"),
      with("embedded", {{"memory.port_bits", "16"}}),
      with("embedded", {{"memory.port_bits", "128"}}),
      with("embedded", {{"memory.port_bits", "512"}, {"cache.kind", "tiles"}, {"cache.lines", "16"}}),
      with("embedded", {{"depth.bits", "20"}, {"memory.port_bits", "32"}}),
      with("tiny", {{"tile.size", "4"}, {"stamp.size", "4"}, {"memory.port_bits", "512"}}),
      with("full", {{"memory.port_bits", "64"}})};
  return all;
}

MemoryLayout moved(const Widths& widths) {
  MemoryLayout layout = default_layout(widths);
  const std::uint32_t by = 3U << std::max(widths.memory.tile(), widths.memory.flag_row);
  for (std::uint32_t* base :
       {&layout.depth_base, &layout.color_base, &layout.depth_flags_base, &layout.color_flags_base})
    *base += by;
  layout.row_stride += 1U << widths.memory.tile();
  layout.depth_flags_base += static_cast<std::uint32_t>(widths.tiles_y) << widths.memory.tile();
  layout.color_flags_base += static_cast<std::uint32_t>(widths.tiles_y) << widths.memory.tile();
  return layout;
}

TEST(MemoryLayout, NoTwoStampsShareAByteAndAllOfThemAreInside) {
  for (const Config& config : configurations()) {
    const Widths widths = derive_widths(config);
    for (const MemoryLayout& layout : {default_layout(widths), moved(widths)}) {
      SCOPED_TRACE(label(config));
      std::map<std::uint32_t, std::uint32_t> pieces;  // by address: bytes
      const int last_x = widths.tiles_x - 1, last_y = widths.tiles_y - 1;
      for (const TilePlane plane : kTilePlanes)
        for (const int x : {0, 1, last_x})
          for (const int y : {0, 1, last_y})
            for (int stamp = 0; stamp < widths.stamps.stamps(); ++stamp)
              pieces[byte_address(plane, x, y, stamp, layout, widths)] = 1U << item_shift(plane, widths.memory);
      if (config.cache_kind == CacheKind::blocks)
        for (const TilePlane plane : {TilePlane::depth_flags, TilePlane::color_flags})
          for (const int y : {0, 1, last_y})
            for (int row = 0; row < widths.blocks.per_tile; ++row)
              for (int word = 0; word * widths.blocks.flag_word < widths.tiles_x * widths.blocks.per_tile; ++word)
                pieces[byte_address(plane, word, y, row, layout, widths)] = 1U << widths.memory.flag_word;
      std::uint64_t end = 0;
      for (const auto& [address, bytes] : pieces) {
        EXPECT_GE(address, end);
        end = std::uint64_t{address} + bytes;
      }
      EXPECT_LE(end, layout_end(layout, widths));
    }
  }
}

TEST(MemoryLayout, TheStampsOfABlockFollowEachOtherAndTheTilesOfARowHaveAPitch) {
  const Widths widths = derive_widths(preset("embedded"));
  const MemoryLayout layout = default_layout(widths);
  const auto at = [&](int x, int y, int stamp) { return byte_address(TilePlane::depth, x, y, stamp, layout, widths); };
  // Tiles of 4x4 stamps of 8 bytes, blocks of 2x2.
  EXPECT_EQ(at(0, 0, 0), 0u);
  EXPECT_EQ(at(0, 0, 1), 8u);
  EXPECT_EQ(at(0, 0, 4), 16u);
  EXPECT_EQ(at(0, 0, 5), 24u);
  EXPECT_EQ(at(0, 0, 2), 32u);
  EXPECT_EQ(at(0, 0, 8), 64u);
  EXPECT_EQ(at(1, 0, 0), 256u);
  EXPECT_EQ(at(0, 1, 0), layout.row_stride);
  EXPECT_EQ(layout.row_stride, 240u * 256u);
  EXPECT_EQ(layout.color_base, 128u);
}

/// A run of writes, and its bytes in memory afterwards; checks the bursts on the way.
TEST(MemoryPort, ARunIsOneBurstAndEveryByteGoesWhereItBelongs) {
  for (const Config& config : configurations()) {
    const Widths widths = derive_widths(config);
    const MemoryLayout layout = moved(widths);
    PortStage port(widths, layout);
    std::map<std::uint32_t, std::uint8_t> memory, expected;
    int left = 0, bursts = 0;
    std::uint32_t next = 0;
    std::uint32_t value = 1;
    const int block = config.cache_kind == CacheKind::blocks ? widths.blocks.stamps() : widths.stamps.stamps();
    for (const TilePlane plane : kTilePlanes)
      for (int begin = 0; begin < block; ++begin)
        for (int count = 1; begin + count <= block; ++count) {
          SCOPED_TRACE(label(config) + ", " + std::to_string(begin) + ", " + std::to_string(count));
          for (int n = 0; n < count; ++n) {
            int stamp = begin + n;
            if (config.cache_kind == CacheKind::blocks) stamp = stamp_address({{0, 0}, stamp}, widths).stamp;
            MemoryRequest request;
            request.is_write = true;
            request.plane = plane;
            request.tile_x = 1;
            request.tile_y = 1;
            request.stamp = static_cast<std::uint16_t>(stamp);
            request.run = static_cast<std::uint16_t>(count - n);
            std::uint32_t address = byte_address(plane, 1, 1, stamp, layout, widths);
            const int bytes = 1 << widths.memory.sample[is_of_color(plane) ? 1 : 0];
            for (int s = 0; s < widths.samples; ++s) {
              value = value * 0x9E3779B1U + 1;
              request.strobe.set(s, (value >> 9 & 3) != 0);
              const int bits = is_of_color(plane) ? widths.stored_color.bits : widths.depth().code.bits;
              if (request.strobe.has(static_cast<std::size_t>(s)))
                request.data[static_cast<std::size_t>(s)] = static_cast<std::uint32_t>(wrap_unsigned(value, bits));
              for (int b = 0; b < bytes; ++b, ++address)
                if (request.strobe.has(static_cast<std::size_t>(s)))
                  expected[address] = static_cast<std::uint8_t>(request.data[static_cast<std::size_t>(s)] >> 8 * b);
            }
            port.take(request, [&](const MemoryBeat& beat) {
              EXPECT_EQ(beat.is_first, left == 0);
              if (beat.is_first) {
                left = beat.length;
                next = beat.address;
                ++bursts;
              }
              EXPECT_EQ(beat.length, left);
              EXPECT_EQ(beat.address, next);
              EXPECT_EQ(beat.address % static_cast<std::uint32_t>(widths.port_bytes), 0u);
              --left;
              next += static_cast<std::uint32_t>(widths.port_bytes);
              for (std::uint32_t b = 0; b < static_cast<std::uint32_t>(widths.port_bytes); ++b)
                if ((beat.strobe >> b & 1) != 0)
                  memory[beat.address + b] = beat.data[b];
                else
                  EXPECT_EQ(beat.data[b], 0);
            });
          }
          EXPECT_EQ(left, 0) << "the burst has ended";
        }
    EXPECT_EQ(memory, expected) << label(config);
    EXPECT_EQ(bursts, block * (block + 1));
  }
}

TEST(MemoryPort, WhatIsReadIsWhatMemoryAnswers) {
  for (const Config& config : configurations()) {
    const Widths widths = derive_widths(config);
    const MemoryLayout layout = default_layout(widths);
    PortStage port(widths, layout);
    const auto byte = [](std::uint32_t address) { return static_cast<std::uint8_t>(address * 37 + (address >> 8)); };
    for (const TilePlane plane : kTilePlanes)
      for (const int first : {0, 1, widths.stamps.stamps() - 1}) {
        if (first >= widths.stamps.stamps()) continue;
        SCOPED_TRACE(label(config) + ", " + std::to_string(first));
        MemoryRequest request;
        request.plane = plane;
        request.tile_x = 1;
        request.stamp = static_cast<std::uint16_t>(first);
        request.run =
            static_cast<std::uint16_t>(first == 0 && widths.blocks.per_tile == 1 ? widths.stamps.stamps() : 1);
        std::vector<MemoryResponse> responses;
        port.take(request, [&](const MemoryBeat& beat) {
          EXPECT_TRUE(beat.is_first);
          EXPECT_EQ(beat.strobe, 0u);
          for (std::uint32_t n = 0; n < beat.length; ++n) {
            MemoryAnswer answer;
            for (std::uint32_t b = 0; b < static_cast<std::uint32_t>(widths.port_bytes); ++b)
              answer.data[b] = byte(beat.address + n * static_cast<std::uint32_t>(widths.port_bytes) + b);
            port.answer(answer, [&](const MemoryResponse& response) { responses.push_back(response); });
          }
        });
        ASSERT_EQ(responses.size(), request.run);
        for (std::size_t n = 0; n < responses.size(); ++n) {
          std::uint32_t address = byte_address(plane, 1, 0, first + static_cast<int>(n), layout, widths);
          for (int s = 0; s < widths.samples; ++s) {
            std::uint32_t value = 0;
            for (int b = 0; b < 1 << widths.memory.sample[is_of_color(plane) ? 1 : 0]; ++b)
              value |= std::uint32_t{byte(address++)} << 8 * b;
            EXPECT_EQ(responses[n].data[static_cast<std::size_t>(s)],
                      static_cast<std::uint32_t>(wrap_unsigned(value, widths.memory_lane.bits)));
          }
        }
      }
  }
}

TEST(MemoryPort, ARowOfFlagsIsOneBurst) {
  const Config config = with("embedded", {{"memory.port_bits", "128"}});  // two words a beat
  const Widths widths = derive_widths(config);
  PortStage port(widths, default_layout(widths));
  std::vector<MemoryBeat> beats;
  for (std::uint16_t word = 0; word < 3; ++word) {
    MemoryRequest request;
    request.is_write = true;
    request.plane = TilePlane::color_flags;
    request.tile_x = word;
    request.tile_y = 2;
    request.stamp = 1;
    request.run = static_cast<std::uint16_t>(3 - word);
    request.strobe = SampleMask::all(widths.samples);
    set_flag_word(request, 0x0102030405060708ULL * (word + 1U), widths);
    port.take(request, [&](const MemoryBeat& beat) { beats.push_back(beat); });
  }
  ASSERT_EQ(beats.size(), 2u);
  EXPECT_EQ(beats[0].length, 2);
  EXPECT_EQ(beats[0].strobe, 0xFFFFu);
  EXPECT_EQ(beats[0].data[0], 8);
  EXPECT_EQ(beats[0].data[8], 16);
  EXPECT_EQ(beats[1].length, 1);
  EXPECT_FALSE(beats[1].is_first);
  EXPECT_EQ(beats[1].strobe, 0xFFu);
  EXPECT_EQ(beats[1].data[7], 3);
  EXPECT_EQ(beats[0].address, default_layout(widths).color_flags_base + (5U << widths.memory.flag_row));
}

}  // namespace
}  // namespace halfplane::memory_port_test
