#include "change_vectors.hpp"

namespace lodestar {

ChangeKernels avx512_change_kernels() { return change_kernels<xsimd::avx512bw>(); }

}  // namespace lodestar
