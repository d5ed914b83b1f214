# Sources that are compiled together: a batch is one source that includes several of its target, so
# that the headers are read, and the templates instantiated, once for all. It makes a first build
# faster and a later one slower, and is left out for what the compiler inlines across sources: the
# kernels, whose instructions are counted, are compiled one by one.

option(VMECH_BATCHES "compile several sources as one; makes a first build faster" OFF)
if(VMECH_BATCHES)
  find_program(VMECH_PYTHON3 python3 REQUIRED)
  mark_as_advanced(VMECH_PYTHON3)
  # The interpreter itself: what finds it by a script of the shell costs half a second each time.
  execute_process(COMMAND ${VMECH_PYTHON3} -c "import sys; print(sys.executable, end='')"
                  OUTPUT_VARIABLE vmech_python3 COMMAND_ERROR_IS_FATAL ANY)
endif()

# vmech_batch(<target> <size> [ONLY <regex>] [EXCEPT <regex>]): compiles the sources of the
# target, or those whose path matches or does not, in batches of at most <size>.
function(vmech_batch target size)
  if(NOT VMECH_BATCHES)
    return()
  endif()
  cmake_parse_arguments(ARG "" "ONLY;EXCEPT" "" ${ARGN})
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "[.]cc$")
  if(ARG_ONLY)
    list(FILTER sources INCLUDE REGEX "${ARG_ONLY}")
  endif()
  if(ARG_EXCEPT)
    list(FILTER sources EXCLUDE REGEX "${ARG_EXCEPT}")
  endif()
  set(script ${PROJECT_SOURCE_DIR}/cmake/batches.py)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${script})
  execute_process(COMMAND ${vmech_python3} -B ${script} ${size} ${sources}
                  WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
                  OUTPUT_VARIABLE lines OUTPUT_STRIP_TRAILING_WHITESPACE
                  COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\n" ";" lines "${lines}")
  foreach(line ${lines})
    string(REGEX MATCH "^([0-9]+) (.*)$" line "${line}")
    set_source_files_properties(${CMAKE_MATCH_2} PROPERTIES UNITY_GROUP batch_${CMAKE_MATCH_1})
  endforeach()
  set(launcher ${vmech_python3} -B ${PROJECT_SOURCE_DIR}/cmake/compile_batch.py
               ${CMAKE_CXX_COMPILER_LAUNCHER})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP
                        CXX_COMPILER_LAUNCHER "${launcher}")
endfunction()
