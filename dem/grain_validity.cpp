#include "dem/grain_validity.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace thalweg::dem {

namespace {

struct Report {
  std::int64_t id = std::numeric_limits<std::int64_t>::max();
  GrainFault fault = GrainFault::none;
  double x[3] = {}, speed = 0.0;
};

// The report with the lowest id, on every rank.
Report lowest_of(Report report, MPI_Comm communicator) {
  std::int64_t lowest = 0;
  MPI_Allreduce(&report.id, &lowest, 1, MPI_INT64_T, MPI_MIN, communicator);
  int reporter = report.id == lowest ? rank_of(communicator) : 0, root = 0;
  MPI_Allreduce(&reporter, &root, 1, MPI_INT, MPI_MAX, communicator);
  MPI_Bcast(&report, sizeof(Report), MPI_BYTE, root, communicator);
  return report;
}

}  // namespace

GrainFault GrainValidity::fault_of(const GrainStore& store, std::size_t s, double displacement) const {
  const Vec3& x = store.position[s];
  const double speed = store.velocity[s].norm(), radius = store.radius[s];
  if (!x.allFinite() || !std::isfinite(speed)) return GrainFault::not_finite;
  if (!space.holds(x, radius)) return GrainFault::outside;
  if (!holds_translation(store.motion[s])) {
    if (space.beyond_wall(x, radius)) return GrainFault::beyond_wall;
    if (space.deep_in_plate(x, radius)) return GrainFault::in_plate;
    if (std::binary_search(in_solids.begin(), in_solids.end(), s)) return GrainFault::in_solid;
  }
  if (speed * time_step * sub_steps > radius) return GrainFault::too_fast;
  return displacement > 0.5 * skin ? GrainFault::outran : GrainFault::none;
}

void GrainValidity::throw_first(const GrainStore& store, const PeriodicBox& box, const std::vector<Vec3>& listed,
                                MPI_Comm communicator) const {
  Report mine;
  for (std::size_t s = 0; s < store.owned && mine.fault == GrainFault::none; ++s) {
    const Vec3& x = store.position[s];
    const GrainFault fault = fault_of(store, s, box.difference(x, listed[s]).norm());
    if (fault != GrainFault::none) mine = {store.id[s], fault, {x[0], x[1], x[2]}, store.velocity[s].norm()};
  }
  const Report report = lowest_of(mine, communicator);
  const std::string grain = fmt::format("Grain {} at ({:g}, {:g}, {:g}) m, moving at {:g} m/s,", report.id, report.x[0],
                                        report.x[1], report.x[2], report.speed);
  switch (report.fault) {
    case GrainFault::not_finite:
      throw RunError(grain + " has a position or velocity that is not a number; its load or its contacts diverged.");
    case GrainFault::outside:
      throw RunError(grain + " is more than its radius beyond a face of the box that is not periodic.");
    case GrainFault::beyond_wall:
      throw RunError(grain + " is more than its radius beyond a wall.");
    case GrainFault::in_plate:
      throw RunError(grain +
                     " is more than half its radius deep in a plate; use stiffer contacts, or less load or speed.");
    case GrainFault::in_solid:
      throw RunError(grain +
                     " is more than half its radius deep in a solid; use stiffer contacts, or less load or speed.");
    case GrainFault::too_fast:
      throw RunError(fmt::format("{} moves more than its radius in {} steps of {:g} s; use a shorter time step.", grain,
                                 sub_steps, time_step));
    default:
      throw RunError(
          fmt::format("{} has moved more than half the skin of {:g} m since the neighbour list was built; use a "
                      "shorter time step or a wider skin.",
                      grain, skin));
  }
}

}  // namespace thalweg::dem
