#pragma once

#include <cstdint>

namespace lodestar {

/// How well what was measured fitted what was expected: the squared distance (NIS) of the used measurements over their
/// degrees of freedom, 1 for a filter that is right about everything. Less where errors repeat from sample to sample:
/// then the state has them already.
struct InnovationMeans {
  struct Mean {
    double sum = 0;
    std::uint64_t dof = 0;
    void add(double distance2, int degrees) {
      sum += distance2;
      dof += static_cast<std::uint64_t>(degrees);
    }
    double mean() const { return dof > 0 ? sum / static_cast<double>(dof) : 0.0; }
  };
  Mean bearings, fixes, wheels;

  void add(const InnovationMeans& other) {
    for (Mean InnovationMeans::*m : {&InnovationMeans::bearings, &InnovationMeans::fixes, &InnovationMeans::wheels}) {
      (this->*m).sum += (other.*m).sum;
      (this->*m).dof += (other.*m).dof;
    }
  }
};

}  // namespace lodestar
