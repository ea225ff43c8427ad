#include "lbm/upstream_bodies.hpp"

#include <cmath>

namespace thalweg::lbm {

GapFlow gap_flow(const CollisionParameters& collision) {
  const double viscosity = (collision.relaxation_time - 0.5) / 3.0, rate = collision.odd_rate();
  const double k = rate / (16.0 * viscosity);
  if (k > 1.0) return {0.0, 1.0 - 1.0 / k};
  constexpr double rounding = 1e-9;
  if (k <= (1.0 - 0.5 * rate) * (1.0 + rounding)) return {};  // Lambda at or above 3/16
  return {(1.0 - k) / (k - 1.0 + rate), 0.0};
}

void UpstreamBodies::set_normals(int link, const Vec3& own, const Vec3& other) {
  for (int a = 0; a < 3; ++a) {
    own_normal_[a][link] = own[a];
    normal_[a][link] = other[a];
  }
}

void UpstreamBodies::set_radial_normals() {
  for (int a = 0; a < 3; ++a)
    for (int k = 0; k < padded(count_); ++k) {
      const double back = distance_[k] * LinkTag::velocity(static_cast<int>(tag_[k]), a);
      own_normal_[a][k] = own_arm_[a][k] - back;
      normal_[a][k] = arm_[a][k] - back;
    }
}

void UpstreamBodies::let_flow(const double (&force)[3], const GapFlow& flow) {
  const double fx = 0.5 * force[0], fy = 0.5 * force[1], fz = 0.5 * force[2];
  const double slip = flow.slip, changed = 1.0 - flow.kept;
  const int n = padded(count_);
  for (int first = 0; first < n; first += links_at_a_time)
    for (int k = first; k < first + links_at_a_time; ++k) {
      const int tag = static_cast<int>(tag_[k]);
      const double cx = LinkTag::velocity(tag, 0), cy = LinkTag::velocity(tag, 1), cz = LinkTag::velocity(tag, 2);
      const double d = distance_[k];
      const double x1 = own_arm_[0][k] - d * cx, y1 = own_arm_[1][k] - d * cy, z1 = own_arm_[2][k] - d * cz;
      const double x2 = arm_[0][k] - d * cx, y2 = arm_[1][k] - d * cy, z2 = arm_[2][k] - d * cz;
      const double n1x = own_normal_[0][k], n1y = own_normal_[1][k], n1z = own_normal_[2][k];
      const double n2x = normal_[0][k], n2y = normal_[1][k], n2z = normal_[2][k];
      const double to_1 = 1.0 / std::sqrt(n1x * n1x + n1y * n1y + n1z * n1z);
      const double to_2 = 1.0 / std::sqrt(n2x * n2x + n2y * n2y + n2z * n2z);
      const double mx = to_1 * n1x - to_2 * n2x, my = to_1 * n1y - to_2 * n2y, mz = to_1 * n1z - to_2 * n2z;
      const double u1x = own_velocity_[0][k] + (own_spin_[1][k] * z1 - own_spin_[2][k] * y1),
                   u1y = own_velocity_[1][k] + (own_spin_[2][k] * x1 - own_spin_[0][k] * z1),
                   u1z = own_velocity_[2][k] + (own_spin_[0][k] * y1 - own_spin_[1][k] * x1);
      const double u2x = velocity_[0][k] + (spin_[1][k] * z2 - spin_[2][k] * y2),
                   u2y = velocity_[1][k] + (spin_[2][k] * x2 - spin_[0][k] * z2),
                   u2z = velocity_[2][k] + (spin_[0][k] * y2 - spin_[1][k] * x2);
      const double wx = 0.5 * (u1x + u2x), wy = 0.5 * (u1y + u2y), wz = 0.5 * (u1z + u2z);
      const double density = 1.0 + deviation_[k];
      const double vx = (momentum_[0][k] - fx) / density - wx, vy = (momentum_[1][k] - fy) / density - wy,
                   vz = (momentum_[2][k] - fz) / density - wz;
      // The link enters one body and leaves the other, so m is not zero.
      const double across = (vx * mx + vy * my + vz * mz) / (mx * mx + my * my + mz * mz);
      const double along_gap = slip * static_cast<double>(1 - (tag >> LinkTag::confined_shift & 1));
      const double sx = along_gap * (vx - across * mx), sy = along_gap * (vy - across * my),
                   sz = along_gap * (vz - across * mz);
      const double along = cx * sx + cy * sy + cz * sz;
      slip_along_[k] = along;
      const double weight = (3.0 - (cx * cx + cy * cy + cz * cz)) * (1.0 / 36.0);
      const double target = density * (cx * wx + cy * wy + cz * wz + along) + (cx * fx + cy * fy + cz * fz);
      odd_change_[k] = changed * (3.0 * weight * target - odd_[k]);
    }
}

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

}  // namespace thalweg::lbm
