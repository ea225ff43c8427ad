#include "bodies/bodies.hpp"

#include "core/base/check.hpp"
#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_all_ranks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace thalweg::bodies {

template <typename Real>
Bodies<Real>::Bodies(const Decomposition& decomposition, MPI_Comm communicator, lbm::Fluid<Real>& fluid,
                     const BodyOptions& options, const Hydrostatic& rest, std::vector<Solid> solids)
    : fluid_(fluid),
      options_(options),
      box_(decomposition.cell_box()),
      rest_(rest),
      map_(decomposition, fluid.block(), fluid.cells()),
      links_(fluid.tiles().count()),
      solids_(decomposition, fluid.block(), fluid.cells(), fluid.tiles(), std::move(solids)),
      link_builder_(decomposition, fluid.block(), fluid.cells(), fluid.tiles(), &solids_),
      occluded_links_(decomposition, fluid.block(), fluid.cells(), rest),
      refill_(decomposition, communicator) {
  set_rest(options_.links, rest_);
  add_solids(communicator);
}

template <typename Real>
void Bodies<Real>::add_solids(MPI_Comm communicator) {
  if (solids_.count() == 0) return;
  std::vector<std::int64_t> cells(static_cast<std::size_t>(solids_.count()));
  std::vector<bool> moves;
  for (int s = 0; s < solids_.count(); ++s) moves.push_back(solids_.moves(s));
  map_.add_solids(moves);
  map_.begin_update();
  solids_.hand_over([&](const InsideCell& cell) { map_.claim(slot_of_solid(cell.solid), cell.local); });
  for (const CellChange& change : map_.settle())
    if (fluid_.indexing().owned(change.cell[0], change.cell[1], change.cell[2]))
      ++cells[static_cast<std::size_t>(change.now)];
  for (std::size_t s = 0; s < cells.size(); ++s)
    if (!moves[s] && sum_over_ranks(communicator, cells[s]) == 0)
      throw InputError(
          fmt::format("solids.{} covers no cell: it lies outside the box, inside another solid, or between the centres "
                      "of the cells; check its place and its size in m.",
                      s));
  resize_to_slots();
  for (std::size_t s = 0; s < cells.size(); ++s) {
    bodies_[s].turns = moves[s];
    bodies_[s].centre = solids_.centre(static_cast<int>(s));
  }
  update_links();
}

template <typename Real>
void Bodies<Real>::check_block(MPI_Comm communicator) const {
  on_all_ranks(communicator, [&] {
    LinkSlots::check(fluid_.populations());
    for (int a = 0; a < 2; ++a)
      if (fluid_.block().size()[a] > LinkXY::largest)
        throw InputError(fmt::format("A rank would hold {} cells along {}, more than {}; use more ranks.",
                                     fluid_.block().size()[a], "xy"[a], LinkXY::largest));
  });
}

template <typename Real>
template <typename Error>
void Bodies<Real>::check_count(MPI_Comm communicator) const {
  on_all_ranks(communicator, [&] {
    if (map_.bodies().size() > static_cast<std::size_t>(LinkTag::bodies))
      throw Error(fmt::format("A rank would hold the links of {} bodies, more than {}; use more ranks.",
                              map_.bodies().size(), LinkTag::bodies));
  });
}

template <typename Real>
void Bodies<Real>::resize_to_slots() {
  const std::size_t slots = map_.bodies().size();
  bodies_.resize(slots);
  surrounding_.resize(slots);
  moments_.resize(slots);
}

template <typename Real>
void Bodies<Real>::begin_step(const StepMeasurements& measured) {
  totals_ = {};
  measured_ = measured;
  by_height_ = measured.momentum_by_height
                   ? MomentumByHeight(solids(), fluid_.indexing().size()[2], !options_.obstacles.empty())
                   : MomentumByHeight();
  map_.begin_update();
  for (LinkBody& body : bodies_) body.clear_sums();
  if (has_moments()) moments_.assign(bodies_.size(), {});
}

template <typename Real>
BodySlot Bodies<Real>::add(GlobalId id, double radius, GlobalId clump, const Vec3& centre) {
  const BodySlot slot = map_.add(id, radius, clump);
  remap(slot, centre);
  resize_to_slots();
  LinkBody& body = bodies_[index_of(slot)];
  body.radius = radius;
  body.is_obstacle = std::binary_search(options_.obstacles.begin(), options_.obstacles.end(), id);
  return slot;
}

template <typename Real>
void Bodies<Real>::remove(BodySlot slot) {
  map_.remove(slot);
  settled_ = false;
}

template <typename Real>
void Bodies<Real>::remap(BodySlot slot, const Vec3& centre) {
  map_.remap(slot, centre);
  settled_ = false;
}

template <typename Real>
void Bodies<Real>::move(BodySlot slot, const BodyMotion& motion) {
  CHECK(index_of(slot) < bodies_.size());
  LinkBody& body = bodies_[index_of(slot)];
  body.centre = motion.centre;
  body.velocity = motion.velocity;
  body.angular_velocity = motion.angular_velocity;
  body.returned = motion.returned;
  body.returned_slope = motion.returned_slope;
  surrounding_[index_of(slot)] = motion.surrounding;
}

template <typename Real>
void Bodies<Real>::move_solid(int solid, const SolidMotion& motion) {
  CHECK(solid >= 0 && solid < solids());
  settled_ = false;
  const std::vector<InsideCell> before = solids_.inside(solid);
  solids_.move_to(solid, motion.transform);
  move(slot_of_solid(solid), {solids_.centre(solid), motion.velocity, motion.angular_velocity, motion.returned.density,
                              motion.returned.slope, 0.0});
  const std::vector<InsideCell>& now = solids_.inside(solid);
  std::vector<InsideCell> turned;
  std::set_difference(now.begin(), now.end(), before.begin(), before.end(), std::back_inserter(turned));
  for (const InsideCell& cell : turned) map_.claim(slot_of_solid(solid), cell.local);
  turned.clear();
  std::set_difference(before.begin(), before.end(), now.begin(), now.end(), std::back_inserter(turned));
  for (const InsideCell& cell : turned) map_.give_up(slot_of_solid(solid), cell.local);
}

template <typename Real>
void Bodies<Real>::settle_cells() {
  map_.settle();
  settled_ = true;
  linked_ = map_.changes().empty() && linked_;
}

template <typename Real>
void Bodies<Real>::settle() {
  settle_cells();
  account_for_covered_cells();
}

template <typename Real>
void Bodies<Real>::refill() {
  CHECK(settled_);
  const RefillTotals totals = refill_.fill(fluid_, map_.changes(), rest_, surrounding_, bodies_);
  totals_.refilled_mass = totals.mass;
  totals_.refilled = totals.momentum;
  totals_.refilled_angular_momentum = totals.angular_momentum;
}

// Links follow from the map of the cells alone.
template <typename Real>
void Bodies<Real>::update_links() {
  CHECK(settled_);
  link_builder_.update(map_, links_);
  occluded_links_.update(map_);
  linked_ = true;
}

template <typename Real>
void Bodies<Real>::sweep(PhaseTimer& timer, int sweep_phase, int links_phase) {
  CHECK(settled_ && linked_);
  std::vector<FixedTensor>* moments = has_moments() ? &moments_ : nullptr;
  InterpolatedBounceBack<Real> links(fluid_, links_, box_, options_.links, bodies_, moments, solids());
  const auto sweep = timer.measure(sweep_phase);
  fluid_.stream_and_collide([&](int tile) {
    const auto scope = timer.measure(links_phase);
    links.apply_tile(tile);
  });
  const auto scope = timer.measure(links_phase);
  add_link_totals();
  occluded_links_.apply(solids(), bodies_, moments);
  map_.occluded_patches().apply(map_.bodies(), map_.solids(), surrounding_, reference_density(), bodies_, moments);
}

template <typename Real>
std::array<FixedVec3, 6> Bodies<Real>::occluded_wall_forces() const {
  std::array<FixedVec3, 6> forces =
      map_.occluded_patches().wall_forces(map_.solids(), surrounding_, reference_density());
  const std::array<FixedVec3, 6> of_links = occluded_links_.wall_forces(bodies_);
  for (std::size_t face = 0; face < forces.size(); ++face) forces[face] += of_links[face];
  return forces;
}

template <typename Real>
void Bodies<Real>::settle_at_start() {
  settle_cells();
  update_links();
}

template <typename Real>
void Bodies<Real>::remove_all() {
  map_.begin_update();
  for (std::size_t slot = static_cast<std::size_t>(solids()); slot < map_.bodies().size(); ++slot)
    if (!map_.bodies()[slot].is_free()) map_.remove(slot_at(slot));
  settle_at_start();
}

template <typename Real>
void Bodies<Real>::apply_links_on_copies(MomentumByHeight* by_height) const {
  CHECK(settled_ && linked_);
  std::vector<LinkBody> copies = bodies_;  // take up the momentum, which belongs to the next step
  InterpolatedBounceBack<Real> links(fluid_, links_, box_, options_.links, copies, nullptr, 0, by_height);
  for (int tile = 0; tile < fluid_.tiles().count(); ++tile) links.apply_tile(tile);
}

template <typename Real>
const MomentumByHeight& Bodies<Real>::momentum_by_height() {
  CHECK(measured_.momentum_by_height);
  apply_links_on_copies(&by_height_);
  return by_height_;
}

template <typename Real>
void Bodies<Real>::account_for_covered_cells() {
  const Index3& lower = fluid_.block().lower;
  for (const CellChange& change : map_.changes()) {
    const Index3& at = change.cell;
    if (change.before != lbm::CellMap::fluid || !fluid_.indexing().owned(at[0], at[1], at[2])) continue;
    const std::ptrdiff_t cell = fluid_.indexing().index(at[0], at[1], at[2]);
    Vec3 momentum = Vec3::Zero();
    for (int i = 0; i < lbm::D3Q19::directions; ++i)
      for (int a = 0; a < 3; ++a)
        momentum[a] += lbm::D3Q19::c[i][a] * static_cast<double>(fluid_.populations().post_collision(i, cell));
    const Vec3 position(lower[0] + at[0] + 0.5, lower[1] + at[1] + 0.5, lower[2] + at[2] + 0.5);
    totals_.covered += momentum;
    totals_.covered_angular_momentum += position.cross(momentum);
    const double deviation = fluid_.populations().density_deviation(cell);
    const std::int64_t mass = LatticeFixed::from(rest_.deviation(position) - deviation);
    LinkBody& body = bodies_[static_cast<std::size_t>(change.now)];
    body.mass += mass;
    totals_.covered_mass += mass;
    if (options_.keep_covered_momentum) keep_momentum(body, at[2], position, 1.0 + deviation, momentum);
  }
}

// Gives the body the momentum of a cell that it covers, sum (c_i - u_w) f_i^c without the half force, which refill puts
// into cells again. The rest, rho u_w, belongs to the mass, which comes back (docs/theory.md, section 3, "Covered
// cells").
template <typename Real>
void Bodies<Real>::keep_momentum(LinkBody& body, int plane, const Vec3& position, double density,
                                 const Vec3& momentum) {
  const Vec3 arm = box_.difference(position, body.centre);
  const Vec3 wall = body.velocity + body.angular_velocity.cross(arm);
  const Vec3 kept = momentum - 0.5 * fluid_.carried_force() - density * wall, torque = arm.cross(kept);
  body.force += FixedVec3::from(kept);
  const std::ptrdiff_t slot = &body - bodies_.data();
  if (measured_.momentum_by_height) by_height_.add(slot, body.is_obstacle, 2 * plane + 1, FixedVec3::from(kept));
  body.torque += FixedVec3::from(torque);
  if (has_moments() && slot >= solids()) moments_[static_cast<std::size_t>(slot)].add(kept, arm);
  totals_.kept += kept;
  totals_.kept_angular_momentum += body.centre.cross(kept) + torque;
}

// Call it before adding forces that the fluid does not feel.
template <typename Real>
void Bodies<Real>::add_link_totals() {
  for (std::size_t slot = 0; slot < bodies_.size(); ++slot) {
    const LinkBody& body = bodies_[slot];  // one that has just been removed has refilled its cells
    const Vec3 force = body.force.to_vec3();
    totals_.link_momentum += force;
    totals_.link_angular_momentum += body.centre.cross(force) + body.torque.to_vec3();
    totals_.link_mass = exact_sum(totals_.link_mass, body.mass);
  }
  totals_.link_momentum -= totals_.kept;
  totals_.link_angular_momentum -= totals_.kept_angular_momentum;
  totals_.link_mass -= totals_.refilled_mass + totals_.covered_mass;
}

template class Bodies<float>;
template class Bodies<double>;
template void Bodies<float>::check_count<InputError>(MPI_Comm) const;
template void Bodies<double>::check_count<InputError>(MPI_Comm) const;
template void Bodies<float>::check_count<RunError>(MPI_Comm) const;
template void Bodies<double>::check_count<RunError>(MPI_Comm) const;

}  // namespace thalweg::bodies
