// Diagnostics of the state of all grains: GrainDynamics looked at, never changed.
#include "core/parallel/mpi_session.hpp"
#include "core/sums/reproducible_sum.hpp"
#include "dem/contact/contact_forces.hpp"
#include "dem/contact/wall_touches.hpp"
#include "dem/distributed_argmax.hpp"
#include "dem/grain_dynamics.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::dem {

namespace {

// Calls visit(pair, overlap, separation) for every touching pair of the list whose lower id is owned.
template <typename Visitor>
void for_each_touching(const NeighbourList& list, const GrainStore& store, const PeriodicBox& box, Visitor&& visit) {
  for (const PairContact& c : list.pairs) {
    if (store.is_ghost(c.first)) continue;
    const Vec3 separation = box.difference(store.position[c.first], store.position[c.second]);
    const double overlap = c.reach - separation.norm();
    if (overlap > 0.0) visit(c, overlap, separation);
  }
}

// Overlaps between grains that are held do not count: those of a bumpy wall overlap on purpose.
double overlap_in_diameters(const GrainStore& store, const PairContact& c, double overlap) {
  if (holds_translation(store.motion[c.first]) && holds_translation(store.motion[c.second])) return 0.0;
  return overlap / (2.0 * std::min(store.radius[c.first], store.radius[c.second]));
}

}  // namespace

std::string solid_force_diagnostic(std::size_t solid) { return fmt::format("solid_{}_grain_force", solid); }

std::vector<Contact> GrainDynamics::contacts() const {
  const auto kept = [](std::span<const double> history) { return std::vector<double>(history.begin(), history.end()); };
  std::vector<Contact> touching;
  for_each_touching(list_, store_, box_, [&](const PairContact& c, double overlap, const Vec3& separation) {
    const auto number = static_cast<std::size_t>(&c - list_.pairs.data());
    touching.push_back({store_.id[c.first], store_.id[c.second], overlap, separation.normalized(),
                        kept(list_.pair_rows.history_of(number))});
  });
  const auto add = [&](const WallTouch& touch, const ContactRows& rows) {
    const double overlap = store_.radius[touch.slot] - touch.view.distance;
    if (overlap > 0.0)
      touching.push_back(
          {store_.id[touch.slot], touch.partner(), overlap, touch.view.normal, kept(rows.history_of(touch.row))});
  };
  for_each_wall_touch(store_, list_, surroundings(), [&](const WallTouch& touch) { add(touch, list_.wall_rows); });
  for_each_solid_touch(store_, list_, surroundings(), 0.0,
                       [&](const WallTouch& touch) { add(touch, list_.solid_rows); });
  return touching;
}

// Vectors (m) from the centre of a member's clump to the member, for every owned grain; empty without clumps.
std::vector<Vec3> GrainDynamics::places_in_clumps() const {
  std::vector<Vec3> from_centre(clumps_.empty() ? 0 : store_.owned, Vec3::Zero());
  for (std::size_t n = 0; n < clumps_.size(); ++n)
    for (std::size_t m = 0; m < static_cast<std::size_t>(clumps_[n].members); ++m) {
      const std::size_t slot = clumps_.first_slot(n) + m;
      from_centre[slot] = box_.difference(store_.position[slot], clumps_[n].centre);
    }
  return from_centre;
}

// Forces with which the rough floor holds grains along it: contact_force less the forces of the contacts.
void GrainDynamics::for_each_hold(std::span<const char> chosen, const ContactSource::ContactEndVisitor& visit) const {
  if (!rough_floor_) return;
  std::vector<char> held(store_.owned, 0);  // members of a clump with all of it
  for_each_held([this](std::size_t s) { return touches_rough_floor(store_.position[s].z(), store_.radius[s]); },
                [&](std::size_t s) { held[s] = 1; },
                [&](std::size_t n) {
                  std::fill_n(held.begin() + static_cast<std::ptrdiff_t>(clumps_.first_slot(n)),
                              clumps_.member_count(n), 1);
                });
  std::vector<Vec3> hold(store_.contact_force.begin(),
                         store_.contact_force.begin() + static_cast<std::ptrdiff_t>(store_.owned));
  for_each_contact_end(acting_grains(), list_, acting_surroundings(), materials_, held,
                       [&](std::size_t slot, const ContactEnd& end) { hold[slot] -= end.force; });
  for (std::size_t s = 0; s < store_.owned; ++s) {
    if (!held[s] || (!chosen.empty() && !chosen[s])) continue;
    const double depth = store_.position[s].z() - planes_[*rough_floor_].point.z();
    visit(s, {Vec3(0.0, 0.0, -depth), Vec3(hold[s].x(), hold[s].y(), 0.0), -1 - static_cast<GlobalId>(*rough_floor_),
              Vec3(0.0, 0.0, -depth)});
  }
}

void GrainDynamics::for_each_contact(
    const std::function<void(std::size_t slot, const Vec3& arm, const Vec3& force)>& visit) const {
  const std::vector<Vec3> from_centre = places_in_clumps();
  for_each_contact_of({}, [&](std::size_t slot, const ContactEnd& end) {
    visit(slot, from_centre.empty() ? end.arm : Vec3(end.arm + from_centre[slot]), end.force);
  });
}

void GrainDynamics::for_each_lubrication(
    const std::function<void(std::size_t slot, const Vec3& arm, const Vec3& force)>& visit) const {
  if (!parameters_.lubrication) return;
  const std::vector<Vec3> from_centre = places_in_clumps();
  for_each_lubrication_end(acting_grains(), list_, acting_surroundings(), *parameters_.lubrication,
                           [&](std::size_t slot, const Vec3& arm, const Vec3& force) {
                             visit(slot, from_centre.empty() ? arm : Vec3(arm + from_centre[slot]), force);
                           });
}

void GrainDynamics::for_each_contact_of(
    std::span<const char> chosen, const std::function<void(std::size_t slot, const ContactEnd& end)>& visit) const {
  for_each_contact_end(acting_grains(), list_, acting_surroundings(), materials_, chosen, visit);
  for_each_hold(chosen, visit);
}

void GrainDynamics::for_each_wall_force(
    const std::function<void(std::size_t slot, const ContactEnd& end)>& visit) const {
  for_each_wall_contact(acting_grains(), list_, acting_surroundings(), materials_, visit);
  for_each_hold({}, visit);
  if (parameters_.lubrication)
    for_each_wall_lubrication(acting_grains(), list_, acting_surroundings(), *parameters_.lubrication, visit);
}

std::vector<Vec3> GrainDynamics::wall_forces() const {
  const std::size_t walls = planes_.size() + solids_.size();
  std::vector<double> terms;  // 3 * walls of each force
  for_each_wall_force([&](std::size_t /*slot*/, const ContactEnd& end) {
    const auto wall = static_cast<std::size_t>(-1 - end.partner);
    const std::size_t first = terms.size();
    terms.resize(first + 3 * walls, 0.0);
    for (std::size_t axis = 0; axis < 3; ++axis)
      terms[first + 3 * wall + axis] = -end.force[static_cast<Eigen::Index>(axis)];
  });
  const std::vector<double> sums = reproducible_sums(communicator_, terms, 3 * walls);
  std::vector<Vec3> forces;
  for (std::size_t w = 0; w < walls; ++w) forces.emplace_back(sums[3 * w], sums[3 * w + 1], sums[3 * w + 2]);
  return forces;
}

std::int64_t GrainDynamics::contact_count() const {
  std::int64_t count = 0;
  for_each_touching(list_, store_, box_, [&](const PairContact&, double, const Vec3&) { ++count; });
  return sum_over_ranks(communicator_, count);
}

// Calls visit(touch, overlap in diameters) for every grain of this rank that is not held and reaches into a wall or a
// solid. A grain that is held does so on purpose.
template <typename Visitor>
void GrainDynamics::for_each_wall_overlap(Visitor&& visit) const {
  const auto look = [&](const WallTouch& touch) {
    const double radius = store_.radius[touch.slot], overlap = radius - touch.view.distance;
    if (overlap > 0.0 && !holds_translation(store_.motion[touch.slot])) visit(touch, overlap / (2.0 * radius));
  };
  for_each_wall_touch(store_, list_, surroundings(), look);
  for_each_solid_touch(store_, list_, surroundings(), 0.0, look);
}

double GrainDynamics::largest_overlap() const {
  double largest = 0.0;
  for_each_touching(list_, store_, box_, [&](const PairContact& c, double overlap, const Vec3&) {
    largest = std::max(largest, overlap_in_diameters(store_, c, overlap));
  });
  for_each_wall_overlap([&](const WallTouch&, double overlap) { largest = std::max(largest, overlap); });
  return max_over_ranks(communicator_, largest);
}

std::optional<Location> GrainDynamics::place_of_deepest_overlap() const {
  DistributedArgmax deepest;
  for_each_touching(list_, store_, box_, [&](const PairContact& c, double overlap, const Vec3& separation) {
    deepest.consider({overlap_in_diameters(store_, c, overlap), store_.id[c.first], store_.id[c.second],
                      box_.wrapped(store_.position[c.second] + 0.5 * separation)});
  });
  for_each_wall_overlap([&](const WallTouch& touch, double overlap) {
    deepest.consider({overlap, store_.id[touch.slot], -1, store_.position[touch.slot]});
  });
  return deepest.over_ranks(communicator_);
}

std::optional<Location> GrainDynamics::place_of_fastest() const {
  DistributedArgmax fastest;
  for (std::size_t s = 0; s < store_.owned; ++s)
    if (store_.clump[s] < 0) fastest.consider({store_.velocity[s].norm(), store_.id[s], -1, store_.position[s]});
  for (std::size_t n = 0; n < clumps_.size(); ++n)
    fastest.consider({clumps_[n].velocity.norm(), clumps_[n].id, -1, clumps_[n].centre});
  return fastest.over_ranks(communicator_);
}

// Calls visit(mass, velocity, kinetic energy, motion, force) for every grain and clump owned here; force: N, of all
// kinds, calculated only where the visitor calls it.
template <typename Visitor>
void GrainDynamics::for_each_body(Visitor&& visit) const {
  for (std::size_t s = 0; s < store_.owned; ++s) {
    if (store_.clump[s] >= 0) continue;
    const double energy = 0.5 * store_.mass[s] * store_.velocity[s].squaredNorm() +
                          0.5 * store_.inertia[s] * store_.angular_velocity[s].squaredNorm();
    visit(store_.mass[s], store_.velocity[s], energy, store_.motion[s],
          [&]() -> Vec3 { return store_.contact_force[s] + store_.load_force[s] + body_force_[s]; });
  }
  for (std::size_t n = 0; n < clumps_.size(); ++n) {
    const Clump& clump = clumps_[n];
    visit(clump.mass, clump.velocity, clump.kinetic_energy(), clump.motion, [&] { return clumps_.force(n, store_); });
  }
}

void GrainDynamics::show_clumps(GrainView& view) const {
  if (clump_count_ == 0) return;
  view.clump_count = clump_count_;
  view.member_count = member_count_;
  view.clump = {store_.clump.data(), store_.owned};
  for (std::size_t n = 0; n < clumps_.size(); ++n) {
    const Clump& clump = clumps_[n];
    const Quaternion& q = clump.orientation;
    view.clumps.push_back({clump.id,
                           clump.mass,
                           clump.volume,
                           clump.centre,
                           clump.velocity,
                           clump.kinetic_energy(),
                           {q.w, q.x, q.y, q.z},
                           holds_translation(clump.motion),
                           clump.moments,
                           clump.angular_velocity});
  }
}

std::span<const std::uint8_t> GrainDynamics::motion() const {
  static_assert(static_cast<int>(Motion::held_translation) == 1 && static_cast<int>(Motion::held_rotation) == 2);
  return {reinterpret_cast<const std::uint8_t*>(store_.motion.data()), store_.owned};
}

double GrainDynamics::kinetic_energy() const {
  std::vector<double> energies;
  for_each_body([&](double, const Vec3&, double energy, Motion, auto&&) { energies.push_back(energy); });
  return reproducible_sums(communicator_, energies, 1)[0];
}

Vec3 GrainDynamics::momentum() const {
  std::vector<double> terms;
  terms.reserve(3 * store_.owned);
  for_each_body([&](double mass, const Vec3& velocity, double, Motion, auto&&) {
    for (int axis = 0; axis < 3; ++axis) terms.push_back(mass * velocity[axis]);
  });
  const std::vector<double> sums = reproducible_sums(communicator_, terms, 3);
  return {sums[0], sums[1], sums[2]};
}

double GrainDynamics::largest_speed() const {
  double largest = 0.0;
  for_each_body(
      [&](double, const Vec3& velocity, double, Motion, auto&&) { largest = std::max(largest, velocity.norm()); });
  return max_over_ranks(communicator_, largest);
}

double GrainDynamics::largest_free_speed() const {
  double largest = 0.0;
  for_each_body([&](double, const Vec3& velocity, double, Motion motion, auto&&) {
    if (!holds_translation(motion)) largest = std::max(largest, velocity.norm());
  });
  return max_over_ranks(communicator_, largest);
}

double GrainDynamics::largest_acceleration() const {
  double largest = 0.0;
  for_each_body([&](double mass, const Vec3&, double, Motion motion, auto&& force) {
    if (!holds_translation(motion)) largest = std::max(largest, force().norm() * (1.0 / mass));
  });
  return max_over_ranks(communicator_, largest);
}

std::int64_t GrainDynamics::restless_count(double speed, double acceleration) const {
  std::int64_t count = 0;
  for_each_body([&](double mass, const Vec3& velocity, double, Motion motion, auto&& force) {
    const bool at_rest = velocity.norm() < speed && force().norm() * (1.0 / mass) < acceleration;
    if (!holds_translation(motion) && !at_rest) ++count;
  });
  return sum_over_ranks(communicator_, count);
}

std::int64_t GrainDynamics::moving_count(double speed) const {
  std::int64_t count = 0;
  for_each_body([&](double, const Vec3& velocity, double, Motion motion, auto&&) {
    if (!holds_translation(motion) && velocity.norm() > speed) ++count;
  });
  return sum_over_ranks(communicator_, count);
}

std::int64_t GrainDynamics::free_count() const { return moving_count(-1.0); }

double GrainDynamics::moving_share(double speed) const {
  const std::int64_t moving = moving_count(speed), free = free_count();
  return free > 0 ? static_cast<double>(moving) / static_cast<double>(free) : 0.0;
}

}  // namespace thalweg::dem
