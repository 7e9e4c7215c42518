// Other traffic of the memory: the reads of scan-out (core/scan_out.sv) and a steady flow of other masters' bytes. Their bursts
// are served in order of arrival with the port's bursts, and take the memory's time. No data.
#pragma once

#include <array>
#include <cstdint>

#include "../config.hpp"

namespace halfplane {

/// Masters beside the hardware's port. The default: none.
struct MemoryTraffic {
  int scan_out_hz = 0;                  ///< pictures a second that scan-out reads; 0: it is off
  std::uint64_t other_bytes_per_s = 0;  ///< total of all other masters
  [[nodiscard]] bool is_none() const { return scan_out_hz == 0 && other_bytes_per_s == 0; }
  bool operator==(const MemoryTraffic&) const = default;
};

/// Their traffic so far.
struct MemoryUse {
  std::uint64_t scan_out_bytes = 0, other_bytes = 0;
  std::uint64_t bands = 0;       ///< bands that scan-out has read: rows of blocks
  std::uint64_t late_bands = 0;  ///< bands among them whose last pixel came after the display wanted the first one
  bool operator==(const MemoryUse&) const = default;
};

/// Two masters, whose next bursts are known: times in picoseconds since power-up.
///
/// Scan-out reads a band in each 1 / (hz * bands) of a second, from its beginning on and as fast as memory answers, with
/// kAhead units under way, and needs it a band later. Every block counts as drawn, with all of its samples. Its picture lies
/// after the target's. The other masters read 64 bytes at equal distances, each from another row of memory.
class OtherMasters {
 public:
  using Picoseconds = std::uint64_t;
  static constexpr std::uint64_t kOtherBurst = 64;  ///< bytes of a read of the others
  /// Address of the other masters' n-th read, in their part of memory.
  [[nodiscard]] static constexpr std::uint64_t place(std::uint64_t n) {
    return n * 0x9E3779B1U % (1U << 24) / kOtherBurst * kOtherBurst;
  }
  OtherMasters(const MemoryTraffic& traffic, const Config& config, Picoseconds cycle);

  /// The picture that scan-out shows, from its next band on.
  void show(int width, int height);
  /// serve(address, bytes, arrives) for all bursts that arrive up to `time`, in order; it returns their ends.
  template <class Serve>
  void until(Picoseconds time, Serve&& serve) {
    for (;;) {
      const bool is_scan = scan_.arrives <= other_arrives_;
      const Picoseconds arrives = is_scan ? scan_.arrives : other_arrives_;
      if (arrives > time) return;
      if (is_scan) {
        const std::uint64_t address = scan_address(), bytes = scan_bytes();
        scanned(bytes, serve(address, bytes, arrives));
      } else {
        serve(others_base_ + place(others_), kOtherBurst, arrives);
        use_.other_bytes += kOtherBurst;
        other_arrives_ = arrives_of_other(++others_);
      }
    }
  }
  [[nodiscard]] const MemoryUse& use() const { return use_; }

 private:
  static constexpr Picoseconds kNever = ~Picoseconds{0};
  static constexpr std::uint64_t kPicosecondsPerSecond = 1'000'000'000'000;
  static constexpr int kAhead = 16;  ///< AHEAD of scan_out.sv
  static constexpr int kBurst = 16;  ///< its BURST, beats

  [[nodiscard]] Picoseconds band_begins(std::uint64_t band) const;
  [[nodiscard]] Picoseconds arrives_of_other(std::uint64_t n) const;
  [[nodiscard]] std::uint64_t scan_address() const;
  [[nodiscard]] std::uint64_t scan_bytes() const;
  void scanned(std::uint64_t bytes, Picoseconds done);

  MemoryTraffic traffic_;
  Picoseconds cycle_;
  // The layout, in bytes.
  std::uint64_t beat_, unit_, tile_pitch_, row_stride_, picture_, flag_row_, flags_, others_base_;
  int lines_, bands_per_tile_, units_per_tile_, flag_tiles_, tile_size_, flag_reads_;
  std::uint64_t tiles_ = 0, bands_ = 0;  ///< of the picture: tiles along it, bands
  struct {
    Picoseconds arrives = kNever;            ///< of the next burst
    std::uint64_t first_band = 0;            ///< the band since power-up with which the picture begins
    Picoseconds begins = 0;                  ///< begin of that band
    std::uint64_t band = 0;                  ///< since power-up
    std::uint64_t unit = 0;                  ///< in the band
    std::uint64_t sent = 0;                  ///< bytes of the unit
    int flags = 0;                           ///< reads of flags that come before the unit
    Picoseconds asked = 0;                   ///< the burst before
    std::array<Picoseconds, kAhead> done{};  ///< ends of the last units
  } scan_;
  std::uint64_t others_ = 0;  ///< bursts
  Picoseconds other_arrives_ = kNever;
  MemoryUse use_;
};

}  // namespace halfplane
