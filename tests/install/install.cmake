# cmake -DBUILD= -DWORK= -DCONFIG= -P install.cmake
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
    share/halfplane/rtl_ref/stages/cull.sv
    share/halfplane/rtl_ref/area/gates.py
    share/halfplane/rtl_ref/presets/tiny/raster_pkg.sv
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
