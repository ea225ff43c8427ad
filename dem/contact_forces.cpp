#include "dem/contact_forces.hpp"

#include "dem/contact_motion.hpp"
#include "dem/hertz_mindlin.hpp"
#include "dem/pair_batch.hpp"
#include "dem/spring_dashpot.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace thalweg::dem {

namespace {

void forget_springs(ContactList& list, std::size_t pair) {
  std::fill_n(list.pairs[pair].spring, 3, 0.0);
  if (!list.rolling_pairs.empty()) std::fill_n(list.rolling_pairs[pair].spring, 3, 0.0);
}

// Finds the near ones of all pairs; springs of pairs that do not touch are zero.
void look_for_near_pairs(const MovingGrains& grains, ContactList& list, const MinimumImage& image) {
  list.near.begin();
  const double range = list.near.range();
  for (std::size_t p = 0; p < list.pairs.size(); ++p) {
    const PairContact& c = list.pairs[p];
    const Row d = image(grains[c.first].position - grains[c.second].position), square = d * d;
    const double squared = square[0] + square[1] + square[2], limit = c.reach + range;
    if (squared < limit * limit)
      list.near.add({c.first, c.second, static_cast<std::uint32_t>(p)});
    else
      forget_springs(list, p);
  }
}

template <bool fetch, typename Batch, typename ContactLaw>
void evaluate_near_pairs(const std::vector<NearPair>& near, Batch& batch, const ContactLaw& law) {
  const std::span<const NearPair> all(near);
  constexpr std::size_t size = Batch::capacity, ahead = 24;
  for (std::size_t n = 0; n < all.size(); n += size)
    batch.template evaluate<fetch>(all.subspan(n, std::min(size, all.size() - n)),
                                   all.subspan(std::min(n + ahead, all.size())), law);
}

template <bool rolling, typename ContactLaw>
void evaluate_pairs(MovingGrains& grains, ContactList& list, const PeriodicBox& box, const MaterialTable& materials,
                    std::span<const std::uint8_t> material, const ContactLaw& law) {
  PairBatch<rolling> batch(grains, list, box, materials, material);
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
void add_rolling_on_wall(MovingGrain& grain, const ContactMotion& motion, const ContactForce& f,
                         const ContactCoefficients& coefficients, double damping_ratio, RollingContact& c,
                         const ContactLaw& law) {
  const RollingMoment m = rolling_moment(
      motion, grain.spin[0], grain.spin[1], grain.spin[2], f.normal, law.normal_spring(motion, coefficients),
      {c.friction, damping_ratio, c.inertia}, {c.spring[0], c.spring[1], c.spring[2]});
  c.spring[0] = m.spring.x, c.spring[1] = m.spring.y, c.spring[2] = m.spring.z;
  grain.torque += Row{m.x, m.y, m.z, 0.0};
}

// rolling: of every contact, or of none.
template <typename ContactLaw>
void evaluate_walls(MovingGrains& grains, std::vector<WallContact>& contacts, std::span<RollingContact> rolling,
                    const PeriodicBox& box, std::span<const Plane> walls, const MaterialTable& materials,
                    std::span<const std::uint8_t> material, const ContactLaw& law) {
  for (std::size_t number = 0; number < contacts.size(); ++number) {
    WallContact& c = contacts[number];
    MovingGrain& grain = grains[c.grain];
    const Plane& wall = walls[c.wall];
    const WallSight sight = wall.seen_from(vector_of(grain.position), box);
    const ContactMotion motion = motion_of(body_of(grain), sight, wall.velocity);
    if (!(motion.overlap > 0.0)) {
      std::fill_n(c.spring, 3, 0.0);
      if (!rolling.empty()) std::fill_n(rolling[number].spring, 3, 0.0);
      continue;
    }
    ContactCoefficients coefficients = materials.wall(material[c.grain]).coefficients;
    coefficients.friction = wall.friction;
    const ContactForce f = law(motion, coefficients, c.damping, {c.spring[0], c.spring[1], c.spring[2]});
    c.spring[0] = f.spring.x, c.spring[1] = f.spring.y, c.spring[2] = f.spring.z;
    const Vec3 tangential(f.tx, f.ty, f.tz);
    grain.force += row_of(f.normal * sight.normal + tangential);
    grain.torque += row_of(sight.distance * tangential.cross(sight.normal));
    if (!rolling.empty())
      add_rolling_on_wall(grain, motion, f, coefficients, materials.rolling_damping(), rolling[number], law);
  }
}

// What observers see: the force on the first body, with springs as they are.
template <typename ContactLaw>
Vec3 force_of(const ContactLaw& law, const ContactMotion& motion, const ContactCoefficients& coefficients,
              double damping, const double (&spring)[3]) {
  const ContactForce f = law(motion, coefficients, damping, {spring[0], spring[1], spring[2]});
  return f.normal * normal_of(motion) + Vec3(f.tx, f.ty, f.tz);
}

// Calls visit(contact, motion, force on the grain) for every wall contact of the list that touches.
template <typename ContactLaw, typename Visitor>
void visit_walls_with(const ContactLaw& law, const GrainStore& store, const ContactList& list, const PeriodicBox& box,
                      std::span<const Plane> walls, const MaterialTable& materials, Visitor&& visit) {
  for (const WallContact& c : list.walls) {
    const Plane& wall = walls[c.wall];
    const ContactMotion motion =
        motion_of(body_of(store, c.grain), wall.seen_from(store.position[c.grain], box), wall.velocity);
    if (!(motion.overlap > 0.0)) continue;
    ContactCoefficients coefficients = materials.wall(store.material[c.grain]).coefficients;
    coefficients.friction = wall.friction;
    visit(c, motion, force_of(law, motion, coefficients, c.damping, c.spring));
  }
}

template <typename ContactLaw>
std::vector<Vec3> wall_forces_with(const ContactLaw& law, const GrainStore& store, const ContactList& list,
                                   const PeriodicBox& box, std::span<const Plane> walls,
                                   const MaterialTable& materials) {
  std::vector<Vec3> forces(list.walls.size(), Vec3::Zero());
  visit_walls_with(law, store, list, box, walls, materials,
                   [&](const WallContact& c, const ContactMotion&, const Vec3& force) {
                     forces[static_cast<std::size_t>(&c - list.walls.data())] = force;
                   });
  return forces;
}

template <typename ContactLaw>
void visit_ends_with(const ContactLaw& law, const GrainStore& store, const ContactList& list, const PeriodicBox& box,
                     std::span<const Plane> walls, const MaterialTable& materials, std::span<const char> chosen,
                     const ContactEndVisitor& visit) {
  const auto wanted = [&](std::size_t slot) { return !store.is_ghost(slot) && (chosen.empty() || chosen[slot] != 0); };
  for (const PairContact& c : list.pairs) {
    const bool first = wanted(c.first), second = wanted(c.second);
    if (!first && !second) continue;
    const Vec3 separation = box.difference(store.position[c.first], store.position[c.second]);
    const ContactMotion motion = motion_of(body_of(store, c.first), body_of(store, c.second), separation);
    if (!(motion.overlap > 0.0)) continue;
    const Vec3 n = normal_of(motion);
    const Vec3 force =
        force_of(law, motion, materials.pair(store.material[c.first], store.material[c.second]).coefficients, c.damping,
                 c.spring);
    const double half = 0.5 * motion.overlap;
    if (first) visit(c.first, {-(store.radius[c.first] - half) * n, force, store.id[c.second], -separation});
    if (second) visit(c.second, {(store.radius[c.second] - half) * n, -force, store.id[c.first], separation});
  }
  visit_walls_with(law, store, list, box, walls, materials,
                   [&](const WallContact& c, const ContactMotion& motion, const Vec3& force) {
                     if (!wanted(c.grain)) return;
                     const Vec3 arm = (motion.overlap - store.radius[c.grain]) * normal_of(motion);
                     visit(c.grain, {arm, force, -1 - static_cast<GlobalId>(c.wall), arm});
                   });
}

template <typename ContactLaw>
void evaluate_with(const ContactLaw& law, MovingGrains& grains, ContactList& list, const PeriodicBox& box,
                   std::span<const Plane> walls, const MaterialTable& materials,
                   std::span<const std::uint8_t> material) {
  if (list.rolling_pairs.empty())
    evaluate_pairs<false>(grains, list, box, materials, material, law);
  else
    evaluate_pairs<true>(grains, list, box, materials, material, law);
  evaluate_walls(grains, list.walls, list.rolling_walls, box, walls, materials, material, law);
}

}  // namespace

void evaluate_contacts(MovingGrains& grains, ContactList& list, const PeriodicBox& box, std::span<const Plane> walls,
                       const MaterialTable& materials, std::span<const std::uint8_t> material, double time_step) {
  const ContactManner manner = materials.manner(time_step);
  if (materials.law() == Law::linear)
    evaluate_with(SpringDashpotFriction(manner), grains, list, box, walls, materials, material);
  else
    evaluate_with(HertzMindlin(manner), grains, list, box, walls, materials, material);
}

std::vector<Vec3> wall_contact_forces(const GrainStore& store, const ContactList& list, const PeriodicBox& box,
                                      std::span<const Plane> walls, const MaterialTable& materials) {
  const ContactManner manner = materials.manner(0.0);
  if (materials.law() == Law::linear)
    return wall_forces_with(SpringDashpotFriction(manner), store, list, box, walls, materials);
  return wall_forces_with(HertzMindlin(manner), store, list, box, walls, materials);
}

void for_each_contact_end(const GrainStore& store, const ContactList& list, const PeriodicBox& box,
                          std::span<const Plane> walls, const MaterialTable& materials, std::span<const char> chosen,
                          const ContactEndVisitor& visit) {
  const ContactManner manner = materials.manner(0.0);
  if (materials.law() == Law::linear)
    visit_ends_with(SpringDashpotFriction(manner), store, list, box, walls, materials, chosen, visit);
  else
    visit_ends_with(HertzMindlin(manner), store, list, box, walls, materials, chosen, visit);
}

}  // namespace thalweg::dem
