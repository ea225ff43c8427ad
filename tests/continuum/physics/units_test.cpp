// A column in other units of length, time and mass: what follows from its keys and its rates change by the factor of
// their unit, to the last bit for factors that are powers of two.
#include "continuum/column_equations.hpp"
#include "continuum/column_keys.hpp"
#include "continuum/continuum_system.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace thalweg::continuum::units_test {
namespace {

// Of length, time and mass: sixth powers of two, whose roots are exact.
struct Units {
  double m = 1.0, s = 1.0, kg = 1.0;
};
constexpr Units others[] = {{64.0, 1.0, 1.0}, {1.0, 64.0, 1.0}, {1.0, 1.0, 64.0}, {1.0 / 4096.0, 64.0, 1.0 / 64.0}};

// 5 mm glass in water, and sand in oil, whose flow is viscous.
ContinuumKeys keys_of(const FluidPhaseKeys& fluid, const GrainPhaseKeys& grains, double shields_number) {
  ContinuumKeys keys{fluid, grains, {}, {}, {}};
  keys.column.shields_number = shields_number;
  keys.column.bed = 3.0;
  keys.column.cells_per_diameter = 5;
  return keys;
}
ContinuumKeys glass() { return keys_of({1000.0, 1e-6}, {5e-3, 2550.0}, 0.085); }
ContinuumKeys sand_in_oil() { return keys_of({900.0, 1e-4}, {5e-4, 2650.0}, 0.3); }

SystemParameters parameters_in(const Units& u, ContinuumKeys keys) {
  const double density = u.kg / (u.m * u.m * u.m), gravity = u.m / (u.s * u.s);
  keys.fluid.density *= density;
  keys.fluid.kinematic_viscosity *= u.m * u.m / u.s;
  keys.grains.density *= density;
  keys.grains.diameter *= u.m;
  return system_parameters(keys, 0.157 * gravity, 9.8 * gravity);
}

// A bed, grains that move above it, fewer with the height, and water over them that hardly has any.
ColumnState state_in(const Units& u, const SystemParameters& parameters) {
  ColumnState state;
  const double bed = parameters.bed_cells;
  for (int i = 0; i < parameters.column.cells; ++i) {
    const double z = i < bed ? 0.0 : (i - bed) / bed;
    state.fraction.push_back(0.621 * std::exp(-12.0 * z * z));
    state.grain_velocity.push_back((1e-4 + 0.3 * z) * u.m / u.s);
    state.fluid_velocity.push_back((2e-4 + 0.4 * z) * u.m / u.s);
  }
  return state;
}

TEST(ColumnInOtherUnits, HasTheSameRates) {
  for (const ContinuumKeys& keys : {glass(), sand_in_oil()}) {
    for (const DragSpeed speed : {DragSpeed::total, DragSpeed::streamwise}) {
      ContinuumKeys own = keys;
      own.closures.closures.speed = speed;
      const auto rates_in = [&](const Units& u) {
        const SystemParameters parameters = parameters_in(u, own);
        const ColumnEquations equations(parameters.column);
        std::vector<double> rates(static_cast<std::size_t>(equations.size()));
        equations.rates(equations.unknowns_of(state_in(u, parameters)), rates);
        return rates;
      };
      const std::vector<double> here = rates_in({});
      for (const Units& u : others) {
        const std::vector<double> there = rates_in(u);
        ASSERT_EQ(here.size(), there.size());
        for (std::size_t i = 0; i < here.size(); ++i)
          ASSERT_EQ(here[i] * (i % 3 == 0 ? u.m / u.s : u.m / (u.s * u.s)), there[i]) << u.m << ' ' << u.s << ' ' << i;
      }
    }
  }
}

// Its integration takes other roundings and so other steps; both are within the relative error of velocities, 1e-4.
TEST(ColumnInOtherUnits, FlowsTheSameWithAsManySteps) {
  const auto flow_in = [](const Units& u) {
    SystemParameters parameters = parameters_in(u, glass());
    parameters.time_step = 0.2 * u.s;
    ContinuumSystem column(MPI_COMM_WORLD, parameters);
    column.advance();
    return column.diagnostics();
  };
  const std::vector<Diagnostic> here = flow_in({});
  for (const Units& u : others) {
    const std::vector<Diagnostic> there = flow_in(u);
    const double flux = *find_diagnostic(here, "q_star"), steps = *find_diagnostic(here, "integrator_steps");
    EXPECT_NEAR(*find_diagnostic(there, "q_star"), flux, 5e-4 * flux) << u.m << ' ' << u.s;
    EXPECT_NEAR(*find_diagnostic(there, "integrator_steps"), steps, 0.15 * steps) << u.m << ' ' << u.s;
  }
}

// Errors and creep are shares of the speed at which one layer flows fast: of fine sand in thick oil 0.2 mm/s.
TEST(ColumnInOtherUnits, ScalesFollowFromTheGrains) {
  const ColumnParameters glass_bed = parameters_in({}, glass()).column;
  EXPECT_NEAR(glass_bed.closures.rheology.creeping_rate, 2e-3, 2e-5);
  EXPECT_NEAR(glass_bed.closures.rheology.elastic_modulus, 2e5, 2e2);
  EXPECT_NEAR(glass_bed.shear_speed(), std::sqrt(1.55 * 9.8 * 5e-3), 1e-4);
  const ContinuumKeys oil = keys_of({900.0, 1e-3}, {1e-4, 2650.0}, 0.3);
  EXPECT_NEAR(parameters_in({}, oil).column.shear_speed(), (2650.0 / 900.0 - 1.0) * 9.8 * 1e-8 / 1e-3, 2e-7);
}

}  // namespace
}  // namespace thalweg::continuum::units_test
