#include "bodies/links/upstream_bodies.hpp"

namespace thalweg::bodies {

void UpstreamBodies::find_populations(const Vec3& rest_gradient) {
  const double gx = rest_gradient.x(), gy = rest_gradient.y(), gz = rest_gradient.z();
  const int n = padded(count_);
  for (int first = 0; first < n; first += links_at_a_time)
    for (int k = first; k < first + links_at_a_time; ++k) {
      const int tag = static_cast<int>(tag_[k]);
      const double cx = LinkTag::velocity(tag, 0), cy = LinkTag::velocity(tag, 1), cz = LinkTag::velocity(tag, 2);
      const double back = distance_[k] + 1.0;
      const double x = arm_[0][k] - back * cx, y = arm_[1][k] - back * cy, z = arm_[2][k] - back * cz;
      const double ux = velocity_[0][k] + (spin_[1][k] * z - spin_[2][k] * y),
                   uy = velocity_[1][k] + (spin_[2][k] * x - spin_[0][k] * z),
                   uz = velocity_[2][k] + (spin_[0][k] * y - spin_[1][k] * x);
      const double cu = cx * ux + cy * uy + cz * uz, uu = ux * ux + uy * uy + uz * uz;
      const double weight = (3.0 - (cx * cx + cy * cy + cz * cz)) * (1.0 / 36.0);
      const double along = cx * gx + cy * gy + cz * gz, d = deviation_[k] - along;
      population_[k] = weight * (d + (1.0 + d) * (3.0 * cu + 4.5 * cu * cu - 1.5 * uu) + 0.5 * along);
    }
}

}  // namespace thalweg::bodies
