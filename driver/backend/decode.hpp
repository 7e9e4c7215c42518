// The command stream back to packets: the input of the model for a stream that the driver has written.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/packets/packets.hpp"

namespace halfplane::driver {

/// A packet of the stream as core/command_decoder.sv makes it: primitive_id is 0, and vertex i is slot i.
struct DecodedPrimitive {
  PrimitivePacket packet;
  std::optional<LineSetup> line;  ///< with a packet of kind line
};

/// The picture that PRESENT shows.
struct Presented {
  std::uint32_t color = 0, color_flags = 0;
  bool operator==(const Presented&) const = default;
};

/// A word that the core refuses as well.
struct RefusedWord : InputError {
  RefusedWord(std::uint32_t error, std::uint32_t words);
  std::uint32_t error;  ///< as STATUS.error has it: HALFPLANE_ERROR_*
  std::uint32_t words;  ///< as in WORDS: words taken, of which the wrong word is the last
};

/// Reads a stream as core/command_decoder.sv does. Throws
/// - RefusedWord where the core stops with an error: the same error at the same word, for every stream;
/// - another InputError, which names the word, where the core does not check and something undefined comes: of a vertex
///   slot or a state register that holds nothing, a target beyond the configuration, a line that leaves the target,
///   or a command without its last words, for which the core waits.
/// Words are counted from 1, over all that was read, as the register WORDS has them.
class Decoder {
 public:
  explicit Decoder(const Config& config);

  /// Reads up to the end or a STOP, as the core does from one start to the next; returns how many words it took.
  std::size_t read(std::span<const std::uint32_t> words);

  [[nodiscard]] const std::vector<DecodedPrimitive>& primitives() const { return primitives_; }
  [[nodiscard]] const MemoryLayout& layout() const { return layout_; }
  [[nodiscard]] int width() const { return width_; }  ///< of the target; 0: none was set
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const std::vector<std::uint32_t>& fences() const { return fences_; }
  [[nodiscard]] const std::vector<Presented>& presented() const { return presented_; }

 private:
  [[nodiscard]] std::uint32_t next();
  [[noreturn]] void refuse(std::uint32_t error) const;
  [[noreturn]] void undefined(const std::string& why) const;
  [[nodiscard]] bool lacks_unit(std::uint32_t opcode, std::uint32_t fields) const;
  void check_header(std::uint32_t opcode, std::uint32_t fields) const;
  void check_is_set(std::uint32_t first, std::uint32_t last) const;
  void set(std::uint32_t which, std::uint32_t value);
  void draw(PrimitiveKind kind, std::uint32_t fields);
  void read_affine(PerPlane<std::uint32_t>& code);
  void read_triangle(std::uint32_t fields, PrimitivePacket& packet);
  void read_over_w(PrimitivePacket& packet);
  void read_token(PrimitivePacket& packet);
  [[nodiscard]] LineSetup read_line();

  Config config_;
  Widths widths_;
  std::span<const std::uint32_t> words_;
  std::size_t at_ = 0;
  std::uint32_t taken_ = 0;  ///< before words_
  bool is_cleared_ = false, is_drawn_ = false;
  std::uint32_t is_set_ = 0;  ///< a bit for each state register
  PixelBox box_;
  PrimitiveState state_;
  Cull cull_ = Cull::none;
  bool front_cw_ = false;
  std::array<SnappedVertex, 3> slot_{};
  std::array<bool, 3> is_loaded_{};
  MemoryLayout layout_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> fences_;
  std::vector<Presented> presented_;
  std::vector<DecodedPrimitive> primitives_;
};

}  // namespace halfplane::driver
