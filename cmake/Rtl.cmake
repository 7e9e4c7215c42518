# Finds Verilator as HALFPLANE_RTL asks for it, and compiles designs with it at build time.
# Out: HALFPLANE_RTL_FOUND, whether rtl_ref is part of this build.
#
# Verilator's own verilate() runs Verilator when CMake configures and compiles 15 to 20 small sources a design, each of
# which parses the same headers. Here an edit of a module runs Verilator for the designs that have it and nothing else, and
# a design is two or three objects (ADR 109).

set(HALFPLANE_RTL_FOUND OFF)
if(HALFPLANE_RTL)  # AUTO, ON and REQUIRED; OFF skips the search
  find_program(VERILATOR_BIN_PROGRAM verilator_bin)
  if(VERILATOR_BIN_PROGRAM)
    execute_process(COMMAND "${VERILATOR_BIN_PROGRAM}" --getenv VERILATOR_ROOT OUTPUT_VARIABLE VERILATOR_FOLDER
      OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    set(HALFPLANE_RTL_FOUND ON)
  elseif(HALFPLANE_RTL STREQUAL "AUTO")
    message(STATUS "RTL left out: Verilator is not installed")
  else()
    message(FATAL_ERROR "HALFPLANE_RTL=${HALFPLANE_RTL}, but Verilator is not installed: "
      "install the package verilator, or configure with -DHALFPLANE_RTL=OFF")
  endif()
endif()

# The run time that all Verilated classes share.
function(halfplane_verilator_runtime)
  find_package(Threads REQUIRED)
  set(cosim "${PROJECT_SOURCE_DIR}/rtl_ref/cosim")
  set(sources verilated.cpp verilated_threads.cpp)
  if(HALFPLANE_RTL_COVERAGE)
    list(APPEND sources verilated_cov.cpp)
  endif()
  list(TRANSFORM sources PREPEND "${VERILATOR_FOLDER}/include/")
  list(APPEND sources "${cosim}/verilated_messages.cpp")
  if(NOT HALFPLANE_RTL_COVERAGE)
    list(APPEND sources "${cosim}/fst_files.cpp")  # verilated_fst_c.cpp, which looks at its files
  endif()
  add_library(halfplane_verilator STATIC ${sources})
  # What failed assertions say goes to the harness, not to stdout.
  set_source_files_properties("${VERILATOR_FOLDER}/include/verilated.cpp" PROPERTIES
    COMPILE_OPTIONS "-include;${cosim}/verilated_messages.hpp"
    COMPILE_DEFINITIONS "VL_PRINTF=halfplane_verilated_print;VL_USER_FATAL")
  # Verilator's headers warn under our flags: their users see them as system headers.
  target_include_directories(halfplane_verilator SYSTEM PUBLIC
    "${VERILATOR_FOLDER}/include" "${VERILATOR_FOLDER}/include/vltstd")
  target_compile_definitions(halfplane_verilator PUBLIC VM_SC=0 VM_TRACE=1 VM_TRACE_FST=1 VM_TRACE_VCD=0
    VM_COVERAGE=$<BOOL:${HALFPLANE_RTL_COVERAGE}>)
  target_compile_options(halfplane_verilator PRIVATE -w -O1)
  set_target_properties(halfplane_verilator PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(halfplane_verilator PUBLIC Threads::Threads)
  find_package(ZLIB REQUIRED)  # of the FST writer
  target_link_libraries(halfplane_verilator PUBLIC ZLIB::ZLIB)
endfunction()

# halfplane_verilate(target PREFIX Class TOP module SOURCES file... [PARAMS NAME=value...] [INCLUDES file...] [TRACE])
#
# Adds the Verilated class `Class` of module `TOP` to the static library `target`, which the first call creates. One
# class per configuration, because parameters are fixed when Verilator runs. INCLUDES: files that `include finds below the
# caller's folder. TRACE: waveforms (FST) can be written. FAST: with lib/clock_gate.sv and lib/register_gate.sv at work, and
# compiled with -O2, which takes 1.7 times as long: 12 % and 6 % fewer instructions a frame. Any lint warning of -Wall is an
# error.
function(halfplane_verilate target)
  cmake_parse_arguments(PARSE_ARGV 1 RTL "TRACE;FAST" "PREFIX;TOP" "SOURCES;PARAMS;INCLUDES")
  foreach(argument PREFIX TOP SOURCES)
    if(NOT RTL_${argument})
      message(FATAL_ERROR "halfplane_verilate(${target}): ${argument} is missing")
    endif()
  endforeach()
  if(RTL_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "halfplane_verilate(${target}): what is ${RTL_UNPARSED_ARGUMENTS}?")
  endif()
  if(NOT TARGET halfplane_verilator)
    halfplane_verilator_runtime()
  endif()

  set(sources "")
  foreach(source IN LISTS RTL_SOURCES)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
    list(APPEND sources "${source}")
  endforeach()
  list(TRANSFORM RTL_INCLUDES PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/" OUTPUT_VARIABLE includes)
  list(TRANSFORM RTL_PARAMS PREPEND -G)
  # Random start values, so that resets are tested. One source a kind: the objects below include them whole.
  set(waivers "${PROJECT_SOURCE_DIR}/rtl_ref/lint.vlt")
  set(arguments --cc -Wall --assert --x-assign unique --x-initial unique --output-split 0
    "-I${CMAKE_CURRENT_SOURCE_DIR}" ${RTL_PARAMS})
  # What runs in every clock; what runs once, and writes waveforms: there optimisation costs build time and gains little.
  set(parts fast slow)
  if(RTL_TRACE)
    list(APPEND arguments --trace-fst --no-trace-params)  # parameters would be two of five signals
    list(APPEND parts trace)
  endif()
  set(optimised -O1)
  if(RTL_FAST)
    list(APPEND arguments -DCLOCK_GATES)
    set(optimised -O2 -fpeel-loops)  # short loops over the clocks
  endif()
  if(HALFPLANE_RTL_COVERAGE)
    # Packets of up to 1,024 bits count as well.
    list(APPEND arguments --coverage-line --coverage-toggle --coverage-max-width 1024)
  endif()

  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${RTL_PREFIX}")
  list(TRANSFORM parts REPLACE "(.+)" "${folder}/${RTL_PREFIX}_\\1.cpp" OUTPUT_VARIABLE objects)
  add_custom_command(OUTPUT "${folder}/${RTL_PREFIX}.h" ${objects}
    COMMAND "${VERILATOR_BIN_PROGRAM}" ${arguments} --make cmake --prefix ${RTL_PREFIX} --Mdir "${folder}"
      --top-module ${RTL_TOP} "${waivers}" ${sources}
    COMMAND "${CMAKE_COMMAND}" -DFOLDER=${folder} -DPREFIX=${RTL_PREFIX} "-DPARTS=${parts}"
      -P "${PROJECT_SOURCE_DIR}/cmake/VerilatedParts.cmake"
    DEPENDS "${VERILATOR_BIN_PROGRAM}" "${waivers}" ${sources} ${includes} "${PROJECT_SOURCE_DIR}/cmake/VerilatedParts.cmake"
    COMMENT "Verilating ${RTL_PREFIX}" VERBATIM)
  list(GET objects 0 fast)
  set_source_files_properties("${fast}" PROPERTIES COMPILE_OPTIONS "${optimised}" SKIP_UNITY_BUILD_INCLUSION ON)

  if(NOT TARGET ${target})
    add_library(${target} STATIC)
    target_compile_options(${target} PRIVATE -O0 -w)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ${HALFPLANE_UNITY} UNITY_BUILD_BATCH_SIZE 4)
    target_link_libraries(${target} PUBLIC halfplane_verilator)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  target_sources(${target} PRIVATE ${objects} "${folder}/${RTL_PREFIX}.h")
  target_include_directories(${target} SYSTEM PUBLIC "${folder}")
endfunction()
