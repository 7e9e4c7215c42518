# replace_once(variable where [[good]] [[bad]]): in the text that `variable` of the caller holds, `good`, which must occur
# exactly once, becomes `bad`; `where` names the text in the message. For seeded faults: one that no longer fits its source
# stops the build.
function(replace_once variable where good bad)
  set(replace_once_text "${${variable}}")
  string(FIND "${replace_once_text}" "${good}" first)
  string(FIND "${replace_once_text}" "${good}" last REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL last)
    message(FATAL_ERROR "in ${where} this must occur exactly once: ${good}")
  endif()
  string(REPLACE "${good}" "${bad}" replace_once_text "${replace_once_text}")
  set(${variable} "${replace_once_text}" PARENT_SCOPE)
endfunction()
