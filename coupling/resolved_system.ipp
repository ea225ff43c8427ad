// Template bodies of resolved_system.hpp: construction, the step, what the system shows, saves and loads. Included,
// with resolved_loads.ipp and resolved_sample.ipp, where the system is instantiated for a shape: in resolved_system.cpp
// for spheres.
#pragma once

#include "coupling/resolved_system.hpp"

#include "core/mpi_session.hpp"
#include "core/same_time_step.hpp"
#include "coupling/fluid_figures.hpp"
#include "coupling/fluid_mass.hpp"
#include "coupling/fluid_system.hpp"
#include "coupling/taken_fluid.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::coupling {

template <typename Real>
ResolvedSystem<Real>::ResolvedSystem(std::unique_ptr<Decomposition> decomposition, MPI_Comm communicator,
                                     const ResolvedParameters& parameters, std::unique_ptr<dem::GrainDynamics> grains)
    : decomposition_(std::move(decomposition)),
      communicator_(communicator),
      parameters_(parameters),
      fluid_(*decomposition_, communicator, parameters.collision, parameters.faces),
      grains_(std::move(grains)),
      box_(decomposition_->box()),
      lattice_box_{Vec3(decomposition_->cells()[0], decomposition_->cells()[1], decomposition_->cells()[2]),
                   decomposition_->periodic()},
      rest_(rest_state(parameters, *decomposition_)),
      map_(*decomposition_, fluid_.block(), fluid_.cells()),
      links_(fluid_.tiles().count()),
      link_builder_(*decomposition_, fluid_.block(), fluid_.cells(), fluid_.tiles()),
      hidden_links_(*decomposition_, fluid_.block(), fluid_.cells(), rest_),
      refill_(*decomposition_, communicator, parameters.refill),
      mass_(communicator),
      closed_(closed(parameters.faces)) {
  phases_ = {timer_.phase("grain map"), timer_.phase("refill"), timer_.phase("halo"),  timer_.phase("walls"),
             timer_.phase("links"),     timer_.phase("sweep"),  timer_.phase("loads"), timer_.phase("grains")};
  bodies::set_rest(parameters_.links, rest_);
  if (parameters_.flow_target) fluid_.control_flow(*parameters_.flow_target);
  initialise(fluid_, parameters_, rest_);
  dem::GrainStore& store = grains_->store();
  for (std::size_t g = 0; g < store.total(); ++g) exchange_of(g).link_position() = store.position[g];
  initialise_map();
  open_account();
  set_gravity_of(step_);
  fluid_.carry_force();
  show_stresses();
}

// Of the fluid and of the grains, in the step of this number, from 1.
template <typename Real>
void ResolvedSystem<Real>::set_gravity_of(std::int64_t step) {
  if (parameters_.ramp == 0.0) return;
  set_gravity(fluid_, parameters_, step);
  grains_->set_body_force_factor(gravity_factor(parameters_, step));
}

// The cells covered at the start (of a run or after loading) were never fluid: nothing to refill.
template <typename Real>
void ResolvedSystem<Real>::initialise_map() {
  map_.begin_update();
  synchronise_slots();
  map_.settle();
  link_builder_.update(map_, links_);
  hidden_links_.update(map_);
}

template <typename Real>
void ResolvedSystem<Real>::synchronise_slots() {
  dem::GrainStore& store = grains_->store();
  std::vector<char> present(map_.bodies().size(), 0);
  map_slot_.resize(store.total());
  for (std::size_t g = 0; g < store.total(); ++g) {
    const int slot = map_.slot_of(store.id[g]);
    if (slot >= 0) present[slot] = 1;
  }
  for (std::size_t slot = 0; slot < present.size(); ++slot)
    if (!present[slot] && map_.bodies()[slot].id >= 0) map_.remove(static_cast<int>(slot));
  for (std::size_t g = 0; g < store.total(); ++g) {
    int slot = map_.slot_of(store.id[g]);
    if (slot < 0) {
      slot = map_.add(store.id[g], store.radius[g] / parameters_.units.spacing, store.clump[g]);
      map_.place(slot, lattice_position(exchange_of(g).link_position()));
    }
    map_slot_[g] = slot;
  }
  bodies_.resize(map_.bodies().size());
  surrounding_.resize(map_.bodies().size());
  update_bodies();
}

template <typename Real>
void ResolvedSystem<Real>::place_body(std::size_t grain, bodies::LinkBody& body) const {
  const dem::GrainStore& store = grains_->store();
  body.radius = store.radius[grain] / parameters_.units.spacing;
  body.centre = lattice_position(store.position[grain]);
  body.velocity = store.velocity[grain] / parameters_.units.velocity();
  body.angular_velocity = store.angular_velocity[grain] * parameters_.units.time_step;
}

template <typename Real>
void ResolvedSystem<Real>::update_bodies() {
  const dem::GrainStore& store = grains_->store();
  for (std::size_t g = 0; g < store.total(); ++g) {
    bodies::LinkBody& body = bodies_[map_slot_[g]];
    const GrainExchange<double> kept = exchange_of(g);
    place_body(g, body);
    body.returned = kept.returned_density();
    body.returned_slope = kept.returned_slope();
    surrounding_[map_slot_[g]] = kept.surrounding();
    body.clear_sums();
  }
  if (parameters_.grain_stress) moments_.assign(bodies_.size(), {});
}

// Cells follow a grain once it has moved by the tolerance; links know its place exactly all the same. Ghosts follow the
// same rule from the same numbers as their owners, so every rank moves a grain's cells in the same step.
template <typename Real>
void ResolvedSystem<Real>::update_map() {
  dem::GrainStore& store = grains_->store();
  const double tolerance = parameters_.link_tolerance * parameters_.units.spacing;
  for (std::size_t g = 0; g < store.total(); ++g) {
    const GrainExchange<double> kept = exchange_of(g);
    const Vec3 moved = box_.difference(store.position[g], kept.link_position());
    if (moved.squaredNorm() <= tolerance * tolerance) continue;
    kept.link_position() = store.position[g];
    map_.place(map_slot_[g], lattice_position(store.position[g]));
  }
}

template <typename Real>
void ResolvedSystem<Real>::sweep_behind_links() {
  std::vector<FixedTensor>* moments = moments_.empty() ? nullptr : &moments_;
  bodies::LinkPass<Real> links(fluid_, links_, lattice_box_, parameters_.links, bodies_, moments);
  const auto sweep = timer_.measure(phases_.sweep);
  fluid_.stream_and_collide([&](int tile) {
    const auto scope = timer_.measure(phases_.links);
    links.apply_tile(tile);
  });
  const auto scope = timer_.measure(phases_.links);
  book_links();
  hidden_links_.apply(bodies_, moments);
  map_.hidden_patches().apply(map_.bodies(), surrounding_, parameters_.links.reference_density, bodies_, moments);
}

// Links follow from the map of the cells alone, so they are rebuilt while the halo is on its way.
template <typename Real>
void ResolvedSystem<Real>::update_links_behind_halo() {
  {
    const auto scope = timer_.measure(phases_.halo);
    fluid_.start_halo_exchange();
  }
  {
    const auto scope = timer_.measure(phases_.map);
    link_builder_.update(map_, links_);
    hidden_links_.update(map_);
  }
  const auto scope = timer_.measure(phases_.halo);
  fluid_.finish_halo_exchange();
}

template <typename Real>
void ResolvedSystem<Real>::advance() {
  step_totals_ = {};
  momentum_.reset();
  given_by_height_.assign(booking_ ? static_cast<std::size_t>(2 * fluid_.indexing().size()[2] + 1) : 0, {});
  bool slots_changed = false;
  {
    const auto scope = timer_.measure(phases_.grains);
    slots_changed = grains_->prepare();
  }
  {
    const auto scope = timer_.measure(phases_.map);
    map_.begin_update();
    if (slots_changed)
      synchronise_slots();
    else
      update_bodies();
    update_map();
    map_.settle();
    account_for_covered_cells();
  }
  {
    const auto scope = timer_.measure(phases_.refill);
    const bodies::RefillTotals totals = refill_.fill(fluid_, map_.changes(), rest_, bodies_);
    step_totals_.refilled_mass = totals.mass;
    step_totals_.refilled = totals.momentum;
    step_totals_.refilled_angular_momentum = totals.angular_momentum;
  }
  set_gravity_of(step_ + 1);
  update_links_behind_halo();
  {
    const auto scope = timer_.measure(phases_.walls);
    fluid_.apply_walls();
  }
  if (booking_) write_momentum_book();
  sweep_behind_links();
  {
    const auto scope = timer_.measure(phases_.loads);
    collect_loads();
    apply_loads();
  }
  {
    const auto scope = timer_.measure(phases_.grains);
    grains_->advance(parameters_.sub_steps);
    grains_->refresh_ghosts();
  }
  ++step_;
  correct_mass();
}

template <typename Real>
std::int64_t ResolvedSystem<Real>::cells() const {
  const Index3& n = decomposition_->cells();
  return static_cast<std::int64_t>(n[0]) * n[1] * n[2];
}

template <typename Real>
std::int64_t ResolvedSystem<Real>::grain_steps_per_step() const {
  return grains_->global_count() * parameters_.sub_steps;
}

template <typename Real>
Snapshot ResolvedSystem<Real>::snapshot() const {
  const dem::GrainStore& store = grains_->store();
  const std::size_t n = store.owned;
  Snapshot s;
  s.time = time();
  s.step = step_;
  s.decomposition = decomposition_.get();
  s.fluid = this;
  s.contacts = this;
  s.momentum = momentum_ ? &*momentum_ : nullptr;
  s.grains.global_count = grains_->global_count();
  s.grains.id = {store.id.data(), n};
  s.grains.radius = {store.radius.data(), n};
  s.grains.mass = {store.mass.data(), n};
  s.grains.position = {store.position.data(), n};
  s.grains.velocity = {store.velocity.data(), n};
  s.grains.angular_velocity = {store.angular_velocity.data(), n};
  s.grains.fluid_force = {store.load_force.data(), n};
  s.grains.fluid_torque = {store.load_torque.data(), n};
  if (parameters_.grain_stress) s.grains.fluid_stress = {fluid_stress_.data(), n};
  s.grains.contact_force = {store.contact_force.data(), n};
  s.grains.contact_torque = {store.contact_torque.data(), n};
  s.grains.motion = grains_->motion();
  grains_->show_clumps(s.grains);
  return s;
}

template <typename Real>
std::vector<Figure> ResolvedSystem<Real>::figures() const {
  const lbm::FluidSurvey survey = survey_of(fluid_);
  const ExcessMass excess = excess_mass(survey, rest_);
  std::vector<Figure> figures = speed_figures(survey, parameters_.units);
  figures.push_back({"mean_density_deviation", "1", excess.mean()});
  figures.push_back({"fluid_cells", "1", static_cast<double>(excess.cells)});
  figures.push_back({"largest_overlap", "diameter", grains_->largest_overlap()});
  if (parameters_.wall_forces) add_wall_forces(figures);
  add_extremes(survey, figures);
  figures.push_back({"largest_grain_speed", "m/s", grains_->largest_speed()});
  for (const Figure& figure : mass_.figures(excess.sum, mass_owed(), parameters_.units)) figures.push_back(figure);
  add_momentum(survey, fluid_.parameters().force, parameters_.units, figures);
  return figures;
}

template <typename Real>
std::optional<Place> ResolvedSystem<Real>::place_of(const std::string& figure) const {
  if (figure == "largest_overlap") return grains_->place_of_deepest_overlap();
  if (figure == "largest_grain_speed") return grains_->place_of_fastest();
  return place_in_fluid(survey_of(fluid_), parameters_.units, figure);
}

// Of the grains at the end of the step; of the fluid what the walls take from it in the step to come.
template <typename Real>
void ResolvedSystem<Real>::add_wall_forces(std::vector<Figure>& figures) const {
  const std::vector<Vec3> of_grains = grains_->wall_forces();
  const std::array<Vec3, 6> of_fluid = fluid_.wall_forces(parameters_.links.reference_density);
  std::size_t wall = 0;
  for (std::size_t face = 0; face < of_fluid.size(); ++face) {
    if (box_.periodic[face / 2]) continue;
    const Vec3 fluid_force = of_fluid[face] * parameters_.units.force();
    for (int axis = 0; axis < 3; ++axis)
      figures.push_back(
          {fmt::format("wall_force_{}_{}", dem::face_names[face], "xyz"[axis]), "N", of_grains[wall][axis]});
    for (int axis = 0; axis < 3; ++axis)
      figures.push_back(
          {fmt::format("fluid_wall_force_{}_{}", dem::face_names[face], "xyz"[axis]), "N", fluid_force[axis]});
    ++wall;
  }
}

template <typename Real>
void ResolvedSystem<Real>::save(ArchiveWriter& archive) const {
  archive.attribute("system/step", step_);
  archive.attribute("system/time_step", time_step());
  fluid_.save(archive);
  grains_->save(archive);
  mass_.save(archive);
  archive.attribute("mass/reference", parameters_.links.reference_density);
}

template <typename Real>
void ResolvedSystem<Real>::forget_map() {
  map_.begin_update();
  for (std::size_t slot = 0; slot < map_.bodies().size(); ++slot)
    if (map_.bodies()[slot].id >= 0) map_.remove(static_cast<int>(slot));
  map_.settle();
  link_builder_.update(map_, links_);
  hidden_links_.update(map_);
}

template <typename Real>
void ResolvedSystem<Real>::load(ArchiveReader& archive) {
  require_same_time_step(archive, time_step());
  step_ = archive.integer_attribute("system/step");
  forget_map();
  fluid_.load(archive);
  grains_->load(archive);
  mass_.load(archive);
  parameters_.links.reference_density = archive.real_attribute("mass/reference");
  initialise_map();
  set_gravity_of(step_);
  fluid_.carry_force();
  show_stresses();
}

template <typename Real>
void ResolvedSystem<Real>::take_fluid(ArchiveReader& archive, double spacing) {
  const double density_unit = coupling::take_fluid(fluid_, archive, spacing, parameters_);
  open_account();
  // As the run that is taken over would go on.
  if (archive.has("mass/reference"))
    parameters_.links.reference_density = density_unit * archive.real_attribute("mass/reference");
}

// Grains of a resolved run keep the places their links were cut at, others begin where they are. What is in lattice
// units begins anew on another lattice.
template <typename Real>
void ResolvedSystem<Real>::take_grains(ArchiveReader& archive, double spacing) {
  forget_map();
  grains_->take(archive);
  const bool same_units =
      spacing == parameters_.units.spacing && archive.real_attribute("system/time_step") == time_step();
  dem::GrainStore& store = grains_->store();
  for (std::size_t g = 0; g < store.total(); ++g) {
    const GrainExchange<double> kept = exchange_of(g);
    if (kept.exchanges() == 0) kept.link_position() = store.position[g];
    if (!same_units) kept.forget_lattice_units();
  }
  initialise_map();
  open_account();
  show_stresses();
}

}  // namespace thalweg::coupling
