#include "coupling/system/fluid_sample.hpp"

#include "lbm/fluid/flow_fields.hpp"
#include "lbm/lattice/for_each_cell.hpp"

#include <algorithm>
#include <initializer_list>

namespace thalweg::coupling {

namespace {

bool wants(const std::vector<FluidField>& wanted, std::initializer_list<FluidField> any) {
  return std::find_first_of(wanted.begin(), wanted.end(), any.begin(), any.end()) != wanted.end();
}

FluidSource::State in_si(const lbm::FluidState& state, const Units& units) {
  return {state.velocity * units.velocity(), state.density_deviation * (units.stress() / 3.0)};
}

void put(std::vector<double>& values, std::size_t at, const Vec3& v) {
  for (int a = 0; a < 3; ++a) values[3 * at + a] = v[a];
}

// Calls visit(index in memory, local coordinates, place in the fields) for every cell of the fields.
template <typename Real, typename Visit>
void for_each_shown_cell(const lbm::Fluid<Real>& fluid, const FluidFields& fields, Visit visit) {
  const Block part = lbm::local_block(fluid.block(), fields.block);
  lbm::for_each_cell(fluid.indexing(), part, [&](std::ptrdiff_t cell, const Index3& local) {
    visit(cell, local, static_cast<std::size_t>(part.location_of(local)));
  });
}

template <typename Real, typename Visit>
void for_each_shown_fluid_cell(const lbm::Fluid<Real>& fluid, const FluidFields& fields, Visit visit) {
  for_each_shown_cell(fluid, fields, [&](std::ptrdiff_t cell, const Index3& local, std::size_t at) {
    if (fluid.cells().is_fluid(cell)) visit(cell, local, at);
  });
}

template <typename Real>
void sample_states(const lbm::Fluid<Real>& fluid, const SampleContext& context, FluidFields& fields) {
  const Units& units = context.units;
  for_each_shown_cell(fluid, fields, [&](std::ptrdiff_t cell, const Index3&, std::size_t at) {
    const std::int32_t body = fluid.cells().body(cell);
    if (!fields.grain_id.empty()) fields.grain_id[at] = body == lbm::CellMap::fluid ? -1 : context.grain_id(body);
    if (body != lbm::CellMap::fluid) return;
    const lbm::FluidState state = fluid.state_at(cell);
    const FluidSource::State shown = in_si(state, units);
    if (!fields.velocity.empty()) put(fields.velocity, at, shown.velocity);
    if (!fields.pressure.empty()) fields.pressure[at] = shown.pressure;
    if (!fields.density.empty()) fields.density[at] = (1.0 + state.density_deviation) * units.density;
  });
}

template <typename Real>
void sample_subgrid(lbm::Fluid<Real>& fluid, const SampleContext& context, FluidFields& fields) {
  fluid.exchange_halo();
  fluid.apply_walls();
  if (context.apply_links) context.apply_links();
  for_each_shown_fluid_cell(fluid, fields, [&](std::ptrdiff_t cell, const Index3&, std::size_t at) {
    const lbm::SubgridState state = lbm::subgrid_state(fluid, cell);
    if (!fields.shear_rate.empty()) fields.shear_rate[at] = state.shear_rate / context.units.time_step;
    if (!fields.eddy_viscosity.empty())
      fields.eddy_viscosity[at] = state.eddy_viscosity * context.units.kinematic_viscosity();
  });
}

template <typename Real>
void sample_gradients(const lbm::Fluid<Real>& fluid, const SampleContext& context, const Block& region,
                      FluidFields& fields) {
  const GhostedField velocity = lbm::velocity_field(fluid, region);
  const double rate = 1.0 / context.units.time_step;
  for_each_shown_fluid_cell(fluid, fields, [&](std::ptrdiff_t, const Index3& local, std::size_t at) {
    const lbm::Gradient gradient = lbm::velocity_gradient(velocity, local[0], local[1], local[2]);
    if (!fields.vorticity.empty()) put(fields.vorticity, at, lbm::vorticity(gradient) * rate);
    if (!fields.q_criterion.empty()) fields.q_criterion[at] = lbm::q_criterion(gradient) * rate * rate;
  });
}

}  // namespace

template <typename Real>
FluidFields sample_fields(lbm::Fluid<Real>& fluid, const SampleContext& context, const std::vector<FluidField>& wanted,
                          const Block& region) {
  FluidFields fields;
  fields.block = intersection(fluid.block(), region);
  const auto cells = static_cast<std::size_t>(fields.block.volume());
  for (const FluidField field : wanted) {
    if (field == FluidField::grain_id)
      fields.grain_id.assign(cells, -1);
    else
      values_of(fields, field).assign(components_of(field) * cells, 0.0);
  }
  using enum FluidField;
  if (wants(wanted, {velocity, pressure, density, grain_id})) sample_states(fluid, context, fields);
  if (wants(wanted, {vorticity, q_criterion})) sample_gradients(fluid, context, region, fields);
  if (wants(wanted, {shear_rate, eddy_viscosity})) sample_subgrid(fluid, context, fields);
  return fields;
}

template <typename Real>
void visit_velocities(const lbm::Fluid<Real>& fluid, const Units& units, const FluidSource::VelocityVisitor& visit) {
  const Index3& from = fluid.block().lower;
  lbm::for_each_fluid_cell(fluid.cells(), [&](std::ptrdiff_t cell, const Index3& at) {
    visit({from[0] + at[0], from[1] + at[1], from[2] + at[2]}, fluid.state_at(cell).velocity * units.velocity());
  });
}

template <typename Real>
std::optional<FluidSource::State> state_of(const lbm::Fluid<Real>& fluid, const Units& units, const Index3& cell) {
  const Index3& from = fluid.block().lower;
  const std::ptrdiff_t index = fluid.indexing().index(cell[0] - from[0], cell[1] - from[1], cell[2] - from[2]);
  if (!fluid.cells().is_fluid(index)) return std::nullopt;
  return in_si(fluid.state_at(index), units);
}

template <typename Real>
FluidSource::Drive drive_of(lbm::Fluid<Real>& fluid, const Units& units, double reference) {
  FluidSource::Drive drive;
  drive.on_top = fluid.wall_forces(reference)[5] * units.force();
  drive.body_force = fluid.parameters().force * (units.stress() / units.spacing);
  return drive;
}

template FluidSource::Drive drive_of(lbm::Fluid<float>&, const Units&, double);
template FluidSource::Drive drive_of(lbm::Fluid<double>&, const Units&, double);
template std::optional<FluidSource::State> state_of(const lbm::Fluid<float>&, const Units&, const Index3&);
template std::optional<FluidSource::State> state_of(const lbm::Fluid<double>&, const Units&, const Index3&);
template void visit_velocities(const lbm::Fluid<float>&, const Units&, const FluidSource::VelocityVisitor&);
template void visit_velocities(const lbm::Fluid<double>&, const Units&, const FluidSource::VelocityVisitor&);
template FluidFields sample_fields(lbm::Fluid<float>&, const SampleContext&, const std::vector<FluidField>&,
                                   const Block&);
template FluidFields sample_fields(lbm::Fluid<double>&, const SampleContext&, const std::vector<FluidField>&,
                                   const Block&);

}  // namespace thalweg::coupling
