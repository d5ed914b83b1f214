# vmech_add_module(<path> SOURCES ... HEADERS ... [PUBLIC ...] [PRIVATE ...])
#
# One folder, one target. The module `dynamics/bearings` becomes the library vmech_dynamics_bearings
# (alias vmech::dynamics_bearings) whose headers are included as "vmech/dynamics/bearings/<file>.h",
# in this tree and from an installation. Each module has an include root of its own, made of
# forwarding headers: a module can include only what it links to.

function(vmech_add_module path)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  string(REPLACE "/" "_" name ${path})
  set(target vmech_${name})
  set(include_root ${PROJECT_BINARY_DIR}/include/${name})

  add_library(${target} ${ARG_SOURCES} ${ARG_HEADERS})
  add_library(vmech::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR})

  foreach(header ${ARG_HEADERS})
    set(forward ${include_root}/vmech/${path}/${header})
    file(CONFIGURE OUTPUT ${forward} @ONLY
         CONTENT "#include \"${CMAKE_CURRENT_SOURCE_DIR}/${header}\"\n")
    install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vmech/${path})
  endforeach()

  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${include_root}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_definitions(${target} PUBLIC EIGEN_MAX_ALIGN_BYTES=64
                             EIGEN_MAX_STATIC_ALIGN_BYTES=16)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC}
    PRIVATE ${ARG_PRIVATE}
            $<BUILD_INTERFACE:vmech_settings> $<BUILD_INTERFACE:vmech_kernel_settings>)
  install(TARGETS ${target} EXPORT vmech-targets)
endfunction()
