#include "change_vectors.hpp"

namespace lodestar {

ChangeKernels base_change_kernels() { return change_kernels<xsimd::default_arch>(); }

}  // namespace lodestar
