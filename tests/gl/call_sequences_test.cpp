// Random sequences of commands: any enum, any nesting, valid memory. Nothing may crash or touch memory that is not the
// command's; sanitizers see more of it (the preset asan-ubsan). Accepted arguments are tried again with one argument
// changed, so that sequences get past the checks of enums.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "gl/core/commands.hpp"
#include "gl/core/entry_points.hpp"
#include "sim/scene/random.hpp"
#include "tests/tier.hpp"

namespace halfplane::gl::call_sequences_test {
namespace {

constexpr std::size_t kPool = std::size_t{16} << 20;  // bytes that any pointer may be followed and preceded by
constexpr int kLargest = 33;                          // largest of numbers that count something

/// First and last value of the runs in which the enums of OpenGL 1.5 lie.
constexpr std::array<std::pair<unsigned, unsigned>, 51> kEnums{
    {{0x0000, 0x0009}, {0x0100, 0x0104}, {0x0200, 0x0207}, {0x0300, 0x0308}, {0x0400, 0x040c}, {0x0500, 0x0505},
     {0x0600, 0x0604}, {0x0700, 0x0707}, {0x0800, 0x0803}, {0x0900, 0x0901}, {0x0a00, 0x0a02}, {0x0b00, 0x0bf2},
     {0x0c00, 0x0cc6}, {0x0cf0, 0x0d05}, {0x0d10, 0x0dff}, {0x1000, 0x1004}, {0x1100, 0x1102}, {0x1200, 0x1209},
     {0x1300, 0x1301}, {0x1400, 0x140c}, {0x1500, 0x150f}, {0x1600, 0x1603}, {0x1700, 0x1702}, {0x1800, 0x1802},
     {0x1900, 0x190a}, {0x1a00, 0x1a01}, {0x1b00, 0x1b02}, {0x1c00, 0x1c02}, {0x1d00, 0x1d01}, {0x1e00, 0x1e03},
     {0x1f00, 0x1f03}, {0x2000, 0x2003}, {0x2100, 0x2101}, {0x2200, 0x2203}, {0x2300, 0x2300}, {0x2400, 0x2401},
     {0x2500, 0x2502}, {0x2600, 0x2601}, {0x2700, 0x2703}, {0x2800, 0x2803}, {0x2900, 0x2901}, {0x2a00, 0x2a27},
     {0x3000, 0x3005}, {0x4000, 0x4007}, {0x8001, 0x800b}, {0x8032, 0x8074}, {0x80c8, 0x8151}, {0x8362, 0x8370},
     {0x84c0, 0x858a}, {0x8764, 0x8919}, {0x8b90, 0x8b9f}}};

/// Memory for the program's side. Pointers are to its middle.
struct Pools {
  std::vector<std::byte> numbers = std::vector<std::byte>(2 * kPool);  ///< read: any bits
  std::vector<std::byte> indices = std::vector<std::byte>(2 * kPool);  ///< read: numbers below 16 of any integer type
  std::vector<std::byte> scratch = std::vector<std::byte>(2 * kPool);  ///< written
};

class Caller {
 public:
  Caller() {
    Random fill(1);
    for (std::size_t i = 0; i < pools_.numbers.size(); i += 8) {
      const std::uint64_t bits = fill.next();
      std::memcpy(&pools_.numbers[i], &bits, 8);
    }
    for (std::size_t i = 0; i < pools_.indices.size(); i += 4) pools_.indices[i] = static_cast<std::byte>(i / 4 % 16);
    for (const auto& [name, entry] : entry_points())
      if (!name.starts_with("glMultiDrawElements"))  // its pointers lie in memory, where bits of any kind are none
        commands_.push_back({name, entry});
  }

  /// One sequence on contexts of its own.
  void run(std::uint64_t seed, int calls) {
    random_ = Random(seed);
    Options options;
    options.config = labelled(configs_[seed % configs_.size()]);
    options.on_missing = OnMissing::host;
    Drawable drawable(options, 32, 24);
    Context context;
    context.is_embedded = seed % 4 == 0;
    make_current(&context, &drawable, &drawable);
    calls_of_list_ = 0;
    for (int i = 0; i < calls; ++i) {
      Command& command = commands_[random_.next() % commands_.size()];
      // A list that calls itself more than once takes for ever, as it would on any OpenGL.
      if (context.compiling != nullptr && command.name.starts_with("glCallList") &&
          (command.name == "glCallLists" || calls_of_list_++ > 0))
        continue;
      if (command.name == "glNewList") calls_of_list_ = 0;
      call(command);
    }
    if (context.inside_begin()) end(context);
    (void)drawable.frame.picture();
    drawable.frame.end();
    make_current(nullptr, nullptr, nullptr);
  }

 private:
  static constexpr std::size_t kMost = 64;          ///< accepted calls of a command that are kept
  using Arguments = std::array<std::uint64_t, 12>;  ///< the bits of each

  struct Command {
    std::string_view name;
    EntryPoint entry;
    std::vector<Arguments> accepted{};
  };

  void call(Command& command) {
    const auto parameters = command.entry.parameters;
    const bool has_pointer = std::ranges::any_of(parameters, &Parameter::is_pointer);
    Arguments arguments{};
    for (std::size_t i = 0; i < parameters.size(); ++i) arguments[i] = bits(command.name, parameters[i], has_pointer);
    if (!command.accepted.empty() && random_.next() % 4 != 0) {
      const Arguments fresh = arguments;
      arguments = command.accepted[random_.next() % command.accepted.size()];
      const std::size_t changed = random_.next() % (parameters.size() + 1);
      if (changed < parameters.size()) arguments[changed] = fresh[changed];
    }
    Context* context = current();
    const GLenum before = std::exchange(context->error, GL_NO_ERROR);
    command.entry.call(command.entry.function, arguments.data());
    if (context->error == GL_NO_ERROR && context->compiling == nullptr) {
      if (command.accepted.size() < kMost)
        command.accepted.push_back(arguments);
      else
        command.accepted[random_.next() % kMost] = arguments;
    }
    if (before != GL_NO_ERROR) context->error = before;
  }

  std::uint64_t bits(std::string_view name, const Parameter& type, bool has_pointer) {
    if (type.is_pointer) return reinterpret_cast<std::uintptr_t>(pointer(name, type.is_const));
    if (type.is_real) {
      const double value = real(name.starts_with("glPixelStore"));
      return type.bytes == sizeof value ? std::bit_cast<std::uint64_t>(value)
                                        : std::bit_cast<std::uint32_t>(static_cast<float>(value));
    }
    if (type.bytes < sizeof(int)) return random_.next();
    const bool takes_enum = !type.is_signed && type.bytes == sizeof(GLenum);
    if (takes_enum ? random_.next() % 3 != 0 : !has_pointer && random_.next() % 4 == 0 && has_integer_enums(name))
      return any_enum();
    if (takes_enum && random_.next() % 8 == 0) return random_.next();
    return random_.next() % (kLargest + 3) - 2;
  }
  static bool has_integer_enums(std::string_view name) {
    constexpr std::array kOf{"glTex", "glLight", "glMaterial", "glFog", "glPoint", "glPixelTransfer"};
    return std::ranges::any_of(kOf, [name](std::string_view start) { return name.starts_with(start); });
  }
  unsigned any_enum() {
    const auto [first, last] = kEnums[random_.next() % kEnums.size()];
    return first + static_cast<unsigned>(random_.next() % (last - first + 1));
  }
  double real(bool is_small) {
    constexpr std::array kSpecial{0.0, 1.0, -1.0, 0.5, 2.0, 16.0, 255.0, 1e30, -1e30, 1e-30};
    switch (random_.next() % (is_small ? 2 : 8)) {
      case 0: return std::floor(random_.uniform(-2, kLargest));
      case 1: return random_.uniform(-2, 2);
      case 2: return random_.uniform(-64, 64);
      case 3: return any_enum();
      case 4: return random_.next() % 8 == 0 ? std::numeric_limits<double>::infinity() : 1;
      case 5: return random_.next() % 8 == 0 ? std::numeric_limits<double>::quiet_NaN() : 0;
      default: return kSpecial[random_.next() % kSpecial.size()];
    }
  }
  void* pointer(std::string_view name, bool is_read) {
    if (is_read && random_.next() % 16 == 0 && name.starts_with("glTexImage")) return nullptr;
    const bool counts = name.find("Elements") != name.npos || name.find("List") != name.npos ||
                        name.find("Delete") != name.npos || name.find("MultiDraw") != name.npos;
    std::vector<std::byte>& pool = !is_read ? pools_.scratch : counts ? pools_.indices : pools_.numbers;
    return &pool[kPool + random_.next() % 64 * 16];
  }

  Pools pools_;
  std::vector<Command> commands_;
  Random random_{0};
  int calls_of_list_ = 0;
  std::array<std::string, 3> configs_{"embedded", "full stencil.bits=8", "embedded stencil.bits=8 msaa.samples=4"};
};

TEST(CallSequences, RandomCommandsNeitherCrashNorLeaveTheirMemory) {
  Caller caller;
  std::uint64_t first = 1, last = test::cases(2000, 1000000);
  if (const char* seeds = std::getenv("HALFPLANE_SEEDS"))  // "1000 1999": a part of them, or others
    std::istringstream(seeds) >> first >> last;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    if ((seed - first) % 1000 == 0) std::cout << "from seed " << seed << std::endl;
    caller.run(seed, 40);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace halfplane::gl::call_sequences_test
