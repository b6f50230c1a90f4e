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
  # The settings with which it also caches what a precompiled header goes into (tests/CMakeLists.txt).
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${POS_CCACHE})
endif()

# Our own targets link this; dependencies come in as SYSTEM and stay quiet.
add_library(pos_warnings INTERFACE)
# -Wno-restrict, -Wno-maybe-uninitialized, -Wno-array-bounds: GCC 12 warns falsely about temporaries of std::string
# (GCC bugs 105651, 105562) and about Eigen's vectorised loops over short vectors; the sanitizer build and clang-tidy
# watch for the real thing.
target_compile_options(pos_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-maybe-uninitialized -Wno-array-bounds>)

# One instrumented tree serves the sanitizer tests, the coverage and the fuzz programs: every file is built once for
# all three. Line tables (-g1) are all that a report of a fault needs. Left out are the checks of every single member
# access (null, alignment, object-size, pointer-overflow, vptr): they cost a third of the compile time, and the address
# sanitizer finds what a wrong address does. The library takes what its speed and the fuzzers need (pos_library_flags), the
# program and the tests are compiled without optimisation, in half the time (pos_other_flags).
add_library(pos_library_flags INTERFACE)
add_library(pos_other_flags INTERFACE)
if(POS_SANITIZE)
  if(POS_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
      message(FATAL_ERROR "POS_FUZZ needs clang (package clang): cmake --preset asan")
    endif()
    target_compile_options(pos_library_flags INTERFACE -fsanitize=fuzzer-no-link)
  endif()
  add_compile_options(-fsanitize=address,undefined -fno-sanitize=null,alignment,object-size,pointer-overflow,vptr
                      -fno-sanitize-recover=undefined -fno-omit-frame-pointer -O1 -g1)
  target_compile_options(pos_other_flags INTERFACE -O0)
  add_link_options(-fsanitize=address,undefined)
endif()
if(POS_COVERAGE)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    set(counters -fprofile-instr-generate -fcoverage-mapping)
    add_compile_options(-fprofile-list=${CMAKE_SOURCE_DIR}/.ci/counted.txt)
  else()
    set(counters --coverage -fprofile-abs-path)
  endif()
  add_compile_options(${counters})
  add_link_options(${counters})
endif()
