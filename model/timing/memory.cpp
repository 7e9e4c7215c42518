#include "memory.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "../as_number.hpp"
#include "station.hpp"

namespace halfplane {
namespace {

using Picoseconds = std::uint64_t;

/// Length of a cycle of the chip.
Picoseconds cycle_of(int mhz) { return 1'000'000 / static_cast<Picoseconds>(mhz); }

[[noreturn]] void refuse_traffic(const MemorySettings& settings, std::uint64_t given) {
  throw InputError("other masters ask for " + std::to_string(settings.traffic.other_bytes_per_s) +
                   " bytes a second, and the memory " + memory_name(settings) + " gives them " + std::to_string(given) +
                   "; ask for less, the frame needs some of it");
}

/// A memory with the other masters, if there are any.
class SharedMemory : public MemoryTiming {
 public:
  SharedMemory(const MemorySettings& settings, const Config& config)
      : settings_(settings), cycle_(cycle_of(settings.mhz)) {
    if (!settings.traffic.is_none()) others_.emplace(settings.traffic, config, cycle_);
  }
  void show(int width, int height) final {
    if (others_) others_->show(width, height);
  }
  [[nodiscard]] MemoryUse use() const final { return others_ ? others_->use() : MemoryUse{}; }
  /// A read of another master, which the memory gets at `arrives`, in order; its end.
  virtual Picoseconds serve_other(std::uint64_t address, std::uint64_t bytes, Picoseconds arrives) = 0;

 protected:
  [[nodiscard]] bool is_shared() const { return others_.has_value(); }
  [[nodiscard]] Picoseconds cycle() const { return cycle_; }
  /// Serves the requests of other masters up to `time`.
  void serve_others(Picoseconds time) {
    if (!others_) return;
    others_->until(time, [&](std::uint64_t address, std::uint64_t bytes, Picoseconds arrives) {
      const Picoseconds ends = serve_other(address, bytes, arrives);
      if (ends > arrives + kPatience) refuse_traffic(settings_, bytes_given(ends));
      return ends;
    });
  }

 private:
  /// Others that ask for nearly all of the memory delay the port more and more: a frame would not end in sensible time.
  static constexpr Picoseconds kPatience = 1'000'000'000;
  [[nodiscard]] std::uint64_t bytes_given(Picoseconds time) const {
    return static_cast<std::uint64_t>(static_cast<double>(use().other_bytes) / static_cast<double>(time) * 1e12);
  }
  MemorySettings settings_;
  Picoseconds cycle_;
  std::optional<OtherMasters> others_;
};

/// Where other masters read too, all reads share a beat a cycle.
class FixedMemory final : public SharedMemory {
 public:
  FixedMemory(const MemorySettings& settings, const Config& config, int latency)
      : SharedMemory(settings, config),
        latency_(static_cast<Cycle>(latency)),
        port_bytes_(static_cast<std::uint64_t>(config.memory_port_bits / 8)) {}
  [[nodiscard]] Cycle room() const override { return 0; }
  [[nodiscard]] std::optional<Cycle> ideal_latency() const override {
    return is_shared() ? std::nullopt : std::optional(latency_);
  }
  BurstAnswer accept(const MemoryBurst& burst, Cycle cycle_taken) override {
    serve_others(cycle_taken * cycle());
    if (!is_shared() || burst.is_write) return {cycle_taken + latency_, 1, 1, 0};
    const auto beats = static_cast<std::uint64_t>(burst.beats);
    return {read(cycle_taken, beats) - (beats - 1), 1, 1, 0};
  }
  Picoseconds serve_other(std::uint64_t, std::uint64_t bytes, Picoseconds arrives) override {
    return (read((arrives + cycle() - 1) / cycle(), (bytes - 1) / port_bytes_ + 1) + 1) * cycle();
  }

 private:
  /// The cycle of the last beat.
  Cycle read(Cycle arrives, std::uint64_t beats) {
    read_free_ = std::max(arrives + latency_, read_free_) + beats;
    return read_free_ - 1;
  }
  Cycle latency_, read_free_ = 0;
  std::uint64_t port_bytes_;
};

/// Common part of all memories with their own clock: a short queue, and time in picoseconds.
class ClockedMemory : public SharedMemory {
 public:
  ClockedMemory(const MemorySettings& settings, const Config& config, Picoseconds clock)
      : SharedMemory(settings, config),
        port_bytes_(static_cast<std::uint64_t>(config.memory_port_bits / 8)),
        cycle_(cycle_of(settings.mhz)),
        clock_(clock) {}

  [[nodiscard]] Cycle room() const final { return queue_.room(); }
  BurstAnswer accept(const MemoryBurst& burst, Cycle taken) final {
    const Picoseconds arrives = round_up((taken + 1) * cycle_);  // it has passed a register
    serve_others(arrives);
    const auto beats = static_cast<std::uint64_t>(burst.beats);
    const Served served = serve(burst.is_write, burst.address, beats * port_bytes_, arrives);
    queue_.leave((served.last + cycle_ - 1) / cycle_);
    const Picoseconds step = port_bytes_ * served.byte;
    return {burst.is_write ? served.last : served.last - (beats - 1) * step, step, cycle_, 1};
  }
  Picoseconds serve_other(std::uint64_t address, std::uint64_t bytes, Picoseconds arrives) final {
    return serve(false, address, bytes, round_up(arrives)).last;
  }

 protected:
  /// End of a burst's last byte, and the time per burst.
  struct Served {
    Picoseconds last, byte;
  };
  /// The edge of the memory's clock at or after `time`.
  [[nodiscard]] Picoseconds round_up(Picoseconds time) const { return (time + clock_ - 1) / clock_ * clock_; }
  [[nodiscard]] Picoseconds clock() const { return clock_; }
  /// Serves a burst that has completely arrived in `arrives`.
  virtual Served serve(bool is_write, std::uint64_t address, std::uint64_t bytes, Picoseconds arrives) = 0;

 private:
  static constexpr int kQueue = 8;  ///< bursts
  std::uint64_t port_bytes_;
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
// With another width it is chips side by side, with another clock the same times of rows.
constexpr DramTiming kSdram{6'000, 4, 1024, 2, 1, 3, 0, 18'000, 18'000, 42'000, 60'000, 12'000, 0, 60'000, 7'812'500};
// Micron MT41K128M16-125 at DDR3-800 (CL 6, CWL 5), 2 Gbit x16: data sheet "2Gb: x4, x8, x16 DDR3L SDRAM". BL8.
constexpr DramTiming kDdr3{2'500,  8,      2048,   4,      4,      6,       5,        13'750,
                           13'750, 35'000, 48'750, 15'000, 10'000, 160'000, 7'800'000};

DramTiming sdram_timing(const MemorySettings& settings) {
  DramTiming timing = kSdram;
  if (settings.sdram_mhz != MemorySettings{}.sdram_mhz) timing.clock = cycle_of(settings.sdram_mhz);
  timing.bytes_per_clock = static_cast<std::uint64_t>(settings.sdram_width / 8);
  if (settings.sdram_width > 16) timing.row_bytes *= static_cast<std::uint64_t>(settings.sdram_width / 16);
  return timing;
}

/// In order, rows left open; a burst's column command goes out when its row is open and the data bus will be free.
class Dram final : public ClockedMemory {
 public:
  Dram(const MemorySettings& settings, const Config& config, const DramTiming& timing)
      : ClockedMemory(settings, config, timing.clock),
        t_(timing),
        banks_(timing.banks),
        next_refresh_(timing.refresh_interval) {}

 private:
  static constexpr std::uint64_t kClosed = ~0ULL;
  struct Bank {
    std::uint64_t row = kClosed;
    Picoseconds may_activate = 0;  ///< earliest next activate
    Picoseconds may_precharge = 0;
  };

  Served serve(bool is_write, std::uint64_t address, std::uint64_t bytes, Picoseconds arrives) override {
    Picoseconds last = 0;
    for (std::uint64_t left = bytes; left != 0;) {  // row by row
      const std::uint64_t piece = std::min(left, t_.row_bytes - address % t_.row_bytes);
      last = serve_in_row(is_write, address, piece, arrives);
      address += piece;
      left -= piece;
    }
    return {last, t_.clock / t_.bytes_per_clock};
  }

  Picoseconds serve_in_row(bool is_write, std::uint64_t address, std::uint64_t bytes, Picoseconds arrives) {
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
    const Picoseconds bus = bus_free_ + (is_write != last_was_write_ ? t_.clock : 0);  // bus turnaround
    if (bus > latency * t_.clock) column = std::max(column, bus - latency * t_.clock);
    column = round_up(column);
    // The memory moves whole bursts of its own length.
    const std::uint64_t unit = t_.burst_clocks * t_.bytes_per_clock;
    const std::uint64_t clocks = ((address + bytes - 1) / unit - address / unit + 1) * t_.burst_clocks;
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
/// burst has a command of its own; it refreshes itself while it is not selected, so a long burst is cut (tCEM).
class Psram final : public ClockedMemory {
 public:
  Psram(const MemorySettings& settings, const Config& config) : ClockedMemory(settings, config, kClock) {}

 private:
  static constexpr Picoseconds kClock = 11'905, kDeselected = 18'000;        // tCPH
  static constexpr std::uint64_t kCommand = 2, kAddress = 6, kReadWait = 6;  // clocks
  static constexpr std::uint64_t kClocksPerByte = 2;
  static constexpr std::uint64_t kLongest = 256;  // bytes: 6.3 us, where tCEM is 8 us
  Served serve(bool is_write, std::uint64_t, std::uint64_t bytes, Picoseconds arrives) override {
    Picoseconds last = 0;
    for (std::uint64_t left = bytes; left != 0;) {
      const std::uint64_t piece = std::min(left, kLongest);
      const Picoseconds begins = round_up(std::max(arrives, free_));
      last = begins + (kCommand + kAddress + (is_write ? 0 : kReadWait) + kClocksPerByte * piece) * clock();
      free_ = last + kDeselected;
      left -= piece;
    }
    return {last, kClocksPerByte * clock()};
  }
  Picoseconds free_ = 0;
};

std::unique_ptr<SharedMemory> make_shared_memory(const MemorySettings& settings, const Config& config) {
  switch (settings.kind) {
    case MemoryKind::fixed: break;
    case MemoryKind::sram: return std::make_unique<FixedMemory>(settings, config, 2);
    case MemoryKind::sdram: return std::make_unique<Dram>(settings, config, sdram_timing(settings));
    case MemoryKind::psram: return std::make_unique<Psram>(settings, config);
    case MemoryKind::ddr3: return std::make_unique<Dram>(settings, config, kDdr3);
  }
  return std::make_unique<FixedMemory>(settings, config, settings.latency);
}

/// Bytes a second of a memory that serves the reads of other masters and nothing else, one after the other.
std::uint64_t most_other_bytes(const MemorySettings& settings, const Config& config) {
  constexpr std::uint64_t kReads = 1 << 14;  // refresh counts
  const auto memory = make_shared_memory(settings, config);
  Picoseconds first = 0, last = 0;
  for (std::uint64_t n = 0; n <= kReads; ++n) {
    last = memory->serve_other(OtherMasters::place(n), OtherMasters::kOtherBurst, 0);
    if (n == 0) first = last;
  }
  return static_cast<std::uint64_t>(static_cast<double>(kReads * OtherMasters::kOtherBurst) /
                                    static_cast<double>(last - first) * 1e12);
}

}  // namespace

MemoryKind memory_kind(std::string_view name) {
  for (std::size_t i = 0; i < kMemoryKinds.size(); ++i)
    if (kMemoryKinds[i] == name) return static_cast<MemoryKind>(i);
  throw InputError("no memory '" + std::string(name) + "'; give fixed, sram, sdram, psram or ddr3");
}

void set_memory(MemorySettings& settings, std::string_view text) {
  const auto next = [&text] {
    const std::string_view word = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    return word;
  };
  if (text.ends_with(',')) throw InputError("'" + std::string(text) + "' ends with a comma; leave it out");
  const MemoryKind kind = memory_kind(next());
  MemorySettings changed = settings;
  changed.kind = kind;
  changed.sdram_width = MemorySettings{}.sdram_width;
  changed.sdram_mhz = MemorySettings{}.sdram_mhz;
  std::array<bool, 2> is_given{};  // mhz, width
  while (!text.empty()) {
    const std::string_view word = next(), key = word.substr(0, word.find('='));
    const bool is_width = key == "width";
    if (kind != MemoryKind::sdram || (!is_width && key != "mhz"))
      throw InputError("'" + std::string(word) + "' is no setting of " +
                       std::string(kMemoryKinds[static_cast<std::size_t>(kind)]) +
                       "; sdram has width=BITS and mhz=MHZ, as in sdram,width=32,mhz=133");
    if (std::exchange(is_given[is_width ? 1 : 0], true))
      throw InputError("'" + std::string(word) + "' sets " + std::string(key) + " a second time; give it once");
    const std::string_view digits = word.substr(std::min(word.size(), key.size() + 1));
    const int value = as_number<int>(digits).value_or(0);
    if (is_width && std::ranges::find(kSdramWidths, value) == kSdramWidths.end())
      throw InputError("width: '" + std::string(digits) + "' is not 8, 16, 32 or 64 bits");
    if (!is_width && (value < kSdramMinMhz || value > kSdramMaxMhz))
      throw InputError("mhz: '" + std::string(digits) + "' is no clock of an SDRAM, " + std::to_string(kSdramMinMhz) +
                       " to " + std::to_string(kSdramMaxMhz) + " MHz");
    (is_width ? changed.sdram_width : changed.sdram_mhz) = value;
  }
  settings = changed;
}

std::string memory_name(const MemorySettings& settings) {
  const MemorySettings standard;
  std::string name(kMemoryKinds[static_cast<std::size_t>(settings.kind)]);
  if (settings.sdram_width != standard.sdram_width) name += ",width=" + std::to_string(settings.sdram_width);
  if (settings.sdram_mhz != standard.sdram_mhz) name += ",mhz=" + std::to_string(settings.sdram_mhz);
  return name;
}

std::unique_ptr<MemoryTiming> make_memory(const MemorySettings& settings, const Config& config) {
  if (const std::uint64_t asked = settings.traffic.other_bytes_per_s; asked != 0) {
    const std::uint64_t most = most_other_bytes(without_traffic(settings), config);
    if (asked >= most) refuse_traffic(settings, most);
  }
  return make_shared_memory(settings, config);
}

}  // namespace halfplane
