#include "change_vectors.hpp"

namespace lodestar {

ChangeKernels avx2_change_kernels() { return change_kernels<xsimd::avx2>(); }

}  // namespace lodestar
