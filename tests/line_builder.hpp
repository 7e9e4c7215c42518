// Lines for tests: what the stages cover, held against the exact oracle pixel by pixel.
#pragma once

#include <gtest/gtest.h>

#include "scene_builder.hpp"
#include "sim/study/stress/line_check.hpp"

namespace halfplane::test {

using namespace halfplane::stress;  // LineSpace, pixels_of, oracle_positions, ...

}  // namespace halfplane::test
