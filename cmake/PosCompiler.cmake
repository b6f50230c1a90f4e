# Language, warnings and instrumentation, shared by everything that is ours.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(POS_CCACHE ccache)
if(POS_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${POS_CCACHE})
endif()

# Our own targets link this; dependencies come in as SYSTEM and stay quiet.
add_library(pos_warnings INTERFACE)
# -Wno-restrict, -Wno-maybe-uninitialized, -Wno-array-bounds: GCC 12 warns falsely about temporaries of std::string
# (GCC bugs 105651, 105562) and about Eigen's vectorised loops over short vectors; the sanitizer build and clang-tidy
# watch for the real thing.
target_compile_options(pos_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-maybe-uninitialized -Wno-array-bounds>)

if(POS_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer -O1)
  add_link_options(-fsanitize=address,undefined)
endif()
if(POS_COVERAGE)
  add_compile_options(--coverage -fprofile-abs-path)
  add_link_options(--coverage)
endif()
if(POS_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "POS_FUZZ needs clang (package clang): cmake --preset fuzz")
  endif()
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -O1 -g)
  add_link_options(-fsanitize=address,undefined)
endif()
