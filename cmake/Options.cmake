# Compiler settings: the ones that all code shares, and halfplane_warnings() for the code written here.

if(PROJECT_IS_TOP_LEVEL)
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug or RelWithDebInfo" FORCE)
  endif()
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)  # clang-tidy and editors read it
  find_program(CCACHE_PROGRAM ccache)
  if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    # A home that cannot be written to would make every compilation fail.
    execute_process(COMMAND "${CCACHE_PROGRAM}" --get-config cache_dir OUTPUT_VARIABLE cache
      OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    execute_process(COMMAND "${CMAKE_COMMAND}" -E make_directory "${cache}/tmp" OUTPUT_QUIET ERROR_QUIET)
    execute_process(COMMAND "${CMAKE_COMMAND}" -E touch "${cache}/tmp/halfplane-probe" RESULT_VARIABLE denied
      OUTPUT_QUIET ERROR_QUIET)
    if(denied)
      message(STATUS "ccache left out: its folder cannot be written to")
    else()
      # Another checkout's objects serve as well, precompiled headers included.
      set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=1
        CCACHE_SLOPPINESS=pch_defines,time_macros "${CCACHE_PROGRAM}")
    endif()
  endif()
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
include(GNUInstallDirs)
# GCC collects garbage every few MB otherwise, for a tenth of its time.
add_compile_options($<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=400000>)

# All code, Verilated code and tests included: an object without them would hide a fault or fail to link.
if(HALFPLANE_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "HALFPLANE_FUZZ needs clang: configure with -DCMAKE_CXX_COMPILER=clang++")
  endif()
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
if(HALFPLANE_SANITIZE)
  add_compile_options("-fsanitize=${HALFPLANE_SANITIZE}" -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options("-fsanitize=${HALFPLANE_SANITIZE}")
endif()

# Warnings for one of our own targets; never for Verilated or installed code.
function(halfplane_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # GCC 12 cries wolf on inlined std::string::insert (its bug 105651)
  if(HALFPLANE_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()
