// Error of the drag on a grain at a given resolution, from the validations (docs/accuracy.md).
#pragma once

#include "driver/case/case.hpp"

#include <string>

namespace thalweg::driver {

// Relative error of the drag in slow flow with trt and without a subgrid model, from the arrays of
// benchmarks/validation/simple_cubic_arrays, worst of the positions' means; linear in between, beyond the ends with the
// square of the resolution: alone (solid fraction 0.027) and among others (0.216). Negative: too small.
struct SlowDrag {
  double alone, among_others;
};
SlowDrag slow_drag_error(double cells_per_diameter, bool cli);

// Relative error of the drag on a sphere alone in a stream with the defaults for water, Reynolds numbers 300 to 3000
// (benchmarks/validation/sphere_drag_curve, towed), linear in the logarithms of both, constant beyond the ends of the
// Reynolds numbers and with the square of the resolution beyond those of the cells. Positive: too large.
double stream_drag_error(double cells_per_diameter, double reynolds);

// Expected error of the drag, in words: on the finest free grains at their own settling Reynolds number, or at that of
// the flow if they do not settle; in clear water on the thinnest solid, by a sphere as wide. Empty without either.
std::string drag_text(const Case& c);

}  // namespace thalweg::driver
