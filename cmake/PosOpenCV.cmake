# OpenCV's few modules that we use. Debian ships OpenCVConfig.cmake only with the whole of libopencv-dev (several
# hundred packages), so the libraries are found by name.
find_path(POS_OPENCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
foreach(module core imgproc imgcodecs)
  if(NOT TARGET pos_opencv_${module})
    find_library(POS_OPENCV_${module} opencv_${module} REQUIRED)
    add_library(pos_opencv_${module} INTERFACE IMPORTED)
    target_include_directories(pos_opencv_${module} SYSTEM INTERFACE ${POS_OPENCV_INCLUDE})
    target_link_libraries(pos_opencv_${module} INTERFACE ${POS_OPENCV_${module}})
  endif()
endforeach()
