#include "coupling/fluid_system.hpp"

#include "core/mpi_session.hpp"
#include "core/same_time_step.hpp"
#include "coupling/fluid_figures.hpp"
#include "coupling/fluid_mass.hpp"
#include "coupling/fluid_sample.hpp"
#include "coupling/taken_fluid.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::coupling {

template <typename Real>
FluidSystem<Real>::FluidSystem(std::unique_ptr<Decomposition> decomposition, MPI_Comm communicator,
                               const FluidParameters& parameters, const std::vector<bodies::SolidShape>& solids)
    : decomposition_(std::move(decomposition)),
      communicator_(communicator),
      parameters_(parameters),
      fluid_(*decomposition_, communicator, parameters.collision, parameters.faces),
      rest_(rest_state(parameters, *decomposition_)),
      solid_forces_(communicator, static_cast<int>(solids.size())) {
  if (solids.empty())
    phases_.lattice = timer_.phase("lattice");
  else
    phases_ = {0, timer_.phase("halo"), timer_.phase("walls"), timer_.phase("links"), timer_.phase("sweep")};
  if (!solids.empty())
    solids_ =
        std::make_unique<bodies::Bodies<Real>>(*decomposition_, communicator, fluid_, parameters.bodies, rest_, solids);
  if (parameters_.flow_target) fluid_.control_flow(*parameters_.flow_target);
  initialise(fluid_, parameters_, rest_);
  set_gravity(fluid_, parameters_, step_);
  fluid_.carry_force();
}

template <typename Real>
void FluidSystem<Real>::advance() {
  set_gravity(fluid_, parameters_, step_ + 1);
  if (solids_) {
    advance_around_solids();
  } else {
    const auto scope = timer_.measure(phases_.lattice);
    fluid_.advance();
  }
  ++step_;
  if (solids_) keep_mass();
}

// The links of a solid conserve no mass where the pressure changes along them (mass_return.hpp).
template <typename Real>
void FluidSystem<Real>::keep_mass() {
  if (looks_at_mass(step_) && closed(parameters_.faces))
    restore_excess(fluid_, excess_mass(survey_of(fluid_), rest_), start_excess_);
}

template <typename Real>
void FluidSystem<Real>::advance_around_solids() {
  {
    const auto scope = timer_.measure(phases_.halo);
    fluid_.exchange_halo();
  }
  {
    const auto scope = timer_.measure(phases_.walls);
    fluid_.apply_walls();
  }
  solid_forces_.forget();
  solids_->begin_step();
  solids_->sweep(timer_, phases_.sweep, phases_.links);
}

template <typename Real>
std::int64_t FluidSystem<Real>::cells() const {
  const Index3& n = decomposition_->cells();
  return static_cast<std::int64_t>(n[0]) * n[1] * n[2];
}

template <typename Real>
Snapshot FluidSystem<Real>::snapshot() const {
  Snapshot s;
  s.time = time();
  s.step = step_;
  s.decomposition = decomposition_.get();
  s.fluid = this;
  return s;
}

template <typename Real>
FluidFields FluidSystem<Real>::sample(const std::vector<FluidField>& wanted, const Block& region) const {
  SampleContext context;
  context.units = parameters_.units;
  context.grain_id = [](std::int32_t solid) { return -2 - solid; };
  if (solids_) context.apply_links = [this] { solids_->apply_links_on_copies(); };
  return sample_fields(fluid_, context, wanted, region);
}

template <typename Real>
void FluidSystem<Real>::for_each_velocity(const VelocityVisitor& visit) const {
  visit_velocities(fluid_, parameters_.units, visit);
}

template <typename Real>
std::optional<FluidSource::State> FluidSystem<Real>::state_in(const Index3& cell) const {
  return state_of(fluid_, parameters_.units, cell);
}

template <typename Real>
FluidSource::Drive FluidSystem<Real>::drive() const {
  return drive_of(fluid_, parameters_.units, parameters_.bodies.links.reference_density);
}

template <typename Real>
std::vector<Figure> FluidSystem<Real>::figures() const {
  const lbm::FluidSurvey survey = survey_of(fluid_);
  const double cells = static_cast<double>(std::max<std::int64_t>(1, survey.totals.cells));
  const double force = fluid_.parameters().force[0];
  const Units& units = parameters_.units;
  std::vector<Figure> figures = speed_figures(survey, units);
  figures.push_back({"mean_velocity_x", "m/s", (survey.totals.momentum.x() / cells - 0.5 * force) * units.velocity()});
  figures.push_back({"body_force_x", "N/m^3", force * units.density * units.acceleration()});
  figures.push_back({"mean_density_deviation", "1", excess_mass(survey, rest_).mean()});
  figures.push_back({"fluid_cells", "1", static_cast<double>(survey.totals.cells)});
  if (solids_) {
    const std::vector<Vec3> forces = solid_forces_.of(*solids_);
    for (std::size_t s = 0; s < forces.size(); ++s)
      for (int a = 0; a < 3; ++a)
        figures.push_back({fmt::format("solid_{}_force_{}", s, "xyz"[a]), "N", forces[s][a] * units.force()});
  }
  add_extremes(survey, figures);
  return figures;
}

template <typename Real>
std::optional<Place> FluidSystem<Real>::place_of(const std::string& figure) const {
  return place_in_fluid(survey_of(fluid_), parameters_.units, figure);
}

template <typename Real>
void FluidSystem<Real>::save(ArchiveWriter& archive) const {
  archive.attribute("system/step", step_);
  archive.attribute("system/time_step", time_step());
  fluid_.save(archive);
  if (solids_) solid_forces_.save(*solids_, archive);
  archive.attribute("mass/start", start_excess_);
}

template <typename Real>
void FluidSystem<Real>::load(ArchiveReader& archive) {
  require_same_time_step(archive, time_step());
  step_ = archive.integer_attribute("system/step");
  fluid_.load(archive);
  set_gravity(fluid_, parameters_, step_);
  fluid_.carry_force();
  if (solids_) solid_forces_.load(archive);
  start_excess_ = archive.real_attribute("mass/start");
}

template <typename Real>
void FluidSystem<Real>::take_fluid(ArchiveReader& archive, double spacing) {
  coupling::take_fluid(fluid_, archive, spacing, parameters_);
  start_excess_ = excess_mass(survey_of(fluid_), rest_).sum;
}

template class FluidSystem<float>;
template class FluidSystem<double>;

}  // namespace thalweg::coupling
