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
      rest_(rest_state(parameters, *decomposition_)),
      bodies_(*decomposition_, communicator, fluid_, parameters.bodies, rest_),
      mass_(communicator),
      closed_(closed(parameters.faces)) {
  phases_ = {timer_.phase("grain map"), timer_.phase("refill"), timer_.phase("halo"),  timer_.phase("walls"),
             timer_.phase("links"),     timer_.phase("sweep"),  timer_.phase("loads"), timer_.phase("grains")};
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
  bodies_.begin_step();
  synchronise_slots();
  update_bodies();
  bodies_.settle_at_start();
}

// Bodies for the grains that are in reach of this rank, and no others.
template <typename Real>
void ResolvedSystem<Real>::synchronise_slots() {
  const dem::GrainStore& store = grains_->store();
  std::vector<char> present(bodies_.mapped().size(), 0);
  slot_.resize(store.total());
  for (std::size_t g = 0; g < store.total(); ++g) {
    slot_[g] = bodies_.slot_of(store.id[g]);
    if (slot_[g] >= 0) present[static_cast<std::size_t>(slot_[g])] = 1;
  }
  for (std::size_t slot = 0; slot < present.size(); ++slot)
    if (!present[slot] && bodies_.mapped()[slot].id >= 0) bodies_.remove(static_cast<int>(slot));
  for (std::size_t g = 0; g < store.total(); ++g)
    if (slot_[g] < 0)
      slot_[g] = bodies_.add(store.id[g], store.radius[g] / parameters_.units.spacing, store.clump[g],
                             lattice_position(exchange_of(g).link_position()));
}

template <typename Real>
void ResolvedSystem<Real>::update_bodies() {
  const dem::GrainStore& store = grains_->store();
  for (std::size_t g = 0; g < store.total(); ++g) {
    const GrainExchange<double> kept = exchange_of(g);
    bodies_.move(slot_[g], {lattice_position(store.position[g]), store.velocity[g] / parameters_.units.velocity(),
                            store.angular_velocity[g] * parameters_.units.time_step, kept.returned_density(),
                            kept.returned_slope(), kept.surrounding()});
  }
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
    bodies_.place(slot_[g], lattice_position(store.position[g]));
  }
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
    bodies_.update_links();
  }
  const auto scope = timer_.measure(phases_.halo);
  fluid_.finish_halo_exchange();
}

template <typename Real>
void ResolvedSystem<Real>::advance() {
  momentum_.reset();
  bool slots_changed = false;
  {
    const auto scope = timer_.measure(phases_.grains);
    slots_changed = grains_->prepare();
  }
  {
    const auto scope = timer_.measure(phases_.map);
    bodies_.begin_step(booking_);
    if (slots_changed) synchronise_slots();
    update_bodies();
    update_map();
    bodies_.settle();
  }
  {
    const auto scope = timer_.measure(phases_.refill);
    bodies_.refill();
  }
  set_gravity_of(step_ + 1);
  update_links_behind_halo();
  {
    const auto scope = timer_.measure(phases_.walls);
    fluid_.apply_walls();
  }
  if (booking_) write_momentum_book();
  bodies_.sweep(timer_, phases_.sweep, phases_.links);
  {
    const auto scope = timer_.measure(phases_.loads);
    book_masses();
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
  if (parameters_.bodies.moments) s.grains.fluid_stress = {fluid_stress_.data(), n};
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
  const std::array<Vec3, 6> of_fluid = fluid_.wall_forces(bodies_.reference_density());
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
  archive.attribute("mass/reference", bodies_.reference_density());
}

template <typename Real>
void ResolvedSystem<Real>::load(ArchiveReader& archive) {
  require_same_time_step(archive, time_step());
  step_ = archive.integer_attribute("system/step");
  bodies_.remove_all();
  fluid_.load(archive);
  grains_->load(archive);
  mass_.load(archive);
  bodies_.set_reference_density(archive.real_attribute("mass/reference"));
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
    bodies_.set_reference_density(density_unit * archive.real_attribute("mass/reference"));
}

// Grains of a resolved run keep the places their links were cut at, others begin where they are. What is in lattice
// units begins anew on another lattice.
template <typename Real>
void ResolvedSystem<Real>::take_grains(ArchiveReader& archive, double spacing) {
  bodies_.remove_all();
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
