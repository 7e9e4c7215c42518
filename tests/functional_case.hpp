// The functional engine's fast path against the scalar engine: image and program-order counters, whatever the thread
// count, the instruction set and the skips.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "model/engines/functional.hpp"
#include "model/engines/functional/kernels.hpp"
#include "model/engines/scalar.hpp"

namespace halfplane::test {

inline void expect_same(const Rendering& fast, const Rendering& scalar) {
  ASSERT_EQ(fast.frame.depth, scalar.frame.depth);
  ASSERT_EQ(fast.frame.color, scalar.frame.color);
  EXPECT_EQ(fast.counters.depth_passed, scalar.counters.depth_passed);
  ASSERT_EQ(fast.frame.stencil, scalar.frame.stencil);
  EXPECT_EQ(fast.counters.alpha_killed, scalar.counters.alpha_killed);
  EXPECT_EQ(fast.counters.written, scalar.counters.written);
  EXPECT_EQ(fast.counters.primitives_in, scalar.counters.primitives_in);
  EXPECT_EQ(fast.counters.primitives_in, fast.counters.culled + fast.counters.drawn);
}

/// Every kernel that this machine has, one and three threads, everything skipped and nothing; and fragments one by one.
inline void expect_all_same(const Scene& scene, const Config& config) {
  const Rendering scalar = render_scalar(scene, config);
  const PreparedScene prepared(scene);
  FunctionalEngine engine(config);
  for (const functional::Kernels* kernels : functional::available_kernels())
    for (const int threads : {1, 3})
      for (const bool skips : {true, false}) {
        SCOPED_TRACE(std::string(kernels->name) + ", threads " + std::to_string(threads) +
                     (skips ? ", skip all" : ", skip none"));
        RenderOptions options;
        options.instruction_set = kernels->name;
        options.threads = threads;
        if (!skips) options.skip = skip_none();
        const Rendering& fast = engine.render(prepared, options);
        expect_same(fast, scalar);
        if (!skips) {
          EXPECT_EQ(fast.counters.covered, scalar.counters.covered);
        }
      }
  for (const functional::Kernels* kernels : functional::available_kernels()) {
    SCOPED_TRACE(std::string(kernels->name) + ", general fragments");
    RenderOptions options;
    options.instruction_set = kernels->name;
    options.general_fragments = true;
    const Rendering& fast = engine.render(prepared, options);
    expect_same(fast, scalar);
    EXPECT_EQ(fast.counters.covered, scalar.counters.covered);
  }
}

}  // namespace halfplane::test
