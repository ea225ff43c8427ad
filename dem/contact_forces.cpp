#include "dem/contact_forces.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace thalweg::dem {

namespace {

// The minimum image of core/periodic_box.hpp (same bits), with the axes' rules turned into numbers.
class MinimumImage {
public:
  explicit MinimumImage(const PeriodicBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
      size_[axis] = box.periodic[axis] ? box.size[axis] : 0.0;
      half_[axis] = box.periodic[axis] ? 0.5 * box.size[axis] : std::numeric_limits<double>::infinity();
    }
  }
  double operator()(int axis, double d) const {
    return d > half_[axis] ? d - size_[axis] : d < -half_[axis] ? d + size_[axis] : d;
  }

private:
  double size_[3], half_[3];
};

// Touching pairs, gathered into arrays so that the law is evaluated for several at once, and scattered in their order.
class PairBatch {
public:
  static constexpr int capacity = 64;
  static constexpr int lanes = 8;   // whole vectors: the rest of the last one holds old, harmless values

  bool full() const { return count_ == capacity; }

  void gather(const GrainStore& store, PairContact& c, double dx, double dy, double dz) {
    const int k = count_++;
    contact_[k] = &c;
    x_[k] = dx, y_[k] = dy, z_[k] = dz;
    reach_[k] = c.reach;
    damping_[k] = c.damping;
    const double r1 = store.radius[c.first], r2 = store.radius[c.second];
    r1_[k] = r1, r2_[k] = r2;
    const Vec3 &v1 = store.velocity[c.first], &v2 = store.velocity[c.second];
    vx_[k] = v1[0] - v2[0], vy_[k] = v1[1] - v2[1], vz_[k] = v1[2] - v2[2];
    const Vec3 &w1 = store.angular_velocity[c.first], &w2 = store.angular_velocity[c.second];
    rwx_[k] = r1 * w1[0] + r2 * w2[0], rwy_[k] = r1 * w1[1] + r2 * w2[1], rwz_[k] = r1 * w1[2] + r2 * w2[2];
    wx_[k] = w1[0] + w2[0], wy_[k] = w1[1] + w2[1], wz_[k] = w1[2] + w2[2];
    sx_[k] = c.spring[0], sy_[k] = c.spring[1], sz_[k] = c.spring[2];
  }

  // Force on the first and turning moment per unit of lever arm on both: n x F_t, with the sign turned.
  void evaluate(const SpringDashpotFriction& law, double friction) {
    const int rounded = (count_ + lanes - 1) / lanes * lanes;
    for (int k = 0; k < rounded; ++k) {
      const double distance = std::sqrt(x_[k] * x_[k] + y_[k] * y_[k] + z_[k] * z_[k]);
      const double inverse = 1.0 / distance, nx = inverse * x_[k], ny = inverse * y_[k], nz = inverse * z_[k];
      const double overlap = reach_[k] - distance, half = 0.5 * overlap;
      // Surface velocity by rotation: -(l1 w1 + l2 w2) x n with the lever arms l = R - overlap/2.
      const double ax = rwx_[k] - half * wx_[k], ay = rwy_[k] - half * wy_[k], az = rwz_[k] - half * wz_[k];
      const ContactMotion motion{overlap, nx, ny, nz, vx_[k] - (ay * nz - az * ny), vy_[k] - (az * nx - ax * nz),
                                 vz_[k] - (ax * ny - ay * nx)};
      const ContactForce f = law(motion, damping_[k], friction, {sx_[k], sy_[k], sz_[k]});
      x_[k] = f.normal * nx + f.tx, y_[k] = f.normal * ny + f.ty, z_[k] = f.normal * nz + f.tz;
      wx_[k] = f.ty * nz - f.tz * ny, wy_[k] = f.tz * nx - f.tx * nz, wz_[k] = f.tx * ny - f.ty * nx;
      sx_[k] = f.spring.x, sy_[k] = f.spring.y, sz_[k] = f.spring.z;
      r1_[k] -= half;
      r2_[k] -= half;
    }
  }

  void scatter(GrainStore& store) {
    for (int k = 0; k < count_; ++k) {
      PairContact& c = *contact_[k];
      c.spring[0] = sx_[k], c.spring[1] = sy_[k], c.spring[2] = sz_[k];
      const Vec3 force(x_[k], y_[k], z_[k]), turn(wx_[k], wy_[k], wz_[k]);
      store.contact_force[c.first] += force;
      store.contact_force[c.second] -= force;
      store.contact_torque[c.first] += r1_[k] * turn;
      store.contact_torque[c.second] += r2_[k] * turn;
    }
    count_ = 0;
  }

private:
  using Lane = double[capacity];

  int count_ = 0;
  PairContact* contact_[capacity];
  alignas(64) Lane x_{}, y_{}, z_{};            // separation from second to first; then the force on the first
  alignas(64) Lane reach_{}, damping_{}, r1_{}, r2_{};   // radii; then lever arms
  alignas(64) Lane vx_{}, vy_{}, vz_{};         // velocity of the first centre against the second
  alignas(64) Lane rwx_{}, rwy_{}, rwz_{};      // R1 w1 + R2 w2
  alignas(64) Lane wx_{}, wy_{}, wz_{};         // w1 + w2; then the moment
  alignas(64) Lane sx_{}, sy_{}, sz_{};         // spring
};

void evaluate_pairs(GrainStore& store, std::vector<PairContact>& pairs, const PeriodicBox& box,
                    const SpringDashpotFriction& law, double friction) {
  const MinimumImage image(box);
  PairBatch batch;
  const auto flush = [&] {
    batch.evaluate(law, friction);
    batch.scatter(store);
  };
  for (PairContact& c : pairs) {
    const Vec3 &p1 = store.position[c.first], &p2 = store.position[c.second];
    const double dx = image(0, p1[0] - p2[0]), dy = image(1, p1[1] - p2[1]), dz = image(2, p1[2] - p2[2]);
    if (dx * dx + dy * dy + dz * dz >= c.reach * c.reach) {
      c.spring[0] = c.spring[1] = c.spring[2] = 0.0;
      continue;
    }
    batch.gather(store, c, dx, dy, dz);
    if (batch.full()) flush();
  }
  flush();
}

void evaluate_walls(GrainStore& store, std::vector<WallContact>& contacts, std::span<const Plane> walls,
                    const SpringDashpotFriction& law) {
  for (WallContact& c : contacts) {
    const Plane& wall = walls[c.wall];
    const Vec3& n = wall.normal;
    const double height = (store.position[c.grain] - wall.point).dot(n);
    const double overlap = store.radius[c.grain] - height;
    if (!(overlap > 0.0)) {
      c.spring[0] = c.spring[1] = c.spring[2] = 0.0;
      continue;
    }
    const Vec3 v = store.velocity[c.grain] - wall.velocity - height * store.angular_velocity[c.grain].cross(n);
    const ContactForce f = law({overlap, n[0], n[1], n[2], v[0], v[1], v[2]}, c.damping, wall.friction,
                               {c.spring[0], c.spring[1], c.spring[2]});
    c.spring[0] = f.spring.x, c.spring[1] = f.spring.y, c.spring[2] = f.spring.z;
    const Vec3 tangential(f.tx, f.ty, f.tz);
    store.contact_force[c.grain] += f.normal * n + tangential;
    store.contact_torque[c.grain] += height * tangential.cross(n);
  }
}

}  // namespace

void evaluate_contacts(GrainStore& store, ContactList& list, const PeriodicBox& box, std::span<const Plane> walls,
                       const SpringDashpotFriction& law, double friction) {
  std::fill(store.contact_force.begin(), store.contact_force.end(), Vec3::Zero());
  std::fill(store.contact_torque.begin(), store.contact_torque.end(), Vec3::Zero());
  evaluate_pairs(store, list.pairs, box, law, friction);
  evaluate_walls(store, list.walls, walls, law);
}

}  // namespace thalweg::dem
