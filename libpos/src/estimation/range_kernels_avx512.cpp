#include "range_kernels_source.hpp"

namespace pos::estimation::kernel {

const RangeKernels kAvx512{evaluated<Exponent::One>, evaluated<Exponent::Given>};

}  // namespace pos::estimation::kernel
