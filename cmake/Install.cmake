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

# What people look for: manual page, completion for shells, licence and docs.
set(limn_words ${PROJECT_BINARY_DIR}/words)
install(FILES ${limn_words}/limn.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${limn_words}/limn.bash RENAME limn
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${limn_words}/limn.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
# Debian's zsh looks for what packages bring in another folder than for what users install.
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    install(FILES ${limn_words}/_limn DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
else()
    install(FILES ${limn_words}/_limn DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md
    ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
