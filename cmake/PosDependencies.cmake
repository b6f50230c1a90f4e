# Every outside library, by the name of its Debian 12 package (scripts/setup installs the same list).
find_package(Eigen3 3.4 REQUIRED NO_MODULE)                           # libeigen3-dev
include(PosOpenCV)                                                    # libopencv-{core,imgproc,imgcodecs}-dev
find_package(yaml-cpp 0.7 REQUIRED)                                   # libyaml-cpp-dev
include(PosGeographic)                                                # libgeographiclib-dev
find_package(Boost 1.74 REQUIRED)                                     # libboost-dev (headers: Boost.Math)
find_package(nlohmann_json 3.11 REQUIRED)                             # nlohmann-json3-dev
find_package(CLI11 2.1 REQUIRED)                                      # libcli11-dev
find_package(ZLIB REQUIRED)                                           # zlib1g-dev (libmrpt-obs-dev brings it)
include(PosZstd)                                                      # libzstd-dev
find_package(TBB 2021.8 REQUIRED)                                     # libtbb-dev
include(PosHttplib)                                                   # libcpp-httplib-dev
find_package(mrpt-obs 2.5 REQUIRED)                                   # libmrpt-obs-dev
find_package(mrpt-maps 2.5 REQUIRED)                                  # libmrpt-maps-dev
find_package(mrpt-slam 2.5 REQUIRED)                                  # libmrpt-slam-dev
