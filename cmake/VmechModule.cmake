# Modules: libraries with an include root each, installed as components of the package `vmech`.

# vmech_found_by(<how> <target>...): a program that uses the installed vmech finds these targets of
# a package by the command <how>.
function(vmech_found_by how)
  foreach(library ${ARGN})
    set_property(GLOBAL PROPERTY VMECH_FOUND_BY_${library} "${how}")
  endforeach()
endfunction()

# Installs a module as a component of the package `vmech`: vmech-<name>.cmake finds what the
# libraries of the module ask for, modules and packages, then adds its target.
function(vmech_install_module name target libraries)
  set(finds)
  foreach(library ${libraries})
    get_property(how GLOBAL PROPERTY VMECH_FOUND_BY_${library})
    if(how)
      list(APPEND finds "${how}")
    elseif(library MATCHES "::")
      message(FATAL_ERROR "vmech_add_module: ${target} links to ${library}: say with "
                          "vmech_found_by how an installed vmech finds it")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES finds)
  list(JOIN finds "\n" finds)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/vmech-module.cmake.in
                 ${PROJECT_BINARY_DIR}/package/vmech-${name}.cmake @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/package/vmech-${name}.cmake DESTINATION ${VMECH_PACKAGE_DIR})
  install(TARGETS ${target} EXPORT vmech-${name})
  install(EXPORT vmech-${name} NAMESPACE vmech:: FILE vmech-${name}-targets.cmake
          DESTINATION ${VMECH_PACKAGE_DIR})
  vmech_found_by("include(\${CMAKE_CURRENT_LIST_DIR}/vmech-${name}.cmake)" vmech::${name})
  set_property(GLOBAL APPEND PROPERTY VMECH_MODULES ${name})
endfunction()

# vmech_add_module(<path> [LOCAL] COMPONENTS ... [INTERNAL ...] [SOURCES ...] [PUBLIC ...]
#                  [PRIVATE ...])
#
# One folder, one library: the module `dynamics/bearings` becomes vmech_dynamics_bearings (alias
# vmech::dynamics_bearings). A component `loads/load_study` is a header, a source or both, in the
# module's folder or a folder below. Its header is included as
# "vmech/<path>/loads/load_study.h", in this tree and from an installation; "vmech/<path>.h"
# includes all that are installed. Each module has an include root of its own, made of forwarding
# headers: a module can include only what it links to.
# INTERNAL components have headers that are not installed: what is passed in them depends on the
# instruction set that the library is compiled for. SOURCES are those that belong to no component.
# Nothing of a LOCAL module is installed: it is part of a program.
function(vmech_add_module path)
  cmake_parse_arguments(ARG "LOCAL" "" "COMPONENTS;INTERNAL;SOURCES;PUBLIC;PRIVATE" ${ARGN})
  string(REPLACE "/" "_" name ${path})
  set(target vmech_${name})
  set(include_root ${PROJECT_BINARY_DIR}/include/${name})

  set(sources ${ARG_SOURCES})
  set(installed)
  foreach(component ${ARG_COMPONENTS} ${ARG_INTERNAL})
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${component}.cc)
      list(APPEND sources ${component}.cc)
    elseif(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${component}.h)
      message(FATAL_ERROR "vmech_add_module(${path}): no ${component}.h and no ${component}.cc")
    endif()
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${component}.h)
      file(CONFIGURE OUTPUT ${include_root}/vmech/${path}/${component}.h @ONLY
           CONTENT "#include \"${CMAKE_CURRENT_SOURCE_DIR}/${component}.h\"\n")
      if(NOT ARG_LOCAL AND NOT component IN_LIST ARG_INTERNAL)
        get_filename_component(folder vmech/${path}/${component} DIRECTORY)
        install(FILES ${component}.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
        list(APPEND installed "#include \"vmech/${path}/${component}.h\"\n")
        set_property(GLOBAL APPEND PROPERTY VMECH_PUBLIC_HEADERS
                     ${CMAKE_CURRENT_SOURCE_DIR}/${component}.h)
      endif()
    endif()
  endforeach()

  list(SORT installed)
  list(JOIN installed "" includes)
  set(umbrella ${include_root}/vmech/${path}.h)
  file(CONFIGURE OUTPUT ${umbrella} CONTENT "#pragma once\n\n${includes}" @ONLY)

  if(sources)
    add_library(${target} ${sources})
    set_target_properties(${target} PROPERTIES VERSION ${PROJECT_VERSION}
                          SOVERSION ${PROJECT_VERSION_MAJOR}
                          INSTALL_RPATH "$ORIGIN;$ORIGIN/vmech")
    target_link_libraries(${target} PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:vmech_settings>
                                            $<BUILD_INTERFACE:vmech_kernel_settings>)
    vmech_precompile(${target} library)
    set(scope PUBLIC)
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(vmech::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${include_root}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} ${scope} cxx_std_20)
  target_compile_definitions(${target} ${scope} EIGEN_MAX_ALIGN_BYTES=64
                             EIGEN_MAX_STATIC_ALIGN_BYTES=16)
  target_link_libraries(${target} ${scope} ${ARG_PUBLIC})
  if(NOT ARG_LOCAL)
    get_filename_component(folder vmech/${path} DIRECTORY)
    install(FILES ${umbrella} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder})
    vmech_install_module(${name} ${target} "${ARG_PUBLIC};${ARG_PRIVATE}")
  endif()
endfunction()

# vmech_add_late_library(<name> SOURCES ... LIBS ...)
#
# libvmech_<name>.so, which a program loads when it asks for it (base/late_library.h): what few runs
# need and what takes long to load. It is found in `vmech_late_libraries` of this build and in the
# folder vmech beside the installed libraries. Headers among the SOURCES are included by their path
# from the top, "vmech/solvers/packages/ceres_rows.h".
set(vmech_late_libraries ${PROJECT_BINARY_DIR}/late)
set(vmech_installed_late_libraries ${CMAKE_INSTALL_LIBDIR}/vmech)
set(CMAKE_BUILD_RPATH ${vmech_late_libraries})

function(vmech_add_late_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  set(target vmech_${name})
  set(include_root ${PROJECT_BINARY_DIR}/include/late_${name})
  add_library(${target} MODULE ${ARG_SOURCES})
  foreach(header ${ARG_SOURCES})
    if(header MATCHES "[.]h$")
      file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${header})
      file(CONFIGURE OUTPUT ${include_root}/vmech/${path} @ONLY
           CONTENT "#include \"${CMAKE_CURRENT_SOURCE_DIR}/${header}\"\n")
    endif()
  endforeach()
  target_include_directories(${target} PRIVATE ${include_root})
  # A program may hold another version of a package under the same names, as one with Simbody does
  # of SUNDIALS: a static library, of which nothing is seen from outside, stays what was linked.
  foreach(library ${ARG_LIBS})
    if(TARGET ${library}_static)
      list(TRANSFORM ARG_LIBS REPLACE "^${library}$" "${library}_static")
    endif()
  endforeach()
  target_link_libraries(${target} PRIVATE ${ARG_LIBS} vmech_settings vmech_kernel_settings)
  # What it shares with the program, if that is linked statically, each has for itself.
  target_link_options(${target} PRIVATE LINKER:--exclude-libs,ALL)
  set_target_properties(${target} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${vmech_late_libraries}
                        INSTALL_RPATH "$ORIGIN/..")
  install(TARGETS ${target} LIBRARY DESTINATION ${vmech_installed_late_libraries})
endfunction()
