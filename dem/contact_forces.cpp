#include "dem/contact_forces.hpp"

#include "dem/hertz_mindlin.hpp"
#include "dem/rolling_pass.hpp"
#include "dem/spring_dashpot.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

namespace thalweg::dem {

namespace {

// The minimum image of core/periodic_box.hpp (same bits), all axes at once and with their rules turned into numbers.
class MinimumImage {
public:
  explicit MinimumImage(const PeriodicBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
      size_[axis] = box.periodic[axis] ? box.size[axis] : 0.0;
      half_[axis] = box.periodic[axis] ? 0.5 * box.size[axis] : std::numeric_limits<double>::infinity();
    }
  }
  Row operator()(const Row& d) const { return d > half_ ? d - size_ : d < -half_ ? d + size_ : d; }

private:
  Row size_{}, half_{0.0, 0.0, 0.0, std::numeric_limits<double>::infinity()};
};

inline Row last_everywhere(const Row& r) { return Row{r[3], r[3], r[3], r[3]}; }

inline Row row_at(const double* values) {
  Row row;
  std::memcpy(&row, values, sizeof(Row));
  return row;
}

// Turns four rows into four columns, and back.
inline void transpose(Row (&r)[4]) {
  const Row a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6), b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  const Row c = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6), d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  r[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  r[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  r[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  r[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

// Touching pairs, gathered into arrays so that the law is evaluated for several at once, and scattered in their order.
class PairBatch {
public:
  static constexpr int capacity = 64;
  static constexpr int lanes = 8;  // whole vectors: the last one is filled up with copies of the first pair

  // material: of every slot.
  PairBatch(const MaterialTable& materials, std::span<const std::uint8_t> material)
      : materials_(materials), material_(material) {
    // One material's numbers are the same in all lanes, so they are put there once.
    if (materials.count() > 1) return;
    const ContactCoefficients& only = materials.pair(0, 0).coefficients;
    std::fill_n(normal_, capacity, only.normal);
    std::fill_n(tangential_, capacity, only.tangential);
    std::fill_n(friction_, capacity, only.friction);
  }

  bool full() const { return count_ == capacity; }

  // Keeps the pair if it touches. No branch: whether a pair within the skin touches cannot be foreseen.
  void offer(PairContact& c, const Row& separation, bool touches) {
    contact_[count_] = &c;
    separation_[count_] = separation;
    count_ += touches;
  }

  template <typename ContactLaw>
  void evaluate_and_scatter(MovingGrains& grains, const ContactLaw& law) {
    if (count_ == 0) return;
    const int rounded = (count_ + lanes - 1) / lanes * lanes;
    for (int k = count_; k < rounded; ++k) contact_[k] = contact_[0], separation_[k] = separation_[0];
    for (int k = 0; k < rounded; k += 4) gather(grains, k);
    if (materials_.count() > 1) gather_coefficients(rounded);
    evaluate(law, rounded);
    for (int k = 0; k < count_; k += 4) scatter(grains, k);
    count_ = 0;
  }

private:
  using Lane = double[capacity];

  static void store(const Row (&r)[4], int k, Lane& x, Lane& y, Lane& z, Lane& last) {
    std::memcpy(x + k, &r[0], sizeof(Row));
    std::memcpy(y + k, &r[1], sizeof(Row));
    std::memcpy(z + k, &r[2], sizeof(Row));
    std::memcpy(last + k, &r[3], sizeof(Row));
  }

  void gather(const MovingGrains& grains, int k) {
    Row v[4], rw[4], w[4], spring[4];
    for (int m = 0; m < 4; ++m) {
      const PairContact& c = *contact_[k + m];
      const MovingGrain &first = grains[c.first], &second = grains[c.second];
      v[m] = first.velocity - second.velocity;
      rw[m] = last_everywhere(first.position) * first.spin + last_everywhere(second.position) * second.spin;
      w[m] = first.spin + second.spin;
      spring[m] = row_at(c.spring);
      reach_[k + m] = c.reach;
    }
    Row separation[4] = {separation_[k], separation_[k + 1], separation_[k + 2], separation_[k + 3]};
    transpose(separation), transpose(v), transpose(rw), transpose(w), transpose(spring);
    store(separation, k, x_, y_, z_, difference_);
    store(v, k, vx_, vy_, vz_, unused_);
    store(rw, k, rwx_, rwy_, rwz_, unused_);
    store(w, k, wx_, wy_, wz_, unused_);
    store(spring, k, sx_, sy_, sz_, damping_);
  }

  void gather_coefficients(int rounded) {
    for (int k = 0; k < rounded; ++k) {
      const PairContact& c = *contact_[k];
      const ContactCoefficients& pair = materials_.pair(material_[c.first], material_[c.second]).coefficients;
      normal_[k] = pair.normal, tangential_[k] = pair.tangential, friction_[k] = pair.friction;
    }
  }

  // Force on the first and turning moment per unit of lever arm on both: n x F_t, with the sign turned.
  template <typename ContactLaw>
  void evaluate(const ContactLaw& law, int rounded) {
    for (int k = 0; k < rounded; ++k) {
      const double distance = std::sqrt(x_[k] * x_[k] + y_[k] * y_[k] + z_[k] * z_[k]);
      const double inverse = 1.0 / distance, nx = inverse * x_[k], ny = inverse * y_[k], nz = inverse * z_[k];
      const double overlap = reach_[k] - distance, half = 0.5 * overlap;
      // Surface velocity by rotation: -(l1 w1 + l2 w2) x n with the lever arms l = R - overlap/2.
      const double ax = rwx_[k] - half * wx_[k], ay = rwy_[k] - half * wy_[k], az = rwz_[k] - half * wz_[k];
      const ContactMotion motion{overlap, nx, ny, nz, vx_[k] - (ay * nz - az * ny), vy_[k] - (az * nx - ax * nz),
                                 vz_[k] - (ax * ny - ay * nx),
                                 // R1 R2/(R1 + R2) of the sum and the difference of the radii
                                 0.25 * (reach_[k] - difference_[k] * difference_[k] / reach_[k])};
      const ContactForce f =
          law(motion, {normal_[k], tangential_[k], friction_[k]}, damping_[k], {sx_[k], sy_[k], sz_[k]});
      x_[k] = f.normal * nx + f.tx, y_[k] = f.normal * ny + f.ty, z_[k] = f.normal * nz + f.tz;
      wx_[k] = f.ty * nz - f.tz * ny, wy_[k] = f.tz * nx - f.tx * nz, wz_[k] = f.tx * ny - f.ty * nx;
      sx_[k] = f.spring.x, sy_[k] = f.spring.y, sz_[k] = f.spring.z;
      difference_[k] = half;
    }
  }

  void scatter(MovingGrains& grains, int k) {
    Row force[4] = {row_at(x_ + k), row_at(y_ + k), row_at(z_ + k), row_at(difference_ + k)};
    Row turn[4] = {row_at(wx_ + k), row_at(wy_ + k), row_at(wz_ + k), Row{}};
    Row spring[4] = {row_at(sx_ + k), row_at(sy_ + k), row_at(sz_ + k), row_at(damping_ + k)};
    transpose(force), transpose(turn), transpose(spring);
    for (int m = 0; m < 4 && k + m < count_; ++m) {
      PairContact& c = *contact_[k + m];
      std::memcpy(c.spring, &spring[m], sizeof(Row));
      MovingGrain &first = grains[c.first], &second = grains[c.second];
      const Row half = last_everywhere(force[m]), f = force[m] * Row{1.0, 1.0, 1.0, 0.0};
      first.force += f;
      second.force -= f;
      first.torque += (last_everywhere(first.position) - half) * turn[m];
      second.torque += (last_everywhere(second.position) - half) * turn[m];
    }
  }

  const MaterialTable& materials_;
  std::span<const std::uint8_t> material_;
  int count_ = 0;
  PairContact* contact_[capacity + 1];               // one more: what is offered to a full batch is not kept
  Row separation_[capacity + 1];                     // from second to first
  alignas(64) Lane x_{}, y_{}, z_{}, difference_{};  // separation, difference of radii; then force, overlap/2
  alignas(64) Lane normal_{}, tangential_{}, friction_{};
  alignas(64) Lane reach_{}, damping_{}, unused_{};
  alignas(64) Lane vx_{}, vy_{}, vz_{};     // velocity of the first centre against the second
  alignas(64) Lane rwx_{}, rwy_{}, rwz_{};  // R1 w1 + R2 w2
  alignas(64) Lane wx_{}, wy_{}, wz_{};     // w1 + w2; then the moment
  alignas(64) Lane sx_{}, sy_{}, sz_{};     // spring
};

template <typename ContactLaw>
void evaluate_pairs(MovingGrains& grains, std::vector<PairContact>& pairs, const PeriodicBox& box, PairBatch& batch,
                    const ContactLaw& law) {
  static_assert(offsetof(PairContact, damping) == offsetof(PairContact, spring) + 3 * sizeof(double));
  const MinimumImage image(box);
  for (PairContact& c : pairs) {
    const Row d = image(grains[c.first].position - grains[c.second].position), square = d * d;
    const bool touches = square[0] + square[1] + square[2] < c.reach * c.reach;
    const bool was_touching = (c.spring[0] != 0.0) | (c.spring[1] != 0.0) | (c.spring[2] != 0.0);
    if (!touches & was_touching) c.spring[0] = c.spring[1] = c.spring[2] = 0.0;
    batch.offer(c, d, touches);
    if (batch.full()) batch.evaluate_and_scatter(grains, law);
  }
  batch.evaluate_and_scatter(grains, law);
}

template <typename ContactLaw>
void evaluate_walls(MovingGrains& grains, std::vector<WallContact>& contacts, std::span<const Plane> walls,
                    const MaterialTable& materials, std::span<const std::uint8_t> material, const ContactLaw& law) {
  for (WallContact& c : contacts) {
    MovingGrain& grain = grains[c.grain];
    const Plane& wall = walls[c.wall];
    const Vec3& n = wall.normal;
    const double height = (vector_of(grain.position) - wall.point).dot(n);
    const double overlap = grain.position[3] - height;
    if (!(overlap > 0.0)) {
      c.spring[0] = c.spring[1] = c.spring[2] = 0.0;
      continue;
    }
    const Vec3 v = vector_of(grain.velocity) - wall.velocity - height * vector_of(grain.spin).cross(n);
    ContactCoefficients coefficients = materials.wall(material[c.grain]).coefficients;
    coefficients.friction = wall.friction;
    const ContactForce f = law({overlap, n[0], n[1], n[2], v[0], v[1], v[2], grain.position[3]}, coefficients,
                               c.damping, {c.spring[0], c.spring[1], c.spring[2]});
    c.spring[0] = f.spring.x, c.spring[1] = f.spring.y, c.spring[2] = f.spring.z;
    const Vec3 tangential(f.tx, f.ty, f.tz);
    grain.force += row_of(f.normal * n + tangential);
    grain.torque += row_of(height * tangential.cross(n));
  }
}

template <typename ContactLaw>
std::vector<Vec3> wall_forces_with(const ContactLaw& law, const GrainStore& store, const ContactList& list,
                                   std::span<const Plane> walls, const MaterialTable& materials) {
  MovingGrains one;
  std::vector<Vec3> forces;
  std::vector<WallContact> contact(1);
  GrainStore alone;
  for (const WallContact& c : list.walls) {
    alone.clear();
    alone.append(store.id[c.grain], store.radius[c.grain], store.mass[c.grain], store.motion[c.grain],
                 store.position[c.grain], store.material[c.grain]);
    alone.velocity[0] = store.velocity[c.grain];
    alone.angular_velocity[0] = store.angular_velocity[c.grain];
    one.load(alone, {});
    contact[0] = c;
    contact[0].grain = 0;
    evaluate_walls(one, contact, walls, materials, alone.material, law);
    forces.push_back(vector_of(one[0].force));
  }
  return forces;
}

template <typename ContactLaw>
void evaluate_with(const ContactLaw& law, MovingGrains& grains, ContactList& list, const PeriodicBox& box,
                   std::span<const Plane> walls, const MaterialTable& materials,
                   std::span<const std::uint8_t> material) {
  PairBatch batch(materials, material);
  evaluate_pairs(grains, list.pairs, box, batch, law);
  evaluate_walls(grains, list.walls, walls, materials, material, law);
}

}  // namespace

void evaluate_contacts(MovingGrains& grains, ContactList& list, const PeriodicBox& box, std::span<const Plane> walls,
                       const MaterialTable& materials, std::span<const std::uint8_t> material, double time_step) {
  const ContactManner manner = materials.manner(time_step);
  if (materials.law() == Law::linear)
    evaluate_with(SpringDashpotFriction(manner), grains, list, box, walls, materials, material);
  else
    evaluate_with(HertzMindlin(manner), grains, list, box, walls, materials, material);
  evaluate_rolling(grains, list, box, walls, materials, material, time_step);
}

std::vector<Vec3> wall_contact_forces(const GrainStore& store, const ContactList& list, std::span<const Plane> walls,
                                      const MaterialTable& materials) {
  const ContactManner manner = materials.manner(0.0);
  if (materials.law() == Law::linear)
    return wall_forces_with(SpringDashpotFriction(manner), store, list, walls, materials);
  return wall_forces_with(HertzMindlin(manner), store, list, walls, materials);
}

}  // namespace thalweg::dem
