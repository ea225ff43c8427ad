#include "coupling/system/grain_bodies.hpp"

#include "bodies/mass_return.hpp"
#include "core/base/check.hpp"
#include "core/base/error.hpp"
#include "core/geometry/sphere.hpp"
#include "core/sums/wide_sums_over_ranks.hpp"

#include <algorithm>
#include <array>

namespace thalweg::coupling {

namespace {

constexpr double link_tolerance = 1e-3;  // cells a grain may move before the cells of its body follow

}  // namespace

template <typename Real>
GrainBodies<Real>::GrainBodies(MPI_Comm communicator, dem::GrainDynamics& grains, bodies::Bodies<Real>& bodies,
                               const PeriodicBox& box, const Units& units, LoadAveraging load)
    : communicator_(communicator),
      grains_(grains),
      bodies_(bodies),
      box_(box),
      units_(units),
      load_(load),
      light_load_{units.density, units.spacing} {}

template <typename Real>
void GrainBodies<Real>::begin_where_grains_are() {
  const dem::GrainStore& store = grains_.store();
  for (std::size_t g = 0; g < store.total(); ++g)
    if (exchange_of(g).exchanges() == 0) exchange_of(g).link_position() = store.position[g];
}

template <typename Real>
void GrainBodies<Real>::place_at_start() {
  bodies_.remove_all();
  bodies_.begin_step();
  synchronise_slots();
  bodies_.template check_count<InputError>(communicator_);
  update_motions();
  bodies_.settle_at_start();
  stresses_.clear();
}

template <typename Real>
void GrainBodies<Real>::set_surroundings(double deviation) {
  for (std::size_t g = 0; g < grains_.store().total(); ++g)
    if (exchange_of(g).exchanges() == 0) exchange_of(g).surrounding() = deviation;
}

template <typename Real>
void GrainBodies<Real>::forget_lattice_units() {
  for (std::size_t g = 0; g < grains_.store().total(); ++g) exchange_of(g).forget_lattice_units();
}

template <typename Real>
void GrainBodies<Real>::move_bodies(bool slots_changed) {
  if (slots_changed) {
    synchronise_slots();
    bodies_.template check_count<RunError>(communicator_);
  }
  update_motions();
  update_cells();
}

template <typename Real>
void GrainBodies<Real>::take_loads() {
  collect();
  apply();
  apply_stresses();
  settle_masses();
  grains_.refresh_ghost_attached(GrainExchange<double>::first_shared, GrainExchange<double>::shared);
}

// Bodies for the grains that are in reach of this rank, and no others.
template <typename Real>
void GrainBodies<Real>::synchronise_slots() {
  const dem::GrainStore& store = grains_.store();
  std::vector<char> present(bodies_.mapped().size(), 0);
  slot_.resize(store.total());
  for (std::size_t g = 0; g < store.total(); ++g) {
    slot_[g] = bodies_.slot_of(store.id[g]);
    if (slot_[g] != bodies::BodySlot::none) present[index_of(slot_[g])] = 1;
  }
  for (std::size_t slot = 0; slot < present.size(); ++slot)
    if (!present[slot] && bodies_.mapped()[slot].id >= 0) bodies_.remove(bodies::slot_at(slot));
  for (std::size_t g = 0; g < store.total(); ++g)
    if (slot_[g] == bodies::BodySlot::none)
      slot_[g] = bodies_.add(store.id[g], store.radius[g] / units_.spacing, store.clump[g],
                             lattice_position(exchange_of(g).link_position()));
}

template <typename Real>
void GrainBodies<Real>::update_motions() {
  const dem::GrainStore& store = grains_.store();
  CHECK(slot_.size() == store.total());
  for (std::size_t g = 0; g < store.total(); ++g) {
    const GrainExchange<double> kept = exchange_of(g);
    bodies_.move(slot_[g], {lattice_position(store.position[g]), store.velocity[g] / units_.velocity(),
                            store.angular_velocity[g] * units_.time_step, kept.returned_density(),
                            kept.returned_slope(), kept.surrounding()});
  }
}

// Cells follow a grain once it has moved by the tolerance; links know its place exactly all the same. Ghosts follow the
// same rule from the same numbers as their owners, so every rank moves a grain's cells in the same step.
template <typename Real>
void GrainBodies<Real>::update_cells() {
  dem::GrainStore& store = grains_.store();
  const double tolerance = link_tolerance * units_.spacing;
  for (std::size_t g = 0; g < store.total(); ++g) {
    const GrainExchange<double> kept = exchange_of(g);
    const Vec3 moved = box_.difference(store.position[g], kept.link_position());
    if (moved.squaredNorm() <= tolerance * tolerance) continue;
    kept.link_position() = store.position[g];
    bodies_.remap(slot_[g], lattice_position(store.position[g]));
  }
}

template <typename Real>
void GrainBodies<Real>::collect() {
  const std::size_t count = grains_.store().total();
  CHECK(slot_.size() == count);
  const bool with_stress = bodies_.has_moments();
  sums_.begin(count, with_stress);
  std::vector<std::array<std::int64_t, 3>> occluded;
  if (with_stress) occluded = bodies_.occluded_by_solids();
  for (std::size_t g = 0; g < count; ++g) {
    const bodies::LinkBody& body = bodies_.body(slot_[g]);
    sums_.set(g, GrainSums{body.force, body.torque, body.mass, body.pressure, bodies_.link_sums(slot_[g])});
    if (with_stress) sums_.set(g, StressSums{bodies_.moments(slot_[g]), occluded[index_of(slot_[g])]});
  }
  grains_.add_ghost_values(sums_.values(), sums_.width());
}

template <typename Real>
void GrainBodies<Real>::apply() {
  for (std::size_t g = 0; g < grains_.store().owned; ++g) {
    const GrainSums sums = sums_.of(g);
    const Vec3 force = sums.force.to_vec3() * units_.force();
    const Vec3 torque = sums.torque.to_vec3() * units_.torque();
    const GrainExchange<double> kept = exchange_of(g);
    set_load(g, force, torque);
    kept.earlier_force() = kept.last_force();
    kept.earlier_torque() = kept.last_torque();
    kept.last_force() = force;
    kept.last_torque() = torque;
    kept.set_exchanges(std::min(kept.exchanges() + 1, 2));
  }
}

// Settles the mass of a grain, or of a clump whose members are in the slots from `first` on.
template <typename Real>
void GrainBodies<Real>::settle_mass(std::size_t first, std::size_t count) {
  bodies::LinkSums links;
  std::int64_t sum = 0;
  double came_back = 0.0;
  for (std::size_t g = first; g < first + count; ++g) {
    const GrainSums sums = sums_.of(g);
    const bodies::LinkBody& body = bodies_.body(slot_[g]);
    links += sums.links;
    sum = exact_sum(sum, sums.mass);
    came_back += bodies::MassReturn{body.returned, body.returned_slope}.mass(sums.links);
    // A grain without links has no fluid around it: what was there last stays.
    const double weight = sums.links.weight();
    if (weight > 0.0) exchange_of(g).surrounding() = LatticeFixed::to_double(sums.pressure) / weight;
  }
  const GrainExchange<double> kept = exchange_of(first);
  bodies::MassDebt debt{kept.owed_mass(), kept.mean_loss(), kept.wanted_return()};
  const bodies::MassReturn next = debt.settle(LatticeFixed::to_double(sum), came_back, links);
  kept.owed_mass() = debt.owed;
  kept.mean_loss() = debt.mean_loss;
  kept.wanted_return() = debt.wanted;
  for (std::size_t g = first; g < first + count; ++g) {
    exchange_of(g).returned_density() = next.density;
    exchange_of(g).returned_slope() = next.slope;
  }
}

template <typename Real>
void GrainBodies<Real>::settle_masses() {
  const dem::GrainStore& store = grains_.store();
  for (std::size_t g = 0; g < store.owned; ++g)
    if (store.clump[g] < 0) settle_mass(g, 1);
  const dem::Clumps& clumps = grains_.clumps();
  for (std::size_t n = 0; n < clumps.size(); ++n)
    settle_mass(clumps.first_slot(n), static_cast<std::size_t>(clumps[n].members));
}

// Multiples of 2^-44, whose sum in any order is exact. A grain may owe more than a term of LatticeFixed holds: a large
// clump that closes a gap covers thousands of cells in a few steps, and returns their mass as slowly as its links
// allow.
template <typename Real>
double GrainBodies<Real>::mass_owed() const {
  WideSum owed;
  for (std::size_t g = 0; g < grains_.store().owned; ++g)
    owed.add(WideSum::from(exchange_of(g).owed_mass(), LatticeFixed::bits));
  sum_over_ranks(communicator_, {&owed, 1});
  return owed.to_double(LatticeFixed::bits);
}

// sum F_a x_b of what the fluid presses where solids hide the grain, F = 2 D h, x on the surface against h; lattice
// units (bodies/map/occluded_patches.hpp).
template <typename Real>
Mat3 GrainBodies<Real>::moment_occluded_by_solids(std::size_t grain) const {
  const std::array<std::int64_t, 3> sums = sums_.stress_of(grain).occluded_by_solids;
  const Vec3 h = Vec3(static_cast<double>(sums[0]), static_cast<double>(sums[1]), static_cast<double>(sums[2])) / 36.0;
  if (h.isZero(0.0)) return Mat3::Zero();
  const double excess = exchange_of(grain).surrounding() - bodies_.reference_density();
  const double radius = grains_.store().radius[grain] / units_.spacing;
  return -2.0 * excess * radius / h.norm() * (h * h.transpose());
}

// sigma_ab = (1/V) sum F_a x_b over the surface (Zhang et al. 2022, eq. 13), of this exchange.
template <typename Real>
Mat3 GrainBodies<Real>::stress_of(std::size_t grain) const {
  const double volume = Sphere{grains_.store().radius[grain]}.volume();
  return (sums_.stress_of(grain).moments.to_mat3() + moment_occluded_by_solids(grain)) * (units_.torque() / volume);
}

// The mean of two exchanges where the one before has measured it as well. What is not measured is zero in a checkpoint,
// whatever was measured before.
template <typename Real>
void GrainBodies<Real>::apply_stresses() {
  const bool measured = bodies_.has_moments();
  stresses_.resize(measured ? grains_.store().owned : 0);
  for (std::size_t g = 0; g < grains_.store().owned; ++g) {
    const GrainExchange<double> kept = exchange_of(g);
    if (measured) {
      const Mat3 stress = stress_of(g);
      stresses_[g] = kept.has_last_stress() ? Mat3(0.5 * (stress + kept.last_stress())) : stress;
      kept.last_stress() = stress;
    } else if (kept.has_last_stress()) {
      kept.last_stress().setZero();
    }
    kept.set_has_last_stress(measured);
  }
}

// Averages this exchange and those before it. For a light grain, the store holds the load of the step before; what is
// filtered is the torque of one that may turn, although its place be held, and the force on one that may move. A force
// on a member turns its clump as well.
template <typename Real>
void GrainBodies<Real>::set_load(std::size_t grain, const Vec3& force, const Vec3& torque) {
  dem::GrainStore& store = grains_.store();
  const GrainExchange<const double> kept = std::as_const(*this).exchange_of(grain);
  const LightLoad::Grain body{store.mass[grain], grains_.volume_radius(grain), grains_.width(grain)};
  const dem::Motion motion = store.motion[grain];
  const bool is_light = light_load_.concerns(body), turns = !dem::holds_rotation(motion);
  const bool force_moves = !dem::holds_translation(motion) || (dem::is_member(motion) && turns);
  const double share = light_load_.share(body);
  if (is_light && force_moves) {
    const Vec3 weight = grains_.body_force(grain);
    const Vec3 before =
        kept.exchanges() == 0 ? Vec3::Zero() : Vec3(store.load_force[grain] + grains_.kept_body_force(grain));
    const Vec3 mean = averaged_load(LoadAveraging::mean, force, kept.last_force(), kept.earlier_force());
    store.load_force[grain] = LightLoad::filtered(before, mean + weight, share) - weight;
  } else {
    store.load_force[grain] = averaged_load(load_, force, kept.last_force(), kept.earlier_force());
  }
  if (is_light && turns) {
    const Vec3 mean = averaged_load(LoadAveraging::mean, torque, kept.last_torque(), kept.earlier_torque());
    store.load_torque[grain] = LightLoad::filtered(store.load_torque[grain], mean, share);
  } else {
    store.load_torque[grain] = averaged_load(load_, torque, kept.last_torque(), kept.earlier_torque());
  }
}

template class GrainBodies<float>;
template class GrainBodies<double>;

}  // namespace thalweg::coupling
