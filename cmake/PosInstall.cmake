# Installed tree: bin/pos, lib/libpos_*.a, include/pos, lib/cmake/pos (find_package(pos) gives pos::<module>).
include(CMakePackageConfigHelpers)
get_property(modules GLOBAL PROPERTY POS_MODULES)
set(POS_COMPONENTS ${modules})
list(TRANSFORM POS_COMPONENTS REPLACE "^pos_" "")
install(TARGETS ${modules} EXPORT posTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY libpos/include/pos DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT posTargets NAMESPACE pos:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pos)
configure_package_config_file(cmake/posConfig.cmake.in ${CMAKE_BINARY_DIR}/posConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pos)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/posConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/PosOpenCV.cmake cmake/PosGeographic.cmake cmake/PosZstd.cmake ${CMAKE_BINARY_DIR}/posConfig.cmake
  ${CMAKE_BINARY_DIR}/posConfigVersion.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/pos)
