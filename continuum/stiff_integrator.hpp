// Stiff systems of ordinary differential equations over one interval of time: backward differentiation of variable step
// and order (at most 2) with a banded Jacobian, by CVODE of SUNDIALS (Hindmarsh et al. 2005).
//
// Every interval begins anew, without a memory of the one before: the result depends on the unknowns at its beginning
// alone, so that a restart gives the same bits.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace thalweg::continuum {

// Tolerance of one unknown y: an error of relative |y| + absolute has the weight 1.
struct Tolerance {
  double relative = 0.0;
  double absolute = 0.0;  // in its unit
};

class StiffIntegrator {
public:
  using Rates = std::function<void(std::span<const double> unknowns, std::span<double> rates)>;

  // tolerances: one an unknown. half_bandwidth: the rate of unknown i depends on unknowns i - half_bandwidth to i +
  // half_bandwidth.
  StiffIntegrator(int half_bandwidth, std::vector<Tolerance> tolerances, Rates rates);
  ~StiffIntegrator();
  StiffIntegrator(const StiffIntegrator&) = delete;
  StiffIntegrator& operator=(const StiffIntegrator&) = delete;

  // Carries the unknowns on by `duration` (s). Throws RunError where the integrator gets no further.
  void advance(std::span<double> unknowns, double duration);

  std::int64_t steps() const { return steps_; }  // steps of all intervals so far

private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
  std::int64_t steps_ = 0;
};

}  // namespace thalweg::continuum
