# halfplane.core against the RTL: every source at the top of rtl_ref is listed, every listed file exists, and, where
# Verilator is, the list in its order lints.   cmake -DSOURCE= -DVERILATOR= -P core_file.cmake
file(STRINGS "${SOURCE}/halfplane.core" lines REGEX "^      - ")
cmake_minimum_required(VERSION 3.25)
set(listed)
foreach(line IN LISTS lines)
  string(REGEX REPLACE "^      - " "" file "${line}")
  list(APPEND listed "${file}")
  if(NOT EXISTS "${SOURCE}/${file}" AND NOT file MATCHES "^rtl_ref/presets/")  # which the build makes: tests/install looks
    message(SEND_ERROR "halfplane.core lists ${file}, which is not there")
  endif()
endforeach()
file(GLOB sources RELATIVE "${SOURCE}" "${SOURCE}/rtl_ref/*.sv")  # lib and stages: a unit test writes them
foreach(file IN LISTS sources)
  if(NOT file IN_LIST listed)
    message(SEND_ERROR "halfplane.core does not list ${file}")
  endif()
endforeach()
if(VERILATOR)
  list(FILTER listed INCLUDE REGEX "^rtl_ref/(lint|lib|stages|raster_|primitive_)")
  execute_process(COMMAND "${VERILATOR}" --lint-only -Wall --top-module raster_top ${listed}
    WORKING_DIRECTORY "${SOURCE}" COMMAND_ERROR_IS_FATAL ANY)
endif()
