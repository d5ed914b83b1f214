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
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/vmech RENAME copyright)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vmech)
set(CPACK_PACKAGE_VENDOR vmech)
set(CPACK_PACKAGE_CONTACT "vmech")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGE_FILE_NAME vmech_${PROJECT_VERSION}_${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# The shared libraries that the programs load, as packages: found by dpkg-shlibdeps. What a program
# compiled against vmech needs beside is what packages.txt lists.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
include(CPack)
