# The installed package: find_package(vmech CONFIG) gives the targets vmech::<module>.

include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/vmech)

get_property(VMECH_OPTIONAL_DEPENDENCIES GLOBAL PROPERTY VMECH_OPTIONAL_DEPENDENCIES)
list(JOIN VMECH_OPTIONAL_DEPENDENCIES "\n" VMECH_OPTIONAL_DEPENDENCIES)
configure_package_config_file(cmake/vmech-config.cmake.in ${PROJECT_BINARY_DIR}/vmech-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vmech-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vmech-config.cmake
              ${PROJECT_BINARY_DIR}/vmech-config-version.cmake
        DESTINATION ${package_dir})
install(EXPORT vmech-targets NAMESPACE vmech:: DESTINATION ${package_dir})
