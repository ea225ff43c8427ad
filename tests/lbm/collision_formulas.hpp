// The formulas of a collision as they stand in the literature, term by term, with no short cut, for the tests of the
// collision; and cells to try them on.
#pragma once

#include "lbm/collision/collision_parameters.hpp"
#include "lbm/lattice/d3q19.hpp"
#include "lbm/lattice/equilibrium.hpp"

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <random>

namespace thalweg::lbm {

struct Sums {
  double density = 0.0;
  Vec3 momentum = Vec3::Zero();
};

inline Sums sums_of(const double (&f)[19]) {
  Sums m;
  for (int i = 0; i < 19; ++i) {
    m.density += f[i];
    for (int a = 0; a < 3; ++a) m.momentum[a] += D3Q19::c[i][a] * f[i];
  }
  return m;
}

// Equilibrium and noise of this size in every population.
inline void fill_noisy(double (&f)[19], unsigned seed, double size = 0.002) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> noise(-size, size);
  const Vec3 velocity(0.05, -0.03, 0.02);
  for (int i = 0; i < 19; ++i) f[i] = equilibrium_deviation(i, 0.01, velocity) + noise(generator);
}

struct WrittenOut {
  double deviation, tau;
  Vec3 u, force;
  Eigen::Matrix3d pi = Eigen::Matrix3d::Zero();
  double equilibrium[19], guo[19];  // guo without its prefactor

  WrittenOut(const double (&f)[19], const CollisionParameters& p) : force(p.force[0], p.force[1], p.force[2]) {
    const Sums m = sums_of(f);
    deviation = m.density;
    u = (m.momentum + 0.5 * force) / (1.0 + deviation);
    for (int i = 0; i < 19; ++i) {
      const Vec3 c(D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]);
      equilibrium[i] = equilibrium_deviation(i, deviation, u);
      guo[i] = D3Q19::weight(i) * (3.0 * (c - u).dot(force) + 9.0 * c.dot(u) * c.dot(force));
      pi += (f[i] - equilibrium[i]) * c * c.transpose();
    }
    pi += 0.5 * (u * force.transpose() + force * u.transpose());
    tau = relaxation_time(p);
  }

  Eigen::Matrix3d traceless() const { return pi - pi.trace() / 3.0 * Eigen::Matrix3d::Identity(); }

  // Half the difference of opposites, less that of the equilibrium, over the nine pairs.
  double odd_non_equilibrium(const double (&f)[19]) const {
    double squares = 0.0;
    for (int i = 1; i < 19; i += 2) {
      const int o = D3Q19::opposite(i);
      const double odd = 0.5 * (f[i] - f[o]) - 0.5 * (equilibrium[i] - equilibrium[o]);
      squares += odd * odd;
    }
    return std::sqrt(squares);
  }

private:
  double relaxation_time(const CollisionParameters& p) const {
    const double tau0 = p.relaxation_time, constant = p.subgrid.constant(), rho = 1.0 + deviation;
    const Eigen::Matrix3d shear = traceless();
    switch (p.subgrid.model()) {
      case SubgridModel::none:
        return tau0;
      case SubgridModel::smagorinsky: {
        const double norm = p.with_bulk() ? shear.norm() : pi.norm();
        return 0.5 * (tau0 + std::sqrt(tau0 * tau0 + 18.0 * std::sqrt(2.0) * constant * constant * norm / rho));
      }
      case SubgridModel::qr: {
        const double eddies = std::max(0.0, shear.determinant()) / shear.squaredNorm();
        return 0.5 * (tau0 + std::sqrt(tau0 * tau0 + 36.0 * constant * eddies / rho));
      }
    }
    return tau0;
  }
};

}  // namespace thalweg::lbm
