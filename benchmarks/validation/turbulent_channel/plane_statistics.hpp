// Means over planes parallel to the plates of a channel (normal z), and over time.
#pragma once

#include "core/base/archive.hpp"
#include "core/parallel/decomposition.hpp"
#include "lbm/fluid/fluid.hpp"

#include <string>
#include <vector>

namespace thalweg::benchmark {

// Means over one plane after another: u, v, w, uu, vv, ww, uw; lattice units.
using PlaneSums = std::vector<std::array<double, 7>>;

// The same on every rank whatever their number. Collective.
template <typename Real>
PlaneSums plane_sums(const lbm::Fluid<Real>& fluid, MPI_Comm communicator, const Decomposition& decomposition);

struct PlaneMeans {
  std::vector<double> velocity, uu, vv, ww, uw;  // mean of u; variances; covariance of u and w
};

class PlaneStatistics {
public:
  explicit PlaneStatistics(int planes) : sums_(planes) { clear(); }

  void add(const PlaneSums& sums);
  void clear();
  std::int64_t samples() const { return samples_; }
  PlaneMeans means() const;

  void save(ArchiveWriter& archive, MPI_Comm communicator) const;
  void load(ArchiveReader& archive);

private:
  PlaneSums sums_;
  std::int64_t samples_ = 0;
};

// Both halves of the channel averaged: y+, U+, rms of u, v (across the flow), w (normal) and -uw+, viscous stress +.
void write_profile(const std::string& file, const PlaneMeans& means, double viscosity, double friction_velocity);

}  // namespace thalweg::benchmark
