# Writes OUTPUT from TEMPLATE with the commit of SOURCE in it, and leaves it alone when nothing changed, so that what
# depends on it is not built again: cmake -DSOURCE=DIR -DTEMPLATE=FILE -DOUTPUT=FILE -DBUILD_TYPE=... -DCOMPILER=... -P ...

# A tree of somebody else's that holds this one says nothing about it.
function(git_says result)
  set(ENV{GIT_OPTIONAL_LOCKS} 0)  # others may be at work in the tree
  execute_process(COMMAND git ${ARGN} WORKING_DIRECTORY "${SOURCE}" RESULT_VARIABLE status OUTPUT_VARIABLE text
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  set(${result} "${text}" PARENT_SCOPE)
  set(git_status "${status}" PARENT_SCOPE)
endfunction()

set(COMMIT unknown)
git_says(prefix rev-parse --show-prefix)
if(git_status STREQUAL 0 AND prefix STREQUAL "")
  git_says(hash rev-parse --short HEAD)
  if(git_status STREQUAL 0)
    set(COMMIT "${hash}")
    git_says(changes status --porcelain --untracked-files=no)
    if(NOT changes STREQUAL "")
      string(APPEND COMMIT +changes)
    endif()
  endif()
endif()
configure_file("${TEMPLATE}" "${OUTPUT}" @ONLY)
