# Rules for cmake --install, in two components: `program` is the content of the packages (scripts/package);
# `development` has the headers, the libraries and the files for find_package(rigcal).
include(CMakePackageConfigHelpers)
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/rigcal)

install(CODE "set(ROOT [==[${PROJECT_SOURCE_DIR}]==])\nset(INCLUDEDIR [==[${CMAKE_INSTALL_INCLUDEDIR}]==])" COMPONENT development)
install(SCRIPT cmake/install_headers.cmake COMPONENT development)
install(EXPORT rigcal NAMESPACE rigcal:: FILE rigcalTargets.cmake DESTINATION ${config} COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/rigcalConfig.cmake.in
  ${PROJECT_BINARY_DIR}/rigcalConfig.cmake INSTALL_DESTINATION ${config})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/rigcalConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/rigcalConfig.cmake ${PROJECT_BINARY_DIR}/rigcalConfigVersion.cmake
  DESTINATION ${config} COMPONENT development)

install(DIRECTORY datasets/rigs docs/schema DESTINATION ${CMAKE_INSTALL_DATADIR}/rigcal COMPONENT program
  FILES_MATCHING PATTERN *.toml PATTERN *.json)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
set(notices ${PROJECT_BINARY_DIR}/NOTICE ${PROJECT_BINARY_DIR}/copyright)
add_custom_command(OUTPUT ${notices}
  COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DNOTICE=${PROJECT_BINARY_DIR}/NOTICE
    -DCOPYRIGHT=${PROJECT_BINARY_DIR}/copyright -P ${PROJECT_SOURCE_DIR}/cmake/notice.cmake
  DEPENDS cmake/notice.cmake cmake/parts.txt LICENSE)
add_custom_target(rigcal_notice ALL DEPENDS ${notices})
install(FILES ${notices} DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

# The .deb contains the program without the libraries that it is linked from.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME rigcal)
set(CPACK_PACKAGE_CONTACT "rigcal maintainers <rigcal@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "calibrates models of servo-hydraulic rigs from recorded runs")
set(CPACK_PACKAGE_DESCRIPTION "Model parameters with intervals, a statement of how far they can be trusted,
and a validation report, from repeated records of a rig. Works offline, from one campaign file.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
include(CPack)
