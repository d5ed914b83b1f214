# The Debian package: made, unpacked into a folder, and run from there.

find_program(VMECH_DPKG_SHLIBDEPS dpkg-shlibdeps)
mark_as_advanced(VMECH_DPKG_SHLIBDEPS)
if(VMECH_DPKG_SHLIBDEPS AND NOT VMECH_SANITIZE)
  add_test(NAME package.runs_where_it_is_unpacked
    COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/package_test.py
            ${CMAKE_CPACK_COMMAND} ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR}/mechanisms/examples)
  set_tests_properties(package.runs_where_it_is_unpacked PROPERTIES COST 50)
endif()
