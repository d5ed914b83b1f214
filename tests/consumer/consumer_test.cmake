# Installs vmech into the build folder, then builds and runs the project beside this file with
# find_package(vmech) and flags of its own: it gets no include path and no target from this build.
# What it prints of the layout of every public class must be the same for all flags.

set(consumer ${CMAKE_CURRENT_BINARY_DIR}/consumer)
set(consumer_flags "")
if(VMECH_SANITIZE)
  set(consumer_flags -fsanitize=${VMECH_SANITIZE})
endif()

add_test(NAME consumer.install
  COMMAND sh -c "rm -rf ${consumer} && ${CMAKE_COMMAND} --install . --prefix ${consumer}/prefix"
  WORKING_DIRECTORY ${PROJECT_BINARY_DIR})
set_tests_properties(consumer.install PROPERTIES FIXTURES_SETUP vmech_installation)

get_target_property(packages vmech_solver_packages MANUALLY_ADDED_DEPENDENCIES)
list(JOIN packages " " packages)

set(run "./consumer ${packages} && ./every_class > layout.txt")

function(vmech_add_consumer name)
  list(JOIN ARGN " " flags)
  add_test(NAME consumer.${name}
    COMMAND ${CMAKE_CTEST_COMMAND}
      --build-and-test ${CMAKE_CURRENT_LIST_DIR} ${consumer}/${name}
      --build-generator ${CMAKE_GENERATOR}
      --build-options -DCMAKE_PREFIX_PATH=${consumer}/prefix
                      -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
                      "-DCMAKE_CXX_FLAGS=${flags} ${consumer_flags}"
                      -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
      --test-command sh -c
        "${run} && cmp layout.txt ../plain/layout.txt")
  set_tests_properties(consumer.${name} PROPERTIES FIXTURES_REQUIRED vmech_installation)
endfunction()

vmech_add_consumer(plain -O2)
vmech_add_consumer(avx2 -O2 -march=x86-64-v3)
vmech_add_consumer(native -O2 -march=native)
# The sanitizer's dlopen looks where the sanitizer's own library says, but for the older RPATH.
vmech_add_consumer(address_sanitizer -O1 -g1 -fsanitize=address -Wl,--disable-new-dtags)
set_tests_properties(consumer.plain PROPERTIES FIXTURES_SETUP layout_of_plain)
foreach(name avx2 native address_sanitizer)
  set_tests_properties(consumer.${name} PROPERTIES
    FIXTURES_REQUIRED "vmech_installation;layout_of_plain")
endforeach()

# The installed command finds what it loads when it is asked for it, and says so if that is gone.
add_test(NAME consumer.command_loads_solvers_late
  COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/tests/apps/late_libraries_test.py
          ${consumer}/prefix/bin/vmech ${PROJECT_SOURCE_DIR}/mechanisms/examples
          ${consumer}/prefix/${vmech_installed_late_libraries} --installed)
set_tests_properties(consumer.command_loads_solvers_late PROPERTIES
  FIXTURES_REQUIRED vmech_installation)

# A program with other settings of Eigen is told so.
add_test(NAME consumer.refuses_other_settings_of_eigen
  COMMAND ${CMAKE_CXX_COMPILER} -std=c++20 -fsyntax-only -I${consumer}/prefix/include
          -isystem $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>
          ${CMAKE_CURRENT_LIST_DIR}/consumer.cc)
set_tests_properties(consumer.refuses_other_settings_of_eigen PROPERTIES
  FIXTURES_REQUIRED vmech_installation
  PASS_REGULAR_EXPRESSION "must be what vmech was compiled with")
