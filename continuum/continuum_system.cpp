#include "continuum/continuum_system.hpp"

#include "core/base/error.hpp"
#include "core/base/round_off.hpp"
#include "core/state/same_time_step.hpp"
#include "core/state/whole_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::continuum {

namespace {

// Tolerances of the integrator: the relative error of velocities, and the absolute errors of the solid fraction (1) and
// of velocities, in shear speeds of the mixture. Grains of a bed at rest creep more slowly than creeping_rate times a
// cell, 3.6e-6 of them, and their error must stay below that.
constexpr double relative_error = 1e-4, fraction_error = 1e-6, grain_error = 3.6e-7, fluid_error = 3.6e-5;

constexpr double least_transport = 1e-4;  // q*, to which changes are compared where there is less
constexpr int creep_points = 801;

std::vector<Tolerance> tolerances_of(const ColumnParameters& column) {
  std::vector<Tolerance> tolerances;
  const double shear = column.shear_speed();
  for (int i = 0; i < column.cells; ++i)
    tolerances.insert(tolerances.end(), {{0.0, fraction_error * column.spacing},
                                         {relative_error, grain_error * shear},
                                         {relative_error, fluid_error * shear}});
  return tolerances;
}

// Velocity of clear water under its own weight over a floor: eta U' + rho_f l^2 U'^2 = rho_f g_x (depth - z), l =
// l_m(0).
std::vector<double> clear_flow(const ColumnParameters& column, double depth, int cells) {
  const Mixture& mixture = column.mixture;
  const double length =
      mixing_length(column.closures.turbulence, mixture.diameter, column.closures.rheology.densest_fraction, 0.0);
  const double inertia = mixture.fluid_density * length * length;
  std::vector<double> velocity;
  double u = 0.0;
  for (int i = 0; i < cells; ++i) {
    const double stress = mixture.fluid_density * column.gravity_x * std::max(0.0, depth - i * column.spacing);
    const double rate =
        2.0 * stress / (mixture.viscosity + std::sqrt(mixture.viscosity * mixture.viscosity + 4.0 * inertia * stress));
    u += rate * column.spacing * (i == 0 ? 0.5 : 1.0);
    velocity.push_back(u);
  }
  return velocity;
}

ColumnState initial_state(const SystemParameters& parameters) {
  const auto cells = static_cast<std::size_t>(parameters.column.cells),
             bed = static_cast<std::size_t>(parameters.bed_cells);
  ColumnState state;
  state.fraction.assign(cells, 0.0);
  std::fill_n(state.fraction.begin(), bed, parameters.column.closures.rheology.densest_fraction);
  state.fluid_velocity.assign(cells, 0.0);
  if (parameters.start == ColumnStart::flow) {
    const std::vector<double> flow =
        clear_flow(parameters.column, parameters.depth, parameters.column.cells - parameters.bed_cells);
    std::copy(flow.begin(), flow.end(), state.fluid_velocity.begin() + parameters.bed_cells);
  }
  state.grain_velocity = state.fluid_velocity;
  return state;
}

Profile over(const std::string& axis, const std::string& name, const std::string& unit, std::vector<double> values) {
  const auto n = static_cast<std::uint64_t>(values.size());
  return {name, unit, {axis}, {}, {n}, std::move(values)};
}
Profile over_z(const std::string& name, const std::string& unit, std::vector<double> values) {
  return over("z", name, unit, std::move(values));
}

// Along x.
Profile vector_over_z(const std::string& name, const std::string& unit, const std::vector<double>& x) {
  Profile profile{name, unit, {"z"}, {"x", "y", "z"}, {static_cast<std::uint64_t>(x.size()), 3}, {}};
  for (const double value : x) profile.values.insert(profile.values.end(), {value, 0.0, 0.0});
  return profile;
}

std::vector<double> at_middles(const std::vector<double>& faces) {
  std::vector<double> middles;
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) middles.push_back(0.5 * (faces[i] + faces[i + 1]));
  return middles;
}

// Throws InputError unless the cells are equally high. Their number agrees, but their height follows from the depth of
// the water, and so perhaps from gravity.
void require_same_spacing(const ArchiveReader& archive, const SystemParameters& parameters) {
  const double saved = archive.real_attribute("column/spacing"), here = parameters.column.spacing;
  if (same_but_for_rounding(saved, here)) return;
  throw InputError(fmt::format(
      "its cells are {:.10g} m high and those of this case {:.10g} m; a restart keeps them: set column, fluid "
      "and gravity back, or give a column.depth of {:.10g} m.",
      saved, here, saved * (parameters.column.cells - parameters.bed_cells)));
}

}  // namespace

std::vector<NamedChoice<ColumnStart>> choices_of(ColumnStart) {
  return {{ColumnStart::flow, "flow", "the water flows over a bed at rest, under its own weight alone"},
          {ColumnStart::rest, "rest", "water and grains at rest"}};
}

static BedStress stress_below(const SystemParameters& parameters) {
  const ColumnParameters& column = parameters.column;
  const double d = column.mixture.diameter;
  return resting_bed(column.closures.rheology, column.mixture, column.gravity_x, column.gravity_z,
                     column.mixture.fluid_density * column.gravity_x * parameters.depth, parameters.creep->lower * d,
                     parameters.creep->upper * d, creep_points);
}

static Creep creep_under(const SystemParameters& parameters, const BedStress& stress) {
  const Rheology& rheology = parameters.column.closures.rheology;
  const CreepParameters& creep = *parameters.creep;
  return creep_of(rheology, parameters.column.mixture, creep.nonlocal_amplitude,
                  creep.rate_coefficient.value_or(local_rate_coefficient(rheology)), stress, creep.surface_fluidity);
}

Creep creep_below(const SystemParameters& parameters) { return creep_under(parameters, stress_below(parameters)); }

ContinuumSystem::ContinuumSystem(MPI_Comm communicator, const SystemParameters& parameters)
    : communicator_(communicator),
      parameters_(parameters),
      decomposition_({1, 1, parameters.column.cells}, parameters.column.spacing, {true, true, false}, {1, 1, 1}),
      equations_(parameters.column),
      integrator_(ColumnEquations::half_bandwidth, tolerances_of(parameters.column),
                  [this](std::span<const double> y, std::span<double> rates) { equations_.rates(y, rates); }),
      unknowns_(equations_.unknowns_of(initial_state(parameters))),
      phase_(timer_.phase("column")) {
  if (!parameters.creep) return;
  creep_stress_ = stress_below(parameters);
  creep_ = creep_under(parameters, *creep_stress_);
}

void ContinuumSystem::advance() {
  const auto scope = timer_.measure(phase_);
  const ColumnParameters& column = parameters_.column;
  const double d = column.mixture.diameter, reduced = column.mixture.excess_density() / column.mixture.fluid_density *
                                                      std::hypot(column.gravity_x, column.gravity_z);
  const double transport = transport_rate(), before = momentum();
  const std::int64_t steps = integrator_.steps();
  integrator_.advance(unknowns_, parameters_.time_step);
  integrator_steps_ += integrator_.steps() - steps;
  ++step_;
  const double now = transport_rate();
  transport_change_ =
      std::abs(now - transport) / std::max(std::abs(now), least_transport * std::sqrt(reduced * d * d * d));
  const double driving = driving_stress(0) * parameters_.time_step;
  momentum_change_ = driving > 0.0 ? std::abs(momentum() - before) / driving : 0.0;
}

Snapshot ContinuumSystem::snapshot() const {
  Snapshot snapshot;
  snapshot.time = time();
  snapshot.step = step_;
  snapshot.decomposition = &decomposition_;
  return snapshot;
}

double ContinuumSystem::transport_rate() const {
  const ColumnState& state = equations_.state_of(unknowns_);
  double sum = 0.0;
  for (std::size_t i = 0; i < state.fraction.size(); ++i) sum += state.fraction[i] * state.grain_velocity[i];
  return sum * parameters_.column.spacing;
}

double ContinuumSystem::momentum() const {
  const ColumnState& state = equations_.state_of(unknowns_);
  const Mixture& mixture = parameters_.column.mixture;
  double sum = 0.0;
  for (std::size_t i = 0; i < state.fraction.size(); ++i)
    sum += mixture.grain_density * state.fraction[i] * state.grain_velocity[i] +
           mixture.fluid_density * (1.0 - state.fraction[i]) * state.fluid_velocity[i];
  return sum * parameters_.column.spacing;
}

// Pa: g_x times the mass above a face.
double ContinuumSystem::driving_stress(std::size_t face) const {
  const std::vector<double>& phi = equations_.state_of(unknowns_).fraction;
  const Mixture& mixture = parameters_.column.mixture;
  double mass = 0.0;
  for (std::size_t i = face; i < phi.size(); ++i)
    mass += (phi[i] * mixture.grain_density + (1.0 - phi[i]) * mixture.fluid_density) * parameters_.column.spacing;
  return parameters_.column.gravity_x * mass;
}

// m above the floor, between the middles of the two cells where phi falls below half of the densest, seen from above:
// the top of the column where the grains reach it, 0 where no cell is as dense.
double ContinuumSystem::surface_height() const {
  const std::vector<double>& phi = equations_.state_of(unknowns_).fraction;
  const double half = 0.5 * parameters_.column.closures.rheology.densest_fraction, dz = parameters_.column.spacing;
  if (phi.back() >= half) return parameters_.column.height();
  for (std::size_t i = phi.size() - 1; i-- > 0;)
    if (phi[i] >= half) return (static_cast<double>(i) + 0.5 + (phi[i] - half) / (phi[i] - phi[i + 1])) * dz;
  return 0.0;
}

// Pa: rho_f g_x times the depth of the water above the surface.
double ContinuumSystem::bed_stress() const {
  const ColumnParameters& column = parameters_.column;
  return column.mixture.fluid_density * column.gravity_x * (column.height() - surface_height());
}

double ContinuumSystem::largest_grain_speed() const {
  const ColumnState& state = equations_.state_of(unknowns_);
  double largest = 0.0;
  for (std::size_t i = 0; i < state.fraction.size(); ++i)
    if (state.fraction[i] > ColumnEquations::dilute) largest = std::max(largest, state.grain_velocity[i]);
  return largest;
}

double ContinuumSystem::moving_depth(double surface) const {
  const ColumnState& state = equations_.state_of(unknowns_);
  const double dz = parameters_.column.spacing;
  const auto top = std::min(state.fraction.size() - 1, static_cast<std::size_t>(surface / dz));
  const double fastest = *std::max_element(state.grain_velocity.begin(), state.grain_velocity.begin() + top + 1);
  std::size_t lowest = top + 1;
  while (lowest > 0 && state.grain_velocity[lowest - 1] > 0.01 * fastest) --lowest;
  return std::max(0.0, surface - static_cast<double>(lowest) * dz);
}

std::vector<Diagnostic> ContinuumSystem::diagnostics() const {
  const ColumnParameters& column = parameters_.column;
  const Mixture& mixture = column.mixture;
  const double gravity = std::hypot(column.gravity_x, column.gravity_z), d = mixture.diameter;
  const double weight = mixture.excess_density() * gravity * d;
  const double transport = transport_rate(), surface = surface_height(), stress = bed_stress();
  const ColumnState& state = equations_.state_of(unknowns_);
  std::vector<Diagnostic> diagnostics{
      {"q_s", "m^2/s", transport},
      {"q_star", "1", transport / std::sqrt(weight / mixture.fluid_density * d * d)},
      {"shields_number", "1", stress / weight},
      {"bed_stress", "Pa", stress},
      {"surface_height", "m", surface},
      {"moving_depth", "m", moving_depth(surface)},
      {"largest_grain_speed", "m/s", largest_grain_speed()},
      {"largest_fluid_speed", "m/s", *std::max_element(state.fluid_velocity.begin(), state.fluid_velocity.end())},
      {"solid_volume", "m", unknowns_[unknowns_.size() - ColumnEquations::unknowns_per_cell]},
      {"integrator_steps", "1", static_cast<double>(integrator_steps_)},
      {unsteadiness_diagnostic, "1", std::max(transport_change_, momentum_change_)}};
  if (!creep_) return diagnostics;
  const double above = (parameters_.creep->lower - creep_decay_depth) * d / creep_stress_->spacing;
  const double length =
      decay_length(*creep_, creep_stress_->spacing, static_cast<std::size_t>(std::max(0.0, std::round(above))));
  diagnostics.push_back({"creep_decay_length", "m", length});
  diagnostics.push_back({"creep_decade_length", "m", length * std::numbers::ln10});
  return diagnostics;
}

std::vector<Profile> ContinuumSystem::profiles() const {
  const ColumnParameters& column = parameters_.column;
  const std::vector<double> pressure = equations_.pressures_of(unknowns_), drag = equations_.drag_of(unknowns_);
  const ColumnFluxes fluxes = equations_.fluxes_of(unknowns_);
  const ColumnState state = equations_.state_of(unknowns_);
  std::vector<double> z, driving, total, drag_function, reynolds;
  for (std::size_t face = 0; face <= state.fraction.size(); ++face) {
    driving.push_back(driving_stress(face));
    total.push_back(fluxes.grain_stress[face] + fluxes.fluid_stress[face]);
  }
  for (std::size_t i = 0; i < state.fraction.size(); ++i) {
    z.push_back((static_cast<double>(i) + 0.5) * column.spacing);
    const ColumnEquations::CellDrag of_cell = equations_.drag_in(i);
    drag_function.push_back(of_cell.function);
    reynolds.push_back(of_cell.reynolds);
  }
  std::vector<Profile> profiles{over_z("z", "m", z),
                                over_z("thickness", "m", std::vector<double>(z.size(), column.spacing)),
                                over_z("solid_fraction", "1", state.fraction),
                                vector_over_z("grain_velocity", "m/s", state.grain_velocity),
                                vector_over_z("fluid_velocity", "m/s", state.fluid_velocity),
                                vector_over_z("drag_density", "N/m^3", drag),
                                over_z("drag_function", "1", drag_function),
                                over_z("drag_reynolds_number", "1", reynolds),
                                over_z("grain_pressure", "Pa", pressure),
                                over_z("grain_shear_stress", "Pa", at_middles(fluxes.grain_stress)),
                                over_z("fluid_shear_stress", "Pa", at_middles(fluxes.fluid_stress)),
                                over_z("total_stress", "Pa", at_middles(total)),
                                over_z("driving_stress", "Pa", at_middles(driving)),
                                over_z("eddy_viscosity", "Pa s", at_middles(fluxes.eddy_viscosity)),
                                over_z("drift_velocity", "m/s", at_middles(fluxes.drift_velocity))};
  if (creep_) add_creep(profiles);
  return profiles;
}

void ContinuumSystem::add_creep(std::vector<Profile>& profiles) const {
  std::vector<double> depth, ratio;
  for (std::size_t i = 0; i < creep_->fluidity.size(); ++i) {
    depth.push_back(parameters_.creep->lower * parameters_.column.mixture.diameter -
                    static_cast<double>(i) * creep_stress_->spacing);
    ratio.push_back(creep_stress_->ratio(i));
  }
  profiles.push_back(over("creep_depth", "creep_depth", "m", depth));
  profiles.push_back(over("creep_depth", "creep_stress_ratio", "1", ratio));
  profiles.push_back(over("creep_depth", "creep_fluidity", "1/s", creep_->fluidity));
  profiles.push_back(over("creep_depth", "creep_velocity", "m/s", creep_->grain_velocity));
}

void ContinuumSystem::save(ArchiveWriter& archive) const {
  archive.attribute("system/step", step_);
  archive.attribute("system/time_step", parameters_.time_step);
  archive.attribute("column/spacing", parameters_.column.spacing);
  archive.attribute("column/transport_change", transport_change_);
  archive.attribute("column/momentum_change", momentum_change_);
  archive.attribute("column/integrator_steps", integrator_steps_);
  write_whole(archive, communicator_, "column/unknowns", std::span<const double>(unknowns_), {unknowns_.size()});
}

void ContinuumSystem::load(ArchiveReader& archive) {
  require_same_time_step(archive, parameters_.time_step);
  const std::vector<std::uint64_t> shape{unknowns_.size()};
  archive.read("column/unknowns", std::span<double>(unknowns_), {shape, {0}, shape});
  require_same_spacing(archive, parameters_);
  step_ = archive.integer_attribute("system/step");
  transport_change_ = archive.real_attribute("column/transport_change");
  momentum_change_ = archive.real_attribute("column/momentum_change");
  integrator_steps_ = archive.integer_attribute("column/integrator_steps");
}

}  // namespace thalweg::continuum
