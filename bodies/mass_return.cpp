#include "bodies/mass_return.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace thalweg::bodies {

MassReturn MassReturn::scaled(double times) const {
  constexpr double largest_density = 0.01;
  const double largest = density == 0.0 ? 0.0 : largest_density / std::abs(density);
  const double factor = std::clamp(times, -largest, largest);
  return {factor * density, factor * slope};
}

MassReturn unit_mass_return(const LinkSums& links) {
  const double weight = links.weight();
  if (weight == 0.0) return {};
  const Vec3 normal = links.normal();
  const Mat3 second = links.second();
  // A few links in one plane have no such x: the mass then comes back evenly.
  constexpr double least_determinant = 1e-3 / 27.0, least_share = 0.1;
  if (second.determinant() <= least_determinant * weight * weight * weight) return {1.0 / weight, Vec3::Zero()};
  const Vec3 x = second.inverse() * normal;
  const double share = weight - normal.dot(x);
  if (share < least_share * weight) return {1.0 / weight, Vec3::Zero()};
  return {1.0 / share, -x / share};
}

// The return changes what the links take, most of all with cli: returning everything at once would oscillate and grow.
// Cells at a surface oscillate from step to step with little damping; the mean of two steps does not excite them.
MassReturn MassDebt::settle(double given, double came_back, const LinkSums& links) {
  constexpr double share_of_owed = 0.5, share_of_last_step = 0.125;
  owed -= given;
  mean_loss += share_of_last_step * (came_back - given - mean_loss);
  const double wanted_before = wanted;
  wanted = share_of_owed * owed + mean_loss;
  return unit_mass_return(links).scaled(0.5 * (wanted + wanted_before));
}

}  // namespace thalweg::bodies
