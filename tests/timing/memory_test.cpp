// The memories by themselves: bursts, rows, refresh, order.
#include <gtest/gtest.h>

#include <map>

#include "model/timing/memory.hpp"

namespace halfplane::memory_test {
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

MemorySettings sdram_with(const char* text, MemoryTraffic traffic = {}) {
  MemorySettings settings;
  set_memory(settings, text);
  settings.mhz = 100;
  settings.traffic = traffic;
  return settings;
}

TEST(Memory, AWiderSdramMovesMoreAndASlowerOneLess) {
  const Config config = preset("embedded");
  const auto cycles = [&](const char* text) { return read_run(*make_memory(sdram_with(text), config), 512, 8, 0); };
  const Cycle usual = cycles("sdram");
  EXPECT_EQ(cycles("sdram,width=16,mhz=167"), usual);
  EXPECT_GT(cycles("sdram,width=8"), usual * 3 / 2);
  EXPECT_LT(cycles("sdram,width=32"), usual * 2 / 3);
  EXPECT_GT(cycles("sdram,mhz=100"), usual * 3 / 2);
  EXPECT_LT(cycles("sdram,width=32,mhz=133"), usual);
}

TEST(Memory, SettingsThatNoSdramHasAreRefusedInOneLine) {
  for (const char* const text :
       {"sdram,width=24", "sdram,width=", "sdram,mhz=5", "sdram,mhz=133x", "sdram,cl=3", "sdram,",
        "sdram,width=16,width=32", "sdram,mhz=100,width=8,mhz=100", "ddr3,width=32", "fixed,mhz=100", "hbm"}) {
    MemorySettings settings;
    try {
      set_memory(settings, text);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
      EXPECT_EQ(settings, MemorySettings{}) << text;
    }
  }
  EXPECT_EQ(memory_name(sdram_with("sdram,mhz=133,width=32")), "sdram,width=32,mhz=133");
}

TEST(Memory, WithoutOtherMastersNothingChanges) {
  const Config config = preset("embedded");
  for (const MemoryKind kind : {MemoryKind::fixed, MemoryKind::sdram, MemoryKind::psram, MemoryKind::ddr3}) {
    const auto alone = make_memory({kind, 8, 100}, config), shown = make_memory({kind, 8, 100}, config);
    shown->show(640, 480);
    EXPECT_EQ(read_run(*alone, 300, 24, 0), read_run(*shown, 300, 24, 0));
    EXPECT_EQ(shown->use(), MemoryUse{});
  }
}

/// The bytes that scan-out reads in a second of a target, in a memory that is asked for nothing else but at the end.
MemoryUse use_in_a_second(const char* text, const Config& config, int width, int height, MemoryTraffic traffic) {
  const auto memory = make_memory(sdram_with(text, traffic), config);
  memory->show(width, height);
  (void)memory->accept({false, 0, 1}, 100'000'000 - 2);
  return memory->use();
}

TEST(Memory, ScanOutReadsThePictureAtItsRate) {
  // 640 x 480 in 2 bytes, 60 times a second: 36,864,000 bytes in 7,200 bands of four lines.
  const Config config = preset("embedded");
  const MemoryUse use = use_in_a_second("sdram", config, 640, 480, {60, 0});
  EXPECT_NEAR(static_cast<double>(use.scan_out_bytes), 640.0 * 480 * 2 * 60, 640.0 * 4 * 2);
  EXPECT_NEAR(static_cast<double>(use.bands), 7200, 1);
  EXPECT_EQ(use.late_bands, 0u);
  // With flags a beat for each 32 tiles in addition: three of them in a band.
  Config flags = config;
  flags.frame_clears = FrameClears::flags;
  const MemoryUse with_flags = use_in_a_second("sdram", flags, 640, 480, {60, 0});
  EXPECT_NEAR(static_cast<double>(with_flags.scan_out_bytes - use.scan_out_bytes), 7200.0 * 3 * 8, 640.0 * 4 * 2);
  // Whole tiles: 641 pixels are 81 tiles, of 481 lines the last band is whole, too.
  const MemoryUse odd = use_in_a_second("sdram", config, 641, 481, {60, 0});
  EXPECT_NEAR(static_cast<double>(odd.scan_out_bytes), 648.0 * 484 * 2 * 60, 648.0 * 4 * 2);
}

TEST(Memory, OtherMastersReadTheirBytes) {
  const MemoryUse use = use_in_a_second("sdram", preset("embedded"), 640, 480, {0, 50'000'000});
  EXPECT_NEAR(static_cast<double>(use.other_bytes), 50e6, 128);
  EXPECT_EQ(use.scan_out_bytes, 0u);
}

TEST(Memory, AMemoryThatIsTooSlowForScanOutIsLate) {
  // QSPI at 42 MB/s against 110 MB/s.
  const MemoryUse use = use_in_a_second("psram", preset("embedded"), 1280, 720, {60, 0});
  EXPECT_GT(use.late_bands, use.bands / 2);
  EXPECT_LT(use.scan_out_bytes, 45'000'000u);
}

TEST(Memory, OtherMastersAreServedWhileThePortOnlyWrites) {
  const Config config = preset("embedded");
  for (const char* const text : {"fixed", "sram", "sdram", "ddr3"}) {
    const auto memory = make_memory(sdram_with(text, {0, 50'000'000}), config);
    for (Cycle at = 0; at < 100'000; at += 100) (void)memory->accept({true, 0, 1}, std::max(at, memory->room()));
    EXPECT_NEAR(static_cast<double>(memory->use().other_bytes), 50e3, 200) << text;  // a millisecond
  }
}

/// The message of a refusal, or an empty text.
std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Memory, MoreTrafficThanMemoryGivesIsRefusedWithBothRates) {
  const Config config = preset("embedded");
  // 8 bytes a cycle of 100 MHz; a byte a clock of 50 MHz.
  for (const auto& [text, most] : {std::pair{"fixed", 800'000'000U},
                                   {"sram", 800'000'000U},
                                   {"sdram,width=8,mhz=50", 50'000'000U},
                                   {"ddr3", 1'600'000'000U}}) {
    EXPECT_EQ(refusal([&] { (void)make_memory(sdram_with(text, {0, most / 2}), config); }), "") << text;
    const std::string said = refusal([&] { (void)make_memory(sdram_with(text, {0, most + 1}), config); });
    EXPECT_NE(said.find("ask for " + std::to_string(most + 1) + " bytes"), std::string::npos) << text << ": " << said;
    EXPECT_NE(said.find(std::string("the memory ") + text + " gives them "), std::string::npos) << said;
  }
}

/// Bytes that are nearly all that memory has would delay the port without end.
TEST(Memory, AFrameThatOtherMastersDelayWithoutEndIsGivenUp) {
  const Config config = preset("embedded");
  std::uint64_t low = 300'000'000, high = 334'000'000;  // the most that is accepted
  while (high - low > 1) {
    const std::uint64_t middle = (low + high) / 2;
    const bool refuses = !refusal([&] { (void)make_memory(sdram_with("sdram", {0, middle}), config); }).empty();
    (refuses ? high : low) = middle;
  }
  std::cout << "sdram: " << low << " bytes/s at most\n";
  const auto memory = make_memory(sdram_with("sdram", {0, low}), config);
  const std::string said = refusal([&] { (void)read_run(*memory, 2'000'000, 8, 0); });
  EXPECT_NE(said.find("ask for " + std::to_string(low) + " bytes"), std::string::npos) << said;
}

TEST(Memory, OtherMastersTakeTheTimeOfThePort) {
  const Config config = preset("embedded");
  for (const char* const text : {"fixed", "sdram", "ddr3"}) {
    const auto alone = make_memory(sdram_with(text), config);
    const auto shared = make_memory(sdram_with(text, {60, 40'000'000}), config);
    shared->show(640, 480);
    const Cycle quick = read_run(*alone, 20'000, 8, 0), slow = read_run(*shared, 20'000, 8, 0);
    EXPECT_GT(slow, quick + quick / 50) << text;
    EXPECT_LT(slow, 3 * quick) << text;
  }
}

}  // namespace
}  // namespace halfplane::memory_test
