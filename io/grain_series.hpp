// The grains as a time series for ParaView: one .vtp a frame, and grains.pvd that gives each its time.
#pragma once

#include "core/snapshot.hpp"
#include "io/pvd_index.hpp"

#include <mpi.h>

#include <filesystem>
#include <optional>

namespace thalweg::io {

// Writes grains/grains_<step>.vtp in the run folder: a point a grain, ordered by id, with the point arrays id, radius
// (m), velocity (m/s), speed (m/s), angular_velocity (rad/s), contact_force (N), contact_stress (Pa; nine components,
// row by row: xx, xy, xz, yx, ...; core/contact_stress.hpp), with a fluid fluid_force (N), where it is measured
// fluid_stress (Pa, nine components as well) and, where there are clumps, clump (id of the clump a member belongs to,
// -1 for others). All ranks write one file together, and no rank gathers the grains. All calls are collective and throw
// RunError on every rank if a file cannot be written.
class GrainSeries {
public:
  // continue_from: simulated time (s) at which a restarted run takes up an existing series; later frames leave the
  // index. Empty: a new series.
  GrainSeries(MPI_Comm communicator, const std::filesystem::path& run_folder,
              std::optional<double> continue_from = std::nullopt);

  void write(const Snapshot& snapshot);

private:
  MPI_Comm communicator_;
  std::filesystem::path folder_;
  PvdIndex index_;
};

}  // namespace thalweg::io
