// The memories by themselves: bursts, rows, refresh, order.
#include <gtest/gtest.h>

#include <map>

#include "model/timing/memory.hpp"

namespace halfplane {
namespace {

std::unique_ptr<MemoryTiming> memory(MemoryKind kind, int mhz = 100) {
  return make_memory({kind, 8, mhz}, preset("embedded"));
}

TEST(Memory, TheFixedOneAnswersAfterItsLatencyAndTakesABeatEveryCycle) {
  const auto fixed = memory(MemoryKind::fixed);
  for (Cycle c = 0; c < 50; ++c) {
    EXPECT_LE(fixed->room(), c);
    EXPECT_EQ(fixed->accept({}, c).at(0), c + 8);
  }
  EXPECT_EQ(fixed->accept({false, 0, 4}, 100).at(3), 111u) << "then a beat a cycle";
}

TEST(Memory, BlockRamTakesTwoCycles) { EXPECT_EQ(memory(MemoryKind::sram)->accept({}, 5).at(0), 7u); }

/// Reads `count` stamps of 8 bytes as fast as they are accepted, each `step` bytes after the previous stamp; returns
/// the cycle of the last answer.
Cycle read_run(MemoryTiming& memory, int count, std::uint64_t step, Cycle from) {
  Cycle at = from, answer = 0;
  for (int i = 0; i < count; ++i, ++at) {
    at = std::max(at, memory.room());
    const Cycle next = memory.accept({false, static_cast<std::uint64_t>(i) * step, 1}, at).at(0);
    EXPECT_GE(next, answer);
    answer = next;
  }
  return answer;
}

// SDR at 6 ns: a row miss costs at least tRP + tRCD, which hits do not pay.
TEST(Memory, SdramReadsOneRowFasterThanManyRows) {
  const auto one_row = memory(MemoryKind::sdram), many_rows = memory(MemoryKind::sdram);
  const Cycle hits = read_run(*one_row, 64, 8, 0), misses = read_run(*many_rows, 64, 4096, 0);
  EXPECT_LT(hits, 64u * 4u);
  EXPECT_GT(misses, hits * 3 / 2);
}

// The first read of an idle SDRAM: activate, tRCD = 3 clocks, CL = 3, 4 words of 6 ns: 60 ns, after the request's register.
TEST(Memory, TheFirstSdramReadTakesTrcdAndCasAndItsBurst) {
  const auto sdram = memory(MemoryKind::sdram);
  // Accepted in cycle 10: at 110 ns, 114 ns at the memory's edge, done at 174 ns: cycle 18, visible in cycle 19.
  EXPECT_EQ(sdram->accept({}, 10).at(0), 19u);
}

TEST(Memory, RefreshStopsSdramAboutEvery78Microseconds) {
  const auto sdram = memory(MemoryKind::sdram);
  std::map<Cycle, int> waits;                                                        // how often an answer took so long
  for (Cycle at = 0; at < 8000; at += 7) ++waits[sdram->accept({}, at).at(0) - at];  // 80 us at 100 MHz, one row
  // Ten times precharge and refresh, 78 ns, and then the row again: a request or two wait for each of them.
  int late = 0;
  const Cycle usual = waits.begin()->first;
  for (const auto& [wait, times] : waits) late += wait > usual + 3 ? times : 0;
  EXPECT_GE(late, 8);
  EXPECT_LE(late, 24);
}

TEST(Memory, PsramPaysForEveryCommand) {
  const auto psram = memory(MemoryKind::psram);
  // 2 + 6 + 6 clocks and 16 for 8 bytes at 84 MHz: 357 ns.
  const Cycle answer = psram->accept({}, 0).at(0);
  EXPECT_GE(answer, 36u);
  EXPECT_LE(answer, 41u);
}

TEST(Memory, ABurstPaysForItsCommandOnce) {
  // 16 stamps of 8 bytes, one by one and at once.
  for (const MemoryKind kind : {MemoryKind::psram, MemoryKind::ddr3}) {
    const auto single = memory(kind), burst = memory(kind);
    const Cycle one_by_one = read_run(*single, 16, 8, 0), at_once = burst->accept({false, 0, 16}, 0).at(15);
    EXPECT_LT(at_once * 3, one_by_one * 2);
  }
  // A PSRAM is not selected for longer than it can go without a refresh.
  const auto psram = memory(MemoryKind::psram);
  const BurstAnswer answer = psram->accept({true, 0, 64}, 0);  // 512 bytes: two commands
  EXPECT_GT(answer.at(0), (2 * (8 + 512) * 1190U) / 1000);
}

TEST(Memory, ABurstThatCrossesARowOpensBoth) {
  const auto closed = memory(MemoryKind::sdram), across = memory(MemoryKind::sdram);
  (void)across->accept({false, 1024 - 64, 16}, 0);
  (void)closed->accept({false, 0, 16}, 0);
  EXPECT_LT(across->accept({false, 1024 + 64, 1}, 100).at(0), closed->accept({false, 1024 + 64, 1}, 100).at(0));
}

TEST(Memory, AWriteIsAnsweredOnceAllOfItIsWritten) {
  const auto sdram = memory(MemoryKind::sdram);
  const BurstAnswer one = sdram->accept({true, 0, 1}, 0), many = sdram->accept({true, 8, 16}, 1);
  EXPECT_GE(many.at(0), one.at(0) + 16 * 4 * 6 / 10);
}

TEST(Memory, AFasterChipWaitsMoreCyclesForTheSameMemory) {
  for (const MemoryKind kind : {MemoryKind::sdram, MemoryKind::psram, MemoryKind::ddr3}) {
    const auto slow = memory(kind, 25), fast = memory(kind, 200);
    EXPECT_LT(read_run(*slow, 40, 8, 0), read_run(*fast, 40, 8, 0));
  }
}

TEST(Memory, AQueueThatIsFullTakesNothing) {
  const auto psram = memory(MemoryKind::psram);
  Cycle at = 0;
  for (; psram->room() <= at; ++at) (void)psram->accept({}, at);
  EXPECT_EQ(at, 8u);
  EXPECT_GT(psram->room(), 8u);
}

TEST(Memory, AnUnknownNameIsRefusedWithTheKnownOnes) {
  try {
    (void)memory_kind("hbm");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "no memory 'hbm'; give fixed, sram, sdram, psram or ddr3");
  }
}

}  // namespace
}  // namespace halfplane
