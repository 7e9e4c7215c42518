# cmake -DBUILD= -DWORK= -DCONFIG= -DSOURCE= -DLIBRARY= -P install.cmake
# LIBRARY: whether it has one that a plain C program can be linked with
file(REMOVE_RECURSE "${WORK}")
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${WORK}" --config "${CONFIG}"
  COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
foreach(file IN ITEMS
    bin/halfplane
    share/bash-completion/completions/halfplane
    share/zsh/site-functions/_halfplane
    share/fish/vendor_completions.d/halfplane.fish
    share/halfplane/rtl_ref/raster_top.sv
    share/halfplane/rtl_ref/raster_pkg.sv
    share/halfplane/rtl_ref/primitive_stream_checker.sv
    share/halfplane/rtl_ref/stages/cull.sv
    share/halfplane/rtl_ref/area/gates.py
    share/halfplane/rtl_ref/presets/tiny/raster_pkg.sv
    share/doc/halfplane/README.md
    share/doc/halfplane/docs/images/teapot.png
    share/man/man1/halfplane.1
    share/man/man1/halfplane-render.1)
  if(NOT EXISTS "${WORK}/${file}")
    message(SEND_ERROR "not installed: ${file}")
    continue()
  endif()
  file(SIZE "${WORK}/${file}" size)
  if(size EQUAL 0)
    message(SEND_ERROR "empty: ${file}")
  endif()
endforeach()
execute_process(COMMAND "${WORK}/bin/halfplane" completions bash OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
file(READ "${WORK}/share/bash-completion/completions/halfplane" installed)
if(NOT said STREQUAL installed)
  message(SEND_ERROR "the completion that is installed is not what the program says")
endif()

# Every page and schema, and every command's manual page, which equals --help.
file(GLOB_RECURSE pages RELATIVE "${SOURCE}" "${SOURCE}/docs/*.md" "${SOURCE}/docs/*.json")
list(LENGTH pages count)
if(count LESS 50)
  message(SEND_ERROR "only ${count} pages in ${SOURCE}/docs")
endif()
foreach(page IN LISTS pages)
  if(NOT EXISTS "${WORK}/share/doc/halfplane/${page}")
    message(SEND_ERROR "not installed: ${page}")
  endif()
endforeach()
execute_process(COMMAND "${WORK}/bin/halfplane" --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "\n  [a-z]+  +" commands "${help}")
list(LENGTH commands count)
if(count LESS 15)
  message(SEND_ERROR "--help lists ${count} commands")
endif()
foreach(command IN LISTS commands)
  string(STRIP "${command}" command)
  if(NOT EXISTS "${WORK}/share/man/man1/halfplane-${command}.1")
    message(SEND_ERROR "no manual page of ${command}")
  endif()
endforeach()

# The FuseSoC core finds its files where it lies.
file(STRINGS "${WORK}/share/halfplane/halfplane.core" lines REGEX "^      - [a-z_]+/")
list(LENGTH lines count)
if(count LESS 20)
  message(SEND_ERROR "halfplane.core lists ${count} files")
endif()
foreach(line IN LISTS lines)
  string(REGEX REPLACE "^      - " "" file "${line}")
  if(NOT EXISTS "${WORK}/share/halfplane/${file}")
    message(SEND_ERROR "halfplane.core lists ${file}, which is not installed beside it")
  endif()
endforeach()

# A C program that knows pkg-config alone, wherever the prefix is.
find_program(CC NAMES cc gcc clang)
find_program(PKG_CONFIG pkg-config)
if(NOT LIBRARY)
  message(STATUS "built without the C interface: pkg-config was not tried")
elseif(NOT CC OR NOT PKG_CONFIG)
  message(STATUS "no C compiler or no pkg-config here: it was not tried")
else()
  file(GLOB_RECURSE pc "${WORK}/*/halfplane.pc")
  cmake_path(GET pc PARENT_PATH folder)
  set(ENV{PKG_CONFIG_PATH} "${folder}")
  foreach(asked IN ITEMS --cflags --libs --variable=libdir)
    execute_process(COMMAND "${PKG_CONFIG}" ${asked} halfplane OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE
      COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(said)
    list(APPEND flags ${said})
  endforeach()
  list(POP_BACK flags libdir)
  execute_process(COMMAND "${CC}" "${SOURCE}/tests/consumer/main.c" -o "${WORK}/c_consumer" ${flags}
    COMMAND_ERROR_IS_FATAL ANY)
  set(ENV{LD_LIBRARY_PATH} "${libdir}")
  execute_process(COMMAND "${WORK}/c_consumer" COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
endif()
