#include "dem/grain_dynamics.hpp"

#include "core/parallel/mpi_session.hpp"
#include "dem/grain_validity.hpp"
#include "dem/ranks/grain_balance.hpp"

#include <algorithm>

namespace thalweg::dem {

bool GrainDynamics::prepare() {
  const auto scope = timer_.measure(lists_phase_);
  return rebuild_for(look_ahead(), parameters_.sub_steps);
}

int GrainDynamics::prepare_part() {
  // Part of the way that a fresh list allows at twice the largest speed. Since grains are slower, most parts need no
  // new list.
  constexpr double part = 0.25;
  const auto scope = timer_.measure(lists_phase_);
  const Outlook outlook = look_ahead();
  const double steps = part * 0.5 * parameters_.skin / (outlook.fastest * parameters_.time_step);  // infinite at rest
  const int allowed = static_cast<int>(std::clamp(steps, 1.0, static_cast<double>(parameters_.sub_steps)));
  rebuild_for(outlook, allowed);
  return allowed;
}

bool GrainDynamics::rebuild_for(const Outlook& outlook, int sub_steps) {
  const double way = outlook.fastest * sub_steps * parameters_.time_step;
  if (outlook.farthest + way <= 0.5 * parameters_.skin) return false;
  rebuild();
  return true;
}

// Wraps positions and checks the validity of the grains.
GrainDynamics::Outlook GrainDynamics::look_ahead() {
  wrap_positions();
  // Bounds until the next call: a grain at rest can be thrown at no more than about twice the largest speed, and the
  // loads accelerate it.
  double farthest = 0.0, fastest = largest_prescribed_speed();
  bool faulty = false;
  const GrainValidity validity{GrainSpace(box_, planes_), parameters_.skin, parameters_.time_step,
                               parameters_.sub_steps, deep_in_solids()};
  for (std::size_t w = 0; w < planes_.size(); ++w)
    farthest = std::max(farthest, planes_[w].moved_since(listed_planes_[w]));
  for (std::size_t n = 0; n < solids_.size(); ++n)
    farthest = std::max(farthest, solids_[n].moved_since(listed_solids_[n]));
  for (std::size_t s = 0; s < store_.owned; ++s) {
    const double displacement = box_.difference(store_.position[s], listed_position_[s]).norm();
    const double speed = store_.velocity[s].norm();
    const double pull = (store_.load_force[s] + body_force_[s]).norm() * store_.inverse_mass[s];
    farthest = std::max(farthest, displacement);
    fastest = std::max(fastest, 2.0 * speed + pull * step_time());
    faulty = faulty || validity.fault_of(store_, s, displacement) != GrainFault::none;
  }
  fastest = std::max(fastest, fastest_member());
  const double mine[3] = {farthest, fastest, faulty ? 1.0 : 0.0};
  double all[3];
  MPI_Allreduce(mine, all, 3, MPI_DOUBLE, MPI_MAX, communicator_);
  if (all[2] != 0.0) validity.throw_first(store_, box_, listed_position_, communicator_);
  return {all[0], all[1]};
}

std::vector<std::size_t> GrainDynamics::deep_in_solids() const {
  std::vector<std::size_t> deep;
  SolidTouches touches(box_, solids_, parameters_.solids);
  SolidTouches::for_each_grain(list_.solids, [&](std::size_t first, std::size_t last) {
    const std::uint32_t slot = list_.solids[first].grain;
    if (touches.is_deep(list_.solids, first, last, store_.position[slot], store_.radius[slot])) deep.push_back(slot);
  });
  return deep;
}

// A hit off the centre throws the far end of a clump faster than the near one.
double GrainDynamics::fastest_member() const {
  double speed = 0.0;
  for (std::size_t n = 0; n < clumps_.size(); ++n)
    for (std::int64_t m = 0; m < clumps_[n].members; ++m)
      speed = std::max(speed, store_.velocity[clumps_.first_slot(n) + static_cast<std::size_t>(m)].norm());
  return 3.0 * speed + clumps_.largest_pull(store_) * step_time();
}

void GrainDynamics::wrap_positions() {
  for (Vec3& x : store_.position) x = box_.wrapped(x);
  clumps_.wrap(box_);
}

void GrainDynamics::rebuild() { rebuild_with(histories_of(list_, store_, planes_.size())); }

void GrainDynamics::rebuild_with(ContactHistories histories) {
  if (size_of(communicator_) > 1) {
    if (parameters_.movable_cuts) move_cuts();
    migrate(histories);
  }
  build_dependents(histories);
  ++rebuilds_;
}

void GrainDynamics::move_cuts() {
  const std::optional<Decomposition> moved = balanced_cuts(decomposition_, store_, communicator_);
  if (!moved) return;
  decomposition_ = *moved;
  ghosts_ = GhostExchange(decomposition_, communicator_, ghost_reach(), largest_offset_);
}

void GrainDynamics::migrate(ContactHistories& histories) {
  const int me = rank_of(communicator_);
  std::vector<int> owner(store_.owned);
  for (std::size_t s = 0; s < store_.owned; ++s) owner[s] = decomposition_.owner_of(store_.position[s]);
  clumps_.assign_owners(decomposition_, owner);

  // Both grains of a contact take its history along. Ids of ghosts and walls are not found: not this rank's to move.
  const auto new_owner = [&](GlobalId id) {
    const auto end = store_.id.begin() + static_cast<std::ptrdiff_t>(store_.owned);
    const auto found = std::lower_bound(store_.id.begin(), end, id);
    return found != end && *found == id ? owner[static_cast<std::size_t>(found - store_.id.begin())] : me;
  };
  ContactHistories leaving(histories.width());
  std::vector<int> destination;
  for (std::size_t n = 0; n < histories.size(); ++n)
    for (const GlobalId id : {histories.key(n).first, histories.key(n).second})
      if (const int to = new_owner(id); to != me) {
        leaving.add(histories.key(n), histories.values(n));
        destination.push_back(to);
      }
  const ContactHistories arrived = leaving.exchanged(communicator_, destination);
  if (arrived.size() > 0) {
    histories.add(arrived);
    histories.sort();
  }
  move_grains(communicator_, store_, owner);
  if (clump_count_ > 0) clumps_.migrate(decomposition_, communicator_);
}

// Makes everything that follows from the owned grains: ghosts, neighbour list, body forces.
void GrainDynamics::build_dependents(const ContactHistories& histories) {
  acting_ = {};
  clumps_.find_members(store_);
  if (parameters_.field) parameters_.field->fill_columns(store_, clumps_);
  ghosts_.build(store_);
  assemblies_.find(store_);
  listed_planes_ = planes_;
  listed_solids_ = solids_;
  list_ = find_contacts(store_, surroundings(), materials_, list_range(), largest_radius_);
  if (!parameters_.field) ghosts_.follow(list_.pairs, store_);  // a field may look further than contacts
  restore_histories(list_, store_, planes_.size(), histories);
  if (parameters_.field) parameters_.field->find_neighbours(store_, parameters_.skin, clumps_);
  const auto owned_end = static_cast<std::ptrdiff_t>(store_.owned);
  listed_position_.assign(store_.position.begin(), store_.position.begin() + owned_end);
  compute_body_forces();
}

}  // namespace thalweg::dem
