# SPDX-License-Identifier: Apache-2.0
# The install tree: public headers under include/limn, the floors as limn::far_ext, limn::eval,
# limn::engine, and the command line as limn::cli.
include(CMakePackageConfigHelpers)

install(TARGETS limn_far_ext limn_eval limn_evaluators limn_engine limn_cli EXPORT limnTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/limn)
install(TARGETS limn RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS limn_images LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/limn)
install(FILES ${PROJECT_BINARY_DIR}/generated/engine/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/limn)
install(EXPORT limnTargets NAMESPACE limn:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/limn)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/limnConfig.cmake.in ${PROJECT_BINARY_DIR}/limnConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/limn)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/limnConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/limnConfig.cmake ${PROJECT_BINARY_DIR}/limnConfigVersion.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindOpenSubdiv.cmake ${PROJECT_SOURCE_DIR}/cmake/FindLibDeflate.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindMETIS.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/limn)
