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
set_tests_properties(consumer.install PROPERTIES FIXTURES_SETUP vmech_installation COST 110)

get_target_property(packages vmech_solver_packages MANUALLY_ADDED_DEPENDENCIES)
list(JOIN packages " " packages)

# vmech_add_consumer(<name> <project> <flags> <command> [<option>...]): builds a project and runs a
# command.
function(vmech_add_consumer name project flags command)
  add_test(NAME consumer.${name}
    COMMAND ${CMAKE_CTEST_COMMAND}
      --build-and-test ${project} ${consumer}/${name}
      --build-generator ${CMAKE_GENERATOR}
      --build-options -DCMAKE_PREFIX_PATH=${consumer}/prefix
                      -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
                      "-DCMAKE_CXX_FLAGS=${flags} ${consumer_flags}"
                      -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF ${ARGN}
      --test-command sh -c "${command}")
  set_tests_properties(consumer.${name} PROPERTIES FIXTURES_REQUIRED vmech_installation)
endfunction()

vmech_add_consumer(component ${CMAKE_CURRENT_LIST_DIR}/component -O2 ./pendulum)
set(same_layout "./every_class > layout.txt && cmp layout.txt ../plain/layout.txt")
set(study ${PROJECT_SOURCE_DIR}/mechanisms/examples/four-bar-study.yaml)
set(run "./consumer ${study} ${packages} && ${same_layout}")
vmech_add_consumer(plain ${CMAKE_CURRENT_LIST_DIR} -O2 "${run}")
# Where nothing is inlined, the linker takes one of the two versions of every function of a header.
vmech_add_consumer(native ${CMAKE_CURRENT_LIST_DIR} "-O0 -march=native" "${run}")
# The sanitizer's dlopen looks where the sanitizer's own library says, but for the older RPATH.
vmech_add_consumer(address_sanitizer ${CMAKE_CURRENT_LIST_DIR}
                   "-O1 -g1 -fsanitize=address -Wl,--disable-new-dtags" "${run}")
set_tests_properties(consumer.plain PROPERTIES FIXTURES_SETUP layout_of_plain COST 100)
foreach(name native address_sanitizer)
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

# The driver of docs/device-plugin.md, as its author compiles it, moves under the installed command.
set(device ${consumer}/device.so)
add_test(NAME consumer.device_plugin
  COMMAND sh -c "${CMAKE_C_COMPILER} -std=c11 -Wall -Werror -shared -fPIC \
-I${consumer}/prefix/include ${PROJECT_BINARY_DIR}/tests/hw_interface/guide_device.c \
-o ${device} -lm && ${consumer}/prefix/bin/vmech device plugin:${device} --free")
set_tests_properties(consumer.device_plugin PROPERTIES FIXTURES_REQUIRED vmech_installation)

# A program with other settings of Eigen is told so.
add_test(NAME consumer.refuses_other_settings_of_eigen
  COMMAND ${CMAKE_CXX_COMPILER} -std=c++20 -fsyntax-only -I${consumer}/prefix/include
          -isystem $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>
          ${CMAKE_CURRENT_LIST_DIR}/consumer.cc)
set_tests_properties(consumer.refuses_other_settings_of_eigen PROPERTIES
  FIXTURES_REQUIRED vmech_installation
  PASS_REGULAR_EXPRESSION "must be what vmech was compiled with")

# The program of docs/c.md, found by CMake and by pkg-config.
if(VMECH_BUILD_C AND NOT VMECH_SANITIZE)
  set(program ${PROJECT_SOURCE_DIR}/tests/bindings/c/four_bar_loads.c)
  set(study ${PROJECT_SOURCE_DIR}/mechanisms/examples/four-bar-study.yaml)
  set(libraries ${consumer}/prefix/${CMAKE_INSTALL_LIBDIR})
  vmech_add_consumer(c ${CMAKE_CURRENT_LIST_DIR}/c "" "./loads ${study}" -DPROGRAM=${program})
  add_test(NAME consumer.c_by_pkg_config
    COMMAND sh -c "${CMAKE_C_COMPILER} -std=c99 ${program} -o ${consumer}/loads \
$(pkg-config --cflags --libs vmech_c) && ${consumer}/loads ${study}")
  set_tests_properties(consumer.c_by_pkg_config PROPERTIES
    FIXTURES_REQUIRED vmech_installation
    ENVIRONMENT "PKG_CONFIG_PATH=${libraries}/pkgconfig;LD_LIBRARY_PATH=${libraries}")
endif()
