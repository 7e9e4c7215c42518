// The writer writes an accepted capture back unchanged; a refused capture gets a message.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>

#include "model/capture/capture.hpp"
#include "model/config.hpp"

namespace {

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz_capture: %s\n", what);
  std::abort();
}

std::string written(const halfplane::Scene& scene) {
  std::ostringstream out;
  halfplane::write_capture(scene, out);
  return out.str();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  halfplane::Scene scene;
  try {
    scene = halfplane::read_capture(text, "fuzz.hpt");
  } catch (const halfplane::InputError& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz.hpt:"), "a message does not begin with the place");
    require(message.find('\n') == std::string_view::npos, "a message is longer than a line");
    require(message.size() < 900, "a message repeats the input at length");  // one message names all states
    return 0;
  }
  const std::string first = written(scene);
  const halfplane::Scene again = halfplane::read_capture(first, "again.hpt");  // throws: a crash, and rightly so
  require(halfplane::same_scene(scene, again), "a scene changed on its way through write and read");
  require(written(again) == first, "writing twice gives two texts");
  return 0;
}
