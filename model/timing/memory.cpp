#include "memory.hpp"

#include <algorithm>
#include <vector>

#include "station.hpp"

namespace halfplane {
namespace {

using Picoseconds = std::uint64_t;

class FixedMemory final : public MemoryTiming {
 public:
  explicit FixedMemory(int latency) : latency_(static_cast<Cycle>(latency)) {}
  [[nodiscard]] Cycle room() const override { return 0; }
  Cycle accept(const MemoryAccess&, Cycle cycle) override { return cycle + latency_; }
  [[nodiscard]] Cycle fixed_latency() const override { return latency_; }

 private:
  Cycle latency_;
};

/// Where a request lies: tiles of the widest target one after the other, all depth before all colour, then the words of
/// either plane's flags, row by row.
class AddressMap {
 public:
  explicit AddressMap(const Config& config) : widths_(derive_widths(config)) {
    for (const bool is_color : {false, true})
      bytes_[is_color] = static_cast<std::uint64_t>(stamp_bytes(config, is_color));
  }
  [[nodiscard]] std::uint64_t bytes(const MemoryAccess& a) const {
    return is_flags(a) ? flag_bytes() : bytes_[a.plane == TilePlane::color];
  }
  [[nodiscard]] std::uint64_t address(const MemoryAccess& a) const {
    const auto stamps = static_cast<std::uint64_t>(widths_.stamps.stamps());
    const auto tiles_x = static_cast<std::uint64_t>(widths_.tiles_x),
               tiles_y = static_cast<std::uint64_t>(widths_.tiles_y);
    const std::uint64_t tile = static_cast<std::uint64_t>(a.tile_y) * tiles_x + static_cast<std::uint64_t>(a.tile_x);
    const auto plane = [&](bool is_color) {
      return (tiles_x * tiles_y * stamps * bytes_[is_color] + kPlane - 1) / kPlane * kPlane;
    };
    if (is_flags(a)) {
      const auto per_tile = static_cast<std::uint64_t>(widths_.blocks.per_tile),
                 word = static_cast<std::uint64_t>(widths_.blocks.flag_word);
      const std::uint64_t row = (tiles_x * per_tile + word - 1) / word, rows = tiles_y * per_tile;
      const std::uint64_t y = static_cast<std::uint64_t>(a.tile_y) * per_tile + static_cast<std::uint64_t>(a.stamp);
      const std::uint64_t first = a.plane == TilePlane::color_flags ? rows * row : 0;
      return plane(false) + plane(true) + (first + y * row + static_cast<std::uint64_t>(a.tile_x)) * flag_bytes();
    }
    const bool is_color = a.plane == TilePlane::color;
    return (is_color ? plane(false) : 0) + (tile * stamps + static_cast<std::uint64_t>(a.stamp)) * bytes_[is_color];
  }

 private:
  [[nodiscard]] static bool is_flags(const MemoryAccess& a) {
    return a.plane == TilePlane::depth_flags || a.plane == TilePlane::color_flags;
  }
  [[nodiscard]] std::uint64_t flag_bytes() const { return static_cast<std::uint64_t>(flag_word_bytes(widths_)); }
  static constexpr std::uint64_t kPlane = 4096;  ///< a plane begins at a multiple of it: no stamp lies in two rows
  Widths widths_;
  std::array<std::uint64_t, 2> bytes_{};
};

/// What all memories with a clock of their own have: a short queue, and time in picoseconds.
class ClockedMemory : public MemoryTiming {
 public:
  ClockedMemory(const Config& config, int mhz, Picoseconds clock)
      : map_(config), cycle_(1'000'000 / static_cast<Picoseconds>(mhz)), clock_(clock) {}

  [[nodiscard]] Cycle room() const final { return queue_.room(); }
  Cycle accept(const MemoryAccess& access, Cycle cycle) final {
    const Picoseconds arrives = round_up((cycle + 1) * cycle_);  // it has gone through a register
    const Picoseconds done = serve(access.is_write, map_.address(access), map_.bytes(access), arrives);
    const Cycle done_cycle = (done + cycle_ - 1) / cycle_;
    queue_.leave(done_cycle);
    return done_cycle + 1;
  }

 protected:
  /// The edge of the memory's clock at or after `time`.
  [[nodiscard]] Picoseconds round_up(Picoseconds time) const { return (time + clock_ - 1) / clock_ * clock_; }
  [[nodiscard]] Picoseconds clock() const { return clock_; }
  /// When the last byte of a request that comes at `arrives` has moved.
  virtual Picoseconds serve(bool is_write, std::uint64_t address, std::uint64_t bytes, Picoseconds arrives) = 0;

 private:
  static constexpr int kQueue = 8;  ///< requests
  AddressMap map_;
  Picoseconds cycle_, clock_;
  Station queue_{kQueue, 0, 1};
};

/// A DRAM with rows and banks, times in picoseconds unless said otherwise.
struct DramTiming {
  Picoseconds clock;
  std::uint64_t banks, row_bytes, bytes_per_clock;
  std::uint64_t burst_clocks;             ///< the shortest burst
  std::uint64_t read_clocks;              ///< CAS latency
  std::uint64_t write_clocks;             ///< CAS write latency
  Picoseconds row_to_column;              ///< tRCD
  Picoseconds precharge;                  ///< tRP
  Picoseconds row_active;                 ///< tRAS, activate to precharge
  Picoseconds row_cycle;                  ///< tRC, activate to activate of a bank
  Picoseconds write_recovery;             ///< tWR, last data to precharge
  Picoseconds write_to_read;              ///< tWTR, last data to a read
  Picoseconds refresh, refresh_interval;  ///< tRFC, tREFI
};

// Micron MT48LC16M16A2-6A, 256 Mbit x16: data sheet "256Mb: x4, x8, x16 SDRAM", table of AC characteristics. CL 3.
constexpr DramTiming kSdram{6'000, 4, 1024, 2, 1, 3, 0, 18'000, 18'000, 42'000, 60'000, 12'000, 0, 60'000, 7'812'500};
// Micron MT41K128M16-125 at DDR3-800 (CL 6, CWL 5), 2 Gbit x16: data sheet "2Gb: x4, x8, x16 DDR3L SDRAM". BL8.
constexpr DramTiming kDdr3{2'500,  8,      2048,   4,      4,      6,       5,        13'750,
                           13'750, 35'000, 48'750, 15'000, 10'000, 160'000, 7'800'000};

/// In order, rows left open; a request's column command goes out when its row is open and the data bus will be free.
class Dram final : public ClockedMemory {
 public:
  Dram(const Config& config, int mhz, const DramTiming& timing)
      : ClockedMemory(config, mhz, timing.clock),
        t_(timing),
        banks_(timing.banks),
        next_refresh_(timing.refresh_interval) {}

 private:
  static constexpr std::uint64_t kClosed = ~0ULL;
  struct Bank {
    std::uint64_t row = kClosed;
    Picoseconds may_activate = 0;  ///< earliest next one
    Picoseconds may_precharge = 0;
  };

  Picoseconds serve(bool is_write, std::uint64_t address, std::uint64_t bytes, Picoseconds arrives) override {
    while (arrives >= next_refresh_ || bus_free_ >= next_refresh_) refresh();
    const std::uint64_t row = address / (t_.row_bytes * t_.banks);
    Bank& bank = banks_[address / t_.row_bytes % t_.banks];
    Picoseconds column = std::max(arrives, command_free_);
    if (bank.row != row) {
      Picoseconds activate = std::max(column, bank.may_activate);
      if (bank.row != kClosed) activate = std::max(activate, std::max(column, bank.may_precharge) + t_.precharge);
      activate = round_up(activate);
      bank.row = row;
      bank.may_activate = activate + t_.row_cycle;
      bank.may_precharge = activate + t_.row_active;
      column = activate + t_.row_to_column;
    }
    const std::uint64_t latency = is_write ? t_.write_clocks : t_.read_clocks;
    if (!is_write) column = std::max(column, write_ended_ + t_.write_to_read);
    const Picoseconds bus = bus_free_ + (is_write != last_was_write_ ? t_.clock : 0);  // the bus turns round
    if (bus > latency * t_.clock) column = std::max(column, bus - latency * t_.clock);
    column = round_up(column);
    const std::uint64_t clocks = std::max(t_.burst_clocks, (bytes + t_.bytes_per_clock - 1) / t_.bytes_per_clock);
    const Picoseconds done = column + (latency + clocks) * t_.clock;
    command_free_ = column + t_.clock;
    bus_free_ = done;
    last_was_write_ = is_write;
    if (is_write) write_ended_ = done;
    bank.may_precharge = std::max(bank.may_precharge, is_write ? done + t_.write_recovery : column + clocks * t_.clock);
    return done;
  }

  /// All rows are closed and refreshed.
  void refresh() {
    Picoseconds begins = std::max(next_refresh_, bus_free_);
    for (const Bank& bank : banks_)
      if (bank.row != kClosed) begins = std::max(begins, bank.may_precharge);
    const Picoseconds ends = round_up(begins + t_.precharge + t_.refresh);
    for (Bank& bank : banks_) bank = {kClosed, ends, 0};
    command_free_ = ends;
    next_refresh_ += t_.refresh_interval;
  }

  DramTiming t_;
  std::vector<Bank> banks_;
  Picoseconds next_refresh_, command_free_ = 0, bus_free_ = 0, write_ended_ = 0;
  bool last_was_write_ = false;
};

/// AP Memory APS6404L-3SQR, 64 Mbit, QPI at 84 MHz: data sheet "QSPI PSRAM", 38h quad write and EBh quad read. Every
/// request has a command of its own; it refreshes itself while it is not selected.
class Psram final : public ClockedMemory {
 public:
  Psram(const Config& config, int mhz) : ClockedMemory(config, mhz, kClock) {}

 private:
  static constexpr Picoseconds kClock = 11'905, kDeselected = 18'000;        // tCPH
  static constexpr std::uint64_t kCommand = 2, kAddress = 6, kReadWait = 6;  // clocks
  Picoseconds serve(bool is_write, std::uint64_t, std::uint64_t bytes, Picoseconds arrives) override {
    const Picoseconds begins = round_up(std::max(arrives, free_));
    const Picoseconds done = begins + (kCommand + kAddress + (is_write ? 0 : kReadWait) + 2 * bytes) * clock();
    free_ = done + kDeselected;
    return done;
  }
  Picoseconds free_ = 0;
};

}  // namespace

MemoryKind memory_kind(std::string_view name) {
  for (std::size_t i = 0; i < kMemoryKinds.size(); ++i)
    if (kMemoryKinds[i] == name) return static_cast<MemoryKind>(i);
  throw InputError("no memory '" + std::string(name) + "'; give fixed, sram, sdram, psram or ddr3");
}

int stamp_bytes(const Config& config, bool is_color) {
  const int depth = config.depth_bits <= 8 ? 1 : config.depth_bits <= 16 ? 2 : 4;
  const int color = config.color_format == ColorFormat::rgb565 ? 2 : 4;
  return config.stamp_size * config.stamp_size * (is_color ? color : depth);
}

int flag_word_bytes(const Widths& widths) { return (widths.blocks.flag_word + 7) / 8; }

std::unique_ptr<MemoryTiming> make_memory(const MemorySettings& settings, const Config& config) {
  switch (settings.kind) {
    case MemoryKind::fixed: break;
    case MemoryKind::sram: return std::make_unique<FixedMemory>(2);
    case MemoryKind::sdram: return std::make_unique<Dram>(config, settings.mhz, kSdram);
    case MemoryKind::psram: return std::make_unique<Psram>(config, settings.mhz);
    case MemoryKind::ddr3: return std::make_unique<Dram>(config, settings.mhz, kDdr3);
  }
  return std::make_unique<FixedMemory>(settings.latency);
}

}  // namespace halfplane
