// Stands in for libpng, of which the program needs 16-bit grey alone (`--depth FILE.png`): refused here, with the reason.
#pragma once

#include <csetjmp>
#include <cstddef>
#include <cstdint>

using png_struct = const char;
using png_structp = void*;
using png_infop = void*;
using png_bytep = const std::uint8_t*;
using png_const_charp = const char*;
using png_uint_32 = std::uint32_t;
using png_error_ptr = void (*)(png_structp, png_const_charp);
using png_rw_ptr = void (*)(png_structp, png_bytep, std::size_t);
using png_flush_ptr = void (*)(png_structp);

inline constexpr const char* PNG_LIBPNG_VER_STRING = "";
inline constexpr int PNG_COLOR_TYPE_GRAY = 0, PNG_INTERLACE_NONE = 0, PNG_COMPRESSION_TYPE_DEFAULT = 0,
                     PNG_FILTER_TYPE_DEFAULT = 0;

/// The job is all that there is of a png_struct here.
inline png_structp png_create_write_struct(const char*, void* job, png_error_ptr on_error, png_error_ptr) {
  on_error(job, "the program in a page writes none");
  return nullptr;
}
inline void* png_get_error_ptr(png_structp png) { return png; }
inline void* png_get_io_ptr(png_structp png) { return png; }
inline void png_longjmp(png_structp, int) {}
inline void png_error(png_structp, const char*) {}
inline png_infop png_create_info_struct(png_structp) { return nullptr; }
inline void png_destroy_write_struct(png_structp*, png_infop*) {}
inline void png_set_write_fn(png_structp, void*, png_rw_ptr, png_flush_ptr) {}
inline void png_set_IHDR(png_structp, png_infop, png_uint_32, png_uint_32, int, int, int, int, int) {}
inline void png_write_info(png_structp, png_infop) {}
inline void png_write_row(png_structp, const std::uint8_t*) {}
inline void png_write_end(png_structp, png_infop) {}
#undef setjmp
#define setjmp(place) 0
#define png_jmpbuf(png) 0
