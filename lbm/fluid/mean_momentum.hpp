// The mean momentum of the fluid cells along one axis, for a controller that looks often. It has the bits of the survey
// (fluid_survey.hpp), but reads ten populations of each cell instead of nineteen and nothing else.
#pragma once

#include "lbm/fluid/fluid.hpp"

namespace thalweg::lbm {

// Mean of sum c_i f_i of the post-collision populations over all fluid cells (lattice units), the same on every rank;
// not a number where that of a cell is not, or is larger than any fluid's, or where there is no fluid. Collective.
template <typename Real>
double mean_momentum(const Fluid<Real>& fluid, int axis);

}  // namespace thalweg::lbm
