# Seeded faults in copies of the RTL, all in one build, chosen at run time by raster_cosim.mutant_q.
#
#   halfplane_mutants_begin(folder)              copies of changed files go here
#   mutant(id file "what is wrong" [[good]] [[bad]])
#       in `file` (relative to rtl_ref) the expression `good`, which must occur exactly once, becomes
#       (raster_cosim.mutant_q == id ? bad : good)
#   mutant_text(id file "what is wrong" [[good]] [[text]])
#       the same for what is no expression: `text` reads raster_cosim.mutant_q itself
#   halfplane_mutants_end(include files_var)     writes a list for C++, {id, "file", "what"}, and the changed sources

function(halfplane_mutants_begin folder)
  set_property(GLOBAL PROPERTY HALFPLANE_MUTANTS_FOLDER "${folder}")
  set_property(GLOBAL PROPERTY HALFPLANE_MUTANTS_FILES "")
  set_property(GLOBAL PROPERTY HALFPLANE_MUTANTS_LIST "")
endfunction()

function(mutant id file what good bad)
  mutant_text(${id} "${file}" "${what}" "${good}" "(raster_cosim.mutant_q == 16'd${id} ? (${bad}) : (${good}))")
endfunction()

function(mutant_text id file what good text_with_mutant)
  get_property(text GLOBAL PROPERTY "HALFPLANE_MUTANTS_TEXT_${file}")
  if("${text}" STREQUAL "")
    file(READ "${file}" text)
    set_property(GLOBAL APPEND PROPERTY HALFPLANE_MUTANTS_FILES "${file}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
  endif()
  string(FIND "${text}" "${good}" first)
  string(FIND "${text}" "${good}" last REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL last)
    message(FATAL_ERROR "mutant ${id}: in ${file} this must occur exactly once: ${good}")
  endif()
  string(REPLACE "${good}" "${text_with_mutant}" text "${text}")
  set_property(GLOBAL PROPERTY "HALFPLANE_MUTANTS_TEXT_${file}" "${text}")
  get_property(list GLOBAL PROPERTY HALFPLANE_MUTANTS_LIST)
  set_property(GLOBAL PROPERTY HALFPLANE_MUTANTS_LIST "${list}{${id}, \"${file}\", \"${what}\"},\n")
endfunction()

function(halfplane_mutants_end include files_var)
  get_property(folder GLOBAL PROPERTY HALFPLANE_MUTANTS_FOLDER)
  get_property(files GLOBAL PROPERTY HALFPLANE_MUTANTS_FILES)
  get_property(list GLOBAL PROPERTY HALFPLANE_MUTANTS_LIST)
  set(changed "")
  foreach(file IN LISTS files)
    get_property(text GLOBAL PROPERTY "HALFPLANE_MUTANTS_TEXT_${file}")
    file(CONFIGURE OUTPUT "${folder}/${file}" CONTENT "${text}" @ONLY)
    list(APPEND changed "${folder}/${file}")
  endforeach()
  file(CONFIGURE OUTPUT "${include}" CONTENT "${list}" @ONLY)
  set(${files_var} "${changed}" PARENT_SCOPE)
endfunction()
