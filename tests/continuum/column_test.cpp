// The column as a system: what it conserves, the balance of its steady state, saving.
#include "continuum/column_keys.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace thalweg::continuum {
namespace {

constexpr double slope = 0.016, gravity = 9.8;

SystemParameters coarse_column() {
  ContinuumKeys keys;
  keys.fluid = {1000.0, 1e-6};
  keys.grains = {5e-3, 2550.0};
  keys.column.shields_number = 0.085;
  keys.column.bed = 3.0;
  keys.column.cells_per_diameter = 5;
  const double angle = std::atan(slope);
  SystemParameters parameters = system_parameters(keys, gravity * std::sin(angle), gravity * std::cos(angle));
  parameters.time_step = 5.0;
  return parameters;
}

double figure(const System& system, const std::string& name) { return *find_figure(system.figures(), name); }

std::vector<double> profile(const ContinuumSystem& column, const std::string& name) {
  for (const Profile& found : column.profiles())
    if (found.name == name) return found.values;
  ADD_FAILURE() << name;
  return {};
}

TEST(Column, DepthFollowsFromTheShieldsNumber) {
  // tau* (s - 1) d/sin(atan S): 0.085 * 1.55 * 5 mm/0.0159980
  EXPECT_NEAR(coarse_column().depth, 0.0411777, 1e-6);
}

TEST(Column, ConservesSolidsAndComesToTheBalanceOfStresses) {
  ContinuumSystem column(MPI_COMM_SELF, coarse_column());
  const double solids = figure(column, "solid_volume");
  EXPECT_NEAR(solids, 0.62 * coarse_column().bed_cells * coarse_column().column.spacing, 1e-15);
  EXPECT_EQ(figure(column, "unsteadiness"), 1.0);
  while (column.time() < 100.0 && figure(column, "unsteadiness") > 1e-4) column.advance();
  EXPECT_LT(figure(column, "unsteadiness"), 1e-4);
  double sum = 0.0;
  for (const double fraction : profile(column, "solid_fraction")) sum += fraction * coarse_column().column.spacing;
  EXPECT_NEAR(sum / solids, 1.0, 1e-12);
  // A change of momentum of 1e-4 of the driving force a step is a stress of 1e-4 of it; the integrator's error adds to
  // it.
  const std::vector<double> total = profile(column, "total_stress"), driving = profile(column, "driving_stress");
  for (std::size_t i = 1; i + 1 < total.size(); ++i) EXPECT_NEAR(total[i], driving[i], 0.01 * driving.front()) << i;
}

}  // namespace
}  // namespace thalweg::continuum
