// The column as a system: what it conserves, the balance of its steady state, saving.
#include "continuum/column_keys.hpp"
#include "core/base/error.hpp"
#include "core/keys/key_error.hpp"
#include "tests/support/memory_archive.hpp"
#include "tests/support/named_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::continuum::column_test {
namespace {

constexpr double slope = 0.016, gravity = 9.8;

ContinuumKeys coarse_keys() {
  ContinuumKeys keys;
  keys.fluid = {1000.0, 1e-6};
  keys.grains = {5e-3, 2550.0};
  keys.column.shields_number = 0.085;
  keys.column.bed = 3.0;
  keys.column.cells_per_diameter = 5;
  return keys;
}

SystemParameters coarse_column() {
  const ContinuumKeys keys = coarse_keys();
  const double angle = std::atan(slope);
  SystemParameters parameters = system_parameters(keys, gravity * std::sin(angle), gravity * std::cos(angle));
  parameters.time_step = 5.0;
  return parameters;
}

// On a slope of 0.3 the shear stress of the bed itself, (phi rho_s + (1 - phi) rho_f) tan/(phi (rho_s - rho_f)) = 0.61
// of the pressure of the grains, is above mu_1: all of it flows, and spreads over the few diameters of water.
SystemParameters flooded_column() {
  ContinuumKeys keys = coarse_keys();
  keys.column.shields_number = 0.5;
  const double angle = std::atan(0.3);
  SystemParameters parameters = system_parameters(keys, gravity * std::sin(angle), gravity * std::cos(angle));
  parameters.time_step = 5.0;
  return parameters;
}

double diagnostic(const System& system, const std::string& name) {
  return *find_diagnostic(system.diagnostics(), name);
}

std::vector<double> profile(const ContinuumSystem& column, const std::string& name) {
  return test::named(column.profiles(), name).values;
}

TEST(Column, DepthFollowsFromTheShieldsNumber) {
  // tau* (s - 1) d/sin(atan S): 0.085 * 1.55 * 5 mm/0.0159980
  EXPECT_NEAR(coarse_column().depth, 0.0411777, 1e-6);
}

// The key by which a case is refused; empty: it is not.
std::string refused_key(const ContinuumKeys& keys) {
  try {
    check(keys, slope * gravity, gravity);
  } catch (const KeyError& error) {
    return error.key;
  }
  return {};
}

TEST(Column, MoreCellsThanAnIntHoldsAreRefused) {
  EXPECT_EQ(refused_key(coarse_keys()), "");
  ContinuumKeys keys = coarse_keys();
  keys.column.bed = 6e8;  // 3e9 cells, which are -1.3e9 in 32 bits
  EXPECT_EQ(refused_key(keys), "column.bed");
  keys.column.bed = 2e4;  // would do with fewer cells per diameter
  keys.column.cells_per_diameter = 6;
  EXPECT_EQ(refused_key(keys), "column.cells_per_diameter");
  keys.column.cells_per_diameter = std::int64_t{1} << 60;
  EXPECT_EQ(refused_key(keys), "column.cells_per_diameter");
  keys = coarse_keys();
  keys.column.shields_number = 1e300;
  EXPECT_EQ(refused_key(keys), "column.shields_number");
  keys.column.shields_number.reset();
  keys.column.depth = 3e6;  // m, 3e9 cells
  EXPECT_EQ(refused_key(keys), "column.depth");
  keys.column.depth = 2e-11;  // four cells of 5e-12 m, and 3e9 in the bed
  EXPECT_EQ(refused_key(keys), "column.depth");
}

TEST(Column, AStateGoesOnInCellsOfItsOwnHeightOnly) {
  const ContinuumSystem column(MPI_COMM_SELF, coarse_column());
  const test::MemoryArchive archive = test::saved(column, MPI_COMM_SELF);
  const auto load_with_height = [&archive](double factor) {
    SystemParameters parameters = coarse_column();
    parameters.column.spacing *= factor;
    ContinuumSystem other(MPI_COMM_SELF, parameters);
    test::load(other, archive);
  };
  EXPECT_NO_THROW(load_with_height(1.0 + 1e-12));
  // Heights as for a slope of 0.0161 in place of 0.016, with as many cells.
  for (const double factor : {0.9938, 1.0 / 0.9938, 1.0 + 1e-6}) EXPECT_THROW(load_with_height(factor), InputError);
}

TEST(Column, GrainsThatReachTheTopLeaveNoClearWater) {
  const SystemParameters parameters = flooded_column();
  ContinuumSystem column(MPI_COMM_SELF, parameters);
  const double bed = parameters.bed_cells * parameters.column.spacing;
  EXPECT_NEAR(diagnostic(column, "surface_height"), bed, parameters.column.spacing);
  column.advance();
  EXPECT_GT(profile(column, "solid_fraction").back(), 0.31);
  EXPECT_EQ(diagnostic(column, "surface_height"), parameters.column.height());
  EXPECT_EQ(diagnostic(column, "bed_stress"), 0.0);
  EXPECT_EQ(diagnostic(column, "shields_number"), 0.0);
  EXPECT_GT(diagnostic(column, "moving_depth"), bed);
  EXPECT_LE(diagnostic(column, "moving_depth"), parameters.column.height());
}

TEST(Column, ConservesSolidsAndComesToTheBalanceOfStresses) {
  ContinuumSystem column(MPI_COMM_SELF, coarse_column());
  const double solids = diagnostic(column, "solid_volume");
  EXPECT_NEAR(solids, 0.62 * coarse_column().bed_cells * coarse_column().column.spacing, 1e-15);
  EXPECT_EQ(diagnostic(column, "unsteadiness"), 1.0);
  while (column.time() < 100.0 && diagnostic(column, "unsteadiness") > 1e-4) column.advance();
  EXPECT_LT(diagnostic(column, "unsteadiness"), 1e-4);
  double sum = 0.0;
  for (const double fraction : profile(column, "solid_fraction")) sum += fraction * coarse_column().column.spacing;
  EXPECT_NEAR(sum / solids, 1.0, 1e-12);
  // A change of momentum of 1e-4 of the driving force a step is a stress of 1e-4 of it; the integrator's error adds to
  // it.
  const std::vector<double> total = profile(column, "total_stress"), driving = profile(column, "driving_stress");
  for (std::size_t i = 1; i + 1 < total.size(); ++i) EXPECT_NEAR(total[i], driving[i], 0.01 * driving.front()) << i;
}

}  // namespace
}  // namespace thalweg::continuum::column_test
