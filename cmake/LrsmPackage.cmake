# What `cmake --install` lays down and `cpack` packs, in two components: `program` (with documentation and licence) and `development` (the modules
# declared INSTALL, their headers, find_package(lrsm)). Nothing of it may name the source or the build folder: tests/package.
include(CMakePackageConfigHelpers)

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lrsm)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/lrsmConfig.cmake.in ${PROJECT_BINARY_DIR}/lrsmConfig.cmake INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lrsmConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lrsmConfig.cmake ${PROJECT_BINARY_DIR}/lrsmConfigVersion.cmake ${PROJECT_SOURCE_DIR}/cmake/LrsmDependencies.cmake
        DESTINATION ${config_folder} COMPONENT development)
install(EXPORT lrsmTargets NAMESPACE lrsm:: DESTINATION ${config_folder} COMPONENT development)

if(TARGET lrsm_program)
  install(TARGETS lrsm_program COMPONENT program)
  install(FILES ${PROJECT_BINARY_DIR}/apps/lrsm.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  install(FILES ${PROJECT_BINARY_DIR}/apps/lrsm.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME lrsm COMPONENT program)
  install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
  install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
  install(FILES docs/licence.md DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)  # where Debian looks
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR lrsm)
set(CPACK_PACKAGE_CONTACT "lrsm maintainers <maintainers@lrsm.invalid>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "The program: renders, path-traces, compares, captures and checks frames lit indirectly by layered\nreflective shadow maps.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME lrsm)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)

set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Static libraries, headers and what CMake's find_package(lrsm) reads.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liblrsm-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "lrsm, libembree-dev, libglm-dev, libtinygltf-dev, libopenimageio-dev, openimageio-tools, libopenexr-dev, libpng-dev, libtbb-dev, libssl-dev, libmeshoptimizer-dev, libwebp-dev, nlohmann-json3-dev")
include(CPack)
