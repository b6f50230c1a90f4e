# Debian's libcpp-httplib-dev has no CMake configuration. Its library was compiled with TLS, and its classes have other sizes
# without: the definition has to be the same here.
find_library(POS_HTTPLIB_LIBRARY cpp-httplib)
find_path(POS_HTTPLIB_INCLUDE httplib.h)
find_path(POS_OPENSSL_INCLUDE openssl/ssl.h)
if(NOT POS_HTTPLIB_LIBRARY OR NOT POS_HTTPLIB_INCLUDE OR NOT POS_OPENSSL_INCLUDE)
  message(FATAL_ERROR "cpp-httplib is missing: install libcpp-httplib-dev (scripts/setup does)")
endif()
find_package(Threads REQUIRED)
add_library(pos_httplib INTERFACE)
target_link_libraries(pos_httplib INTERFACE ${POS_HTTPLIB_LIBRARY} Threads::Threads)
target_compile_definitions(pos_httplib INTERFACE CPPHTTPLIB_OPENSSL_SUPPORT)
