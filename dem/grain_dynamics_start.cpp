#include "dem/grain_dynamics.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_all_ranks.hpp"
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
    throw InputError(fmt::format("The skin of the neighbour list is {:g} m; it must be positive.", p.skin));
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
      turnover_(parameters.supplies, parameters.sinks, decomposition.box()),
      store_(parameters.attached_width, parameters.disk_thickness > 0.0 ? GrainStore::of_disk : GrainStore::of_sphere),
      ghosts_(decomposition, communicator, ghost_reach(), largest_offset_),
      lists_phase_(timer_.phase("contact lists")),
      forces_phase_(timer_.phase("contact forces")),
      motion_phase_(timer_.phase("motion")),
      messages_phase_(timer_.phase("messages")) {
  assert(decomposition.ranks() == size_of(communicator));
  place_solids(0.0, 0.0);
  take_seeds(std::move(seeds));
  check_prescribed_speed();
  planes_ = parameters_.walls;
  for (std::size_t w = 0; w < planes_.size(); ++w)
    if (planes_[w].rough) rough_floor_ = w;
  if (walls_change_) place_walls(0.0, 0.0);
  check_range();
  build_dependents({});
  moving_.gather_from(store_, body_force_);
  assemblies_.place(moving_, box_, 0.0, 0.0);
  ghosts_.refresh(moving_);
  evaluate_forces(0.0);
  moving_.scatter_to(store_);
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
    check_whole(parameters_.assemblies, grains, box_);
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
  turnover_.set_first_id(global_count_);
  turnover_.set_largest(largest_radius_, largest_offset_);
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

// The neighbour list must outlast a step.
void GrainDynamics::check_prescribed_speed() const {
  const double speed = largest_prescribed_speed();
  if (speed * step_time() <= 0.5 * parameters_.skin) return;
  throw InputError(fmt::format(
      "Walls or rigid assemblies of grains move at up to {:g} m/s, further than half the skin of the neighbour "
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

}  // namespace thalweg::dem
