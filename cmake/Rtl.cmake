# Finds Verilator as HALFPLANE_RTL asks for it, and wraps its verilate() command.
# Out: HALFPLANE_RTL_FOUND, whether rtl_ref is part of this build.

set(HALFPLANE_RTL_FOUND OFF)
if(HALFPLANE_RTL)  # AUTO, ON and REQUIRED; OFF skips the search
  find_package(verilator QUIET)
  if(verilator_FOUND)
    set(HALFPLANE_RTL_FOUND ON)
  elseif(HALFPLANE_RTL STREQUAL "AUTO")
    message(STATUS "RTL left out: Verilator is not installed")
  else()
    message(FATAL_ERROR "HALFPLANE_RTL=${HALFPLANE_RTL}, but Verilator is not installed: "
      "install the package verilator, or configure with -DHALFPLANE_RTL=OFF")
  endif()
endif()

# halfplane_verilate(target PREFIX Class TOP module SOURCES file... [PARAMS NAME=value...] [INCLUDES folder...] [TRACE])
#
# Adds the Verilated class `Class` of module `TOP` to the static library `target`, which the first call creates. One
# class per configuration, because parameters are fixed when Verilator runs; one library for many, because each carries
# Verilator's runtime. TRACE: waveforms (FST) can be written. Any lint warning of -Wall is an error, at configure time already.
function(halfplane_verilate target)
  cmake_parse_arguments(PARSE_ARGV 1 RTL "TRACE" "PREFIX;TOP" "SOURCES;PARAMS;INCLUDES")
  foreach(argument PREFIX TOP SOURCES)
    if(NOT RTL_${argument})
      message(FATAL_ERROR "halfplane_verilate(${target}): ${argument} is missing")
    endif()
  endforeach()
  if(RTL_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "halfplane_verilate(${target}): what is ${RTL_UNPARSED_ARGUMENTS}?")
  endif()

  set(sources "")
  foreach(source IN LISTS RTL_SOURCES)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
    list(APPEND sources "${source}")
  endforeach()
  set(arguments -Wall --assert --x-assign unique --x-initial unique)  # random start values, so that resets are tested
  foreach(folder IN LISTS RTL_INCLUDES)
    cmake_path(ABSOLUTE_PATH folder BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
    list(APPEND arguments "-I${folder}")
  endforeach()
  foreach(param IN LISTS RTL_PARAMS)
    list(APPEND arguments "-G${param}")
  endforeach()

  set(trace "")
  if(RTL_TRACE)
    set(trace TRACE_FST)
  endif()
  set(optimised -O2)
  if(HALFPLANE_RTL_COVERAGE)
    # Packets of up to 1,024 bits count as well. Code that counts is large: what -O2 gains, its compilation loses.
    list(APPEND arguments --coverage-line --coverage-toggle --coverage-max-width 1024)
    set(optimised -O1)
  endif()

  if(NOT TARGET ${target})
    add_library(${target} STATIC)
  endif()
  # SLOW is what runs once, GLOBAL the runtime: optimising them costs build time and gains nothing.
  verilate(${target} PREFIX ${RTL_PREFIX} TOP_MODULE ${RTL_TOP} SOURCES ${sources} ${trace} VERILATOR_ARGS ${arguments}
    OPT_SLOW -O0 OPT_FAST ${optimised} OPT_GLOBAL -O1)
  # Verilator's headers warn under our flags: their users see them as system headers.
  get_target_property(folders ${target} INTERFACE_INCLUDE_DIRECTORIES)
  set_target_properties(${target} PROPERTIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${folders}")
endfunction()
