// How accurate the drag on a grain is at a resolution, from the repository's own validations (docs/accuracy.md).
#pragma once

#include "driver/case/case.hpp"

#include <string>

namespace thalweg::driver {

// Relative error of the drag in slow flow without a subgrid model (benchmarks/validation/simple_cubic_arrays, worst of
// the positions' means), linear in between, beyond the ends with the square of the resolution: alone (solid fraction
// 0.027) and among others (0.216). Negative: too small.
struct SlowDrag {
  double alone, among_others;
};
SlowDrag slow_drag_error(double cells_per_diameter, bool cli);

// What a case may expect, in words: of its smallest grains at the Reynolds number of their fall, or of the flow where
// none fall. Empty without grains in a fluid.
std::string drag_text(const Case& c);

}  // namespace thalweg::driver
