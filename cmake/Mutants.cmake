# Seeded faults in copies of the RTL, all in one build, chosen at run time by raster_cosim.mutant_q. A script:
#
#   cmake -DSOURCE=rtl_ref -DMUTANTS=FILE "-DFILES=lib/a.sv;stages/b.sv" -DFOLDER=DIR -P cmake/Mutants.cmake
#
# writes each of FILES (relative to SOURCE) into FOLDER, with the faults that MUTANTS names, and mutants.inc, a list for C++:
# {id, "file", "what"}. A file whose text stays is not written again. MUTANTS calls
#
#   mutant(id file "what is wrong" [[good]] [[bad]])
#       in `file` (relative to rtl_ref) the expression `good`, which must occur exactly once, becomes
#       (raster_cosim.mutant_q == id ? bad : good)
#   mutant_text(id file "what is wrong" [[good]] [[text]])
#       the same for what is no expression: `text` reads raster_cosim.mutant_q itself

cmake_policy(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/ReplaceOnce.cmake")
set(mutant_list "")

function(mutant id file what good bad)
  mutant_text(${id} "${file}" "${what}" "${good}" "(raster_cosim.mutant_q == 16'd${id} ? (${bad}) : (${good}))")
  set(mutant_list "${mutant_list}" PARENT_SCOPE)
  set("text_of_${file}" "${text_of_${file}}" PARENT_SCOPE)
endfunction()

function(mutant_text id file what good text_with_mutant)
  set(text "${text_of_${file}}")
  if(text STREQUAL "")
    message(FATAL_ERROR "mutant ${id}: there is no module ${file}")
  endif()
  replace_once(text "${file}, mutant ${id}," "${good}" "${text_with_mutant}")
  set("text_of_${file}" "${text}" PARENT_SCOPE)
  set(mutant_list "${mutant_list}{${id}, \"${file}\", \"${what}\"},\n" PARENT_SCOPE)
endfunction()

foreach(file IN LISTS FILES)
  file(READ "${SOURCE}/${file}" "text_of_${file}")
endforeach()
include("${MUTANTS}")
foreach(file IN LISTS FILES)
  file(CONFIGURE OUTPUT "${FOLDER}/${file}" CONTENT "${text_of_${file}}" @ONLY)
endforeach()
file(CONFIGURE OUTPUT "${FOLDER}/mutants.inc" CONTENT "${mutant_list}" @ONLY)
