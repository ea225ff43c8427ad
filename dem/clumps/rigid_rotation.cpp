#include "dem/clumps/rigid_rotation.hpp"

#include <cmath>

namespace thalweg::dem {

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Quaternion normalised(const Quaternion& q) {
  const double scale = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
}

Eigen::Matrix3d rotation_matrix(const Quaternion& q) {
  const double x = 2.0 * q.x, y = 2.0 * q.y, z = 2.0 * q.z;
  Eigen::Matrix3d m;
  m << 1.0 - (y * q.y + z * q.z), x * q.y - z * q.w, x * q.z + y * q.w,  //
      x * q.y + z * q.w, 1.0 - (x * q.x + z * q.z), y * q.z - x * q.w,   //
      x * q.z - y * q.w, y * q.z + x * q.w, 1.0 - (x * q.x + y * q.y);
  return m;
}

Vec3 angular_velocity_of(const Quaternion& q, const Vec3& angular_momentum, const Vec3& moments) {
  const Eigen::Matrix3d turn = rotation_matrix(q);
  const Vec3 in_body = turn.transpose() * angular_momentum;
  return turn * in_body.cwiseQuotient(moments);
}

Vec3 angular_momentum_of(const Quaternion& q, const Vec3& angular_velocity, const Vec3& moments) {
  const Eigen::Matrix3d turn = rotation_matrix(q);
  const Vec3 in_body = turn.transpose() * angular_velocity;
  return turn * in_body.cwiseProduct(moments);
}

Quaternion freely_turned(const Quaternion& q, const Vec3& angular_momentum, const Vec3& moments, double time_step) {
  Quaternion turned = q;
  Vec3 l = rotation_matrix(q).transpose() * angular_momentum;
  const auto about = [&](int axis, double time) {
    const double angle = time * l[axis] / moments[axis], c = std::cos(angle), s = std::sin(angle);
    const double half_c = std::cos(0.5 * angle), half_s = std::sin(0.5 * angle);
    turned = product(turned, {half_c, axis == 0 ? half_s : 0.0, axis == 1 ? half_s : 0.0, axis == 2 ? half_s : 0.0});
    // The body turns under the angular momentum, which so turns back in the body's frame.
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    const double a = l[next], b = l[last];
    l[next] = c * a + s * b;
    l[last] = c * b - s * a;
  };
  about(2, 0.5 * time_step);
  about(1, 0.5 * time_step);
  about(0, time_step);
  about(1, 0.5 * time_step);
  about(2, 0.5 * time_step);
  return normalised(turned);
}

Quaternion turned(const Quaternion& q, const Vec3& angular_velocity, double time_step) {
  const double speed = angular_velocity.norm();
  if (speed == 0.0) return q;
  const double half = 0.5 * speed * time_step, scale = std::sin(half) / speed;
  return normalised(product(
      {std::cos(half), scale * angular_velocity[0], scale * angular_velocity[1], scale * angular_velocity[2]}, q));
}

}  // namespace thalweg::dem
