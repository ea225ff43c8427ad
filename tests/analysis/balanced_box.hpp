// A stress balance of a small resolved system, for tests.
#pragma once

#include "analysis/observers/stress_balance.hpp"
#include "core/parallel/mpi_session.hpp"
#include "tests/coupling/water_box.hpp"

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace thalweg::analysis {

using coupling::glass_sphere;
using coupling::LatticeSystem;
using coupling::make_system;
using coupling::WaterBox;

using Values = std::map<std::string, std::vector<double>>;

inline Values by_name(const StressBalance& balance) {
  Values values;
  for (const Profile& profile : balance.profiles()) values[profile.name] = profile.values;
  return values;
}

inline std::unique_ptr<LatticeSystem<double>> system_of(const WaterBox& box) {
  return make_system<double>(box, MPI_COMM_WORLD, Decomposition::best_layout(box.cells, size_of(MPI_COMM_WORLD)));
}

inline StressBalance balance_of(const WaterBox& box, const LatticeSystem<double>& system, double layer,
                                std::vector<HeldGrains> held, MPI_Comm communicator = MPI_COMM_WORLD) {
  const BalanceScales scales{1000.0, 1000.0 * box.viscosity, 5e-3,
                             [g = box.gravity](double mass, double) { return Vec3(mass * g); },
                             box.spacing / box.time_step / std::sqrt(3.0)};
  return StressBalance(communicator, *system.snapshot().decomposition, layer, {0.0, 1e-4}, scales, std::move(held));
}

}  // namespace thalweg::analysis
