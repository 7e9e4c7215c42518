// Any bytes as a configuration and a capture: functional = scalar = cycle, skip all = skip none, oracle and golden
// within their bounds. A failure prints the capture and the settings that repeat it.
#include <cstdio>
#include <cstdlib>

#include "../pipeline_case.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const halfplane::test::PipelineCase input = halfplane::test::pipeline_case({data, size});
  const std::string fault = halfplane::test::pipeline_fault(input);
  if (fault.empty()) return 0;
  std::fprintf(stderr, "fuzz_pipeline: %s\n%s\n%s", fault.c_str(), halfplane::label(input.config).c_str(),
               input.capture.c_str());
  std::abort();
}
