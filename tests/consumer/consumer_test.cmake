# Two tests: install vmech into the build folder, then build and run the project beside this file
# with find_package(vmech). It gets no include path and no target from this build.

set(prefix ${CMAKE_CURRENT_BINARY_DIR}/consumer/prefix)
set(consumer_flags "")
if(VMECH_SANITIZE)
  set(consumer_flags -fsanitize=${VMECH_SANITIZE})
endif()

add_test(NAME consumer.install
  COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --prefix ${prefix})
set_tests_properties(consumer.install PROPERTIES FIXTURES_SETUP vmech_installation)

add_test(NAME consumer.finds_the_installed_package
  COMMAND ${CMAKE_CTEST_COMMAND}
    --build-and-test ${CMAKE_CURRENT_LIST_DIR} ${CMAKE_CURRENT_BINARY_DIR}/consumer/build
    --build-generator ${CMAKE_GENERATOR}
    --build-options -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
                    -DCMAKE_CXX_FLAGS=${consumer_flags} -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
    --test-command consumer)
set_tests_properties(consumer.finds_the_installed_package PROPERTIES
  FIXTURES_REQUIRED vmech_installation)
