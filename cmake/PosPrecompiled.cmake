# Precompiled headers: what nearly every file of a kind includes, compiled once. Files still include what they use, which
# clang-tidy checks without precompiled headers (.ci/tidy).

# What a source needs behind one: -fpch-preprocess and -fno-pch-timestamp are for ccache; GCC's bug 105651
# (PosCompiler.cmake) shows again.
add_library(pos_precompiled INTERFACE)
target_compile_options(pos_precompiled INTERFACE
  $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess -Wno-stringop-overflow -Wno-stringop-overread> $<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>)

# pos_precompiled_holder(<target> <library or executable> <folder> <libraries>...): compiles <folder>/precompiled.hpp in a
# target of its own. Users take it with pos_use_precompiled; they must be of the same kind, so that their flags agree.
function(pos_precompiled_holder target kind folder)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "int main() {}\n")
  if(kind STREQUAL "library")
    file(CONFIGURE OUTPUT ${source} CONTENT "")
    add_library(${target} OBJECT ${source})
  else()
    add_executable(${target} ${source})
  endif()
  target_link_libraries(${target} PRIVATE pos_precompiled pos_warnings ${ARGN})
  target_precompile_headers(${target} PRIVATE ${folder}/precompiled.hpp)
endfunction()

function(pos_use_precompiled target holder)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:pos_precompiled>)
  target_precompile_headers(${target} REUSE_FROM ${holder})
endfunction()
