// A small box with supplies and sinks, for the tests of dem/supply.
#pragma once

#include "core/parallel/ranks.hpp"
#include "tests/dem/clump_cases.hpp"
#include "tests/support/memory_archive.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace thalweg::dem::test::supply {

inline constexpr double small = 1.5e-3, large = 2.5e-3;  // m, radii

inline Decomposition box_on(int ranks) {
  const Index3 cells{16, 8, 16};
  return Decomposition(cells, 2.5e-3, {true, true, false}, Decomposition::best_layout(cells, ranks));
}

// Spheres that are small and large in turn, which come down in the middle.
inline Supply spheres(double rate) {
  Supply supply;
  supply.entrance = {{Vec3(0.012, 0.004, 0.025), Vec3(0.028, 0.016, 0.036)}, Vec3(0.3, 0.1, -0.5), 3};
  supply.rate = rate;
  supply.make = [](std::int64_t n) {
    return GrainSeeds{{glass_sphere(0, Vec3::Zero(), Vec3::Zero(), n % 2 == 0 ? small : large)}, {}};
  };
  return supply;
}

inline Supply clumps(double mass_rate) {
  Supply supply = spheres(mass_rate);
  supply.entrance.seed = 4;
  supply.by_mass = true;
  const std::shared_ptr<const ClumpShape> shape = pebble();
  supply.members = static_cast<int>(shape->members.size());
  supply.make = [shape](std::int64_t n) {
    ClumpSeed clump = glass_clump(0, shape, Vec3::Zero());
    clump.orientation = some_orientation(static_cast<int>(n));
    return GrainSeeds{{}, {clump}};
  };
  return supply;
}

inline constexpr double clump_mass_rate = 0.02;  // kg/s

inline GrainParameters parameters() {
  GrainParameters p = test::parameters(glass(0.5), 2.5e-5, 10);
  p.contact.normal_stiffness = 500.0;  // so that a step of 25 us is short enough
  p.contact.tangential_stiffness = 2.0 / 7.0 * 500.0;
  p.walls = face_planes(box_on(1).box(), p.contact);
  p.body_force = [](double mass, double) { return Vec3(mass * Vec3(2.0, 0.0, -15.0)); };
  p.ghost_width = 3e-3;
  p.attached_width = 1;
  return p;
}

// A box with two supplies, a sink on the left of its floor, and one on the right whose grains come back.
inline GrainParameters busy_box() {
  GrainParameters p = parameters();
  p.supplies = {spheres(900.0), clumps(clump_mass_rate)};
  Sink gone, back;
  gone.zone = {Vec3::Zero(), Vec3(0.012, 0.02, 0.006)};
  back.zone = {Vec3(0.03, 0.0, 0.0), Vec3(0.04, 0.02, 0.006)};
  back.recirculation = {{{Vec3(0.002, 0.0, 0.03), Vec3(0.038, 0.02, 0.038)}, std::nullopt, 5}, 0.05};
  p.sinks = {gone, back};
  return p;
}

// A large sphere, a small one and a clump, of the kinds that are supplied.
inline GrainSeeds few_at_start() {
  return {{glass_sphere(0, Vec3(0.02, 0.01, 0.004), Vec3::Zero(), large),
           glass_sphere(1, Vec3(0.01, 0.01, 0.004), Vec3::Zero(), small)},
          {glass_clump(2, pebble(), Vec3(0.03, 0.01, 0.01))}};
}
inline constexpr std::int64_t bodies_at_start = 3;
inline constexpr GlobalId ids_at_start = 5, ids_a_round = 4;

inline bool step(GrainDynamics& grains) {
  const bool changed = grains.turn_over();
  grains.prepare();
  grains.advance(grains.parameters().sub_steps);
  grains.refresh_ghosts();
  return changed;
}

inline void run(GrainDynamics& grains, int steps) {
  for (int n = 0; n < steps; ++n) step(grains);
}

inline double diagnostic(const GrainDynamics& grains, const std::string& name) {
  return find_diagnostic(grains.turnover_diagnostics(), name).value();
}

inline std::vector<GlobalId> all_ids(const GrainDynamics& grains) {
  const GrainStore& store = grains.store();
  return Ranks(MPI_COMM_WORLD)
      .gathered(std::vector<GlobalId>(store.id.begin(), store.id.begin() + static_cast<std::ptrdiff_t>(store.owned)));
}

}  // namespace thalweg::dem::test::supply
