#include "field_kernels_source.hpp"

namespace pos::lidar::kernel {

const FieldKernels kAvx2{addScores};

}  // namespace pos::lidar::kernel
