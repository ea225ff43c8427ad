#include "coupling/mass_return.hpp"

#include <Eigen/LU>

#include <algorithm>

namespace thalweg::coupling {

MassReturn mass_return(double mass, const lbm::LinkSums& links) {
  constexpr double largest_density = 0.01;
  MassReturn r;
  const double weight = links.weight();
  if (mass == 0.0 || weight == 0.0) return r;
  const Vec3 normal = links.normal();
  const Mat3 second = links.second();
  // A few links in a plane, or none in some direction: without the second condition.
  Vec3 x = Vec3::Zero();
  double even = weight;
  if (second.determinant() > 1e-3 * weight * weight * weight / 27.0) {
    x = second.inverse() * normal;
    even = weight - normal.dot(x);
  }
  if (even < 0.1 * weight) {
    x.setZero();
    even = weight;
  }
  r.density = std::clamp(mass / even, -largest_density, largest_density);
  r.slope = -r.density * x;
  return r;
}

}  // namespace thalweg::coupling
