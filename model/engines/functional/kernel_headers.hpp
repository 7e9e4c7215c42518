// All headers that the kernels include, before a TU switches to another instruction set: definitions of these headers
// stay code for every machine.
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
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "../../stages/fragment_ops.hpp"
#include "../../stages/triangle_setup.hpp"
#include "frame.hpp"
#include "kernels.hpp"
#include "surface_constants.hpp"

// The instruction set of a unit of kernels: bits of its registers, and the namespace that every file of kernels/ opens. A unit
// sets both before it includes anything; these are for tools that read one of those files by itself.
#ifndef HALFPLANE_ISA
#define HALFPLANE_ISA 128
#define HALFPLANE_ISA_NAME portable
#endif

#define HALFPLANE_NOINLINE __attribute__((noinline))
// HALFPLANE_LEAF is always inlined: operations on lanes, and the leaf arithmetic of the stages.
// HALFPLANE_SMALL_KERNELS: the compiler decides about the functions built on them. Inlining all of it, where a vector
// is two or four registers, makes two or four times the code and takes two to ten times as long to compile.
#define HALFPLANE_LEAF inline __attribute__((always_inline))
#ifdef HALFPLANE_SMALL_KERNELS
#define HALFPLANE_INLINE inline
#define HALFPLANE_LAMBDA
#else
#define HALFPLANE_INLINE HALFPLANE_LEAF
#define HALFPLANE_LAMBDA __attribute__((always_inline))
#endif
