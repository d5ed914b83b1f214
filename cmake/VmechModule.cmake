# vmech_add_module(<path> [LOCAL] [SOURCES ...] HEADERS ... [INTERNAL ...] [PUBLIC ...]
#                  [PRIVATE ...])
#
# One folder, one target. The module `dynamics/bearings` becomes the library vmech_dynamics_bearings
# (alias vmech::dynamics_bearings) whose headers are included as "vmech/dynamics/bearings/<file>.h",
# in this tree and from an installation. Each module has an include root of its own, made of
# forwarding headers: a module can include only what it links to. INTERNAL headers are not
# installed: what is passed in them depends on the instruction set that the library is compiled for.
# Nothing of a LOCAL module is installed: it is part of a program.

function(vmech_add_module path)
  cmake_parse_arguments(ARG "LOCAL" "" "SOURCES;HEADERS;INTERNAL;PUBLIC;PRIVATE" ${ARGN})
  string(REPLACE "/" "_" name ${path})
  set(target vmech_${name})
  set(include_root ${PROJECT_BINARY_DIR}/include/${name})

  if(ARG_SOURCES)
    add_library(${target} ${ARG_SOURCES} ${ARG_HEADERS} ${ARG_INTERNAL})
    set_target_properties(${target} PROPERTIES VERSION ${PROJECT_VERSION}
                          SOVERSION ${PROJECT_VERSION_MAJOR})
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

  foreach(header ${ARG_HEADERS} ${ARG_INTERNAL})
    set(forward ${include_root}/vmech/${path}/${header})
    file(CONFIGURE OUTPUT ${forward} @ONLY
         CONTENT "#include \"${CMAKE_CURRENT_SOURCE_DIR}/${header}\"\n")
  endforeach()
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${include_root}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} ${scope} cxx_std_20)
  target_compile_definitions(${target} ${scope} EIGEN_MAX_ALIGN_BYTES=64
                             EIGEN_MAX_STATIC_ALIGN_BYTES=16)
  target_link_libraries(${target} ${scope} ${ARG_PUBLIC})
  if(NOT ARG_LOCAL)
    install(FILES ${ARG_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vmech/${path})
    install(TARGETS ${target} EXPORT vmech-targets)
  endif()
endfunction()
