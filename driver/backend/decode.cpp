#include "decode.hpp"

#include <algorithm>
#include <string_view>

#include "../stream.h"
#include "model/host/stream_rules.hpp"
#include "model/packets/packet_words.hpp"
#include "model/packets/state_packets.hpp"

namespace halfplane::driver {
namespace {

constexpr std::uint32_t kBoxMax = HALFPLANE_STATE_REGISTER_BOX_MAX, kDepthBase = HALFPLANE_STATE_REGISTER_DEPTH_BASE,
                        kRowStride = HALFPLANE_STATE_REGISTER_ROW_STRIDE,
                        kTextureBase = HALFPLANE_STATE_REGISTER_TEXTURE_BASE;

#define NAME_AND_TEXT(name, when) std::string_view{#name ": " when},
constexpr std::array kErrors{HALFPLANE_ERRORS(NAME_AND_TEXT)};
#undef NAME_AND_TEXT

std::string word_text(std::uint32_t number) {
  return "word " + std::to_string(number) + " of the command stream (of which the first is word 1): ";
}

/// The header bits that a command names; nothing for an opcode that is none.
std::optional<std::uint32_t> named_bits(std::uint32_t opcode) {
  switch (opcode) {
#define BITS_OF(name, bits) \
  case HALFPLANE_COMMAND_##name: return bits;
    HALFPLANE_COMMANDS(BITS_OF)
#undef BITS_OF
    default: return std::nullopt;
  }
}

bool draws(std::uint32_t opcode) { return opcode >= HP_TRIANGLE; }

bool clears_bin(std::uint32_t fields) { return (fields & HALFPLANE_CLEAR_BIN_MASK) != 0; }
bool clears_both(std::uint32_t fields) {
  return (fields & (HALFPLANE_CLEAR_BIN_MASK | HALFPLANE_CLEAR_DEPTH_MASK | HALFPLANE_CLEAR_COLOR_MASK)) ==
         (HALFPLANE_CLEAR_DEPTH_MASK | HALFPLANE_CLEAR_COLOR_MASK);
}
/// A clear of nothing, or of a bin with more than colour.
bool is_no_clear(std::uint32_t fields) {
  constexpr std::uint32_t kBuffers = HALFPLANE_CLEAR_DEPTH_MASK | HALFPLANE_CLEAR_COLOR_MASK;
  if (clears_bin(fields)) return fields != (HALFPLANE_CLEAR_BIN_MASK | HALFPLANE_CLEAR_COLOR_MASK);
  return (fields & kBuffers) == 0;
}

}  // namespace

RefusedWord::RefusedWord(std::uint32_t code, std::uint32_t number)
    : InputError(word_text(number) + std::string(kErrors[code])), error(code), words(number) {}

Decoder::Decoder(const Config& config) : config_(config), widths_(derive_widths(config)) {}

void Decoder::refuse(std::uint32_t error) const { throw RefusedWord(error, taken_ + static_cast<std::uint32_t>(at_)); }

void Decoder::undefined(const std::string& why) const {
  throw InputError(word_text(taken_ + static_cast<std::uint32_t>(at_)) + why);
}

std::uint32_t Decoder::next() {
  if (at_ == words_.size()) undefined("the stream ends inside a command, and the core waits for the rest of it");
  return words_[at_++];
}

std::size_t Decoder::read(std::span<const std::uint32_t> words) {
  words_ = words;
  at_ = 0;
  bool is_stopped = false;
  while (at_ < words_.size() && !is_stopped) {
    const std::uint32_t header = next(), opcode = header >> 24, fields = header & 0xffffff;
    check_header(opcode, fields);
    switch (opcode) {
      case HP_SET: {
        const std::uint32_t first = fields & 15, count = fields >> 8 & 15;
        for (std::uint32_t i = 0; i < count; ++i) set(first + i, next());
        break;
      }
      case HP_FENCE: fences_.push_back(next()); break;
      case HP_PRESENT: {
        const std::uint32_t color = next();
        presented_.push_back({color, next()});
        break;
      }
      case HP_STOP: is_stopped = true; break;
      default:
        if (draws(opcode)) draw(static_cast<PrimitiveKind>(opcode & 7), fields);
    }
  }
  taken_ += static_cast<std::uint32_t>(at_);
  return at_;
}

bool Decoder::lacks_unit(std::uint32_t opcode, std::uint32_t fields) const {
  const bool has_blocks = config_.cache_kind == CacheKind::blocks;
  switch (opcode) {
    case HP_LINE: return config_.line_units == 0;
    case HP_TOKEN: return !has_register(static_cast<StateRegister>(fields & 7), config_);
    case HP_TRIANGLE: return (fields & HP_OVER_W) != 0 && widths_.planes == widths_.affine_planes;
    case HP_FAST_CLEAR:
      return (fields & (HALFPLANE_CLEAR_BIN_MASK | HALFPLANE_CLEAR_LOSES_DEPTH_MASK)) != 0 && !has_blocks;
    case HP_FLUSH: return (fields & HALFPLANE_FLUSH_LOSES_DEPTH_MASK) != 0 && !has_blocks;
    default: return false;
  }
}

/// The first error of a header, in the order of docs/core.md.
void Decoder::check_header(std::uint32_t opcode, std::uint32_t fields) const {
  const std::optional<std::uint32_t> named = named_bits(opcode);
  if (!named) refuse(HALFPLANE_ERROR_UNKNOWN_OPCODE);
  if (lacks_unit(opcode, fields)) refuse(HALFPLANE_ERROR_NOT_SUPPORTED);
  if ((fields & ~*named) != 0 || (opcode == HP_FAST_CLEAR && is_no_clear(fields))) refuse(HALFPLANE_ERROR_RESERVED);
  if (opcode == HP_SET) {
    const std::uint32_t first = fields & 15, count = fields >> 8 & 15;
    if (count == 0 || first + count > kTextureBase + 1) refuse(HALFPLANE_ERROR_BAD_REGISTER);
  }
  if (!draws(opcode) || opcode == HP_TOKEN) return;
  if (!is_cleared_ && !(opcode == HP_FAST_CLEAR && clears_both(fields))) refuse(HALFPLANE_ERROR_NO_CLEAR);
  const bool has_box = !is_token(static_cast<PrimitiveKind>(opcode & 7));
  if (has_box || (opcode == HP_FAST_CLEAR && clears_bin(fields))) {
    check_is_set(HP_BOX_MIN, kBoxMax);
    if (box_.left > box_.right || box_.top > box_.bottom || box_.right >= width_ || box_.bottom >= height_)
      refuse(HALFPLANE_ERROR_BAD_BOX);
  }
  if (has_box || opcode == HP_LINE) check_is_set(HP_STATE, HP_STATE);
  check_is_set(kDepthBase, kRowStride);
}

void Decoder::check_is_set(std::uint32_t first, std::uint32_t last) const {
  for (std::uint32_t which = first; which <= last; ++which)
    if ((is_set_ >> which & 1) == 0)
      undefined("it draws, and state register " + std::to_string(which) + " was never set");
}

void Decoder::set(std::uint32_t which, std::uint32_t value) {
  const auto column = static_cast<std::uint16_t>(wrap_unsigned(value & 0xffff, widths_.pixel_x.bits)),
             row = static_cast<std::uint16_t>(wrap_unsigned(value >> 16, widths_.pixel_y.bits));
  if (which >= HP_TARGET && is_drawn_) refuse(HALFPLANE_ERROR_NOT_FLUSHED);
  is_set_ |= 1U << which;
  switch (which) {
    case HP_BOX_MIN: box_.left = column, box_.top = row; break;
    case kBoxMax: box_.right = column, box_.bottom = row; break;
    case HP_STATE:
      state_ = {static_cast<DepthFunc>(value & 7), (value >> 3 & 1) != 0, (value >> 4 & 1) != 0};
      cull_ = static_cast<Cull>(value >> 5 & 3);
      front_cw_ = (value >> 7 & 1) != 0;
      state_.tests_stencil = (value >> 8 & 1) != 0;
      state_.writes_stencil = (value >> 9 & 1) != 0;
      state_.marks_failed = (value >> 10 & 1) != 0;
      state_.is_back = (value >> 11 & 1) != 0;
      state_.masked_samples = static_cast<std::uint8_t>(value >> 16);
      break;
    case HP_TARGET: {
      const std::uint32_t width = (value & 0xffff) + 1, height = (value >> 16) + 1;
      if (width > static_cast<std::uint32_t>(config_.target_width) ||
          height > static_cast<std::uint32_t>(config_.target_height))
        undefined("a target of " + std::to_string(width) + "x" + std::to_string(height) +
                  ", and this configuration has " + std::to_string(config_.target_width) + "x" +
                  std::to_string(config_.target_height));
      width_ = static_cast<int>(width);
      height_ = static_cast<int>(height);
      is_cleared_ = false;
      break;
    }
    case kDepthBase: layout_.depth_base = value; break;
    case HALFPLANE_STATE_REGISTER_COLOR_BASE: layout_.color_base = value; break;
    case HALFPLANE_STATE_REGISTER_DEPTH_FLAGS_BASE: layout_.depth_flags_base = value; break;
    case HALFPLANE_STATE_REGISTER_COLOR_FLAGS_BASE: layout_.color_flags_base = value; break;
    case kRowStride:
      layout_.row_stride = static_cast<std::uint32_t>(wrap_unsigned(value, widths_.row_stride.bits));
      break;
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
      const auto coordinate = [&](std::uint32_t half) {
        return from_bits<decltype(slot_[s].x)>(half, widths_.coordinate);
      };
      slot_[s] = {coordinate(xy & 0xffff), coordinate(xy >> 16), {}};
      read_affine(slot_[s].code);
      is_loaded_[s] = true;
    }
    if (!is_loaded_[s]) undefined("a TRIANGLE, and vertex slot " + std::to_string(s) + " holds no vertex");
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
  packet.box = {0, 0, static_cast<std::uint16_t>(std::max(width_, 1) - 1),
                static_cast<std::uint16_t>(std::max(height_, 1) - 1)};
  if (!is_token(kind)) packet.box = box_;
  packet.state = state_;
  if (kind == PrimitiveKind::fast_clear || kind == PrimitiveKind::flush)
    packet.state = {DepthFunc::always, false, false};
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
      packet.state.depth_write = (fields & HALFPLANE_CLEAR_DEPTH_MASK) != 0;
      packet.state.color_write = (fields & HALFPLANE_CLEAR_COLOR_MASK) != 0;
      if ((fields & HALFPLANE_CLEAR_LOSES_DEPTH_MASK) != 0) packet.state.depth_test = DepthFunc::never;
      if (clears_bin(fields)) packet.state.depth_test = DepthFunc::equal, packet.box = box_;
      is_cleared_ = is_cleared_ || clears_both(fields);
      break;
    case PrimitiveKind::flush:
      if ((fields & HALFPLANE_FLUSH_LOSES_DEPTH_MASK) != 0) packet.state.depth_test = DepthFunc::never;
      break;
    case PrimitiveKind::line:
      out.line = read_line();
      if (!is_line_inside(*out.line, widths_, width_, height_))
        undefined("the end of a LINE whose setup is none, or draws outside of the target");
      break;
    case PrimitiveKind::state:
      packet.state = sets_register(static_cast<StateRegister>(fields));
      read_token(packet);
      break;
  }
  if (kind != PrimitiveKind::triangle) is_loaded_ = {};
  if (kind != PrimitiveKind::state) is_drawn_ = kind != PrimitiveKind::flush;
  primitives_.push_back(std::move(out));
}

}  // namespace halfplane::driver
