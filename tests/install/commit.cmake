# cmake -DSOURCE= -DWORK= -P commit.cmake
# Runs cmake/BuildInfo.cmake outside of git, in a tree of its own, in one with changes; needs git for the last two.
file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}/tree")
file(WRITE "${WORK}/in" "@COMMIT@, @BUILD_TYPE@, @COMPILER@")

function(expect_info pattern)
  execute_process(COMMAND "${CMAKE_COMMAND}" "-DSOURCE=${WORK}/tree" "-DTEMPLATE=${WORK}/in" "-DOUTPUT=${WORK}/out"
    -DBUILD_TYPE=Release "-DCOMPILER=GNU 12" -P "${SOURCE}/cmake/BuildInfo.cmake" COMMAND_ERROR_IS_FATAL ANY)
  file(READ "${WORK}/out" text)
  string(STRIP "${text}" text)
  if(NOT text MATCHES "^${pattern}, Release, GNU 12$")
    message(SEND_ERROR "'${text}' is not as '${pattern}'")
  endif()
endfunction()

expect_info(unknown)  # within the build folder, in whatever tree of git that lies

find_program(GIT git)
if(NOT GIT)
  message(STATUS "no git here: only a tree without it was tried")
  return()
endif()
macro(git)
  execute_process(COMMAND "${GIT}" -c user.name=test -c user.email=test@localhost -c commit.gpgsign=false ${ARGN}
    WORKING_DIRECTORY "${WORK}/tree" COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
endmacro()
file(WRITE "${WORK}/tree/file" one)
git(init --quiet)
git(add file)
git(commit --quiet --message first)
expect_info("[0-9a-f]+")
file(TIMESTAMP "${WORK}/out" before "%s")
execute_process(COMMAND "${CMAKE_COMMAND}" -E sleep 1.1)
expect_info("[0-9a-f]+")
file(TIMESTAMP "${WORK}/out" after "%s")
if(NOT before STREQUAL after)
  message(SEND_ERROR "written again without a change, and so built again")
endif()
file(WRITE "${WORK}/tree/untracked" x)
expect_info("[0-9a-f]+")
file(WRITE "${WORK}/tree/file" two)
expect_info("[0-9a-f]+[+]changes")
