#include "dem/contact_forces.hpp"

#include "dem/contact_motion.hpp"
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

// Near pairs, gathered into arrays so that the law is evaluated for several at once, and scattered in their order. A
// pair that does not touch goes along with a force of zero: nearly all touch, and adding zero changes no bit (no sum
// here is ever -0, since it began at +0).
class PairBatch {
public:
  static constexpr int capacity = 64;
  static constexpr int lanes = 8;  // whole vectors: the last one is filled up with copies of the first pair

  // material: of every slot.
  PairBatch(MovingGrains& grains, std::vector<PairContact>& pairs, const PeriodicBox& box,
            const MaterialTable& materials, std::span<const std::uint8_t> material)
      : grains_(grains), pairs_(pairs), image_(box), materials_(materials), material_(material) {
    static_assert(offsetof(PairContact, damping) == offsetof(PairContact, spring) + 3 * sizeof(double));
    // One material's numbers are the same in all lanes, so they are put there once.
    if (materials.count() > 1) return;
    const ContactCoefficients& only = materials.pair(0, 0).coefficients;
    std::fill_n(normal_, capacity, only.normal);
    std::fill_n(tangential_, capacity, only.tangential);
    std::fill_n(friction_, capacity, only.friction);
  }

  // near: at most `capacity`. fetch: whether to ask for grains and contacts of `ahead` pairs behind these.
  template <bool fetch, typename ContactLaw>
  void evaluate(std::span<const NearPair> near, std::span<const NearPair> behind, const ContactLaw& law) {
    const int count = static_cast<int>(near.size()), rounded = (count + lanes - 1) / lanes * lanes;
    std::copy(near.begin(), near.end(), pair_);
    std::fill(pair_ + count, pair_ + rounded, near[0]);
    for (int k = 0; k < rounded; k += 4) {
      if constexpr (fetch)
        for (std::size_t n = k; n < std::min<std::size_t>(k + 4, behind.size()); ++n) ask_for(behind[n]);
      gather(k);
    }
    if (materials_.count() > 1) gather_coefficients(rounded);
    evaluate(law, rounded);
    for (int k = 0; k < count; k += 4) scatter(k, std::min(4, count - k));
  }

private:
  using Lane = double[capacity];

  static void store(const Row (&r)[4], int k, Lane& x, Lane& y, Lane& z, Lane& last) {
    std::memcpy(x + k, &r[0], sizeof(Row));
    std::memcpy(y + k, &r[1], sizeof(Row));
    std::memcpy(z + k, &r[2], sizeof(Row));
    std::memcpy(last + k, &r[3], sizeof(Row));
  }

  // Inlined, because to the compiler a function that only asks does nothing, and a call of it can go.
  [[gnu::always_inline]] void ask_for(const NearPair& next) const {
    __builtin_prefetch(&pairs_[next.pair], 1);
    for (const std::uint32_t slot : {next.first, next.second}) {
      const char* grain = reinterpret_cast<const char*>(&grains_[slot]);
      for (std::size_t line = 0; line < sizeof(MovingGrain); line += 64) __builtin_prefetch(grain + line, 1);
    }
  }

  void gather(int k) {
    Row separation[4], v[4], rw[4], w[4], spring[4];
    for (int m = 0; m < 4; ++m) {
      const PairContact& c = pairs_[pair_[k + m].pair];
      const MovingGrain &first = grains_[pair_[k + m].first], &second = grains_[pair_[k + m].second];
      separation[m] = image_(first.position - second.position);
      v[m] = first.velocity - second.velocity;
      rw[m] = last_everywhere(first.position) * first.spin + last_everywhere(second.position) * second.spin;
      w[m] = first.spin + second.spin;
      spring[m] = row_at(c.spring);
      reach_[k + m] = c.reach;
    }
    transpose(separation), transpose(v), transpose(rw), transpose(w), transpose(spring);
    store(separation, k, x_, y_, z_, difference_);
    store(v, k, vx_, vy_, vz_, unused_);
    store(rw, k, rwx_, rwy_, rwz_, unused_);
    store(w, k, wx_, wy_, wz_, unused_);
    store(spring, k, sx_, sy_, sz_, damping_);
  }

  void gather_coefficients(int rounded) {
    for (int k = 0; k < rounded; ++k) {
      const ContactCoefficients& pair =
          materials_.pair(material_[pair_[k].first], material_[pair_[k].second]).coefficients;
      normal_[k] = pair.normal, tangential_[k] = pair.tangential, friction_[k] = pair.friction;
    }
  }

  // Force on the first and turning moment per unit of lever arm on both: n x F_t, with the sign turned.
  template <typename ContactLaw>
  void evaluate(const ContactLaw& law, int rounded) {
    for (int k = 0; k < rounded; ++k) {
      const double squared = x_[k] * x_[k] + y_[k] * y_[k] + z_[k] * z_[k];
      const bool touches = squared < reach_[k] * reach_[k];
      const double distance = std::sqrt(squared);
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
      const auto if_touching = [touches](double value) { return touches ? value : 0.0; };
      x_[k] = if_touching(f.normal * nx + f.tx);
      y_[k] = if_touching(f.normal * ny + f.ty);
      z_[k] = if_touching(f.normal * nz + f.tz);
      wx_[k] = if_touching(f.ty * nz - f.tz * ny);
      wy_[k] = if_touching(f.tz * nx - f.tx * nz);
      wz_[k] = if_touching(f.tx * ny - f.ty * nx);
      sx_[k] = if_touching(f.spring.x), sy_[k] = if_touching(f.spring.y), sz_[k] = if_touching(f.spring.z);
      difference_[k] = half;
    }
  }

  void scatter(int k, int count) {
    Row force[4] = {row_at(x_ + k), row_at(y_ + k), row_at(z_ + k), row_at(difference_ + k)};
    Row turn[4] = {row_at(wx_ + k), row_at(wy_ + k), row_at(wz_ + k), Row{}};
    Row spring[4] = {row_at(sx_ + k), row_at(sy_ + k), row_at(sz_ + k), row_at(damping_ + k)};
    transpose(force), transpose(turn), transpose(spring);
    for (int m = 0; m < count; ++m) {
      const NearPair& pair = pair_[k + m];
      std::memcpy(pairs_[pair.pair].spring, &spring[m], sizeof(Row));
      MovingGrain &first = grains_[pair.first], &second = grains_[pair.second];
      const Row half = last_everywhere(force[m]), f = force[m] * Row{1.0, 1.0, 1.0, 0.0};
      first.force += f;
      second.force -= f;
      first.torque += (last_everywhere(first.position) - half) * turn[m];
      second.torque += (last_everywhere(second.position) - half) * turn[m];
    }
  }

  MovingGrains& grains_;
  std::vector<PairContact>& pairs_;
  const MinimumImage image_;
  const MaterialTable& materials_;
  std::span<const std::uint8_t> material_;
  NearPair pair_[capacity];
  alignas(64) Lane x_{}, y_{}, z_{}, difference_{};  // separation, difference of radii; then force, overlap/2
  alignas(64) Lane normal_{}, tangential_{}, friction_{};
  alignas(64) Lane reach_{}, damping_{}, unused_{};
  alignas(64) Lane vx_{}, vy_{}, vz_{};     // velocity of the first centre against the second
  alignas(64) Lane rwx_{}, rwy_{}, rwz_{};  // R1 w1 + R2 w2
  alignas(64) Lane wx_{}, wy_{}, wz_{};     // w1 + w2; then the moment
  alignas(64) Lane sx_{}, sy_{}, sz_{};     // spring
};

// Finds the near ones of all pairs; springs of pairs that do not touch are zero.
void look_for_near_pairs(const MovingGrains& grains, ContactList& list, const MinimumImage& image) {
  list.near.begin();
  const double range = list.near.range();
  for (std::size_t p = 0; p < list.pairs.size(); ++p) {
    PairContact& c = list.pairs[p];
    const Row d = image(grains[c.first].position - grains[c.second].position), square = d * d;
    const double squared = square[0] + square[1] + square[2], limit = c.reach + range;
    if (squared < limit * limit)
      list.near.add({c.first, c.second, static_cast<std::uint32_t>(p)});
    else
      c.spring[0] = c.spring[1] = c.spring[2] = 0.0;
  }
}

template <bool fetch, typename ContactLaw>
void evaluate_near_pairs(const std::vector<NearPair>& near, PairBatch& batch, const ContactLaw& law) {
  const std::span<const NearPair> all(near);
  constexpr std::size_t size = PairBatch::capacity, ahead = 24;
  for (std::size_t n = 0; n < all.size(); n += size)
    batch.evaluate<fetch>(all.subspan(n, std::min(size, all.size() - n)), all.subspan(std::min(n + ahead, all.size())),
                          law);
}

template <typename ContactLaw>
void evaluate_pairs(MovingGrains& grains, ContactList& list, const PeriodicBox& box, PairBatch& batch,
                    const ContactLaw& law) {
  if (list.near.stale()) look_for_near_pairs(grains, list, MinimumImage(box));
  // What does not stay in the cache from one sub-step to the next is asked for ahead.
  constexpr std::size_t cached = 2 << 20;  // bytes
  const std::vector<NearPair>& near = list.near.pairs();
  if (near.size() * sizeof(PairContact) + grains.size() * sizeof(MovingGrain) > cached)
    evaluate_near_pairs<true>(near, batch, law);
  else
    evaluate_near_pairs<false>(near, batch, law);
}

template <typename ContactLaw>
void evaluate_walls(MovingGrains& grains, std::vector<WallContact>& contacts, std::span<const Plane> walls,
                    const MaterialTable& materials, std::span<const std::uint8_t> material, const ContactLaw& law) {
  for (WallContact& c : contacts) {
    MovingGrain& grain = grains[c.grain];
    const Plane& wall = walls[c.wall];
    const auto [height, n] = wall.seen_from(vector_of(grain.position));
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
void visit_ends_with(const ContactLaw& law, const GrainStore& store, const ContactList& list, const PeriodicBox& box,
                     std::span<const Plane> walls, const MaterialTable& materials, const ContactEndVisitor& visit) {
  const auto force_of = [&](const ContactMotion& motion, const ContactCoefficients& k, double damping,
                            const double(&spring)[3]) -> Vec3 {
    const ContactForce f = law(motion, k, damping, {spring[0], spring[1], spring[2]});
    return f.normal * normal_of(motion) + Vec3(f.tx, f.ty, f.tz);
  };
  for (const PairContact& c : list.pairs) {
    const ContactMotion motion = motion_of(body_of(store, c.first), body_of(store, c.second),
                                           box.difference(store.position[c.first], store.position[c.second]));
    if (!(motion.overlap > 0.0)) continue;
    const Vec3 n = normal_of(motion);
    const Vec3 force = force_of(motion, materials.pair(store.material[c.first], store.material[c.second]).coefficients,
                                c.damping, c.spring);
    const double half = 0.5 * motion.overlap;
    if (!store.is_ghost(c.first)) visit(c.first, -(store.radius[c.first] - half) * n, force);
    if (!store.is_ghost(c.second)) visit(c.second, (store.radius[c.second] - half) * n, -force);
  }
  for (const WallContact& c : list.walls) {
    const ContactMotion motion = motion_of(body_of(store, c.grain), walls[c.wall], store.position[c.grain]);
    if (!(motion.overlap > 0.0)) continue;
    ContactCoefficients coefficients = materials.wall(store.material[c.grain]).coefficients;
    coefficients.friction = walls[c.wall].friction;
    visit(c.grain, (motion.overlap - store.radius[c.grain]) * normal_of(motion),
          force_of(motion, coefficients, c.damping, c.spring));
  }
}

template <typename ContactLaw>
void evaluate_with(const ContactLaw& law, MovingGrains& grains, ContactList& list, const PeriodicBox& box,
                   std::span<const Plane> walls, const MaterialTable& materials,
                   std::span<const std::uint8_t> material) {
  PairBatch batch(grains, list.pairs, box, materials, material);
  evaluate_pairs(grains, list, box, batch, law);
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

void for_each_contact_end(const GrainStore& store, const ContactList& list, const PeriodicBox& box,
                          std::span<const Plane> walls, const MaterialTable& materials,
                          const ContactEndVisitor& visit) {
  const ContactManner manner = materials.manner(0.0);
  if (materials.law() == Law::linear)
    visit_ends_with(SpringDashpotFriction(manner), store, list, box, walls, materials, visit);
  else
    visit_ends_with(HertzMindlin(manner), store, list, box, walls, materials, visit);
}

}  // namespace thalweg::dem
