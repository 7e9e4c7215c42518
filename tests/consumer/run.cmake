# cmake -DSOURCE= -DWORK= -DGENERATOR= -DCOMPILER= -DLAUNCHER= [-DBUILD=] -P run.cmake
# The steps of a stranger who uses the library; the first that fails stops the script, and so the test. BUILD: a build whose
# library is installed; without it the library is built, alone.

file(REMOVE_RECURSE "${WORK}")
# Unoptimised: the test is that the library is found, links and runs.
set(common -G "${GENERATOR}" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 "-DCMAKE_CXX_COMPILER=${COMPILER}"
  "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}")

macro(step)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY COMMAND_ECHO STDOUT)
endmacro()

if(NOT BUILD)
  set(BUILD "${WORK}/library")
  step("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${BUILD}" ${common} -DHALFPLANE_RTL=OFF -DHALFPLANE_BUILD_SIM=OFF
    -DHALFPLANE_BUILD_TESTS=OFF)
  step("${CMAKE_COMMAND}" --build "${BUILD}" --parallel 2)
endif()
step("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${WORK}/prefix")
step("${CMAKE_COMMAND}" -S "${SOURCE}/tests/consumer" -B "${WORK}/consumer" ${common}
  "-DCMAKE_PREFIX_PATH=${WORK}/prefix")
step("${CMAKE_COMMAND}" --build "${WORK}/consumer")
step("${CMAKE_COMMAND}" -S "${SOURCE}/examples/turning_cube" -B "${WORK}/cube" ${common}
  "-DCMAKE_PREFIX_PATH=${WORK}/prefix")
step("${CMAKE_COMMAND}" --build "${WORK}/cube")
step("${WORK}/cube/turning_cube" 2)
step("${WORK}/consumer/consumer")
step("${WORK}/consumer/c_consumer")
