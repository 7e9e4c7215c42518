// Any bytes as a Scene that a caller has filled in: an InputError or a picture, from every public function. A failure
// prints the settings; the input is kept by libFuzzer.
#include <cstdio>
#include <cstdlib>

#include "../api_case.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const halfplane::test::ApiCase input = halfplane::test::api_case({data, size});
  const std::string fault = halfplane::test::api_fault(input);
  if (fault.empty()) return 0;
  std::fprintf(stderr, "fuzz_api: %s\n%s\n", fault.c_str(), halfplane::label(input.config).c_str());
  std::abort();
}
