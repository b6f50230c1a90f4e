# zstd as the target pos_zstd. Debian's package ships no CMake config, so it is found by name.
if(NOT TARGET pos_zstd)
  find_library(POS_ZSTD_LIBRARY zstd REQUIRED)
  add_library(pos_zstd INTERFACE IMPORTED)
  target_link_libraries(pos_zstd INTERFACE ${POS_ZSTD_LIBRARY})
endif()
