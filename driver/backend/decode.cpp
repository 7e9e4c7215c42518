#include "decode.hpp"

#include <cstdio>

#include "../stream.h"
#include "model/packets/packet_words.hpp"
#include "model/packets/state_packets.hpp"

namespace halfplane::driver {
namespace {

constexpr int kBoxMax = 1, kDepthBase = 4, kColorBase = 5, kDepthFlagsBase = 6, kColorFlagsBase = 7, kRowStride = 8,
              kTextureBase = 9;

}  // namespace

Decoder::Decoder(const Config& config) : config_(config), widths_(derive_widths(config)) {}

void Decoder::refuse(const std::string& why) const {
  throw InputError("word " + std::to_string(at_) + " of the command stream: " + why);
}

std::uint32_t Decoder::next() {
  if (at_ == words_.size()) refuse("the stream ends inside a command");
  return words_[at_++];
}

void Decoder::read(std::span<const std::uint32_t> words) {
  words_ = words;
  at_ = 0;
  while (at_ < words_.size()) {
    const std::uint32_t header = next(), opcode = header >> 24, fields = header & 0xffffff;
    switch (opcode) {
      case HP_SET: {
        const std::uint32_t first = fields & 15, count = fields >> 8 & 15;
        if (count == 0 || first + count > kTextureBase + 1) refuse("SET of registers that there are not");
        for (std::uint32_t i = 0; i < count; ++i) set(first + i, next());
        break;
      }
      case HP_FENCE: fences_.push_back(next()); break;
      case HP_PRESENT:
        (void)next();
        (void)next();
        break;
      case HP_WAIT_VBLANK:
      case HP_STOP: break;
      case HP_TRIANGLE:
      case HP_RECTANGLE:
      case HP_FAST_CLEAR:
      case HP_FLUSH:
      case HP_POINT:
      case HP_LINE:
      case HP_TOKEN: draw(static_cast<PrimitiveKind>(opcode & 7), fields); break;
      default: refuse("unknown opcode " + std::to_string(opcode));
    }
  }
}

void Decoder::set(std::uint32_t which, std::uint32_t value) {
  const auto low = static_cast<std::uint16_t>(value), high = static_cast<std::uint16_t>(value >> 16);
  if (which >= HP_TARGET && is_drawn_) refuse("SET of the layout after drawing without a flush");
  switch (which) {
    case HP_BOX_MIN: box_.left = low, box_.top = high; break;
    case kBoxMax: box_.right = low, box_.bottom = high; break;
    case HP_STATE:
      state_ = {static_cast<DepthFunc>(value & 7), (value >> 3 & 1) != 0, (value >> 4 & 1) != 0};
      cull_ = static_cast<Cull>(value >> 5 & 3);
      front_cw_ = (value >> 7 & 1) != 0;
      state_.tests_stencil = (value >> 8 & 1) != 0;
      state_.writes_stencil = (value >> 9 & 1) != 0;
      state_.marks_failed = (value >> 10 & 1) != 0;
      state_.masked_samples = static_cast<std::uint8_t>(value >> 16);
      break;
    case HP_TARGET:
      width_ = low + 1;
      height_ = high + 1;
      is_cleared_ = false;
      break;
    case kDepthBase: layout_.depth_base = value; break;
    case kColorBase: layout_.color_base = value; break;
    case kDepthFlagsBase: layout_.depth_flags_base = value; break;
    case kColorFlagsBase: layout_.color_flags_base = value; break;
    case kRowStride: layout_.row_stride = value; break;
    default: break;  // the base of textures
  }
}

void Decoder::read_affine(PerPlane<std::uint32_t>& code) {
  std::array<std::uint32_t, 4> words{};
  int bits = 0;
  for (int p = 0; p < widths_.affine_planes; ++p) bits += widths_.of_plane(static_cast<std::size_t>(p)).code.bits;
  for (std::size_t i = 0; i < words_of(bits); ++i) words[i] = next();
  WordReader reader(words.data());
  for (std::size_t p = 0; p < static_cast<std::size_t>(widths_.affine_planes); ++p)
    code[p] = static_cast<std::uint32_t>(reader.take_word(widths_.of_plane(p).code.bits));
}

void Decoder::read_over_w(PrimitivePacket& packet) {
  const auto first = static_cast<std::size_t>(widths_.affine_planes), end = static_cast<std::size_t>(widths_.planes);
  int bits = 0;
  for (std::size_t p = first; p < end; ++p) bits += widths_.of_plane(p).code.bits;
  for (auto& code : packet.vertex.code) {
    std::vector<std::uint32_t> words(words_of(bits));
    for (std::uint32_t& word : words) word = next();
    WordReader reader(words.data());
    for (std::size_t p = first; p < end; ++p)
      code[p] = static_cast<std::uint32_t>(reader.take_word(widths_.of_plane(p).code.bits));
  }
  std::vector<std::uint32_t> frame(words_of(packet_bits<CoordinateFrame>(widths_)));
  for (std::uint32_t& word : frame) word = next();
  packet.coordinates = unpack_words<CoordinateFrame>(frame.data(), widths_);
}

void Decoder::read_triangle(std::uint32_t fields, PrimitivePacket& packet) {
  for (std::size_t s = 0; s < 3; ++s) {
    if ((fields >> s & 1) != 0) {
      const std::uint32_t xy = next();
      slot_[s] = {static_cast<std::int16_t>(xy), static_cast<std::int16_t>(xy >> 16), {}};
      read_affine(slot_[s].code);
      is_loaded_[s] = true;
    }
    if (!is_loaded_[s]) refuse("TRIANGLE of a vertex slot that is not loaded");
    packet.vertex.x[s] = slot_[s].x;
    packet.vertex.y[s] = slot_[s].y;
    packet.vertex.code[s] = slot_[s].code;
  }
  packet.cull = cull_;
  packet.front_cw = front_cw_ != ((fields & HP_FLIP) != 0);
  if ((fields & HP_OVER_W) != 0) read_over_w(packet);
}

/// The low bits of the value in the words of the affine codes, the rest after them.
void Decoder::read_token(PrimitivePacket& packet) {
  auto& code = packet.vertex.code[0];
  read_affine(code);
  int bits = 0;
  for (int p = widths_.affine_planes; p < widths_.token_planes(); ++p)
    bits += widths_.of_plane(static_cast<std::size_t>(p)).code.bits;
  std::vector<std::uint32_t> words(words_of(bits) + 1);
  for (std::size_t i = 0; i < words_of(bits); ++i) words[i] = next();
  WordReader reader(words.data());
  for (auto p = static_cast<std::size_t>(widths_.affine_planes); p < static_cast<std::size_t>(widths_.token_planes());
       ++p)
    code[p] = static_cast<std::uint32_t>(reader.take_word(widths_.of_plane(p).code.bits));
  packet.vertex.code.fill(code);
}

LineSetup Decoder::read_line() {
  const int bits = packet_bits<LineSetup>(widths_);
  std::vector<std::uint32_t> words(words_of(bits) + 1);
  for (std::size_t i = 0; i < words_of(bits - widths_.primitive_id.bits); ++i) words[i] = next();
  return unpack_words<LineSetup>(words.data(), widths_);
}

void Decoder::draw(PrimitiveKind kind, std::uint32_t fields) {
  DecodedPrimitive out;
  PrimitivePacket& packet = out.packet;
  packet.kind = kind;
  packet.box = {0, 0, static_cast<std::uint16_t>(width_ - 1), static_cast<std::uint16_t>(height_ - 1)};
  if (!is_token(kind)) packet.box = box_;
  packet.state = state_;
  if (kind == PrimitiveKind::fast_clear || kind == PrimitiveKind::flush)
    packet.state = {DepthFunc::always, false, false};
  if (!is_cleared_ && kind != PrimitiveKind::state && kind != PrimitiveKind::fast_clear)
    refuse("drawing before the first clear of depth and colour");
  switch (kind) {
    case PrimitiveKind::triangle: read_triangle(fields, packet); break;
    case PrimitiveKind::rectangle:
    case PrimitiveKind::point:
      read_affine(packet.vertex.code[0]);
      packet.vertex.code.fill(packet.vertex.code[0]);
      break;
    case PrimitiveKind::fast_clear:
      read_affine(packet.vertex.code[0]);
      packet.vertex.code.fill(packet.vertex.code[0]);
      packet.state.depth_write = (fields & 1) != 0;
      packet.state.color_write = (fields & 2) != 0;
      is_cleared_ = is_cleared_ || (fields & 3) == 3;
      break;
    case PrimitiveKind::flush:
      if ((fields & 1) != 0) packet.state.depth_test = DepthFunc::never;
      break;
    case PrimitiveKind::line: out.line = read_line(); break;
    case PrimitiveKind::state:
      packet.state = sets_register(static_cast<StateRegister>(fields));
      read_token(packet);
      break;
  }
  if (!is_token(kind) && (packet.box.left > packet.box.right || packet.box.top > packet.box.bottom ||
                          packet.box.right >= width_ || packet.box.bottom >= height_))
    refuse("the box is inverted or ends beyond the target");
  if (kind != PrimitiveKind::triangle && kind != PrimitiveKind::flush) is_loaded_ = {};
  if (kind != PrimitiveKind::state) is_drawn_ = kind != PrimitiveKind::flush;
  primitives_.push_back(std::move(out));
}

}  // namespace halfplane::driver
