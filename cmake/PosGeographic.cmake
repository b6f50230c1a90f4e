# GeographicLib as the target pos_geographic. Debian's package ships no CMake config, so it is found by name.
if(NOT TARGET pos_geographic)
  find_library(POS_GEOGRAPHIC_LIBRARY GeographicLib REQUIRED)
  add_library(pos_geographic INTERFACE IMPORTED)
  target_link_libraries(pos_geographic INTERFACE ${POS_GEOGRAPHIC_LIBRARY})
endif()
set(POS_GEOGRAPHIC pos_geographic)
