#include "field_kernels_source.hpp"

namespace pos::lidar::kernel {

const FieldKernels kPortable{addScores};

}  // namespace pos::lidar::kernel
