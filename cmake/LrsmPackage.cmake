# What `cmake --install` lays down, in two components: `program` (with documentation and licence) and `development` (the modules
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
  install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
  install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
endif()
