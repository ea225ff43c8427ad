// LatticeSystem as observers see it: snapshot, diagnostics and fields.
#include "core/sums/wide_sums_over_ranks.hpp"
#include "coupling/system/fluid_diagnostics.hpp"
#include "coupling/system/fluid_mass.hpp"
#include "coupling/system/fluid_sample.hpp"
#include "coupling/system/lattice_system.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::coupling {

template <typename Real>
Snapshot LatticeSystem<Real>::snapshot() const {
  Snapshot s;
  s.time = time();
  s.step = step_;
  s.decomposition = decomposition_.get();
  s.fluid = this;
  if (grains_) show_grains(s);
  return s;
}

template <typename Real>
void LatticeSystem<Real>::show_grains(Snapshot& s) const {
  const dem::GrainStore& store = grains_->store();
  const std::size_t n = store.owned;
  s.contacts = this;
  s.momentum = momentum_ ? &*momentum_ : nullptr;
  s.grains.global_count = grains_->global_count();
  s.grains.id_limit = grains_->id_limit();
  s.grains.force_density = held_force_on_grains();
  s.grains.id = {store.id.data(), n};
  s.grains.radius = {store.radius.data(), n};
  s.grains.mass = {store.mass.data(), n};
  s.grains.position = {store.position.data(), n};
  s.grains.velocity = {store.velocity.data(), n};
  s.grains.angular_velocity = {store.angular_velocity.data(), n};
  s.grains.fluid_force = {store.load_force.data(), n};
  s.grains.fluid_torque = {store.load_torque.data(), n};
  s.grains.fluid_stress = grain_bodies_->stresses();
  s.grains.contact_force = {store.contact_force.data(), n};
  s.grains.contact_torque = {store.contact_torque.data(), n};
  s.grains.motion = grains_->motion();
  grains_->show_clumps(s.grains);
}

template <typename Real>
std::vector<Diagnostic> LatticeSystem<Real>::diagnostics() const {
  const lbm::FluidSurvey survey = survey_of(fluid_);
  const ExcessMass excess = excess_mass(survey, rest_);
  std::vector<Diagnostic> diagnostics = speed_diagnostics(survey, parameters_.units);
  if (!grains_ || parameters_.flow_target) add_flow_diagnostics(survey, diagnostics);
  diagnostics.push_back({"mean_density_deviation", "1", excess.mean()});
  diagnostics.push_back({"fluid_cells", "1", static_cast<double>(excess.cells)});
  if (grains_) diagnostics.push_back({"largest_overlap", "diameter", grains_->largest_overlap()});
  if (grains_ && parameters_.wall_forces) add_wall_forces(diagnostics);
  add_solid_diagnostics(diagnostics);
  add_extremes(survey, diagnostics);
  if (grains_) add_grain_diagnostics(survey, diagnostics);
  return diagnostics;
}

template <typename Real>
void LatticeSystem<Real>::add_flow_diagnostics(const lbm::FluidSurvey& survey,
                                               std::vector<Diagnostic>& diagnostics) const {
  const double cells = static_cast<double>(std::max<std::int64_t>(1, survey.totals.cells));
  const double force = fluid_.parameters().force.x();
  const Units& units = parameters_.units;
  diagnostics.push_back(
      {"mean_velocity_x", "m/s", (survey.totals.momentum.x() / cells - 0.5 * force) * units.velocity()});
  diagnostics.push_back({"body_force_x", "N/m^3", force * units.density * units.acceleration()});
}

template <typename Real>
void LatticeSystem<Real>::add_grain_diagnostics(const lbm::FluidSurvey& survey,
                                                std::vector<Diagnostic>& diagnostics) const {
  diagnostics.push_back({"largest_grain_speed", "m/s", grains_->largest_free_speed()});
  const std::vector<Diagnostic> budget =
      mass_.diagnostics(excess_mass(survey, rest_).sum, mass_owed(), parameters_.units);
  diagnostics.insert(diagnostics.end(), budget.begin(), budget.end());
  add_momentum(survey, fluid_.parameters().force, parameters_.units, diagnostics);
  for (const Diagnostic& diagnostic : grains_->turnover_diagnostics()) diagnostics.push_back(diagnostic);
}

template <typename Real>
void LatticeSystem<Real>::add_solid_diagnostics(std::vector<Diagnostic>& diagnostics) const {
  if (bodies_.solids() == 0) return;
  const std::vector<Diagnostic> of_fluid = solid_bodies_.diagnostics();
  diagnostics.insert(diagnostics.end(), of_fluid.begin(), of_fluid.end());
  if (!grains_) return;
  const std::vector<Vec3> of_grains = grains_->wall_forces();
  for (std::size_t s = 0; s < static_cast<std::size_t>(bodies_.solids()); ++s)
    add_vector(dem::solid_force_diagnostic(s), "N", of_grains[grains_->walls().size() + s], diagnostics);
}

// Forces of the grains at the end of the step, and of the fluid in the coming step.
template <typename Real>
void LatticeSystem<Real>::add_wall_forces(std::vector<Diagnostic>& diagnostics) const {
  const std::vector<Vec3> of_grains = grains_->wall_forces();
  const std::array<Vec3, 6> of_fluid = fluid_.wall_forces(bodies_.reference_density());
  const std::vector<Vec3> under_grains = vectors_over_ranks(communicator_, bodies_.occluded_wall_forces());
  std::size_t wall = 0;
  for (std::size_t face = 0; face < of_fluid.size(); ++face) {
    if (decomposition_->periodic()[face / 2]) continue;
    const Vec3 fluid_force = (of_fluid[face] + under_grains[face]) * parameters_.units.force();
    add_vector(fmt::format("wall_force_{}", dem::face_names[face]), "N", of_grains[wall], diagnostics);
    add_vector(fmt::format("fluid_wall_force_{}", dem::face_names[face]), "N", fluid_force, diagnostics);
    ++wall;
  }
}

template <typename Real>
std::optional<Location> LatticeSystem<Real>::location_of(const std::string& diagnostic) const {
  if (grains_ && diagnostic == "largest_overlap") return grains_->place_of_deepest_overlap();
  if (grains_ && diagnostic == "largest_grain_speed") return grains_->place_of_fastest();
  return location_in_fluid(survey_of(fluid_), parameters_.units, diagnostic);
}

template <typename Real>
FluidFields LatticeSystem<Real>::sample(const std::vector<FluidField>& wanted, const Block& region) const {
  SampleContext context;
  context.units = parameters_.units;
  // A solid n is -2 - n.
  context.grain_id = [this](std::int32_t slot) {
    return slot < bodies_.solids() ? -2 - slot
                                   : static_cast<std::int32_t>(bodies_.mapped()[static_cast<std::size_t>(slot)].id);
  };
  if (has_bodies()) context.apply_links = [this] { bodies_.apply_links_on_copies(); };
  return sample_fields(fluid_, context, wanted, region);
}

template <typename Real>
void LatticeSystem<Real>::for_each_velocity(const VelocityVisitor& visit) const {
  visit_velocities(fluid_, parameters_.units, visit);
}

template <typename Real>
std::optional<FluidSource::State> LatticeSystem<Real>::state_in(const Index3& cell) const {
  return state_of(fluid_, parameters_.units, cell);
}

template <typename Real>
FluidSource::Drive LatticeSystem<Real>::drive() const {
  Drive drive = drive_of(fluid_, parameters_.units, bodies_.reference_density());
  if (bodies_.solids() == 0) return drive;
  for (const Vec3& force : solid_bodies_.loads().forces) drive.on_solids += force * parameters_.units.force();
  return drive;
}

template class LatticeSystem<float>;
template class LatticeSystem<double>;

}  // namespace thalweg::coupling
