# The installed package: find_package(vmech CONFIG [COMPONENTS <module>...]) gives the targets
# vmech::<module>, and asks for the packages only that these link to. `cpack` packs it for Debian.

include(CMakePackageConfigHelpers)
get_property(VMECH_MODULES GLOBAL PROPERTY VMECH_MODULES)
configure_package_config_file(cmake/vmech-config.cmake.in
                              ${PROJECT_BINARY_DIR}/package/vmech-config.cmake
                              INSTALL_DESTINATION ${VMECH_PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/vmech-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/vmech-config.cmake
              ${PROJECT_BINARY_DIR}/package/vmech-config-version.cmake
        DESTINATION ${VMECH_PACKAGE_DIR})
