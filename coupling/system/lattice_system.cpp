#include "coupling/system/lattice_system.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/state/same_time_step.hpp"
#include "coupling/loads/momentum_budget.hpp"
#include "coupling/system/fluid_mass.hpp"
#include "coupling/system/imported_fluid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace thalweg::coupling {

namespace {

// Throws InputError if the saved grains carry another number of columns.
void require_same_columns(const ArchiveReader& archive, int width) {
  const std::string name = "grains/system_columns";
  if (!archive.has(name) || archive.integer_attribute(name) == width) return;
  throw InputError(fmt::format(
      "The grains of this checkpoint carry {} values of their exchange with the fluid, those of this program {}: it "
      "was written by another version; finish the run with that one, or begin a new run from its state with "
      "initial.from.",
      archive.integer_attribute(name), width));
}

std::vector<bodies::Solid> with_motions(const std::vector<bodies::SolidShape>& shapes,
                                        const std::vector<dem::PrescribedMotion>& motions) {
  std::vector<bodies::Solid> solids;
  for (std::size_t s = 0; s < shapes.size(); ++s)
    solids.push_back({shapes[s], s < motions.size() && motions[s].moves()});
  return solids;
}

}  // namespace

template <typename Real>
LatticeSystem<Real>::LatticeSystem(std::unique_ptr<Decomposition> decomposition, MPI_Comm communicator,
                                   const LatticeParameters& parameters, std::unique_ptr<dem::GrainDynamics> grains,
                                   const std::vector<bodies::SolidShape>& solids)
    : decomposition_(std::move(decomposition)),
      communicator_(communicator),
      parameters_(parameters),
      fluid_(*decomposition_, communicator, parameters.collision, parameters.faces),
      rest_(rest_state(parameters, *decomposition_)),
      bodies_(*decomposition_, communicator, fluid_, parameters.bodies, rest_,
              with_motions(solids, parameters.solid_motions)),
      solid_bodies_(communicator, bodies_, parameters.units, parameters.solid_motions),
      grains_(std::move(grains)),
      mass_(communicator) {
  name_phases();
  if (has_bodies()) bodies_.check_block(communicator);
  if (parameters_.flow_target) fluid_.control_flow(*parameters_.flow_target);
  set_gravity_of(step_);
  fluid_.carry_force();
  initialise(fluid_, parameters_, rest_);
  if (grains_) {
    grain_bodies_.emplace(communicator, *grains_, bodies_, decomposition_->box(), parameters_.units, parameters_.load);
    grain_bodies_->begin_where_grains_are();
    grain_bodies_->place_at_start();
    open_mass_budget();
  }
}

template <typename Real>
void LatticeSystem<Real>::name_phases() {
  if (!has_bodies()) {
    phases_.lattice = timer_.phase("lattice");
    return;
  }
  if (any_moves()) {
    phases_.map = timer_.phase(grains_ ? "grain map" : "solid map");
    phases_.refill = timer_.phase("refill");
  }
  phases_.halo = timer_.phase("halo");
  phases_.walls = timer_.phase("walls");
  phases_.links = timer_.phase("links");
  phases_.sweep = timer_.phase("sweep");
  if (grains_) {
    phases_.loads = timer_.phase("loads");
    phases_.grains = timer_.phase("grains");
  }
}

// Sets the gravity of fluid and grains in the step of this number, from 1.
template <typename Real>
void LatticeSystem<Real>::set_gravity_of(std::int64_t step) {
  set_gravity(fluid_, parameters_, step);
  if (grains_ && parameters_.ramp > 0.0) grains_->set_body_force_factor(gravity_factor(parameters_, step));
}

// Pressure gradient that holds the mean velocity, as in the last step, N/m^3.
template <typename Real>
Vec3 LatticeSystem<Real>::held_force_on_grains() const {
  Vec3 force = Vec3::Zero();
  if (!parameters_.target_moves_grains) return force;
  const int axis = parameters_.flow_target->axis;
  force[axis] = fluid_.parameters().force[axis] * parameters_.units.density * parameters_.units.acceleration();
  return force;
}

template <typename Real>
void LatticeSystem<Real>::advance() {
  if (has_bodies()) {
    momentum_.reset();
    solid_bodies_.forget_loaded();
    move_bodies();
    if (grains_) grains_->keep_body_force();
    set_gravity_of(step_ + 1);
    exchange_behind_links();
    if (next_.momentum_by_height) record_momentum_budget();
    bodies_.sweep(timer_, phases_.sweep, phases_.links);
    solid_bodies_.settle_masses();
    if (grains_) take_loads();
    if (grains_) advance_grains();
  } else {
    set_gravity_of(step_ + 1);
    const auto scope = timer_.measure(phases_.lattice);
    fluid_.advance();
  }
  ++step_;
  next_ = {};
  keep_mass();
}

// Restores the positions that moving solids had in the last step.
template <typename Real>
void LatticeSystem<Real>::place_solids_again() {
  if (!solid_bodies_.any_moves() || step_ == 0) return;
  bodies_.begin_step();
  solid_bodies_.move(static_cast<double>(step_ - 1) * time_step());
  bodies_.settle_at_start();
}

template <typename Real>
double LatticeSystem<Real>::mass_owed() const {
  return solid_bodies_.mass_owed() + (grains_ ? grain_bodies_->mass_owed() : 0.0);
}

// Velocity (m/s) of the fluid at a point of this rank; zero in a body.
template <typename Real>
Vec3 LatticeSystem<Real>::velocity_at(const Vec3& point) const {
  Index3 cell;
  for (int axis = 0; axis < 3; ++axis)
    cell[axis] =
        std::clamp(static_cast<int>(point[axis] / parameters_.units.spacing), 0, decomposition_->cells()[axis] - 1);
  const std::optional<State> state = state_in(cell);
  return state ? state->velocity : Vec3::Zero();
}

template <typename Real>
void LatticeSystem<Real>::move_bodies() {
  if (!any_moves()) {
    bodies_.begin_step();
    return;
  }
  bool slots_changed = false;
  if (grains_) {
    const auto scope = timer_.measure(phases_.grains);
    if (grains_->has_turnover()) grain_bodies_->update_motions();
    const bool turned_over = grains_->turn_over([this](const Vec3& point) { return velocity_at(point); });
    if (turned_over) grain_bodies_->begin_where_grains_are();
    if (turned_over) grain_bodies_->set_surroundings(bodies_.reference_density());
    slots_changed = grains_->prepare() || turned_over;
  }
  {
    const auto scope = timer_.measure(phases_.map);
    bodies_.begin_step(next_);
    solid_bodies_.move(time());
    if (grains_) grain_bodies_->move_bodies(slots_changed);
    bodies_.settle();
  }
  const auto scope = timer_.measure(phases_.refill);
  bodies_.refill();
}

// Links follow from the map of the cells alone, so they are rebuilt while the halo is on its way.
template <typename Real>
void LatticeSystem<Real>::exchange_behind_links() {
  {
    const auto scope = timer_.measure(phases_.halo);
    fluid_.start_halo_exchange();
  }
  if (any_moves()) {
    const auto scope = timer_.measure(phases_.map);
    bodies_.update_links();
  }
  {
    const auto scope = timer_.measure(phases_.halo);
    fluid_.finish_halo_exchange();
  }
  const auto scope = timer_.measure(phases_.walls);
  fluid_.apply_walls();
}

template <typename Real>
void LatticeSystem<Real>::record_momentum_budget() {
  momentum_ = momentum_budget_of(fluid_, parameters_.units, bodies_.reference_density(), bodies_.momentum_by_height());
  momentum_->driving_of_grains = held_force_on_grains();
}

template <typename Real>
void LatticeSystem<Real>::take_loads() {
  const auto scope = timer_.measure(phases_.loads);
  const bodies::ExchangeTotals& totals = bodies_.step_totals();
  mass_.record(MassBudget::links, totals.link_mass);
  mass_.record(MassBudget::uncovered, totals.refilled_mass);
  mass_.record(MassBudget::covered, totals.covered_mass);
  grains_->set_force_density(held_force_on_grains());
  grain_bodies_->take_loads();
}

template <typename Real>
void LatticeSystem<Real>::advance_grains() {
  const auto scope = timer_.measure(phases_.grains);
  grains_->advance(parameters_.sub_steps);
  grains_->refresh_ghosts();
}

// Starts the budget of a run: the present mass, and what imported grains owe, is to be conserved.
template <typename Real>
void LatticeSystem<Real>::open_mass_budget() {
  const ExcessMass excess = excess_mass(survey_of(fluid_), rest_);
  if (!grains_) {
    start_excess_ = excess.sum;
    return;
  }
  mass_.open(excess.sum, mass_owed());
  bodies_.set_reference_density(excess.mean());
  grain_bodies_->set_surroundings(excess.mean());
}

// Corrects mass errors that no body owes: round-off, and walls and solids that do not conserve mass. Called at the end
// of a step, so that checkpoints contain it.
template <typename Real>
void LatticeSystem<Real>::keep_mass() {
  if (!has_bodies() || !corrects_mass_at(step_)) return;
  const bool is_closed = closed(parameters_.faces);
  if (!grains_ && !is_closed) return;
  const ExcessMass excess = excess_mass(survey_of(fluid_), rest_);
  if (grains_) bodies_.set_reference_density(excess.mean());
  if (!is_closed) return;
  const double kept = (grains_ ? mass_.kept() : start_excess_) - mass_owed();
  const double added = restore_excess(fluid_, excess, kept);
  if (grains_ && rank_of(communicator_) == 0) mass_.record(MassBudget::corrections, added);
}

template <typename Real>
std::int64_t LatticeSystem<Real>::cells() const {
  const Index3& n = decomposition_->cells();
  return static_cast<std::int64_t>(n[0]) * n[1] * n[2];
}

template <typename Real>
std::int64_t LatticeSystem<Real>::grain_steps_per_step() const {
  return grains_ ? grains_->global_count() * parameters_.sub_steps : 0;
}

template <typename Real>
void LatticeSystem<Real>::save(ArchiveWriter& archive) const {
  archive.attribute("system/step", step_);
  archive.attribute("system/time_step", time_step());
  fluid_.save(archive);
  if (bodies_.solids() > 0) solid_bodies_.save(archive);
  if (grains_) {
    grains_->save(archive);
    mass_.save(archive);
    archive.attribute("mass/reference", bodies_.reference_density());
  } else {
    archive.attribute("mass/start", start_excess_);
  }
}

template <typename Real>
void LatticeSystem<Real>::load(ArchiveReader& archive) {
  require_same_time_step(archive, time_step());
  if (grains_) require_same_columns(archive, attached_width);
  step_ = archive.integer_attribute("system/step");
  bodies_.remove_all();
  fluid_.load(archive);
  if (bodies_.solids() > 0) solid_bodies_.load(archive);
  place_solids_again();
  if (grains_) {
    grains_->load(archive);
    mass_.load(archive);
    bodies_.set_reference_density(archive.real_attribute("mass/reference"));
    grain_bodies_->place_at_start();
  } else {
    start_excess_ = archive.real_attribute("mass/start");
  }
  set_gravity_of(step_);
  if (grains_) grains_->set_force_density(held_force_on_grains());
  fluid_.carry_force();
}

template <typename Real>
void LatticeSystem<Real>::import_fluid(ArchiveReader& archive, double spacing) {
  const double density_unit = coupling::import_fluid(fluid_, archive, spacing, parameters_);
  open_mass_budget();
  // Keeps the reference density of the imported run.
  if (grains_ && archive.has("mass/reference"))
    bodies_.set_reference_density(density_unit * archive.real_attribute("mass/reference"));
}

// Grains of a resolved run keep their link positions, others begin where they are. Values in lattice units are reset if
// the lattice differs.
template <typename Real>
void LatticeSystem<Real>::import_grains(ArchiveReader& archive, double spacing) {
  bodies_.remove_all();
  grains_->take(archive);
  grain_bodies_->begin_where_grains_are();
  if (spacing != parameters_.units.spacing || archive.real_attribute("system/time_step") != time_step())
    grain_bodies_->forget_lattice_units();
  grain_bodies_->place_at_start();
  open_mass_budget();
}

template class LatticeSystem<float>;
template class LatticeSystem<double>;

}  // namespace thalweg::coupling
