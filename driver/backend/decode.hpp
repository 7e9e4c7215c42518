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

/// Reads a stream. Throws InputError, naming the word, for a word that the core would refuse.
class Decoder {
 public:
  explicit Decoder(const Config& config);

  void read(std::span<const std::uint32_t> words);

  [[nodiscard]] const std::vector<DecodedPrimitive>& primitives() const { return primitives_; }
  [[nodiscard]] const MemoryLayout& layout() const { return layout_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const std::vector<std::uint32_t>& fences() const { return fences_; }

 private:
  [[nodiscard]] std::uint32_t next();
  [[noreturn]] void refuse(const std::string& why) const;
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
  bool is_cleared_ = false, is_drawn_ = false;
  PixelBox box_;
  PrimitiveState state_;
  Cull cull_ = Cull::none;
  bool front_cw_ = false;
  std::array<SnappedVertex, 3> slot_{};
  std::array<bool, 3> is_loaded_{};
  MemoryLayout layout_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> fences_;
  std::vector<DecodedPrimitive> primitives_;
};

}  // namespace halfplane::driver
