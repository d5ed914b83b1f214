# cmake -D SOURCE=... -D TEMPLATE=... -D OUTPUT=... -P write_commit.cmake: puts the commit of the
# folder SOURCE into TEMPLATE. OUTPUT is written only if it changes, so that nothing is compiled
# anew until there is another commit.

set(VMECH_COMMIT "unknown: not compiled from a clone")
find_program(GIT git)
if(GIT)
  # A copy of the project inside another's repository does not have that one's commit.
  set(ENV{GIT_OPTIONAL_LOCKS} 0)
  execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse --show-prefix --short=12 HEAD
                  OUTPUT_VARIABLE place_and_commit RESULT_VARIABLE failed ERROR_QUIET)
  if(NOT failed AND place_and_commit MATCHES "^\n([0-9a-f]+)\n$")
    set(VMECH_COMMIT ${CMAKE_MATCH_1})
    execute_process(COMMAND ${GIT} -C ${SOURCE} diff --quiet HEAD RESULT_VARIABLE changed)
    if(changed)
      string(APPEND VMECH_COMMIT " and changes to it")
    endif()
  endif()
endif()
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)
