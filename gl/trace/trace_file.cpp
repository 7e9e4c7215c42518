#include "trace_file.hpp"

#include <snappy.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "../../model/config.hpp"

namespace halfplane::gl {
namespace {

// apitrace writes chunks of 1 MiB. The other bounds keep a damaged file from filling memory or the stack.
constexpr std::size_t kLargestChunk = std::size_t{1} << 26;
constexpr std::uint64_t kLargestCount = std::uint64_t{1} << 30;
constexpr int kDeepestValue = 32;
constexpr std::uint64_t kArguments = 64;

enum : std::uint8_t { kEnter, kLeave };
enum : std::uint8_t { kEnd, kArgument, kResult, kThread, kBacktrace, kFlags };
enum : std::uint8_t {
  kNull,
  kFalse,
  kTrue,
  kNegative,
  kPositive,
  kFloat,
  kDouble,
  kString,
  kBlob,
  kEnum,
  kMask,
  kArray,
  kStruct,
  kOpaque,
  kRepresentation,
  kWideString
};

}  // namespace

const TraceValue& TraceCall::none() {
  static const TraceValue value;
  return value;
}

TraceFile::TraceFile(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  if (!file_) fail("cannot be read");
  std::array<char, 2> magic{};
  file_.read(magic.data(), magic.size());
  if (file_.gcount() == 2 && magic[0] == '\x1f' && magic[1] == '\x8b')
    fail("is packed by gzip, as apitrace did before 2012; `apitrace repack` makes a file of today's kind");
  if (file_.gcount() != 2 || magic[0] != 'a' || magic[1] != 't')
    fail("is no trace of apitrace's; `apitrace trace PROGRAM` makes one");
  version_ = number();
  if (version_ > 6) fail("is of trace version " + std::to_string(version_) + "; versions up to 6 are read");
  if (version_ < 6) return;
  number();  // the version of its meaning
  while (!text().empty()) text();
}

void TraceFile::fail(const std::string& what) const { throw InputError(path_ + ": " + what); }

bool TraceFile::fill() {
  std::array<unsigned char, 4> length{};
  file_.read(reinterpret_cast<char*>(length.data()), length.size());
  if (file_.gcount() == 0) return false;
  if (file_.gcount() != 4) fail("is cut off at call " + std::to_string(calls_));
  std::size_t size = 0;
  for (std::size_t i = 4; i-- > 0;) size = size << 8 | length[i];
  std::size_t unpacked = 0;
  const std::string damaged = "is damaged at call " + std::to_string(calls_) + ": a chunk does not unpack";
  if (size > kLargestChunk) fail(damaged);
  packed_.resize(size);
  file_.read(packed_.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::size_t>(file_.gcount()) != size) fail("is cut off at call " + std::to_string(calls_));
  if (!snappy::GetUncompressedLength(packed_.data(), size, &unpacked) || unpacked > kLargestChunk) fail(damaged);
  chunk_.resize(unpacked);
  if (!snappy::RawUncompress(packed_.data(), size, chunk_.data())) fail(damaged);
  at_ = 0;
  return true;
}

void TraceFile::read(char* to, std::size_t size) {
  while (size > 0) {
    if (at_ == chunk_.size() && !fill()) fail("is cut off at call " + std::to_string(calls_));
    const std::size_t part = std::min(size, chunk_.size() - at_);
    std::memcpy(to, chunk_.data() + at_, part);
    to += part;
    at_ += part;
    size -= part;
  }
}

std::uint8_t TraceFile::byte() {
  if (at_ < chunk_.size()) return static_cast<std::uint8_t>(chunk_[at_++]);
  char one = 0;
  read(&one, 1);
  return static_cast<std::uint8_t>(one);
}

std::uint64_t TraceFile::number() {
  std::uint64_t result = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const std::uint8_t part = byte();
    result |= static_cast<std::uint64_t>(part & 0x7f) << shift;
    if (part < 0x80) return result;
  }
  fail("is damaged at call " + std::to_string(calls_) + ": a number of more than 64 bits");
}

std::uint64_t TraceFile::count() {
  const std::uint64_t result = number();
  if (result > kLargestCount)
    fail("is damaged at call " + std::to_string(calls_) + ": " + std::to_string(result) + " items");
  return result;
}

std::string TraceFile::text() {
  // By parts: memory grows with the bytes present, not with the size announced.
  constexpr std::uint64_t kPart = std::uint64_t{1} << 20;
  std::string result;
  for (std::uint64_t left = count(); left > 0;) {
    const std::size_t part = std::min(left, kPart), size = result.size();
    result.resize(size + part);
    read(result.data() + size, part);
    left -= part;
  }
  return result;
}

template <class T>
T TraceFile::raw() {
  std::array<char, sizeof(T)> bytes{};
  read(bytes.data(), bytes.size());
  T result;
  std::memcpy(&result, bytes.data(), sizeof(T));
  return result;
}

void TraceFile::skip_names(bool values_are_typed) {
  for (std::uint64_t left = count(); left > 0; --left) {
    text();
    if (values_are_typed)
      value(kDeepestValue - 1);
    else
      number();
  }
}

TraceValue TraceFile::value(int depth) {
  if (depth > kDeepestValue) fail("is damaged at call " + std::to_string(calls_) + ": values inside values");
  TraceValue result;
  const auto integer = [&](std::uint64_t bits) {
    result.kind = TraceValue::Kind::integer;
    result.integer = static_cast<std::int64_t>(bits);
    result.real = static_cast<double>(result.integer);
  };
  const auto items = [&](std::uint64_t size) {
    result.kind = TraceValue::Kind::array;
    for (; size > 0; --size) result.items.push_back(value(depth + 1));
  };
  const auto is_new = [&](std::map<std::uint64_t, bool>& known) { return !std::exchange(known[number()], true); };
  switch (const std::uint8_t kind = byte(); kind) {
    case kNull: break;
    case kFalse:
    case kTrue: integer(kind == kTrue ? 1 : 0); break;
    case kNegative: integer(0 - number()); break;
    case kPositive: integer(number()); break;
    case kFloat:
    case kDouble:
      result.kind = TraceValue::Kind::real;
      result.real = kind == kFloat ? static_cast<double>(raw<float>()) : raw<double>();
      break;
    case kString:
    case kBlob:
      result.kind = TraceValue::Kind::bytes;
      result.bytes = text();
      break;
    case kEnum:
      if (version_ < 3) {
        text();
      } else if (is_new(enums_)) {
        skip_names(true);
      }
      return value(depth + 1);
    case kMask:
      if (is_new(masks_)) skip_names(false);
      integer(number());
      break;
    case kArray: items(count()); break;
    case kStruct: {
      const std::uint64_t id = number();
      auto known = structures_.find(id);
      if (known == structures_.end()) {
        text();
        const std::uint64_t members = count();
        for (std::uint64_t i = 0; i < members; ++i) text();
        known = structures_.emplace(id, members).first;
      }
      items(known->second);
      break;
    }
    case kOpaque:
      integer(number());
      result.kind = TraceValue::Kind::pointer;
      break;
    case kRepresentation: value(depth + 1); return value(depth + 1);
    case kWideString:
      for (std::uint64_t left = count(); left > 0; --left) number();
      break;
    default: fail("is damaged at call " + std::to_string(calls_) + ": no value begins with " + std::to_string(kind));
  }
  return result;
}

void TraceFile::skip_frame() {
  if (std::exchange(frames_[number()], true)) return;
  for (;;) switch (const std::uint8_t kind = byte(); kind) {
      case 0: return;
      case 1:
      case 2:
      case 3: text(); break;
      case 4:
      case 5: number(); break;
      default: fail("is damaged at call " + std::to_string(calls_) + ": in a backtrace");
    }
}

std::shared_ptr<const TraceSignature> TraceFile::signature() {
  std::shared_ptr<const TraceSignature>& known = signatures_[number()];
  if (known == nullptr) {
    auto read = std::make_shared<TraceSignature>();
    read->function = text();
    const std::uint64_t arguments = count();
    if (arguments > kArguments)
      fail("is damaged at call " + std::to_string(calls_) + ": " + std::to_string(arguments) + " arguments");
    for (std::uint64_t i = 0; i < arguments; ++i) read->arguments.push_back(text());
    known = std::move(read);
  }
  return known;
}

void TraceFile::details(TraceCall& call) {
  for (;;) switch (const std::uint8_t kind = byte(); kind) {
      case kEnd: return;
      case kArgument: {
        const std::uint64_t index = number();
        if (index >= call.arguments.size())
          fail("is damaged at call " + std::to_string(call.number) + ": argument " + std::to_string(index) + " of " +
               call.function());
        call.arguments[index] = value();
        break;
      }
      case kResult: call.result = value(); break;
      case kThread: call.thread = number(); break;
      case kBacktrace:
        for (std::uint64_t left = count(); left > 0; --left) skip_frame();
        break;
      case kFlags: number(); break;
      default: fail("is damaged at call " + std::to_string(call.number) + ": no detail is " + std::to_string(kind));
    }
}

bool TraceFile::next(TraceCall& call) {
  while (at_ < chunk_.size() || fill()) {
    switch (const std::uint8_t event = byte(); event) {
      case kEnter: {
        TraceCall entered;
        entered.number = calls_;
        if (version_ >= 4) entered.thread = number();
        entered.signature = signature();
        entered.arguments.resize(entered.signature->arguments.size());
        details(entered);
        entered_.emplace(calls_++, std::move(entered));
        break;
      }
      case kLeave: {
        const auto found = entered_.find(number());
        if (found == entered_.end()) fail("is damaged at call " + std::to_string(calls_) + ": a return without a call");
        call = std::move(found->second);
        entered_.erase(found);
        details(call);
        return true;
      }
      default: fail("is damaged at call " + std::to_string(calls_) + ": no event is " + std::to_string(event));
    }
  }
  return false;
}

}  // namespace halfplane::gl
