#include "dem/grain_dynamics.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_all_ranks.hpp"
#include "dem/contact/contact_forces.hpp"
#include "dem/grain_watch.hpp"
#include "dem/motion/grain_volume.hpp"
#include "dem/ranks/grain_balance.hpp"
#include "dem/ranks/grain_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace thalweg::dem {

namespace {

const GrainParameters& checked(const GrainParameters& p) {
  for (const Plane& wall : p.walls) check(wall);
  for (const Solid& solid : p.solids) check(solid);
  if (p.sub_steps < 1)
    throw InputError(fmt::format("The number of grain sub-steps is {}; it must be positive.", p.sub_steps));
  if (!(p.skin > 0.0))
    throw InputError(fmt::format("The skin of the contact list is {:g} m; it must be positive.", p.skin));
  if (!(p.ghost_width >= 0.0))
    throw InputError(fmt::format("The ghost width of the grains is {:g} m; it must not be negative.", p.ghost_width));
  return p;
}

MaterialTable table_of(const GrainParameters& p) {
  std::vector<ContactParameters> materials{p.contact};
  materials.insert(materials.end(), p.other_materials.begin(), p.other_materials.end());
  if (materials.size() > 255) throw InputError("There are more than 255 materials of grains; use fewer.");
  return MaterialTable(materials, p.wall_contact);
}

int columns_of(const GrainParameters& p) {
  return p.attached_width + (p.integrator == Integrator::gear ? GearPredictor::columns : 0);
}

}  // namespace

void check_time_step(const GrainParameters& p, std::span<const LightestGrain> lightest, std::int64_t count) {
  // Two of the lightest grains have the shortest contact; a single grain has only walls to touch.
  const double share = count > 1 ? 0.5 : 1.0;
  for (std::size_t m = 0; m < lightest.size(); ++m) {
    const ContactParameters& material = m == 0 ? p.contact : p.other_materials[m - 1];
    const LightestGrain& grain = lightest[m];
    if (!std::isfinite(grain.mass)) continue;
    check_time_step(material, share * grain.mass, share * grain.hertzian_radius(), p.time_step);
    if (p.wall_contact)
      check_wall_time_step(material, *p.wall_contact, grain.mass, grain.hertzian_radius(), p.time_step);
  }
}

void check_lubrication(const GrainParameters& parameters, std::span<const LightestGrain> lightest,
                       double largest_radius, const PeriodicBox& box) {
  if (!parameters.lubrication) return;
  double radius_per_mass = 0.0;
  for (const LightestGrain& grain : lightest) radius_per_mass = std::max(radius_per_mass, grain.radius_per_mass);
  check(*parameters.lubrication, largest_radius, radius_per_mass, box, parameters.time_step);
}

GrainDynamics::GrainDynamics(const Decomposition& decomposition, MPI_Comm communicator,
                             const GrainParameters& parameters, GrainSeeds seeds)
    : decomposition_(decomposition),
      box_(decomposition.box()),
      communicator_(communicator),
      parameters_(checked(parameters)),
      materials_(table_of(parameters)),
      largest_radius_(max_over_ranks(communicator, largest_radius_of(seeds.grains, seeds.clumps))),
      largest_offset_(max_over_ranks(communicator, largest_offset_of(seeds.clumps))),
      walls_change_(std::any_of(parameters.walls.begin(), parameters.walls.end(),
                                [](const Plane& wall) { return wall.changes(); })),
      solids_change_(std::any_of(parameters.solids.begin(), parameters.solids.end(),
                                 [](const Solid& solid) { return solid.motion.moves(); })),
      assemblies_(parameters.assemblies, seeds.grains),
      store_(columns_of(parameters), parameters.disk_thickness > 0.0 ? GrainStore::of_disk : GrainStore::of_sphere),
      ghosts_(decomposition, communicator, ghost_reach(), largest_offset_),
      lists_phase_(timer_.phase("contact lists")),
      forces_phase_(timer_.phase("contact forces")),
      motion_phase_(timer_.phase("motion")),
      messages_phase_(timer_.phase("messages")) {
  assert(decomposition.ranks() == size_of(communicator));
  place_solids(0.0, 0.0);
  take_seeds(std::move(seeds));
  check_integrator();
  check_prescribed_speed();
  planes_ = parameters_.walls;
  for (std::size_t w = 0; w < planes_.size(); ++w)
    if (planes_[w].rough) rough_floor_ = w;
  if (walls_change_) place_walls(0.0, 0.0);
  check_range();
  build_dependents({});
  moving_.load(store_, body_force_);
  assemblies_.place(moving_, box_, 0.0, 0.0);
  ghosts_.refresh(moving_);
  evaluate_forces(0.0);
  moving_.unload(store_);
  ghosts_.refresh(store_);  // those that touch nothing have the velocities of their assemblies, too
}

void GrainDynamics::take_seeds(GrainSeeds seeds) {
  const std::vector<GrainSeed> grains = with_members(std::move(seeds.grains), seeds.clumps, box_);
  on_all_ranks(communicator_, [&] {
    check(seeds.clumps, box_);
    if (seeds.whole)
      check(grains, box_, parameters_.walls, parameters_.initial_overlap);
    else
      check_part(grains, box_, parameters_.walls, parameters_.initial_overlap, largest_radius_);
    check(grains, parameters_.solids, box_, parameters_.initial_overlap);
    check_kinds(grains);
  });
  std::vector<LightestGrain> lightest(static_cast<std::size_t>(materials_.count()));
  for (const GrainSeed& grain : grains)
    if (!holds_translation(grain.motion))
      lightest[static_cast<std::size_t>(grain.material)].include(grain.contact_mass(), grain.radius);
  share_over_ranks(communicator_, lightest);

  const int me = rank_of(communicator_);
  const std::vector<Clump> mine = clumps_of(seeds.clumps, decomposition_, me);
  const GrainBatch batch = batch_of(grains, mine, decomposition_, me, store_.attached_width);
  std::int64_t members = 0;
  for (const GrainRow& row : batch.rows) members += row.clump >= 0;
  global_count_ = sum_over_ranks(communicator_, static_cast<std::int64_t>(batch.rows.size()));
  clump_count_ = sum_over_ranks(communicator_, static_cast<std::int64_t>(mine.size()));
  member_count_ = sum_over_ranks(communicator_, members);
  check_time_step(parameters_, lightest, body_count());
  check_lubrication(parameters_, lightest, largest_radius_, box_);
  replace_owned(store_, batch);
  clumps_.replace(mine);
}

void GrainDynamics::check_kinds(std::span<const GrainSeed> grains) const {
  for (const GrainSeed& grain : grains) {
    if (grain.material < 0 || grain.material >= materials_.count())
      throw InputError(
          fmt::format("Grain {} is of material {}, but there are {}.", grain.id, grain.material, materials_.count()));
    if (grain.thickness != parameters_.disk_thickness)
      throw InputError(fmt::format("Grain {} is {:g} m thick, and the grains of the run {:g} m (0: spheres).", grain.id,
                                   grain.thickness, parameters_.disk_thickness));
  }
}

void GrainDynamics::check_integrator() const {
  const bool gear = parameters_.integrator == Integrator::gear;
  if (clump_count_ > 0 && gear)
    throw InputError("Clumps are moved by velocity Verlet, not by Gear's predictor-corrector; use the former.");
}

// The contact list must outlast a step.
void GrainDynamics::check_prescribed_speed() const {
  const double speed = largest_prescribed_speed();
  if (speed * step_time() <= 0.5 * parameters_.skin) return;
  throw InputError(fmt::format(
      "Walls or rigid assemblies of grains move at up to {:g} m/s, further than half the skin of the contact "
      "list, {:g} m, in a step of {:g} s; give them a lower speed or the run a shorter step.",
      speed, parameters_.skin, step_time()));
}

double GrainDynamics::largest_prescribed_speed() const {
  double largest = assemblies_.largest_speed();
  for (const Plane& wall : parameters_.walls) largest = std::max(largest, wall.largest_speed());
  for (const Solid& solid : parameters_.solids) largest = std::max(largest, largest_speed_of(solid));
  return largest;
}

double GrainDynamics::ghost_reach() const {
  // Until the ghosts are made anew a grain may come half a skin nearer, and an owned one leave its block by as much.
  const double field = parameters_.field ? parameters_.field->reach() + parameters_.skin : 0.0;
  const double pairs = std::max(field, 2.0 * largest_radius_ + list_range());
  // A little further, so that rounding cannot hide a pair from the rank of one of its grains.
  return std::max(parameters_.ghost_width + 0.5 * parameters_.skin, 1.001 * pairs);
}

// The gap up to which pairs are listed: what acts across a gap must be known there until the list is made anew.
double GrainDynamics::list_range() const {
  const double lubrication = parameters_.lubrication ? parameters_.lubrication->reach() : 0.0;
  return parameters_.skin + std::max(lubrication, range_of({materials_.common()}));
}

// No pair may act across both ends of a periodic axis.
void GrainDynamics::check_range() const {
  const double range = range_of({materials_.common()}), shortest = 2.0 * (2.0 * largest_radius_ + range);
  if (range == 0.0) return;
  for (int axis = 0; axis < 3; ++axis)
    if (box_.periodic[axis] && box_.size[axis] < shortest)
      throw InputError(fmt::format(
          "The box is {:g} m long along the periodic axis {}, but contacts act across gaps of up to {:g} m; "
          "give at least {:g} m, two diameters and twice the gap.",
          box_.size[axis], "xyz"[axis], range, shortest));
}

bool GrainDynamics::prepare() {
  const auto scope = timer_.measure(lists_phase_);
  return rebuild_for(look_ahead(), parameters_.sub_steps);
}

int GrainDynamics::prepare_part() {
  // Of the way that a fresh list allows, at twice the largest speed: since grains are slower, most parts need no new
  // list.
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

// Wraps positions and looks for trouble.
GrainDynamics::Outlook GrainDynamics::look_ahead() {
  wrap_positions();
  // What may still happen before the next call: a grain at rest can be thrown at no more than about twice the largest
  // speed, and the loads accelerate it.
  double farthest = 0.0, fastest = largest_prescribed_speed();
  bool trouble = false;
  const GrainWatch watch{GrainSpace(box_, planes_), parameters_.skin, step_time(), deep_in_solids()};
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
    trouble = trouble || watch.trouble_of(store_, s, displacement) != GrainFault::none;
  }
  fastest = std::max(fastest, fastest_member());
  const double mine[3] = {farthest, fastest, trouble ? 1.0 : 0.0};
  double all[3];
  MPI_Allreduce(mine, all, 3, MPI_DOUBLE, MPI_MAX, communicator_);
  if (all[2] != 0.0) watch.throw_first(store_, box_, listed_position_, communicator_);
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

void GrainDynamics::rebuild() {
  ContactHistories histories = histories_of(list_, store_, planes_.size());
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

// Makes everything that follows from the owned grains: ghosts, contact list, body forces.
void GrainDynamics::build_dependents(const ContactHistories& histories) {
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

void GrainDynamics::compute_body_forces() {
  const auto force = [this](double mass, double radius) -> Vec3 {
    const Vec3 on_volume = grain_volume(radius, parameters_.disk_thickness) * force_density_;
    if (!parameters_.body_force) return on_volume;
    return body_force_factor_ * parameters_.body_force(mass, radius) + on_volume;
  };
  body_force_.assign(store_.owned, Vec3::Zero());
  for (std::size_t s = 0; s < store_.owned; ++s)
    if (store_.clump[s] < 0) body_force_[s] = force(store_.mass[s], store_.radius[s]);
  clumps_.compute_body_forces(force);
  clumps_.share_body_force(body_force_);
}

void GrainDynamics::set_body_force_factor(double factor) {
  if (factor == body_force_factor_) return;
  body_force_factor_ = factor;
  compute_body_forces();
}

void GrainDynamics::set_force_density(const Vec3& density) {
  if (density == force_density_) return;
  force_density_ = density;
  compute_body_forces();
}

void GrainDynamics::evaluate_forces(double time_step) {
  const auto scope = timer_.measure(forces_phase_);
  evaluate_contacts(moving_, list_, surroundings(), materials_, store_.material, time_step);
  if (parameters_.lubrication) add_lubrication(moving_, list_, surroundings(), *parameters_.lubrication);
  if (parameters_.field) parameters_.field->act(moving_, store_, clumps_, body_force_);
  if (rough_floor_) hold_on_rough_floor();
}

void GrainDynamics::hold_on_rough_floor() {
  moving_.forget_stops();
  for_each_held([this](std::size_t s) { return touches_rough_floor(moving_[s].position[2], moving_[s].position[3]); },
                [this](std::size_t s) { moving_.stop_along_floor(s); },
                [this](std::size_t n) { clumps_.stop_along_floor(n, moving_); });
}

void GrainDynamics::place_walls(double time, double time_of_velocity) {
  for (std::size_t w = 0; w < planes_.size(); ++w)
    if (parameters_.walls[w].changes()) planes_[w] = parameters_.walls[w].at(time, time_of_velocity);
}

void GrainDynamics::place_solids(double time, double time_of_velocity) {
  solids_.clear();
  for (const Solid& solid : parameters_.solids) solids_.emplace_back(solid, time, time_of_velocity);
}

void GrainDynamics::place_prescribed(double time, double time_of_velocity) {
  if (walls_change_) place_walls(time, time_of_velocity);
  if (solids_change_) place_solids(time, time_of_velocity);
  assemblies_.place(moving_, box_, time, time_of_velocity);
}

void GrainDynamics::advance(int sub_steps) {
  if (sub_steps < 1) return;
  {
    const auto scope = timer_.measure(motion_phase_);
    moving_.load(store_, body_force_);
    clumps_.load(store_);
  }
  if (parameters_.integrator == Integrator::gear)
    advance_by_gear(sub_steps);
  else
    advance_by_verlet(sub_steps);
  const auto scope = timer_.measure(motion_phase_);
  moving_.unload(store_);
}

template <typename Work>
void GrainDynamics::timed(int phase, Work&& work) {
  const auto scope = timer_.measure(phase);
  work();
}

void GrainDynamics::advance_by_verlet(int sub_steps) {
  const double dt = parameters_.time_step;
  const auto drift_clumps = [&] {
    clumps_.drift(dt);
    clumps_.place(moving_, box_);
  };
  timed(motion_phase_, [&] {
    clumps_.half_kicks(moving_, dt, 1);  // before the others, whose drift forgets the forces
    moving_.half_kick(dt);
    moving_.drift(dt);
    drift_clumps();
  });
  for (int s = 0;; ++s) {
    ++steps_done_;
    // Forces see velocities of the middle of the step, so those of what is prescribed are taken there as well.
    place_prescribed(time(), time() - 0.5 * dt);
    timed(messages_phase_, [&] { ghosts_.refresh(moving_); });
    list_.grains_moved(dt * moving_.speed_bound(!clumps_.empty() || !parameters_.assemblies.empty()));
    evaluate_forces(dt);
    if (s + 1 == sub_steps) break;
    timed(motion_phase_, [&] {
      clumps_.half_kicks(moving_, dt, 2);
      moving_.two_half_kicks_and_drift(dt);
      drift_clumps();
    });
  }
  timed(motion_phase_, [&] {
    clumps_.half_kicks(moving_, dt, 1);
    moving_.half_kick(dt);
    clumps_.place(moving_, box_);
  });
  place_prescribed(time(), time());
}

void GrainDynamics::advance_by_gear(int sub_steps) {
  const double dt = parameters_.time_step;
  timed(motion_phase_, [&] { gear_.load(store_, moving_, dt); });
  for (int s = 0; s < sub_steps; ++s) {
    timed(motion_phase_, [&] { gear_.predict(moving_); });
    ++steps_done_;
    place_prescribed(time(), time());
    timed(messages_phase_, [&] { ghosts_.refresh(moving_); });
    list_.forget_near_pairs();  // a prediction moves by more than its velocity
    evaluate_forces(dt);
    timed(motion_phase_, [&] { gear_.correct(moving_); });
  }
  place_prescribed(time(), time());
  timed(motion_phase_, [&] { gear_.unload(store_); });
}

void GrainDynamics::refresh_ghosts() {
  wrap_positions();
  const auto scope = timer_.measure(messages_phase_);
  ghosts_.refresh(store_);
}

void GrainDynamics::refresh_ghost_attached(std::size_t first, std::size_t count) {
  ghosts_.refresh_attached(store_, first, count);
}

}  // namespace thalweg::dem
