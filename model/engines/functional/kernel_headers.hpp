// Everything that the kernels include, before a TU switches to another instruction set: what these headers define stays
// code for every machine.
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "../../fragment_ops.hpp"
#include "../../stages/triangle_setup.hpp"
#include "frame.hpp"
#include "kernels.hpp"
#include "surface_constants.hpp"

#define HALFPLANE_NOINLINE __attribute__((noinline))
// HALFPLANE_SMALL_KERNELS: the compiler chooses what it inlines. Inlining all of it, where a vector is four registers, makes
// four times the code and takes ten times as long to compile.
#ifdef HALFPLANE_SMALL_KERNELS
#define HALFPLANE_INLINE inline
#define HALFPLANE_LAMBDA
#else
#define HALFPLANE_INLINE inline __attribute__((always_inline))
#define HALFPLANE_LAMBDA __attribute__((always_inline))
#endif
