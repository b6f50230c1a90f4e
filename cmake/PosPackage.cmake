# The Debian package `pos`, made by scripts/package: the program, its manual page and completions, the browser interface where it
# is built, configurations, maps and the short recordings. The library and its headers are not in it.
install(DIRECTORY configs maps rawlogs DESTINATION ${CMAKE_INSTALL_DATADIR}/pos COMPONENT program)

set(debian ${CMAKE_BINARY_DIR}/debian)
set(POS_DEBIAN_RELEASE 1)
set(CPACK_PACKAGE_CONTACT "The pos authors <pos@example.org>")
string(TIMESTAMP POS_DEBIAN_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(cmake/debian/changelog.in ${debian}/changelog.Debian @ONLY)
configure_file(CHANGELOG.md ${debian}/changelog COPYONLY)
execute_process(COMMAND gzip -9nf ${debian}/changelog.Debian ${debian}/changelog COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${debian}/changelog.Debian.gz ${debian}/changelog.gz cmake/debian/copyright
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME pos)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME pos)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${POS_DEBIAN_RELEASE})
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS mrpt-common)  # the recording of the demo
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "positioning for vehicles under ground")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Replays the logs of wheels, inertial units, radio ranges and laser scans
through several estimators side by side, places the vehicle on a map of the
workings, and says how good each answer is. Simulates, runs campaigns over
many seeds, checks maps of roadways and anchors, and shows runs in a browser.")
include(CPack)
