// The density beyond an outlet, of which the populations that enter there are the equilibrium, and the speed at which
// fluid enters. Both are the same all over the face. Lattice units.
//
//   d_w = d_0 + (m - m_s)/c_s,      m_s(t+1) = m_s + (m - m_s)/T,      T = 5 L/c_s
//
// d_w and d_0 are the deviations rho - 1 beyond the outlet and asked for, m the mean momentum out of the box of the
// fluid cells at the face, m_s its mean over the last T steps, L the length of the box across the face,
// c_s = 1/sqrt(3). Sound that falls on the face as a whole has dp = rho c_s du and leaves; a fixed pressure would throw
// it back undamped (Engquist and Majda 1977). Flow that changes more slowly leaves at d_0, a steady one at d_0 exactly:
// the face resists only what is fast, and never drives. Eddies do not change m, as what one half of them takes out the
// other takes in.
#pragma once

#include "core/base/archive.hpp"

#include <optional>
#include <string>

namespace thalweg::lbm {

class OutletDensity {
public:
  // asked_for: rho - 1. cells_across: of the box, along the normal of the face.
  OutletDensity(double asked_for, int cells_across);

  double deviation() const;       // d_w of the coming exchange
  double entering_speed() const;  // of fluid that enters, along the inward normal: max(0, -m_s)

  // Takes the mean of rho u along the outward normal over the fluid cells at the face after a step.
  void update(double mean_momentum);

  // Both write and read attributes whose names begin with `path`. A state without them leaves what is here.
  void save(ArchiveWriter& archive, const std::string& path) const;
  void load(ArchiveReader& archive, const std::string& path);

private:
  double asked_for_, memory_;            // d_0, T
  double momentum_ = 0.0;                // m
  std::optional<double> mean_momentum_;  // m_s; none before the first step
};

}  // namespace thalweg::lbm
