#include "lbm/upstream_bodies.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::lbm {

GapFlow gap_flow(const CollisionParameters& collision) {
  const double viscosity = (collision.relaxation_time - 0.5) / 3.0, rate = collision.odd_rate();
  const double k = rate / (24.0 * viscosity) + (1.0 - 0.5 * rate) / 3.0;
  if (k > 1.0) return {0.0, 1.0 - 8.0 * viscosity * (2.0 + 0.5 * rate) / rate};
  return {std::min(1.0, (1.0 - k) / (k - 1.0 + rate)), 0.0};
}

void UpstreamBodies::add(std::uint32_t tag, std::int32_t cell, double deviation, double distance, const Vec3& arm,
                         const LinkBody& other, const Vec3& apart) {
  const int k = count_++;
  tag_[k] = tag;
  cell_[k] = cell;
  deviation_[k] = deviation;
  distance_[k] = distance;
  for (int a = 0; a < 3; ++a) {
    own_arm_[a][k] = arm[a];
    arm_[a][k] = apart[a] + arm[a];
    velocity_[a][k] = other.velocity[a];
    spin_[a][k] = other.angular_velocity[a];
    slip_[a][k] = 0.0;
  }
}

void UpstreamBodies::set_normals(int link, const Vec3& own, const Vec3& other) {
  for (int a = 0; a < 3; ++a) {
    own_normal_[a][link] = own[a];
    normal_[a][link] = other[a];
  }
}

// Direction by direction, so that the inner loop gathers from one plane of memory.
template <typename Real>
void UpstreamBodies::measure_velocity(const Real* const (&sent)[D3Q19::directions], const double (&force)[3]) {
  const int n = count_;
  for (int a = 0; a < 3; ++a) std::fill_n(fluid_velocity_[a], n, -0.5 * force[a]);
  for (int i = 1; i < D3Q19::directions; ++i)
    for (int k = 0; k < n; ++k) {
      const auto f = static_cast<double>(sent[i][cell_[k]]);
      for (int a = 0; a < 3; ++a) fluid_velocity_[a][k] += D3Q19::c[i][a] * f;
    }
  for (double(&component)[capacity] : fluid_velocity_)
    for (int k = 0; k < n; ++k) component[k] /= 1.0 + deviation_[k];
}

template <typename Real>
void UpstreamBodies::let_flow(const Real* const (&sent)[D3Q19::directions], const double (&force)[3],
                              const GapFlow& flow, const LinkBody& own) {
  measure_velocity(sent, force);
  const Vec3 &v = own.velocity, &w = own.angular_velocity;
  for (int k = 0; k < count_; ++k) {
    const int tag = static_cast<int>(tag_[k]);
    const double cx = LinkTag::velocity(tag, 0), cy = LinkTag::velocity(tag, 1), cz = LinkTag::velocity(tag, 2);
    const double x1[3] = {own_arm_[0][k] - distance_[k] * cx, own_arm_[1][k] - distance_[k] * cy,
                          own_arm_[2][k] - distance_[k] * cz};
    const double x2[3] = {arm_[0][k] - distance_[k] * cx, arm_[1][k] - distance_[k] * cy,
                          arm_[2][k] - distance_[k] * cz};
    const double n1[3] = {own_normal_[0][k], own_normal_[1][k], own_normal_[2][k]};
    const double n2[3] = {normal_[0][k], normal_[1][k], normal_[2][k]};
    const double to_1 = 1.0 / std::sqrt(n1[0] * n1[0] + n1[1] * n1[1] + n1[2] * n1[2]),
                 to_2 = 1.0 / std::sqrt(n2[0] * n2[0] + n2[1] * n2[1] + n2[2] * n2[2]);
    const double mx = to_1 * n1[0] - to_2 * n2[0], my = to_1 * n1[1] - to_2 * n2[1], mz = to_1 * n1[2] - to_2 * n2[2];
    const double u2x = velocity_[0][k] + (spin_[1][k] * x2[2] - spin_[2][k] * x2[1]),
                 u2y = velocity_[1][k] + (spin_[2][k] * x2[0] - spin_[0][k] * x2[2]),
                 u2z = velocity_[2][k] + (spin_[0][k] * x2[1] - spin_[1][k] * x2[0]);
    const double wx = 0.5 * ((v.x() + (w.y() * x1[2] - w.z() * x1[1])) + u2x),
                 wy = 0.5 * ((v.y() + (w.z() * x1[0] - w.x() * x1[2])) + u2y),
                 wz = 0.5 * ((v.z() + (w.x() * x1[1] - w.y() * x1[0])) + u2z);
    const double vx = fluid_velocity_[0][k] - wx, vy = fluid_velocity_[1][k] - wy, vz = fluid_velocity_[2][k] - wz;
    // The link enters one body and leaves the other, so m is not zero.
    const double across = (vx * mx + vy * my + vz * mz) / (mx * mx + my * my + mz * mz);
    slip_[0][k] = flow.slip * (vx - across * mx);
    slip_[1][k] = flow.slip * (vy - across * my);
    slip_[2][k] = flow.slip * (vz - across * mz);
    slip_along_[k] = cx * slip_[0][k] + cy * slip_[1][k] + cz * slip_[2][k];
    const double weight = (3.0 - (cx * cx + cy * cy + cz * cz)) * (1.0 / 36.0);
    const double at_rest = 3.0 * weight * (1.0 + deviation_[k]) * (cx * wx + cy * wy + cz * wz + slip_along_[k]);
    const int i = tag & static_cast<int>(LinkTag::direction_mask);
    const double odd =
        0.5 * (static_cast<double>(sent[i][cell_[k]]) - static_cast<double>(sent[D3Q19::opposite(i)][cell_[k]]));
    odd_change_[k] = (1.0 - flow.kept) * (at_rest - odd);
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
      const double ux = velocity_[0][k] + (spin_[1][k] * z - spin_[2][k] * y) + slip_[0][k],
                   uy = velocity_[1][k] + (spin_[2][k] * x - spin_[0][k] * z) + slip_[1][k],
                   uz = velocity_[2][k] + (spin_[0][k] * y - spin_[1][k] * x) + slip_[2][k];
      const double cu = cx * ux + cy * uy + cz * uz, uu = ux * ux + uy * uy + uz * uz;
      const double weight = (3.0 - (cx * cx + cy * cy + cz * cz)) * (1.0 / 36.0);
      const double along = cx * gx + cy * gy + cz * gz, d = deviation_[k] - along;
      population_[k] = weight * (d + (1.0 + d) * (3.0 * cu + 4.5 * cu * cu - 1.5 * uu) + 0.5 * along);
    }
}

template void UpstreamBodies::let_flow(const float* const (&)[D3Q19::directions], const double (&)[3], const GapFlow&,
                                       const LinkBody&);
template void UpstreamBodies::let_flow(const double* const (&)[D3Q19::directions], const double (&)[3], const GapFlow&,
                                       const LinkBody&);

}  // namespace thalweg::lbm
